"""A wrong matrix with everything that its diagnosis may look at."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Exercise
from service.grading.comparison import Match, matches
from service.grading.feedback import Finding
from service.grading.samples import Samples
from service.kinematics.chain import Table, links
from service.kinematics.dh import Convention
from service.kinematics.transforms import Matrices, Numbers

Mask = NDArray[np.bool_]
Block = tuple[slice, slice]

WHOLE: Block = (slice(None), slice(None))


@dataclass(frozen=True)
class Chain:
    """The links of the reference in one convention.

    ``table`` is ``(rows, 4, SAMPLES)``. ``frames`` names the frame that each row starts from, and
    in the end the last one that is reached. ``own`` says that it is the exercise's own convention.
    """

    table: Table
    convention: Convention
    frames: tuple[str, ...]
    own: bool = True

    @cached_property
    def links(self) -> Matrices:
        """The link transform of each row, ``(rows, SAMPLES, 4, 4)``."""
        return links(self.table, self.convention)

    @cached_property
    def from_base(self) -> Matrices:
        """The pose of the frame behind each row in the base frame: A_1, A_1 A_2 and so on."""
        return _running_products(self.links)

    @cached_property
    def to_end(self) -> Matrices:
        """The pose of the last frame in the one before each row: A_{n-1} A_n, A_n at the end."""
        turned = np.swapaxes(self.links[::-1], -1, -2)
        return np.swapaxes(_running_products(turned), -1, -2)[::-1]

    @property
    def other_convention(self) -> Convention:
        """The convention that this chain's table is not written in."""
        if self.convention is Convention.STANDARD:
            return Convention.MODIFIED
        return Convention.STANDARD

    @cached_property
    def misread_links(self) -> Matrices:
        """The link transforms of the same numbers in the other convention."""
        return links(self.table, self.other_convention)

    def product(self, order: Sequence[int]) -> str:
        """The product of the links in this order, as it is written: A1·A2·A3."""
        return "·".join(f"A{self.frames[i + 1]}" for i in order)

    def frame(self, i: int) -> str:
        """Frame ``i`` as a textbook writes it, with the convention where it is not the usual."""
        name = f"{{{self.frames[i]}}}"
        return name if self.own else f"{name} of the {self.convention.value} convention"


def _running_products(transforms: Matrices) -> Matrices:
    products = np.empty_like(transforms)
    products[0] = transforms[0]
    for i in range(1, len(transforms)):
        np.matmul(products[i - 1], transforms[i], out=products[i])
    return products


def chains_of(exercise: Exercise, samples: Samples) -> tuple[Chain, ...]:
    """The exercise's robot in each convention that can express it, its own first."""
    robot = exercise.robot
    base = str(robot.joints[0].index - 1)
    order = sorted(robot.tables, key=lambda convention: convention is not robot.convention)
    return tuple(
        Chain(
            table=robot.tables[convention].values(samples.values, samples.count),
            convention=convention,
            frames=(base, *robot.tables[convention].labels),
            own=convention is robot.convention,
        )
        for convention in order
    )


@dataclass(frozen=True)
class MatrixCase:
    """A matrix that was handed in and is not the expected one.

    ``actual`` and ``expected`` are ``(rows, columns, SAMPLES)``, NaN where nothing could be read;
    ``scale`` ``(rows, columns)`` is what entries are measured against; ``wrong`` says which have a
    value and are wrong. ``rigid`` marks a transform (4×4) or rotation (3×3), as against a matrix of
    any other meaning. ``chains`` holds the links that it is the product of, in each convention;
    none where it is not a product of links.
    """

    actual: Numbers
    expected: Numbers
    scale: Numbers
    wrong: Mask
    rigid: bool
    chains: tuple[Chain, ...] = ()

    @property
    def is_transform(self) -> bool:
        """Whether it is homogeneous: a rotation, a position and the bottom row."""
        return self.rigid and self.expected.shape[:2] == (4, 4)

    def agrees(self, other: Numbers, block: Block = WHOLE) -> Mask:
        """Where this block of the student's matrix is ``other``, ``(..., rows, columns, n)``."""
        return self._match(self.actual[block], other, block)

    def would_be_right(self, other: Numbers, block: Block = WHOLE) -> Mask:
        """Where this block of the expected matrix is ``other``, so that it explains nothing."""
        return self._match(self.expected[block], other, block)

    def explained_by(self, other: Numbers, block: Block = WHOLE) -> Mask:
        """Whether each of ``other`` is this block as written, and not as expected: ``(...)``."""
        agree, right = self.agrees(other, block), self.would_be_right(other, block)
        return np.asarray(agree.all(axis=(-2, -1)) & ~right.all(axis=(-2, -1)))

    def _match(self, one: Numbers, other: Numbers, block: Block) -> Mask:
        return np.asarray(matches(one, other, self.scale[block]) >= Match.ROUNDED)

    def area(self, *blocks: Block) -> Mask:
        """The mask of the entries in these blocks."""
        mask = np.zeros(self.expected.shape[:2], dtype=np.bool_)
        for block in blocks:
            mask[block] = True
        return mask


@dataclass(frozen=True, slots=True)
class Explanation:
    """What is wrong with many entries at once, and which entries that explains.

    ``row`` is the label of the row that it is about, if it is about one.
    """

    finding: Finding
    entries: Mask
    row: str | None = None
