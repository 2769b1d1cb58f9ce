"""Judge a submitted table cell by cell.

The table is compared with the reference table. If the student chose the frames, it is compared with
the nearest table that describes the robot (``own_frames``).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain, count, repeat
from string import ascii_lowercase
from typing import Final

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Joint, ReferenceTable
from service.catalogue.parts.dh_table import DhTableSpec
from service.expressions import Expression
from service.grading.feedback import Finding
from service.grading.judging.own_frames.best_roles import best_roles, roles_in, without_idle_rows
from service.grading.judging.own_frames.completion import completed
from service.grading.judging.own_frames.nearest.few_cells import NearestTable, frames_from_reference
from service.grading.judging.own_frames.nearest.nearest_table import parallel_neighbours
from service.grading.judging.own_frames.reference import reference_values
from service.grading.judging.own_frames.remarks import remarks_on
from service.grading.judging.own_frames.row_roles import Role, freedom_of, pair_in_order
from service.grading.misconception import register
from service.grading.numerics.comparison import Match, difference, entry_matches, nearly_equal
from service.grading.numerics.samples import SAMPLES
from service.grading.numerics.tolerances import (
    EXACT_VALUE,
    HUGE_CELL,
    HUGE_LENGTH,
    PLAINLY_DIFFERENT,
)
from service.grading.part import Grading
from service.grading.reading.tables.table import IS_ANGLE, StudentRow, StudentTable, values_of
from service.grading.report import Verdict
from service.kinematics.chain import COLUMNS, Table
from service.kinematics.dh import Convention
from service.kinematics.frames.frame_choice import NO_SUCH_CELL, ROW_COSTS, WRONG_CELL, departure
from service.kinematics.transforms import Matrices, Numbers
from service.translations import say

_ARE_ANGLES: Final = tuple(IS_ANGLE.tolist())


@dataclass(frozen=True, slots=True)
class JudgedRow:
    """A submitted row (None if missing), and its correct values ``(4, SAMPLES)``.

    ``shared`` is true if the axis of the row is parallel to a neighbouring axis.
    """

    # Then offsets along both axes add up.
    label: str
    joint: Joint | None
    row: StudentRow | None
    expected: Table
    shared: bool = False


@dataclass(frozen=True)
class Judgement:
    """A submitted table compared with the correct table, in the frames in which it is judged."""

    # ``matches`` is the Match of each cell, ``(rows, 4)``; no cell of a missing row matches.
    # ``roles`` are the roles of the submitted rows if the student chose the frames. ``departures``
    # is the cost of these frames, infinite if the intended frames are unknown. ``extra`` are the
    # rows without a counterpart. ``in_place`` is true if each row was compared with the reference's
    # row of the same place. ``reached`` is true if the rows lead to the given tool frame. ``lost``
    # is the number of units that the wrong cells lose, in the frames in which they lose the fewest;
    # a single wrong cell loses one unit.
    rows: tuple[JudgedRow, ...]
    matches: NDArray[np.int_]
    roles: tuple[Role, ...] = ()
    departures: float = 0.0
    extra: tuple[int, ...] = ()
    findings: tuple[Finding, ...] = ()
    in_place: bool = False
    reached: bool = True
    lost: float = np.inf

    @property
    def slips(self) -> int:
        """The number of mistakes that no cell shows, such as an extra row."""
        return len(self.extra) + (not self.reached)

    @cached_property
    def wrong(self) -> int:
        """The number of cells that are not right."""
        return int(np.count_nonzero(self.matches < Match.ROUNDED))

    @cached_property
    def unread(self) -> NDArray[np.bool_]:
        """A mask ``(rows, 4)`` of the cells of submitted rows that have no value."""
        return np.array(
            [
                np.zeros(len(COLUMNS), np.bool_)
                if judged.row is None
                else ~np.isfinite(judged.row.values).all(axis=-1)
                for judged in self.rows
            ]
        )

    @cached_property
    def empty(self) -> int:
        """The number of empty cells in submitted rows."""
        return sum(
            entry.verdict is Verdict.MISSING
            for judged in self.rows
            if judged.row is not None
            for entry in judged.row.entries
        )

    @property
    def wrong_as_read(self) -> int:
        """The number of cells that were read and are not right."""
        if not self.wrong:
            return 0
        return int(np.count_nonzero((self.matches < Match.ROUNDED) & ~self.unread))


def judged_table(
    part: DhTableSpec, rows: tuple[StudentRow, ...], convention: Convention, grading: Grading
) -> Judgement:
    """Compare a table with the reference table, or with a correct table in the student's frames."""
    reference = grading.exercise.robot.tables.get(convention)
    if reference is None:
        return _judged_by_nearest(part, rows, convention, grading)
    if part.frames == "given" or not _plainly_differs(rows, reference, grading):
        judgement = _judged_by_reference(rows, reference, grading)
        if part.frames == "given" or not (judgement.wrong_as_read or judgement.extra):
            return judgement
    judgement = _judged_by_nearest(part, rows, convention, grading)
    # If most of a table is wrong, the intended frames are unknown, and the nearest valid table
    # would reward cells that fit by chance. An empty cell counts as wrong, so that it gains
    # nothing.
    wrong, empty = judgement.wrong_as_read, judgement.empty
    if wrong and wrong + empty > (np.count_nonzero(~judgement.unread) + empty) / 2:
        return replace(_judged_by_reference(rows, reference, grading), departures=np.inf)
    return judgement


