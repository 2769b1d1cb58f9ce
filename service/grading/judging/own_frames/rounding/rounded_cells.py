"""Correct the rounding of all decimals of a table at once.

After that, the table describes the robot. Each decimal is shifted by at most a unit of its last
place.
"""

# So a less precise decimal cannot hide a wrong number.

# In a row of parallel axes it does not matter which offset was rounded. The errors of the chain
# depend almost linearly on the shifts (``kinematics.chain_match``). The pose of a free base may
# change slightly, and the right value of a wrong cell is unknown. Both are unknowns, too.

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from service.grading.judging.own_frames.base_frame import possible_bases
from service.grading.judging.own_frames.constants import row_constants
from service.grading.judging.own_frames.nearest.few_cells import NearestTable, frames_from_reference
from service.grading.judging.own_frames.reference import mechanism_at, regrouped, tool_pose
from service.grading.judging.own_frames.rounding.rounded_angles import (
    known_angles,
    with_exact_angles,
)
from service.grading.judging.own_frames.row_roles import FrameFreedom, Role, handed_in_values
from service.grading.judging.own_frames.validity import targets_of
from service.grading.numerics.comparison import (
    SharedDecimals,
    difference_steps,
    fitted_unknowns,
    nearly_equal,
)
from service.grading.numerics.samples import HALF, SAMPLES
from service.grading.numerics.tolerances import EXACT_VALUE
from service.grading.part import Grading
from service.grading.reading.tables.table import IS_ANGLE
from service.kinematics.chain import COLUMNS, Table, pose
from service.kinematics.dh import Convention
from service.kinematics.factors import CellIndex
from service.kinematics.frames.chain_match import Target, match_tables, misfits
from service.kinematics.frames.frame_choice import WRONG_CELL
from service.kinematics.tolerances import SAME_POSE
from service.kinematics.transforms import Matrices, Numbers, rot_x, rot_y, rot_z

# The number of sets of links needed to distinguish letters if only decimals are unknown.
LINKS = 6
# The unit of unknowns that are not shifts: an angle, or the same fraction of the typical length.
SMALL = 1e-2
TWIST = 6
# The most wrong cells that may have any value; with more, almost any table could be made to fit.
MOST_UNKNOWN = 6
# The size of a decimal without any effect, so that it is not 0.
LEAST_SIZE = 1e-16


@dataclass(frozen=True, slots=True)
class _Chain:
    """A table whose decimals are shifted until it describes the robot."""

    # At L sets of link lengths.
    # ``links`` ``(rows + 1, 4, L)`` are the regrouped constants of the table; ``values`` ``(rows,
    # 4, SAMPLES)`` are its cells. ``base`` ``(L, 4, 4)`` is the approximate pose of frame 0, or
    # None if frame 0 is given. The ``unknown`` cells may have any value.
    links: Table
    values: Table
    targets: Sequence[Target]
    base: Matrices | None
    unknown: Sequence[CellIndex]
    decimals: SharedDecimals
    convention: Convention
    length_scale: float

    @property
    def free(self) -> int:
        return len(self.unknown) + (TWIST if self.base is not None else 0)

    def misfits(self, shifts: Numbers, free: Numbers) -> Numbers:
        # ``shifts`` ``(K, count)`` are the shifts of the decimals, ``free`` ``(K, free, L)`` the
        # other unknowns; the errors are ``(K, n, L)``.
        count = self.links.shape[-1]
        cells = self.values.reshape(-1, SAMPLES)
        moved = (self.decimals.shifted(shifts, cells) - cells)[..., :count]
        moved = moved.reshape(len(shifts), *self.values.shape[:2], count)
        for i, (row, column) in enumerate(self.unknown):
            unit = SMALL if IS_ANGLE[column] else SMALL * self.length_scale
            moved[:, row, column] += unit * free[:, i]
        links = self.links + _regrouped(moved, self.convention)
        start = None if self.base is None else self._twisted(free[:, -TWIST:])
        no_signs = np.zeros(links.shape[:2], dtype=np.int_)
        _, poses = match_tables(links, no_signs, self.targets, self.length_scale, start=start)
        return misfits(poses, self.targets, self.length_scale)

    def _twisted(self, twist: Numbers) -> Matrices:
        assert self.base is not None
        about_x, about_y, about_z = np.moveaxis(SMALL * twist[:, :3], 1, 0)
        turn = rot_x(about_x) @ rot_y(about_y) @ rot_z(about_z)
        turn[..., :3, 3] = np.swapaxes(SMALL * self.length_scale * twist[:, 3:], 1, 2)
        return np.asarray(turn @ self.base)

    def _sizes(self) -> Numbers:
        # How far a shift by one unit moves the cell of each decimal.
        cells = self.values.reshape(-1, SAMPLES)
        moved = self.decimals.shifted(np.eye(self.decimals.count), cells) - cells
        lengths = np.tile(np.where(IS_ANGLE, 1.0, self.length_scale), len(self.values))
        largest: Numbers = np.abs(moved / lengths[:, None]).max(axis=(1, 2))
        return np.maximum(largest, LEAST_SIZE)

    def fit(self) -> tuple[Numbers, Numbers] | None:
        count, sets = self.decimals.count, self.links.shape[-1]
        sizes = np.concatenate([self._sizes(), np.full(self.free, SMALL)])
        steps = difference_steps(sizes)
        ways = np.concatenate([np.diag(steps), -np.diag(steps), np.zeros((1, len(steps)))])

        def split(unknowns: Numbers) -> tuple[Numbers, Numbers]:
            return unknowns[:count], unknowns[count:].reshape(self.free, sets)

        def linearised(unknowns: Numbers) -> tuple[Numbers, Numbers]:
            shifts, free = split(unknowns)
            found = self.misfits(ways[:, :count] + shifts, ways[:, count:, None] + free)
            rates = found[: len(steps)] - found[len(steps) : -1]
            rates /= 2 * steps[:, None, None]
            # Each of the other unknowns affects only its own set of links.
            own = np.einsum("fnl,lk->flnk", rates[count:], np.eye(sets))
            size = found[-1].size
            columns = [rates[:count].reshape(count, size), own.reshape(self.free * sets, size)]
            return found[-1].ravel(), np.concatenate(columns).T

        sizes = np.concatenate([sizes[:count], np.full(self.free * sets, SMALL)])
        found = fitted_unknowns(linearised, sizes, count, EXACT_VALUE)
        return None if found is None else split(found)


