"""Find the valid table that differs from a submitted one in one cell, if frames may be chosen.

A table is valid if it describes the robot. The joint axes of a valid table, with all joints at 0,
must lie on those of the reference table.
"""

# ``few_cells`` compares poses at all joint values, which is impossible if the student chooses base,
# tool or directions. The axes give the value that each cell would need if no other cell were wrong
# (``kinematics.axis_repairs``). All repaired tables are then tested at once.

from collections.abc import Iterator, Sequence, Set
from dataclasses import dataclass, replace
from itertools import accumulate, compress, product

import numpy as np
from numpy.typing import NDArray

from service.grading.judging.own_frames.base_frame import directed
from service.grading.judging.own_frames.nearest.slip_likelihood import slip_penalty
from service.grading.judging.own_frames.reference import (
    Mechanism,
    as_table,
    frames_on_axes,
    mechanism_at,
    regrouped,
)
from service.grading.judging.own_frames.row_roles import FrameFreedom, Role, joint_cells
from service.grading.part import Grading
from service.grading.reading.tables.table import IS_ANGLE
from service.kinematics.chain import A, D, Table, pose
from service.kinematics.dh import Convention
from service.kinematics.factors import CellIndex, Factors, Integers, X, factors_of
from service.kinematics.frames.axis_alignment import align_first_axes
from service.kinematics.frames.chain_match import (
    ChainMatch,
    RowConstants,
    Target,
    match_tables,
)
from service.kinematics.frames.frame_choice import WRONG_CELL, departure
from service.kinematics.repairs.axis_repairs import repairs_by_axes, reversed_factors
from service.kinematics.repairs.cell_repairs import one_factor_repairs
from service.kinematics.transforms import Matrices, Numbers, identity, inverse

# The number of samples at which repairs are searched; their values are then computed at all
# samples.
SUBSET = 2


@dataclass(frozen=True, slots=True)
class _Repair:
    """A repair of one cell by a new constant."""

    # With the pose of one end of the chain after this repair.
    # The end is the last frame if ``is_last`` is true, else frame 0. Its pose ``(L, 4, 4)`` is in
    # the reference's frame 0. ``attempt`` is the index of the assumption on which the repair is
    # based.
    cell: CellIndex
    value: Numbers
    end: Matrices
    is_last: bool
    attempt: int


@dataclass(frozen=True, slots=True)
class _Body:
    # A table as a product of factors, and the reference's axes in the same order.
    # ``joints`` ``(n,)`` are the indices of the factors that a joint moves. ``axes`` ``(n, L, 4,
    # 4)`` are the correct poses of the joint axes in the reference's frame 0. ``is_reversed`` is
    # true if the factors start from the last frame instead of frame 0.
    factors: Factors
    joints: Integers
    axes: Matrices
    sliding: NDArray[np.bool_]
    is_reversed: bool = False

    @property
    def reversed(self) -> "_Body":
        return _Body(
            reversed_factors(self.factors),
            len(self.factors.axes) - 1 - self.joints[::-1],
            self.axes[::-1],
            self.sliding[::-1],
            is_reversed=True,
        )

    def cell(self, k: int, kind: int) -> CellIndex:
        in_table = len(self.factors.axes) - 1 - k if self.is_reversed else k
        return in_table // 2, (A if self.factors.axes[k] == X else D) + kind

    def factor(self, cell: CellIndex) -> int:
        in_table = self.factors.position(cell)[0]
        return len(self.factors.axes) - 1 - in_table if self.is_reversed else in_table


@dataclass(frozen=True, slots=True)
class _Case:
    """A table to be repaired, and the robot of the reference table."""

    # The constants are ``(rows, 4, L)``. ``wrong`` are the cells that are wrong whatever frames are
    # chosen. ``joint_signs`` ``(rows + 1,)`` are the signs of the joint variables, 0 if irrelevant.
    table: Table
    wrong: frozenset[CellIndex]
    joint_signs: Integers
    roles: tuple[Role, ...]
    convention: Convention
    freedom: FrameFreedom
    mechanism: Mechanism
    targets: Sequence[Target]
    length_scale: float

    def body(self, samples: int) -> tuple[_Body, Matrices]:
        # The table and the reference's last frame, both at the first ``samples``.
        factors = factors_of(self.table[..., :samples], self.convention)
        joints = joint_cells(self.roles)
        axes = np.array(list(accumulate(self.mechanism.joints[:, :samples], np.matmul)))
        body = _Body(
            factors,
            np.array([factors.position((i, D))[0] for i, _ in joints]),
            axes,
            np.array([joint.prismatic for joint in joints.values()]),
        )
        return body, axes[-1] @ self.mechanism.tool[:samples]


