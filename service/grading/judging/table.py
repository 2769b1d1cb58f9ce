"""A handed-in table held against what it should be, in the frames that it is judged in."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Joint, ReferenceTable
from service.catalogue.parts.dh_table import DhTableSpec
from service.grading.comparison import Match, difference, matches, same
from service.grading.feedback import Finding
from service.grading.joint_motion import TOLERANCE, changes
from service.grading.judging.own_frames.few_cells import FrameReading, frames_from_reference
from service.grading.judging.own_frames.frame_freedom import Freedom
from service.grading.judging.own_frames.nearest_table import parallel_neighbours, read_in_own_frames
from service.grading.judging.own_frames.reference import reference_values
from service.grading.judging.own_frames.remarks import choices
from service.grading.judging.own_frames.rounded_angles import steadied
from service.grading.judging.own_frames.row_roles import Role, roles_of, variable_column
from service.grading.part import Grading
from service.grading.reading.table import (
    IS_ANGLE,
    HandedInRow,
    aligned,
    values_of,
)
from service.grading.samples import SAMPLES
from service.kinematics.chain import COLUMNS, Table
from service.kinematics.dh import Convention
from service.kinematics.frame_choice import NO_SUCH_CELL, WRONG_CELL, departure
from service.kinematics.transforms import Matrices, Numbers

# Far beyond what rounding does to a cell.
PLAIN = 0.02
# A length of so many times the robot's own loses figures, but never so many that it is FAR off.
HUGE = 100.0
FAR = 1e-6


@dataclass(frozen=True, slots=True)
class JudgedRow:
    """A row that was handed in, or is missing (None), and what it should be: ``(4, SAMPLES)``.

    ``shared`` says that its axis has a parallel neighbour, so that offsets along it add up.
    """

    label: str
    joint: Joint | None
    row: HandedInRow | None
    expected: Table
    shared: bool = False


@dataclass(frozen=True, slots=True)
class Judgement:
    """A table held against what it should be, in the frames that it is judged in.

    ``matches`` is the Match of each cell, ``(rows, 4)``; a missing row matches nowhere. ``roles``
    are those that the handed-in rows were taken for, where that was asked; ``departures`` is what
    their frames cost, infinitely much where nobody can say which were meant. ``extra`` are rows
    that answer to nothing; ``reached`` says that the rows lead to the given tool frame.
    """

    rows: tuple[JudgedRow, ...]
    matches: NDArray[np.int_]
    roles: tuple[Role, ...] = ()
    departures: float = 0.0
    extra: tuple[int, ...] = ()
    findings: tuple[Finding, ...] = ()
    reached: bool = True

    @property
    def lost(self) -> float:
        """The share of the points that is lost beside those of wrong cells."""
        return (len(self.extra) + (not self.reached)) / len(self.rows)

    @property
    def wrong(self) -> int:
        """How many cells are not right."""
        return int(np.count_nonzero(self.matches < Match.ROUNDED))


def judged_table(
    part: DhTableSpec, rows: tuple[HandedInRow, ...], convention: Convention, grading: Grading
) -> Judgement:
    """The table held against the reference, or against the valid table nearest to it."""
    reference = grading.exercise.robot.tables.get(convention)
    if reference is None:
        return _judged_in_own_frames(part, rows, convention, grading)
    if part.frames == "given" or not _plainly_differs(rows, reference, grading):
        judgement = _judged_as_given(rows, reference, grading)
        if part.frames == "given" or not (judgement.wrong or judgement.extra):
            return judgement
    in_own_frames = _judged_in_own_frames(part, rows, convention, grading)
    # Of a table that is mostly wrong nobody can say which frames were meant; to follow it
    # there would reward cells that any number fits.
    if in_own_frames.wrong > in_own_frames.matches.size / 2:
        return replace(_judged_as_given(rows, reference, grading), departures=np.inf)
    return in_own_frames


def _plainly_differs(
    rows: tuple[HandedInRow, ...], reference: ReferenceTable, grading: Grading
) -> bool:
    """Whether the first sample already shows that the table is not the reference's own."""
    expected = reference_values(reference, grading.samples)
    if len(rows) != len(expected):
        return False
    first = np.array([row.values[:, 0] for row in rows])
    error = np.abs(difference(first, expected[..., 0], IS_ANGLE))
    return bool((error > PLAIN * column_scales(grading)).any())


def _judged_as_given(
    rows: tuple[HandedInRow, ...], reference: ReferenceTable, grading: Grading
) -> Judgement:
    """The table held against the reference's own."""
    expected = reference_values(reference, grading.samples)
    rows = _without_idle_rows(rows, len(expected))
    judged, extra = [], []
    for i, j in _paired(rows, expected, grading):
        if j is None:
            extra.append(i or 0)
            continue
        joint = reference.joints[j] if j < len(reference.joints) else None
        row = None if i is None else rows[i]
        judged.append(JudgedRow(reference.labels[j], joint, row, expected[j]))
    return Judgement(tuple(judged), _all_matches(judged, grading), extra=tuple(extra))


