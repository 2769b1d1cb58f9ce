"""A list of single values, each of its own quantity, held against what was expected."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from service.expressions import Kind
from service.grading.comparison import matches
from service.grading.part import Grading
from service.grading.reading.entry import Entry
from service.kinematics.transforms import Numbers


@dataclass(frozen=True, slots=True)
class WrittenValues:
    """What was written and what was expected, ``(n, SAMPLES)``.

    ``texts`` is what would be right as formulas, each empty where it is not known as one.
    """

    entries: Sequence[Entry]
    expected: Numbers
    quantities: Sequence[Kind]
    texts: Sequence[str]

    def actual(self, grading: Grading) -> Numbers:
        """The numbers that were written, ``(n, SAMPLES)``; NaN where there are none."""
        return grading.reader.numbers(self.entries, self.quantities)

    def scales(self, grading: Grading) -> Numbers:
        """What each value is measured against, ``(n,)``."""
        lengths = [quantity == "length" for quantity in self.quantities]
        return np.where(lengths, grading.exercise.length_scale, 1.0)

    def matches(self, grading: Grading) -> NDArray[np.int_]:
        """The Match of each value, ``(n,)``; angles modulo 2π."""
        angle = np.array([quantity == "angle" for quantity in self.quantities])
        return matches(
            self.actual(grading),
            self.expected,
            self.scales(grading),
            angle=angle[:, None],
            rounded=[entry.may_be_rounded for entry in self.entries],
        )
