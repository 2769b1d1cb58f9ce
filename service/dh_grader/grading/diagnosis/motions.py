"""The case of a wrong matrix, slips in a product of link transforms, and the turns of a motion.

This file has what ``matrices.py`` and ``products.py`` both need: a wrong matrix with its blocks,
the links that it is a product of, and the motion that an exercise gives in formulas.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, reduce
from itertools import chain, permutations

import numpy as np

from dh_grader.catalogue import Exercise, FormulaGrid, grid_values
from dh_grader.expressions import Expression
from dh_grader.grading.diagnosis.upstream import SlipSearch
from dh_grader.grading.judging import as_entries
from dh_grader.grading.misconception import (
    Explained,
    Index,
    Mask,
    Written,
    WrongNumbers,
    hypotheses_of,
    misconception,
    says,
)
from dh_grader.grading.numbers import EXACT_VALUE, Samples
from dh_grader.grading.report import Finding
from dh_grader.kinematics import Convention, Matrices, Numbers, Table, compound, links
from dh_grader.translations import Sentence, say

# --- Slips in a product of link transforms
#
# Each misconception yields a wrong pose ``(SAMPLES, 4, 4)`` and a phrase for that pose, such as
# "the pose of frame {2}". The student may have submitted the pose, or only its rotation or its
# position. Therefore ``named`` puts the phrase into a sentence that fits the answer: "This matrix
# is …", or "The position comes from …".


LinkPose = Written[Matrices]


@dataclass(frozen=True)
class Chain:
    """The links of the exercise's robot."""

    # The DH table (rows, 4, SAMPLES).
    table: Table
    convention: Convention
    # The names of the frames before each row and of the last frame.
    frames: tuple[str, ...]

    @cached_property
    def links(self) -> Matrices:
        """The link transform of each row, ``(rows, SAMPLES, 4, 4)``."""
        return links(self.table, self.convention)

    @cached_property
    def from_base(self) -> Matrices:
        """The poses of frames 1, 2, … in the base frame."""
        return _running_products(self.links)

    @cached_property
    def to_end(self) -> Matrices:
        """The poses of the last frame in frames 0, 1, …."""
        turned = np.swapaxes(self.links[::-1], -1, -2)
        return np.swapaxes(_running_products(turned), -1, -2)[::-1]

    @cached_property
    def misread_links(self) -> Matrices:
        """The link transforms, computed with the formula of the other DH convention."""
        return links(self.table, self.convention.other)

    def product(self, order: Sequence[int]) -> str:
        """Return a product of links as a formula: A1·A2·A3."""
        return "·".join(f"A{self.frames[i + 1]}" for i in order)

    def frame(self, i: int) -> str:
        """Return the name of frame ``i`` in braces: {2}."""
        return f"{{{self.frames[i]}}}"


def _running_products(transforms: Matrices) -> Matrices:
    products = np.empty_like(transforms)
    products[0] = transforms[0]
    for i in range(1, len(transforms)):
        np.matmul(products[i - 1], transforms[i], out=products[i])
    return products


def chains_of(exercise: Exercise, samples: Samples) -> tuple[Chain, ...]:
    """Return the links of the exercise's robot, as a tuple with one ``Chain``."""
    robot = exercise.robot
    table = robot.tables[robot.convention]
    base = str(robot.joints[0].index - 1)
    values = table.values(samples.values, samples.count)
    return (Chain(values, robot.convention, frames=(base, *table.labels)),)


def _other_pose(pose: Sentence, advice: Sentence, correction: Sentence) -> Finding:
    return says(say("{pose}. {advice}", pose=pose, advice=advice), correction)


@misconception(
    of=Chain,
    rank=10,
    code="reversed_product",
    rule="product",
    means="the link transforms, exponentials, turns or motions are multiplied in the wrong order",
    example=("planar-rr", "position", "[a2 c2 + a1 c12, a2 s2 + a1 s12]"),
    unlike={"1/1": "a0*c1 + a2*c12"},
)
def reversed_product(chain: Chain) -> Iterator[LinkPose]:
    """The link transforms were multiplied in reverse order."""
    order = range(len(chain.links))
    finding = _other_pose(
        say(
            "the product of the link transforms in reverse order, {product}",
            product=chain.product(order[::-1]),
        ),
        say("Each link transform describes its frame in the one before."),
        say("Multiply {product}.", product=chain.product(order)),
    )
    yield Written(compound(chain.links[::-1]), finding)


