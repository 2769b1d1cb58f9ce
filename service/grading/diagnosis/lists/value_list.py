"""Slips in a list of values; each value is a length, an angle or a number."""

import numpy as np

from service.expressions.printing.spelling import PLAIN
from service.grading.diagnosis.formulas.formula_repair import WrongEntry
from service.grading.diagnosis.lists.angle import diagnose_angle
from service.grading.diagnosis.matrices.matrix_entry import ENTRY_WORK, diagnose
from service.grading.diagnosis.upstream.missing_symbol import Requirements
from service.grading.diagnosis.upstream.slip_search import SlipSearch
from service.grading.diagnosis.upstream.slipped_answers import SlippedAnswers
from service.grading.diagnosis.wrong_value import Mask
from service.grading.feedback import Finding
from service.grading.judging.value_list import ComparedValues
from service.grading.part import Grading

# The work of explaining a whole list of values, as the budget counts it.
SEARCH_WORK = 15.0


def search_of(
    answers: SlippedAnswers | None, compared: ComparedValues, wrong: Mask, grading: Grading
) -> SlipSearch | None:
    """Return a search for mistakes in the robot's table that explain the list, or None."""
    if answers is None:
        return None
    student = compared.student
    return SlipSearch(
        answers,
        grading.samples,
        student.values,
        compared.expected,
        wrong,
        scale=compared.scales(grading),
        angle=np.array([[quantity == "angle"] for quantity in student.quantities]),
        name=grading.symbol_names(student.entries),
        unwritten=grading.unwritten(student.entries),
    )


def slips_of(
    compared: ComparedValues,
    wrong: Mask,
    grading: Grading,
    answers: SlippedAnswers | None = None,
) -> dict[tuple[int, int], Finding]:
    """Return the findings on the wrong values of a list; the keys are ``(index, 0)``."""
    # The work budget limits the findings. answers tells on which symbols each correct value
    # depends.
    student, scales = compared.student, compared.scales(grading)
    requirements = answers and Requirements(
        answers, grading.exercise, grading.samples, compared.expected, scales
    )
    spelling = grading.spelling(student.entries) if wrong.any() else PLAIN
    slips: dict[tuple[int, int], Finding] = {}
    for i in np.flatnonzero(wrong).tolist():
        if (expression := student.entries[i].expression) is None or not grading.affords(ENTRY_WORK):
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
        required = requirements.of(i) if requirements else None
        slips[i, 0] = diagnose_angle(case) if angle else diagnose(case, required)
    return slips