@dataclass(frozen=True, slots=True)
class _Repaired:
    """Repairs after which the table describes the robot, and the repaired tables."""

    # There are T repairs. ``links`` is ``(T, rows + 1, 4, L)``; ``poses`` ``(rows + 1, T, L, 4,
    # 4)`` are the relative poses of the repaired tables.
    repairs: Sequence[_Repair]
    links: Numbers
    poses: Matrices


def one_cell_match(
    rows: Sequence[RowConstants],
    targets: Sequence[Target],
    roles: tuple[Role, ...],
    convention: Convention,
    freedom: FrameFreedom,
    grading: Grading,
) -> ChainMatch | None:
    """Return the table that describes the robot after the repair of one cell, or None.

    Of several repairs, the likeliest is taken. No row may be missing.
    """
    wrong = np.array([row.wrong_regardless | ~(row.is_gradable | row.absent) for row in rows])
    wrong_cells = np.argwhere(as_table(wrong, convention)).tolist()
    if len(wrong_cells) > 1:
        return None
    case = _Case(
        np.nan_to_num(as_table(np.array([row.written for row in rows]), convention)),
        frozenset((i, column) for i, column in wrong_cells),
        np.array([0 if freedom.directions else row.joint_sign for row in rows]),
        roles,
        convention,
        freedom,
        mechanism_at(grading.exercise, grading.samples),
        targets,
        grading.exercise.length_scale,
    )
    found = _repaired(case, list(_repairs(case, SUBSET)))
    if found.repairs:
        attempts = {(repair.attempt, repair.cell) for repair in found.repairs}
        found = _repaired(case, list(_repairs(case, case.table.shape[-1], attempts)))
    if case.wrong:
        # Prefer 0 as the constant beside a wrong joint variable: it does not imply other frames.
        without = _repaired(case, [replace(r, value=0 * r.value) for r in found.repairs])
        found = without if without.repairs else found
    return _likeliest(found, case, grading) if found.repairs else None


def _likeliest(found: _Repaired, case: _Case, grading: Grading) -> ChainMatch:
    # A repair is likely if it leads to frames near the reference's frames, and if students often
    # make the mistake.
    links = np.moveaxis(found.links, 0, 2)
    frames = frames_on_axes(found.poses, links, case.roles, case.convention, case.mechanism)
    departures = departure(frames.reshape(-1, *frames.shape[2:]), case.length_scale)
    costs = WRONG_CELL + departures.reshape(frames.shape[:2]).sum(axis=0)
    if len(costs) > 1:
        for k, repair in enumerate(found.repairs):
            written = None if repair.cell in case.wrong else case.table[repair.cell]
            angle = bool(IS_ANGLE[repair.cell[1]])
            costs[k] += slip_penalty(written, repair.value, angle, grading)
    # If the constant needs no change, only the variable is wrong.
    unchanged = [np.array_equal(r.value, case.table[r.cell]) for r in found.repairs]
    of_variables = {r.cell for r in compress(found.repairs, unchanged)}
    for k, repair in enumerate(found.repairs):
        if repair.cell in of_variables and not unchanged[k]:
            costs[k] = np.inf
    best = int(np.argmin(costs))
    return ChainMatch(found.links[best], found.poses[:, best], float(costs[best]), WRONG_CELL)


