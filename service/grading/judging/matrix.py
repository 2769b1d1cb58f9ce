"""Compare a matrix with the expected matrix, entry by entry."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from service.expressions import Kind
from service.grading.numerics.comparison import entry_matches
from service.grading.numerics.samples import Samples
from service.grading.reading.matrices.matrix import StudentMatrix
from service.kinematics.transforms import Numbers


@dataclass(frozen=True, slots=True)
class ExpectedMatrix:
    """The correct matrix: the ``values`` and the quantity (length, angle …) of each entry.

    ``rigid`` marks a homogeneous transform (4×4) or a rotation (3×3).
    """

    values: Numbers
    quantities: tuple[tuple[Kind, ...], ...]
    rigid: bool = False

    def scale(self, length_scale: float) -> Numbers:
        """Return the scale of each entry's tolerance, ``(rows, columns)``."""
        return np.array(
            [[length_scale if q == "length" else 1.0 for q in row] for row in self.quantities]
        )

    def matches(
        self, student: StudentMatrix, length_scale: float, samples: Samples
    ) -> NDArray[np.int_]:
        """Compare a student's matrix with this matrix; return the Match (result) of each entry."""
        scale = self.scale(length_scale)
        return entry_matches(student.expressions, student.values, self.values, scale, samples)