@misconception(
    of=Chain,
    rank=20,
    code="other_convention",
    rule="convention",
    means="the table is multiplied out with the link transform of the other convention",
    example=("planar-rr", "position", "[a1 + a2 c1, a2 s1]"),
    unlike={"2/1": "0"},
)
def other_convention(chain: Chain) -> Iterator[LinkPose]:
    """The table was multiplied out with the formula of the other DH convention."""
    if chain.convention is Convention.STANDARD:
        pose = say(
            "the product that the table gives with the link transform of the modified convention"
        )
        correction = say("The table is written in the standard convention.")
    else:
        pose = say(
            "the product that the table gives with the link transform of the standard convention"
        )
        correction = say("The table is written in the modified convention.")
    advice = say("Check in which order a link transform moves about and along z and x.")
    yield Written(compound(chain.misread_links), _other_pose(pose, advice, correction))


@misconception(
    of=Chain,
    rank=30,
    code="wrong_frame",
    rule="product",
    means="the answer is the pose of a frame before the last one",
    example=(
        "spherical-wrist",
        "pose",
        "[c4, 0, -s4, d6*c4*s5; s4, 0, c4, d6*s4*s5; 0, -1, 0, d6*c5; 0, 0, 0, 1]",
    ),
    unlike={"3/1": "-c5*s6"},
)
def wrong_frame(chain: Chain) -> Iterator[LinkPose]:
    """The student submitted the pose of a frame before the last one."""
    last = len(chain.links)
    for k in reversed(range(1, last)):
        finding = _other_pose(
            say("the pose of frame {frame}", frame=chain.frame(k)),
            say("The pose of frame {frame} is asked for.", frame=chain.frame(last)),
            say("Go on with {product}.", product=chain.product(range(k, last))),
        )
        yield Written(chain.from_base[k - 1], finding)


@misconception(
    of=Chain,
    rank=40,
    code="wrong_base",
    rule="product",
    means="the answer is the pose in a frame after the first one",
    example=("planar-rr", "position", "[a2 c2, a2 s2]"),
    unlike={"2/1": "0"},
)
def wrong_base(chain: Chain) -> Iterator[LinkPose]:
    """The pose is described in a later frame instead of in the base frame."""
    for k in range(1, len(chain.links)):
        finding = _other_pose(
            say("the pose seen from frame {frame}", frame=chain.frame(k)),
            say("The pose in frame {frame} is asked for.", frame=chain.frame(0)),
            say("Put {product} in front.", product=chain.product(range(k))),
        )
        yield Written(chain.to_end[k], finding)


@misconception(
    of=Chain,
    rank=50,
    code="missing_link",
    rule="product",
    means="a link transform is missing in the product",
    example=(
        "scara",
        "pose",
        "[c14, -s14, 0, a1 c1; s14, c14, 0, a1 s1; 0, 0, 1, d3 + d4; 0, 0, 0, 1]",
    ),
    unlike={"2/2": "90"},
)
def missing_link(chain: Chain) -> Iterator[LinkPose]:
    """One link transform is missing in the product."""
    last = len(chain.links)
    poses = chain.from_base[: last - 2] @ chain.to_end[2:]
    for k, pose in enumerate(poses, start=1):
        finding = _other_pose(
            say("the product without {link}", link=f"A{chain.frames[k + 1]}"),
            say("Check that each row of the table takes part in the product."),
            say("Multiply {product}.", product=chain.product(range(last))),
        )
        yield Written(pose, finding)


@misconception(
    of=Chain,
    rank=60,
    code="premultiplied",
    rule="product",
    means="one link transform, or every turn and shift, is multiplied from the left",
    example=(
        "scara",
        "pose",
        (
            "[cos(theta1 + theta2 - theta4), -sin(theta1 + theta2 - theta4), 0, a1 cos(theta2 - "
            "theta4) + a2 c4; -sin(theta1 + theta2 - theta4), -cos(theta1 + theta2 - theta4), 0, "
            "-a1 sin(theta2 - theta4) + a2 s4; 0, 0, -1, d3 + d4; 0, 0, 0, 1]"
        ),
    ),
    unlike={"1/4": "-(a1*c1 + a2*c12)", "3/3": "-1/2"},
)
def premultiplied(chain: Chain) -> Iterator[LinkPose]:
    """One or more transforms were multiplied from the left instead of from the right.

    That is correct for motions about fixed axes, but the axes of the links move.
    """
    order = list(range(len(chain.links)))
    advice = say("Check on which side a motion about a moving axis is multiplied.")
    correction = say("Multiply from the right throughout: {product}.", product=chain.product(order))
    poses = chain.links[1:] @ chain.from_base[:-1]
    poses[:-1] = poses[:-1] @ chain.to_end[2:]
    for k, pose in zip(order[1:], poses, strict=True):
        wrong_order = chain.product([k, *order[:k], *order[k + 1 :]])
        used = say(
            "the product with {link} multiplied from the left, {product}",
            link=f"A{chain.frames[k + 1]}",
            product=wrong_order,
        )
        yield Written(pose, _other_pose(used, advice, correction))
    used = say("the product of all rotations and translations, each put on the left")
    yield Written(compound(chain.misread_links[::-1]), _other_pose(used, advice, correction))