def _regrouped(tables: Numbers, convention: Convention) -> Numbers:
    return np.moveaxis(regrouped(np.moveaxis(tables, 0, -1), convention), -1, 0)


def with_true_numbers(
    roles: tuple[Role, ...], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> tuple[Role, ...]:
    """Shift the decimals in the rows of ``roles`` so that the table describes the robot.

    Return ``roles`` itself if that is unnecessary or impossible.
    """
    # A changed row keeps the written numbers in ``as_written``.
    if not _has_decimals(roles):
        return roles
    written, known = _with_known_angles(roles, grading)
    decimals = _decimals(written, grading, known)
    if decimals is None or _has_pose(roles, convention, grading):
        return roles
    for chain in _chains(written, roles, convention, freedom, decimals, grading):
        found = chain.fit()
        if found is not None:
            return _moved(written, decimals, found[0])
    return roles


def with_rounded_cells(
    nearest: NearestTable, convention: Convention, freedom: FrameFreedom, grading: Grading
) -> NearestTable:
    """Find the nearest valid table again, with exact numbers for rounded decimals.

    A valid table describes the robot.
    """
    # ``nearest`` was computed from the rounded decimals.
    # So even its correct cells differ slightly from the written cells.
    roles = nearest.roles
    if nearest.cost < WRONG_CELL or not _has_decimals(roles):
        return nearest
    written, known = _with_known_angles(roles, grading)
    if _decimals(written, grading, known) is None:
        return nearest
    handed_in, scale = handed_in_values(written), grading.exercise.length_scale
    scales = np.where(IS_ANGLE, 1.0, scale)
    near = nearly_equal(handed_in, nearest.expected, scales, IS_ANGLE[:, None])
    unknown = [(i, column) for i, column in np.argwhere(~near).tolist()]
    decimals = _decimals(written, grading, [*known, *unknown])
    if decimals is None:
        return nearest
    if len(unknown) > MOST_UNKNOWN:
        return nearest
    start = handed_in.copy()
    for cell in unknown:
        start[cell] = nearest.expected[cell]
    started = tuple(
        replace(role, row=replace(role.row, values=values)) if role.row else role
        for role, values in zip(written, start, strict=True)
    )
    for chain in _chains(started, started, convention, freedom, decimals, grading, unknown):
        found = chain.fit()
        if found is None:
            continue
        shifts, others = found
        expected = _shifted(decimals, shifts, handed_in)
        for i, cell in enumerate(unknown):
            unit = SMALL if IS_ANGLE[cell[1]] else SMALL * scale
            expected[cell] = start[cell] + np.resize(unit * others[i], SAMPLES)
        frames = nearest.frames
        if not freedom.base:
            frames = frames_from_reference(expected, started, convention, grading)
        return replace(nearest, expected=expected, frames=frames)
    return nearest


def _decimals(
    roles: tuple[Role, ...], grading: Grading, left_out: Sequence[CellIndex]
) -> SharedDecimals | None:
    # None if all decimals are exact, or a cell has no value.
    rows = [role.row for role in roles if role.row is not None]
    if len(rows) < len(roles):
        return None
    if not np.isfinite(handed_in_values(roles)).all():
        return None
    expressions = [each for row in rows for each in row.expressions]
    for i, column in left_out:
        expressions[len(COLUMNS) * i + column] = None
    decimals = SharedDecimals(expressions, grading.samples)
    # A number whose rounding is below the tolerance counts as exact.
    return decimals if decimals.units.max(initial=0.0) > EXACT_VALUE else None


def _has_decimals(roles: tuple[Role, ...]) -> bool:
    return any(role.row is not None and role.row.has_decimal for role in roles)


def _has_pose(roles: tuple[Role, ...], convention: Convention, grading: Grading) -> bool:
    # One sample is enough: then the table is most likely valid.
    reached = pose(handed_in_values(roles)[..., 0], convention)
    error = np.abs(reached - tool_pose(grading.exercise, grading.samples)[0])
    return bool(error.max() < SAME_POSE * max(1.0, grading.exercise.length_scale))


def _with_known_angles(
    roles: tuple[Role, ...], grading: Grading
) -> tuple[tuple[Role, ...], list[CellIndex]]:
    # A rounded angle is recognized if its exact value is known: 1.57 is π/2. The second result has
    # the cells of these angles.
    exercise, samples = grading.exercise, grading.samples
    written = _as_written(roles)
    known = [(i, column) for i, column in np.argwhere(known_angles(written, exercise, samples))]
    return (with_exact_angles(written, exercise, samples) if known else written), known


def _as_written(roles: tuple[Role, ...]) -> tuple[Role, ...]:
    return tuple(
        role
        if role.row is None or role.row.is_exact
        else replace(role, row=replace(role.row, values=role.row.handed_in, as_written=None))
        for role in roles
    )


def _chains(
    roles: tuple[Role, ...],
    based_on: tuple[Role, ...],
    convention: Convention,
    freedom: FrameFreedom,
    decimals: SharedDecimals,
    grading: Grading,
    unknown: Sequence[CellIndex] = (),
) -> list[_Chain]:
    # The roles ``based_on`` give the possible bases.
    exercise, samples = grading.exercise, grading.samples
    mechanism = mechanism_at(exercise, samples)
    rows = row_constants(roles, exercise.robot.joints, convention, samples)
    if any(row.wrong_regardless.any() for row in rows):
        return []
    links = np.array([row.written for row in rows])
    signs = np.array([row.joint_sign for row in rows])
    bases: list[Matrices | None] = [None]
    if freedom.base:
        near = row_constants(based_on, exercise.robot.joints, convention, samples)
        of_base = np.array([row.written for row in near])
        bases = list(possible_bases(of_base, signs, based_on, mechanism, freedom))
    has_letters = any(variable.joint is None for variable in exercise.variables)
    count = (HALF if unknown else LINKS) if has_letters else 1
    return [
        _Chain(
            links[..., :count],
            handed_in_values(roles),
            targets_of(roles, convention, mechanism, freedom),
            None if base is None else base[:count],
            unknown,
            decimals,
            convention,
            exercise.length_scale,
        )
        for base in bases
    ]


def _shifted(decimals: SharedDecimals, shifts: Numbers, values: Table) -> Table:
    moved: Table = decimals.shifted(shifts[None], values.reshape(-1, SAMPLES))[0]
    return moved.reshape(values.shape)


def _moved(roles: tuple[Role, ...], decimals: SharedDecimals, shifts: Numbers) -> tuple[Role, ...]:
    values = _shifted(decimals, shifts, handed_in_values(roles))
    return tuple(
        replace(role, row=replace(role.row, values=moved, as_written=role.row.handed_in))
        if role.row and np.abs(moved - role.row.values).max() > 0
        else role
        for role, moved in zip(roles, values, strict=True)
    )