def _plainly_differs(
    rows: tuple[StudentRow, ...], reference: ReferenceTable, grading: Grading
) -> bool:
    expected = reference_values(reference, grading.samples)
    if len(rows) != len(expected):
        return False
    length = PLAINLY_DIFFERENT * grading.exercise.length_scale
    for row, right in zip(rows, expected[..., 0].tolist(), strict=True):
        cells = zip(row.values[:, 0].tolist(), right, _ARE_ANGLES, strict=True)
        for value, wanted, is_angle in cells:
            error = math.remainder(value - wanted, math.tau) if is_angle else value - wanted
            limit = PLAINLY_DIFFERENT if is_angle else length
            if abs(error) > limit:
                return True
    return False


def _judged_by_reference(
    rows: tuple[StudentRow, ...], reference: ReferenceTable, grading: Grading
) -> Judgement:
    expected = reference_values(reference, grading.samples)
    is_in_place = len(rows) == len(expected)
    if not is_in_place:
        rows = without_idle_rows(rows, len(expected))
    judged, extra = [], []
    for i, j in _paired(rows, expected, grading):
        if j is None:
            extra.append(i or 0)
            continue
        joint = reference.joints[j] if j < len(reference.joints) else None
        row = None if i is None else rows[i]
        judged.append(JudgedRow(reference.labels[j], joint, row, expected[j]))
    found = _matches_of(judged, grading)
    return Judgement(tuple(judged), found, extra=tuple(extra), in_place=is_in_place)


def _paired(
    rows: tuple[StudentRow, ...], expected: Table, grading: Grading
) -> list[tuple[int | None, int | None]]:
    if len(rows) == len(expected):
        return [(i, i) for i in range(len(rows))]
    actual = values_of(rows)[:, None]
    found = nearly_equal(actual, expected[None], column_scales(grading), IS_ANGLE[:, None])
    return pair_in_order(found.sum(axis=-1).astype(np.float64))


def _judged_by_nearest(
    part: DhTableSpec, rows: tuple[StudentRow, ...], convention: Convention, grading: Grading
) -> Judgement:
    roles, nearest = best_roles(part, rows, convention, grading)
    judgement = _judged_by(nearest, roles, convention, grading)
    if not np.isfinite(values_of(rows)).all():
        return _judged_as_read(part, rows, judgement, convention, grading)
    of_rows = ROW_COSTS[np.count_nonzero(judgement.matches < Match.ROUNDED, axis=1)].sum()
    if nearest.cost - of_rows < NO_SUCH_CELL - WRONG_CELL / 2:
        return judgement
    # Remarks on frames make no sense if the frames do not lead to the tool. That costs a unit, also
    # beside wrong cells.
    return replace(judgement, findings=(_UNREACHED,), reached=False)


def _judged_as_read(
    part: DhTableSpec,
    rows: tuple[StudentRow, ...],
    judgement: Judgement,
    convention: Convention,
    grading: Grading,
) -> Judgement:
    # If some values in the unread cells make the table valid, no other cell is wrong. There are no
    # remarks on the frames, which are unknown.
    if judgement.wrong_as_read or len(judgement.rows) != len(rows):
        roles = roles_in(rows, convention, grading, in_order=True)
        valid = completed(roles, convention, freedom_of(part), grading)
        if valid is not None:
            judgement = _judged_by(valid, roles, convention, grading)
    return replace(judgement, findings=())


_TOOL_NOT_REACHED = register(
    of=StudentTable,
    code="tool_not_reached",
    rule="rows",
    means="each row could stand in a right table, but all of them together do not lead to the "
    "given end-effector frame; it costs what a wrong cell costs",
    example=(
        "rrrp-proximal",
        "table",
        {
            "rows": [
                {"a": "0", "alpha": "0", "d": "-l1", "theta": "-q1"},
                {"a": "-l2", "alpha": "0", "d": "0", "theta": "-q2"},
                {"a": "-l3", "alpha": "-180deg", "d": "-l4", "theta": "-q3"},
                {"a": "0", "alpha": "0", "d": "-q4", "theta": "0"},
            ]
        },
    ),
    unlike={"4/d": "2*q4"},
)
_UNREACHED = _TOOL_NOT_REACHED.finding(
    say(
        "Each row alone fits this robot, but the product of all rows does not give the "
        "end-effector frame of the exercise: compare the origin and the axes of your last frame "
        "with it."
    ),
)


