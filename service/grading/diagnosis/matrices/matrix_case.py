"""A wrong matrix with the data for its diagnosis."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from service.grading.diagnosis.motions.given_motion import GivenMotion
from service.grading.diagnosis.motions.link_products import Chain, other_poses
from service.grading.diagnosis.upstream.slip_search import SlipSearch
from service.grading.diagnosis.wrong_value import Mask, WrongNumbers
from service.grading.feedback import Finding
from service.grading.judging.expected import as_entries
from service.grading.misconception import Explained, Index
from service.kinematics.transforms import Numbers

Block = tuple[slice, slice]

ROTATION_BLOCK: Block = (slice(0, 3), slice(0, 3))
POSITION_BLOCK: Block = (slice(0, 3), slice(3, 4))
UPPER_ROWS: Block = (slice(0, 3), slice(None))
BOTTOM_ROW: Block = (slice(3, 4), slice(None))


@dataclass(frozen=True)
class MatrixCase(WrongNumbers):
    """A wrong matrix ``(rows, columns, SAMPLES)``; unreadable entries are NaN."""

    # The entries (rows, columns) that have a value and are wrong.
    wrong: Mask
    # True for a transform or a rotation.
    rigid: bool
    # The links whose product is the correct matrix, if it is such a product.
    chains: tuple[Chain, ...] = ()
    # Compares the matrix with the wrong answers that mistakes in the table lead to. None if there
    # are no such answers.
    slips: SlipSearch | None = None
    # The turns and displacements in the formulas of the exercise.
    motion: GivenMotion | None = None

    @property
    def is_transform(self) -> bool:
        """True if the matrix has a rotation, a position and the bottom row."""
        return self.rigid and self.expected.shape[:2] == (4, 4)

    @cached_property
    def other_poses(self) -> tuple[list[Explained], Numbers]:
        """The wrong poses that mistakes in the product of links lead to, with their entries."""
        # The entries are (poses, rows, columns, SAMPLES), cut to the size of the expected matrix.
        poses = other_poses(self.chains)
        rows, columns = self.expected.shape[:2]
        if not poses:
            return [], np.empty((0, *self.expected.shape))
        return poses, as_entries(np.array([pose.answer for pose in poses]))[:, :rows, :columns]

    def mask(self, *blocks: Index) -> Mask:
        """Return a mask of the entries in these blocks, ``(rows, columns)``."""
        mask = np.zeros(self.expected.shape[:2], dtype=np.bool_)
        for block in blocks:
            mask[block] = True
        return mask


class UpperRows:
    """The rotation and the position of a wrong matrix."""


class RotationBlock:
    """The rotation of a wrong matrix."""


class PositionBlock:
    """The position of a wrong matrix."""


@dataclass(frozen=True, slots=True)
class Explanation:
    """A finding on several entries, and a mask of these entries."""

    finding: Finding
    entries: Mask


def as_explanations(case: MatrixCase, found: Explained | None) -> list[Explanation]:
    """Convert a misconception to explanations of matrix entries; None gives no explanations."""
    if found is None:
        return []
    return [Explanation(finding, case.mask(found.entries)) for finding in found.findings]