def _judged_in_own_frames(
    part: DhTableSpec, rows: tuple[HandedInRow, ...], convention: Convention, grading: Grading
) -> Judgement:
    """The table held against the valid one nearest to it."""
    roles, reading = _read_in_own_frames(part, rows, convention, grading)
    judgement = _held_against(reading, roles, convention, grading)
    if reading.cost - WRONG_CELL * judgement.wrong < NO_SUCH_CELL - WRONG_CELL / 2:
        return judgement
    # Nothing can be said of frames that lead nowhere.
    return replace(judgement, findings=(_UNREACHED,), reached=bool(judgement.wrong))


def judged_against(
    meant: Table, roles: tuple[Role, ...], convention: Convention, grading: Grading
) -> Judgement:
    """The table held against the intended one, ``(rows, 4, SAMPLES)``; all roles have rows."""
    apart = frames_from_reference(meant, roles, convention, grading)
    return _held_against(FrameReading(roles, meant, apart, WRONG_CELL), roles, convention, grading)


def _held_against(
    reading: FrameReading, roles: tuple[Role, ...], convention: Convention, grading: Grading
) -> Judgement:
    """The judgement on rows that were taken for ``roles``, in the frames of the reading."""
    right = reading.cost < WRONG_CELL
    shared = [False] * len(reading.roles)
    if not right:
        shared = parallel_neighbours(reading.roles, convention, grading).tolist()
    judged = tuple(
        JudgedRow(label, role.joint, role.row, expected, adds_up)
        for label, role, expected, adds_up in zip(
            _labels(reading.roles), reading.roles, reading.expected, shared, strict=True
        )
    )
    as_it_stands = not reading.cost and all(role.row and role.row.is_exact for role in roles)
    if as_it_stands:
        matches = np.full((len(judged), len(COLUMNS)), int(Match.EXACT))
    else:
        matches = _all_matches(judged, grading)
    exercise = grading.exercise
    return Judgement(
        judged,
        matches,
        roles,
        departures=0.0 if right else departures_of(reading.frames, grading),
        findings=choices(reading.frames, exercise.robot.joints, convention, exercise),
    )


def departures_of(apart: Matrices, grading: Grading) -> float:
    """What the frames ``(joints, samples, 4, 4)``, seen from the reference's, cost altogether."""
    return float(departure(apart, grading.exercise.length_scale).sum())


def _read_in_own_frames(
    part: DhTableSpec, rows: tuple[HandedInRow, ...], convention: Convention, grading: Grading
) -> tuple[tuple[Role, ...], FrameReading]:
    """What each row was taken for, and the reading of least cost."""
    exercise, freedom = grading.exercise, freedom_of(part)
    roles = roles_in(rows, convention, grading)
    reading = nearest_reading(roles, convention, freedom, grading)
    if reading.cost < WRONG_CELL:
        return roles, reading
    other, price = None, 0.0
    if len(reading.roles) < len(rows):
        # A row of zeros that was left out may be one in which something is missing.
        other = roles_in(rows, convention, grading, wanted=len(rows))
    elif len(rows) == len(exercise.robot.joints) and _lacks_row(len(rows), convention, grading):
        # The row that is missing need not be the last.
        other, price = roles_in(rows, convention, grading, in_order=False), WRONG_CELL
    elif len(rows) > len(exercise.robot.joints):
        # A wrong variable may have made a joint's row look like a fixed one.
        other = roles_in(rows, convention, grading, in_order=True)
    if other is None or _are_alike(other, roles):
        return roles, reading
    found = read_in_own_frames(other, convention, freedom, grading)
    return (other, found) if found.cost + price < reading.cost else (roles, reading)


def _are_alike(one: Sequence[Role], other: Sequence[Role]) -> bool:
    """Whether the same rows, of which there are as many, are for the same joints."""
    first, second = ([(role.joint, role.row is None) for role in roles] for roles in (one, other))
    return first == second


def _lacks_row(count: int, convention: Convention, grading: Grading) -> bool:
    """Whether the reference's table has more rows."""
    own_table = grading.exercise.robot.tables.get(convention)
    return own_table is not None and len(own_table.rows) > count


_UNREACHED = Finding(
    "tool_not_reached",
    "Every row could stand in some table of this robot, but together they do not lead to the given "
    "end-effector frame: compare the last frame with it.",
)