def _repaired(case: _Case, repairs: Sequence[_Repair]) -> _Repaired:
    if not repairs:
        return _Repaired((), np.empty(0), np.empty(0))
    samples = len(repairs[0].value)
    tables = np.repeat(case.table[None, ..., :samples], len(repairs), axis=0)
    signs = np.repeat(case.joint_signs[None], len(repairs), axis=0)
    variables = joint_cells(case.roles)
    for k, repair in enumerate(repairs):
        tables[k][repair.cell] = repair.value
        if repair.cell in variables:
            signs[k, repair.cell[0] + 1] = 0
    links = np.moveaxis(regrouped(np.moveaxis(tables, 0, 2), case.convention), 2, 0)
    starts = _starts(repairs, tables, case.convention)
    valid, poses = match_tables(links, signs, case.targets, case.length_scale, start=starts)
    chosen = [repairs[k] for k in np.flatnonzero(valid).tolist()]
    return _Repaired(chosen, links[valid], poses[:, valid])


def _starts(repairs: Sequence[_Repair], tables: Numbers, convention: Convention) -> Matrices:
    # The pose ``(T, L, 4, 4)`` of frame 0 of each table in the reference's frame 0.
    starts = np.array([repair.end for repair in repairs])
    from_last = np.array([repair.is_last for repair in repairs])
    if from_last.any():
        starts[from_last] @= inverse(pose(np.moveaxis(tables[from_last], 0, 2), convention))
    return starts


def _repairs(
    case: _Case, samples: int, attempts: Set[tuple[int, CellIndex]] | None = None
) -> Iterator[_Repair]:
    # The values are those that each cell would need if no other cell were wrong. If ``attempts``
    # are given, yield only the repairs of these attempts and cells.
    body, tool = case.body(samples)
    for attempt, (seen, ends) in enumerate(_ends(body, tool, case.freedom)):
        if attempts is not None and all(attempt != wanted for wanted, _ in attempts):
            continue
        for cell, value in _values(seen, ends, tool, case):
            if case.wrong <= {cell} and (attempts is None or (attempt, cell) in attempts):
                end = ends[seen.factor(cell)]
                yield _Repair(cell, value, end, seen.is_reversed, attempt)


def _values(
    body: _Body, ends: Matrices, tool: Matrices, case: _Case
) -> Iterator[tuple[CellIndex, Numbers]]:
    if case.freedom.base or case.freedom.tool:
        starts = ends @ body.factors.before[:-1]
        sign = -1.0 if body.is_reversed else 1.0
        for k, kind, value in repairs_by_axes(
            body.factors, starts, body.joints, body.axes, body.sliding
        ):
            yield body.cell(k, kind), sign * value
    else:
        for repair in one_factor_repairs(body.factors, tool):
            if len(repair.cells) == 1:
                yield repair.cells[0], repair.values[0]
    # The constant may be right and the variable wrong.
    for cell in joint_cells(case.roles):
        yield cell, case.table[cell][: len(tool)]


def _ends(body: _Body, tool: Matrices, freedom: FrameFreedom) -> Iterator[tuple[_Body, Matrices]]:
    # The poses ``(K, L, 4, 4)`` are in the reference's frame 0. Pose k is correct if only factor k
    # of the table is wrong.
    count = len(body.factors.axes)
    if not freedom.base:
        yield body, identity((count, len(tool)))
    elif not freedom.tool:
        yield body.reversed, np.repeat(tool[None], count, axis=0)
    else:
        for seen in (body, body.reversed):
            for ends in _ends_by_axes(seen):
                yield seen, ends


def _ends_by_axes(body: _Body) -> Iterator[Matrices]:
    # The student's axes are put on the reference's axes.
    n, samples = body.axes.shape[:2]
    on_axes = body.factors.before[body.joints]
    # A variable may be the wrong cell, or have either sign. The first axis and the next one that is
    # not parallel to it determine the orientation of the end.
    directions = [np.array([z, *[x] * (n - 1)]) for z, x in product((1, -1), repeat=2)]
    source = np.concatenate([directed(on_axes, signs) for signs in directions], axis=1)
    target = np.concatenate([body.axes] * len(directions), axis=1)
    aligned = align_first_axes(source, target, body.sliding)
    before = np.searchsorted(body.joints, np.arange(len(body.factors.axes)), side="right")
    for i in range(len(directions)):
        yield aligned[np.maximum(before, 1) - 1, i * samples : (i + 1) * samples]