@misconception(
    of=Chain,
    rank=70,
    code="row_order",
    rule="product",
    means="a link transform is at the wrong place in the product",
    example=(
        "planar-rrr-standard",
        "pose",
        (
            "[c123, -s123, 0, l2 c2 + l3 c23 + l1 c123; s123, c123, 0, l2 s2 + l3 s23 + l1 s123; "
            "0, 0, 1, 0; 0, 0, 0, 1]"
        ),
    ),
    unlike={"2/2": "2*c123"},
)
def row_order(chain: Chain) -> Iterator[LinkPose]:
    """One link transform is at the wrong place in the product.

    Exchanges of two neighbours, and link transforms moved to the front, are not tried here.
    """
    count = len(chain.links)
    orders = [
        [*rest[:place], row, *rest[place:]]
        for row in range(count)
        for place in range(1, count)
        if abs(place - row) > 1
        for rest in [[i for i in range(count) if i != row]]
    ]
    if not orders:
        return
    poses = compound(np.swapaxes(chain.links[orders], 0, 1))
    for order, pose in zip(orders, poses, strict=True):
        finding = _other_pose(
            say("the product in the order {product}", product=chain.product(order)),
            say("Check which joint each row of the table belongs to."),
            say("Multiply {product}.", product=chain.product(range(count))),
        )
        yield Written(pose, finding)


def other_poses(chains: tuple[Chain, ...]) -> list[Explained]:
    """Return all wrong poses that the misconceptions lead to."""
    return [pose for chain in chains for pose in hypotheses_of(chain)]


def named(pose: Explained, told: str, *others: Finding) -> Callable[[], tuple[Finding, ...]]:
    """Return a function that builds the findings on a wrong pose.

    ``told`` is the template of the hint, such as "This matrix is {pose}. {advice}".
    """

    # The findings ``others`` come first.
    def findings() -> Iterator[Finding]:
        yield from others
        for each in pose.findings:
            assert isinstance(each.hint, Sentence)
            yield replace(each, hint=say(told, **each.hint.values))

    return lambda: tuple(findings())


# --- Split a composite motion into turns and displacements
#
# A displacement is the sum of the terms of a position that are turned by the same angles. A turn is
# the rotation that remains if all angles except one are 0.
#
# An exercise gives the motion in formulas. The turns before a displacement are those whose angles
# change it.


# With more turns, they are not told apart.
MAX_TURNS = 4


@dataclass(frozen=True, slots=True)
class Displacement:
    """A term of a position, which contains ``lengths`` and is turned by ``angles``."""

    lengths: tuple[str, ...]
    angles: tuple[str, ...]


IN_NUMBERS = Displacement((), ())