def judged_by_intended(
    intended: Table, roles: tuple[Role, ...], convention: Convention, grading: Grading
) -> Judgement:
    """Compare a table with the table that the student intended; no row may be missing."""
    # ``intended`` is ``(rows, 4, SAMPLES)``.
    frames = frames_from_reference(intended, roles, convention, grading)
    nearest = NearestTable(roles, intended, frames, WRONG_CELL)
    judgement = _judged_by(nearest, roles, convention, grading)
    # The rows that the slip makes wrong do not imply the frames: the intended rows do.
    return replace(judgement, findings=remarks_on(frames, convention, grading.exercise))


def _judged_by(
    nearest: NearestTable, roles: tuple[Role, ...], convention: Convention, grading: Grading
) -> Judgement:
    right = nearest.cost < WRONG_CELL
    shared = [False] * len(nearest.roles)
    if not right:
        shared = parallel_neighbours(nearest.roles, convention, grading).tolist()
    judged = tuple(
        JudgedRow(label, role.joint, role.row, expected, adds_up)
        for label, role, expected, adds_up in zip(
            _labels(nearest.roles), nearest.roles, nearest.expected, shared, strict=True
        )
    )
    if not nearest.cost and _is_as_written(nearest):
        cell_matches = np.full((len(judged), len(COLUMNS)), int(Match.EXACT))
    else:
        cell_matches = _matches_of(judged, grading)
    is_wrong = (cell_matches < Match.ROUNDED).any()
    rows_right = _rows_right(judged, cell_matches, convention) if is_wrong else None
    findings = remarks_on(nearest.frames, convention, grading.exercise, rows_right)
    handed_in = [row.row is not None for row in judged]
    if not all(handed_in) and (cell_matches[handed_in] < Match.ROUNDED).any():
        # If a row is missing, a wrong row may imply any frames.
        findings = ()
    return Judgement(
        judged,
        cell_matches,
        roles,
        departures=0.0 if right else departures_of(nearest.frames, grading),
        findings=findings,
        # The search tolerates rounding, so it may have found nothing wrong.
        lost=nearest.lost or np.inf,
    )


def _rows_right(
    judged: Sequence[JudgedRow], cell_matches: NDArray[np.int_], convention: Convention
) -> NDArray[np.bool_]:
    # A row beyond the ends of the table counts as correct.
    right = np.ones(len(cell_matches) + 2, np.bool_)
    right[1:-1] = (cell_matches >= Match.ROUNDED).all(axis=1)
    places = np.array([i for i, row in enumerate(judged) if row.joint], dtype=np.int_)
    before = places + (convention is not Convention.STANDARD)
    return np.stack([right[before], right[before + 1]], axis=1)


def _is_as_written(nearest: NearestTable) -> bool:
    rows = [role.row for role in nearest.roles if role.row is not None]
    if len(rows) < len(nearest.roles) or not all(row.is_exact for row in rows):
        return False
    return bool(np.abs(values_of(rows) - nearest.expected).max() < EXACT_VALUE)


def departures_of(frames: Matrices, grading: Grading) -> float:
    """Return how far frames ``(joints, samples, 4, 4)`` are from the reference frames."""
    return float(departure(frames, grading.exercise.length_scale).sum())


def _labels(roles: Sequence[Role]) -> list[str]:
    # "e", "e2" … for fixed rows after the last joint; "0", "0b", "0c" … for fixed rows before it.
    last = max((i for i, role in enumerate(roles) if role.joint), default=-1)
    behind = chain(["e"], (f"e{i}" for i in count(2)))
    before = chain(["0"], (f"0{letter}" for letter in ascii_lowercase[1:]), repeat("0z"))
    return [
        str(role.joint.index) if role.joint else next(behind if i > last else before)
        for i, role in enumerate(roles)
    ]


def _matches_of(judged: Sequence[JudgedRow], grading: Grading) -> NDArray[np.int_]:
    nothing = np.full((len(COLUMNS), SAMPLES), np.nan)
    actual = np.array([nothing if row.row is None else row.row.handed_in for row in judged])
    expected = np.array([row.expected for row in judged])
    expressions = [each for row in judged for each in _expressions(row.row)]
    angle, scales = IS_ANGLE[:, None], column_scales(grading)
    found = entry_matches(expressions, actual, expected, scales, grading.samples, angle)
    if np.abs(expected[..., 0]).max() > HUGE_LENGTH * grading.exercise.length_scale:
        # A large offset of the student's must not increase the tolerance.
        error = np.abs(difference(actual, expected, angle)).max(axis=-1)
        too_far = (found == Match.EXACT) & (error > HUGE_CELL * scales)
        found = np.where(too_far, int(Match.DIFFERENT), found)
    return found


def column_scales(grading: Grading) -> Numbers:
    """Return the scale of each column's tolerance."""
    return np.where(IS_ANGLE, 1.0, grading.exercise.length_scale)


def _expressions(row: StudentRow | None) -> Sequence[Expression | None]:
    return [None] * len(COLUMNS) if row is None else row.expressions
