"""Compare a list of lengths, angles and numbers with the expected list."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from service.grading.formula_text import number_formula
from service.grading.numerics.comparison import entry_matches
from service.grading.part import Grading
from service.grading.reading.lists.value_list import StudentValues
from service.grading.report import Correction
from service.kinematics.transforms import Numbers


@dataclass(frozen=True, slots=True)
class ComparedValues:
    """The n values of a list as read, and the expected values, ``(n, SAMPLES)`` each.

    ``corrections`` are the expected values as formulas, None for an unknown formula.
    """

    student: StudentValues
    expected: Numbers
    corrections: Sequence[Correction | None] = ()

    def scales(self, grading: Grading) -> Numbers:
        """Return the scale of each value's tolerance."""
        lengths = [quantity == "length" for quantity in self.student.quantities]
        return np.where(lengths, grading.exercise.length_scale, 1.0)

    def matches(self, grading: Grading) -> NDArray[np.int_]:
        """Return the comparison result of each value; angles are equal modulo 2π."""
        student, scales = self.student, self.scales(grading)
        angle = np.array([[quantity == "angle"] for quantity in student.quantities])
        return entry_matches(
            student.expressions, student.values, self.expected, scales, grading.samples, angle
        )


def number_corrections(expected: Numbers, grading: Grading) -> list[Correction | None]:
    """Return the expected values as numbers; None for a value that varies."""
    # All are None if the report shows no corrections.
    return [number_formula(each) if grading.corrects else None for each in expected]