@dataclass(frozen=True)
class GivenMotion:
    """A composite motion, which an exercise gives in formulas."""

    # A position (one row), a rotation or a transform.
    grid: FormulaGrid
    # The values of the symbols at count samples.
    values: Mapping[str, Numbers]
    count: int
    # The symbols in the formulas.
    angles: tuple[str, ...]
    lengths: tuple[str, ...]

    @classmethod
    def of(cls, part_id: str, exercise: Exercise, samples: Samples) -> "GivenMotion | None":
        """Return the motion that an exercise gives in formulas, or None without formulas."""
        grid = exercise.formulas.get(part_id)
        if grid is None:
            return None
        used = {name for formula in chain(*grid) for name in formula.symbols}
        of_kind = {
            kind: tuple(v.name for v in exercise.variables if v.kind == kind and v.name in used)
            for kind in ("angle", "length")
        }
        angles = of_kind["angle"] if len(of_kind["angle"]) <= MAX_TURNS else ()
        return cls(grid, samples.values, samples.count, angles, of_kind["length"])

    def position(self, zeros: Iterable[str] = ()) -> Numbers:
        """Return the n coordinates ``(n, samples)`` of the position.

        The symbols ``zeros`` are set to 0.
        """
        column = self.grid[0] if len(self.grid) == 1 else [row[3] for row in self.grid[:3]]
        return np.asarray(self._numbers([column], zeros)[0])

    def rotation(self, zeros: Iterable[str] = ()) -> Numbers:
        """Return the rotation ``(3, 3, samples)`` with the symbols ``zeros`` set to 0."""
        return self._numbers([row[:3] for row in self.grid[:3]], zeros)

    def _numbers(self, grid: Sequence[Sequence[Expression]], zeros: Iterable[str]) -> Numbers:
        values = {**self.values, **{name: np.zeros(self.count) for name in zeros}}
        with np.errstate(all="ignore"):
            return grid_values(tuple(map(tuple, grid)), values, self.count)

    def part(self, displacement: Displacement, straight: Sequence[str] = ()) -> Numbers:
        """Return the values of one displacement, with the angles ``straight`` set to 0."""
        key = displacement.lengths, tuple(straight)
        if key not in self._parts:
            self._parts[key] = self._part(displacement, straight)
        return self._parts[key]

    @cached_property
    def _parts(self) -> dict[tuple[tuple[str, ...], tuple[str, ...]], Numbers]:
        return {}

    def _part(self, displacement: Displacement, straight: Sequence[str]) -> Numbers:
        others = [name for name in self.lengths if name not in displacement.lengths]
        alone = self.position((*others, *straight))
        # The terms without a length are a displacement in numbers.
        return alone - self.position((*self.lengths, *straight)) if displacement.lengths else alone

    @cached_property
    def displacements(self) -> list[Displacement]:
        """The displacements that sum to the position, or an empty list.

        Displacements with few turns before them come first.
        """
        by_angles: dict[tuple[str, ...], list[str]] = {}
        for name in self.lengths:
            by_angles.setdefault(self._turning(Displacement((name,), ())), []).append(name)
        found = [Displacement(tuple(names), angles) for angles, names in by_angles.items()]
        if not _is_zero(self.part(IN_NUMBERS)):
            found.append(replace(IN_NUMBERS, angles=self._turning(IN_NUMBERS)))
        rest = self.position() - sum(map(self.part, found), np.zeros(1))
        return sorted(found, key=lambda each: len(each.angles)) if _is_zero(rest) else []

    def _turning(self, displacement: Displacement) -> tuple[str, ...]:
        right = self.part(displacement)
        return tuple(
            angle for angle in self.angles if not _is_zero(self.part(displacement, [angle]) - right)
        )

    @cached_property
    def order(self) -> tuple[str, ...] | None:
        """The angles in the order of their turns. None if the rotation is no product of turns."""
        if not self.angles or not _is_zero(self.rotation(self.angles) - np.eye(3)[..., None]):
            return None
        right = self.rotation()
        fits = (each for each in permutations(self.angles) if _is_zero(self.turned(each) - right))
        return next(fits, None)

    def turned(self, order: Sequence[str]) -> Numbers:
        """Return the product ``(3, 3, samples)`` of the turns in this order."""
        return np.moveaxis(product([self._turns[angle] for angle in order]), 0, -1)

    @cached_property
    def _turns(self) -> dict[str, Matrices]:
        # The rotation (samples, 3, 3) about each angle, with all other angles 0.
        return {
            angle: np.moveaxis(self.rotation(set(self.angles) - {angle}), -1, 0)
            for angle in self.angles
        }

    @cached_property
    def steps(self) -> list[Matrices] | None:
        """The motions ``(samples, 4, 4)`` whose product is the whole motion, or None.

        Each of them is a displacement and then a turn.
        """
        if self.order is None or len(self.displacements) > len(self.order) + 1:
            return None
        places = {frozenset(self.order[:i]): i for i in range(len(self.order) + 1)}
        steps = [np.tile(np.eye(4), (self.count, 1, 1)) for _ in places]
        for step, angle in zip(steps, self.order, strict=False):
            step[:, :3, :3] = self._turns[angle]
        for displacement in self.displacements:
            place = places.get(frozenset(displacement.angles))
            if place is None:
                return None
            steps[place][:, :3, 3] = self.part(displacement, self.angles).T
        error = np.moveaxis(product(steps), 0, -1) - self._numbers(self.grid, ())
        return steps if _is_zero(error) else None


def _is_zero(numbers: Numbers) -> bool:
    return bool(np.abs(numbers).max(initial=0.0) < EXACT_VALUE)


def product(matrices: Sequence[Matrices]) -> Matrices:
    """Return the product of matrices ``(samples, n, n)``."""
    return np.asarray(reduce(np.matmul, matrices))


# --- A wrong matrix with the data for its diagnosis


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
        """The wrong poses that mistakes in the product of links lead to, with their entries.

        The entries are ``(poses, rows, columns, SAMPLES)``, cut to the size of the expected matrix.
        """
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
