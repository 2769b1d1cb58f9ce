"""Slips in a list of single values, each of its own quantity."""

import numpy as np
from numpy.typing import NDArray

from service.expressions.printing.spelling import PLAIN
from service.grading.diagnosis.angle import diagnose_angle
from service.grading.diagnosis.formula_repair import WrongEntry
from service.grading.diagnosis.matrix_entry import diagnose
from service.grading.feedback import Finding
from service.grading.judging.value_list import ComparedValues
from service.grading.part import Grading


def slips_of(
    compared: ComparedValues, wrong: NDArray[np.bool_], grading: Grading
) -> dict[tuple[int, int], Finding]:
    """The finding on each wrong value that was read, at (its place, 0)."""
    student, scales = compared.student, compared.scales(grading)
    spelling = grading.spelling(student.entries) if wrong.any() else PLAIN
    slips: dict[tuple[int, int], Finding] = {}
    for i in np.flatnonzero(wrong).tolist():
        if (expression := student.entries[i].expression) is None:
            continue
        angle = student.quantities[i] == "angle"
        case = WrongEntry(
            expression=expression,
            actual=student.values[i],
            expected=compared.expected[i],
            samples=grading.samples,
            scale=float(scales[i]),
            angle=angle,
            correction=compared.corrections[i],
            spelling=spelling,
            turning=grading.exercise.vocabulary.turning,
            corrects=grading.corrects,
        )
        slips[i, 0] = diagnose_angle(case) if angle else diagnose(case)
    return slips