def roles_in(
    rows: tuple[HandedInRow, ...],
    convention: Convention,
    grading: Grading,
    wanted: int | None = None,
    *,
    in_order: bool | None = None,
) -> tuple[Role, ...]:
    """Which handed-in row is for which joint; ``wanted`` rows, or as many as the reference has.

    ``in_order`` says whether they are in the order of the joints, where that is known.
    """
    robot = grading.exercise.robot
    own_table = robot.tables.get(convention)
    wanted = wanted or len(robot.joints if own_table is None else own_table.rows)
    rows = _without_idle_rows(rows, wanted)
    roles = roles_of(rows, robot.joints, grading.samples, wanted, in_order=in_order)
    return steadied(roles, grading.exercise, grading.samples)


def freedom_of(part: DhTableSpec) -> Freedom:
    """What the part leaves to the student beyond the frames on the joints."""
    return Freedom(
        base=part.base == "free", tool=part.tool == "free", directions=part.directions == "free"
    )


def nearest_reading(
    roles: tuple[Role, ...], convention: Convention, freedom: Freedom, grading: Grading
) -> FrameReading:
    """The reading of least cost: with the rows as they are, or with the tool row they lack."""
    reading = read_in_own_frames(roles, convention, freedom, grading)
    if reading.cost < WRONG_CELL or not _lacks_row(len(roles), convention, grading):
        return reading
    longer = read_in_own_frames((*roles, Role(None, None)), convention, freedom, grading)
    return longer if longer.cost + WRONG_CELL <= reading.cost else reading


def _labels(roles: Sequence[Role]) -> list[str]:
    """Row labels: the joint's number; "e", "e2" … for fixed rows behind the last, "0" before."""
    last = max((i for i, role in enumerate(roles) if role.joint), default=-1)
    return [
        str(role.joint.index)
        if role.joint
        else f"e{i - last if i > last + 1 else ''}"
        if i > last
        else "0"
        for i, role in enumerate(roles)
    ]


def _without_idle_rows(rows: tuple[HandedInRow, ...], wanted: int) -> tuple[HandedInRow, ...]:
    """The rows without those at the end that are beyond the robot's and move nothing."""
    while len(rows) > wanted and rows[-1].is_zero:
        rows = rows[:-1]
    return rows


def _paired(
    rows: tuple[HandedInRow, ...], expected: Table, grading: Grading
) -> list[tuple[int | None, int | None]]:
    """Which handed-in row answers which expected row; in order where the numbers agree."""
    if len(rows) == len(expected):
        return [(i, i) for i in range(len(rows))]
    actual = values_of(rows)[:, None]
    found = matches(actual, expected[None], column_scales(grading), IS_ANGLE[:, None])
    return aligned((found >= Match.ROUNDED).sum(axis=-1).astype(np.float64))


def column_scales(grading: Grading) -> Numbers:
    """What each column is measured against."""
    return np.where(IS_ANGLE, 1.0, grading.exercise.length_scale)


def _all_matches(judged: Sequence[JudgedRow], grading: Grading) -> NDArray[np.int_]:
    """The Match of each cell of each row, ``(rows, 4)``."""
    nothing = np.full((len(COLUMNS), SAMPLES), np.nan)
    actual = np.array([nothing if row.row is None else row.row.handed_in for row in judged])
    rounded = [[False] * len(COLUMNS) if row.row is None else row.row.rounded for row in judged]
    expected = np.array([row.expected for row in judged])
    angle, scales = IS_ANGLE[:, None], column_scales(grading)
    found = matches(actual, expected, scales, angle, rounded)
    for i, column in np.argwhere(found == Match.ROUNDED).tolist():
        if not _is_rounded(
            actual[i, column], expected[i, column], column, judged[i].joint, grading
        ):
            found[i, column] = Match.DIFFERENT
    if np.abs(expected[..., 0]).max() > HUGE * grading.exercise.length_scale:
        # A student's own large offset must not widen what is let through.
        off = np.abs(difference(actual, expected, angle)).max(axis=-1)
        found = np.where((found == Match.EXACT) & (off > FAR * scales), int(Match.DIFFERENT), found)
    return found


def _is_rounded(
    actual: Numbers, expected: Numbers, column: int, joint: Joint | None, grading: Grading
) -> bool:
    """Whether a cell within rounding is rounded: in its constant, and moved as it should be."""
    angle = bool(IS_ANGLE[column])
    if not _moves_as(changes(actual), changes(expected), angle):
        return False
    if joint is None or column != variable_column(joint):
        return True
    variable = grading.samples.values[joint.variable]
    if not _moves_as(changes(expected), changes(variable), angle):
        variable = -variable
    scale = float(column_scales(grading)[column])
    return same(actual - variable, expected - variable, scale, angle)


def _moves_as(one: Numbers, other: Numbers, angle: bool) -> bool:
    return bool(np.abs(difference(one, other, angle)).max() < TOLERANCE)
