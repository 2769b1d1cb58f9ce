"""A wrong matrix with all that its diagnosis needs."""

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
    """A wrong matrix: ``(rows, columns, SAMPLES)``, NaN where nothing could be read.

    ``wrong`` ``(rows, columns)`` marks the entries that have a value and are wrong. ``rigid`` marks
    a transform (4×4) or rotation (3×3), as against a matrix of any other meaning. ``chains`` holds
    the links that it is the product of, in each convention; none where it is not a product of
    links. ``motion`` is what the formulas say that it is made of, where the exercise gives them.
    ``slips`` holds it against the answers that slips of the table lead to, None where it is not the
    robot's.
    """

    wrong: Mask
    rigid: bool
    chains: tuple[Chain, ...] = ()
    slips: SlipSearch | None = None
    motion: GivenMotion | None = None

    @property
    def is_transform(self) -> bool:
        """Whether it is homogeneous: a rotation, a position and the bottom row."""
        return self.rigid and self.expected.shape[:2] == (4, 4)

    @cached_property
    def other_poses(self) -> tuple[list[Explained], Numbers]:
        """The poses that slips in the product of the links lead to, and their entries.

        The entries are ``(poses, rows, columns, SAMPLES)``, as many rows and columns as expected.
        """
        poses = other_poses(self.chains)
        rows, columns = self.expected.shape[:2]
        if not poses:
            return [], np.empty((0, *self.expected.shape))
        return poses, as_entries(np.array([pose.answer for pose in poses]))[:, :rows, :columns]

    def mask(self, *blocks: Index) -> Mask:
        """The mask of the entries in these blocks, ``(rows, columns)``."""
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
    """What is wrong with many entries at once, and which entries that explains."""

    finding: Finding
    entries: Mask


def as_explanations(case: MatrixCase, found: Explained | None) -> list[Explanation]:
    """The findings of a hypothesis with the entries that it explains; none for None."""
    if found is None:
        return []
    return [Explanation(finding, case.mask(found.entries)) for finding in found.findings]
