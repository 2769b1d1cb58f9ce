"""Judge a submitted table cell by cell, in the convention that fits, and limit its points.

This file decides right or wrong by numbers only, and knows which rows are missing or extra. What is
wrong in a single cell is said in ``diagnosis``; points are counted in ``marks.py``.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache, reduce
from itertools import chain, count, repeat, takewhile
from string import ascii_lowercase
from typing import Final

import numpy as np
from numpy.typing import NDArray

from dh_grader.catalogue import Exercise, Joint, ReferenceTable
from dh_grader.catalogue.kinds import DhTableSpec
from dh_grader.grading.frames import (
    FrameFreedom,
    Role,
    freedom_of,
    joint_variables,
    pair_in_order,
    reference_values,
    remarks_on,
)
from dh_grader.grading.frames.nearest import (
    NearestTable,
    frames_from_reference,
    nearest_for_roles,
    out_of_place,
    parallel_neighbours,
)
from dh_grader.grading.frames.roles import (
    best_roles,
    completed,
    roles_in,
    usual_rows,
    without_idle_rows,
)
from dh_grader.grading.judging import Content, Grading, Judged, KnownCells, known_cells, of_rows
from dh_grader.grading.marks import least_lost, steps_lost
from dh_grader.grading.misconception import register
from dh_grader.grading.numbers import (
    EXACT_VALUE,
    HUGE_CELL,
    HUGE_LENGTH,
    PLAINLY_DIFFERENT,
    SAME_CONTENT,
    SAMPLES,
    Match,
    difference,
    draw,
    entry_matches,
    nearly_equal,
)
from dh_grader.grading.reading.entries import Entry, Reader
from dh_grader.grading.reading.table import (
    COMPUTED,
    EMPTY,
    GIVEN_UP,
    IS_ANGLE,
    StudentRow,
    StudentTable,
    computed_row,
    values_of,
)
from dh_grader.grading.report import Finding, Severity, Verdict
from dh_grader.kinematics import ALPHA, COLUMNS, A, Convention, Matrices, Numbers, Table
from dh_grader.kinematics.frame_choice import NO_SUCH_CELL, ROW_COSTS, WRONG_CELL, departure
from dh_grader.translations import Sentence, say, template

# --- Judge a submitted table cell by cell
#
# The table is compared with the reference table. If the student chose the frames, it is compared
# with the nearest table that describes the robot (``best_roles``).


_ARE_ANGLES: Final = tuple(IS_ANGLE.tolist())


@dataclass(frozen=True, slots=True)
class JudgedRow:
    """A submitted row (None if missing), and its correct values ``(4, SAMPLES)``.

    ``shared`` is true if the axis of the row is parallel to a neighbouring axis, so that offsets
    along both axes add up.
    """

    label: str
    joint: Joint | None
    row: StudentRow | None
    expected: Table
    shared: bool = False


@dataclass(frozen=True)
class Judgement:
    """A submitted table compared with the correct table, in the frames in which it is judged.

    ``matches`` is the Match of each cell, ``(rows, 4)``; no cell of a missing row matches.
    ``roles`` are the roles of the submitted rows if the student chose the frames. ``departures`` is
    the cost of these frames, infinite if the intended frames are unknown. ``extra`` are the rows
    without a counterpart. ``in_place`` is true if each row was compared with the reference's row of
    the same place. ``reached`` is true if the rows lead to the given tool frame. ``lost`` is the
    number of units that the wrong cells lose, in the frames in which they lose the fewest; a single
    wrong cell loses one unit.
    """

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
    """Compare a table with the table ``(rows, 4, SAMPLES)`` that the student intended.

    No row may be missing.
    """
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
    unwritten = [None] * len(COLUMNS)
    expressions = [
        each for row in judged for each in (row.row.expressions if row.row else unwritten)
    ]
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


# --- The content cells of a table: the cells that need knowledge (see ``Content``)


def table_content(
    part: DhTableSpec, judgement: Judgement, convention: Convention, grading: Grading
) -> Content:
    """Return the content cells of a table: the cells that need knowledge."""
    exercise = grading.exercise
    task = _TaskKey(exercise.version, part.id, convention, part, exercise)
    # Unreadable cells alone do not increase the cost of a unit.
    is_spoiled = part.frames == "free" and bool(judgement.wrong_as_read or judgement.empty)
    most = _fewest(task) if is_spoiled else None
    if not judgement.roles:
        content = _of_reference(task)
        return replace(content, most=most) if is_spoiled else content
    joints = [judged.joint for judged in judgement.rows]
    expected = np.array([judged.expected for judged in judgement.rows])
    known = _differs_from_lazy(expected, joints, grading)
    of_robot = exercise.robot.convention
    same = task if convention is of_robot else replace(task, convention=of_robot)
    usual = _of_reference(same).usual
    return of_rows(known, most=most, usual=usual)


def _differs_from_lazy(
    table: Table, joints: Sequence[Joint | None], grading: Grading
) -> KnownCells:
    # Two samples with different links and joint values are enough to distinguish formulas.
    lazy = joint_variables(joints, grading.samples)[..., :: SAMPLES - 1]
    cells, angle = table[..., :: SAMPLES - 1], IS_ANGLE[:, None]
    # The joint variable with a minus sign is also lazy.
    either = known_cells(np.array([cells, -cells]), lazy, column_scales(grading), angle)
    return np.asarray(either.all(axis=0))


@dataclass(frozen=True)
class _TaskKey:
    # A cache key: equal for the same exercise version, part and convention.
    version: str
    part_id: str
    convention: Convention
    part: DhTableSpec = field(compare=False)
    exercise: Exercise = field(compare=False)


@lru_cache(maxsize=256)
def _of_reference(task: _TaskKey) -> Content:
    grading = _own_grading(task.exercise)
    table = reference_values(task.exercise.robot.tables[task.convention], grading.samples)
    joints = _joints_of_rows(task)
    content = _without_given(of_rows(_differs_from_lazy(table, joints, grading)), task.part)
    usual: tuple[int, int] | None = (sum(content.earning), content.count)
    if task.convention != task.exercise.robot.convention:
        usual = _of_reference(replace(task, convention=task.exercise.robot.convention)).usual
    return replace(content, usual=usual)


def _without_given(content: Content, part: DhTableSpec) -> Content:
    if not part.given:
        return content
    given = tuple(i + 1 in part.given for i in range(len(content.known)))
    first = content.groups[given.index(False)]
    rows = list(zip(content.known, content.groups, given, strict=True))
    return replace(
        content,
        known=tuple((False,) * len(row) if is_given else row for row, _, is_given in rows),
        groups=tuple(first if is_given else group for _, group, is_given in rows),
        given=given,
    )


def _own_grading(exercise: Exercise) -> Grading:
    samples = draw(exercise, None)
    reader = Reader.of(exercise, samples, "radians")
    return Grading(exercise, samples, reader)


def _joints_of_rows(task: _TaskKey) -> list[Joint | None]:
    joints, reference = task.exercise.joints, task.exercise.robot.tables.get(task.convention)
    count = len(joints if reference is None else reference.rows)
    return [*joints, *[None] * (count - len(joints))]


@lru_cache(maxsize=256)
def _fewest(task: _TaskKey) -> int:
    # Along parallel axes, a table may have the sum of two lengths in one cell, or arbitrary numbers
    # in other cells that cancel out. Such additional cells have no worth.
    grading, joints = _own_grading(task.exercise), _joints_of_rows(task)
    lazy = joint_variables(joints, grading.samples)
    roles = tuple(Role(computed_row(row), joint) for row, joint in zip(lazy, joints, strict=True))
    nearest = nearest_for_roles(roles, task.convention, freedom_of(task.part), grading)
    return int(np.count_nonzero(_differs_from_lazy(nearest.expected, joints, grading)))


# --- Messages on missing rows, extra rows, and rows that are graded under a new row number


_END_EFFECTOR: Final = template("row {row} with the end effector")
_FIXED_FIRST: Final = template("row {row} with the fixed row {label} before the first joint")
_FIXED_BEFORE: Final = template("row {row} with the fixed row {label} before the last joint")
_FIXED_BEHIND: Final = template("row {row} with the fixed row {label} behind the last joint")
_MATCHED = register(
    of=StudentTable,
    code="rows_matched",
    rule="rows",
    means="rows that are graded under another number than they have in the answer, because some "
    "are missing or too many (an info)",
    example=("planar-rr", "table", "a2, 0, 0, q2"),
    unlike={"1/d": "1"},
)

EXTRA_ROW = register(
    of=StudentTable,
    code="extra_row",
    rule="rows",
    means="a row that belongs to no joint of this robot; it costs what a wrong cell costs",
    example=(
        "planar-rrr-drawn",
        "table",
        (
            "a, alpha, d, theta ↵ 0, 0, 0, q1 ↵ l1, 0, 0, q2 ↵ l2, 0, 0, q3 ↵ l3, 0, 0, 0 ↵ l3, 0, "
            "0, 0"
        ),
    ),
    unlike={"1/a": "l1"},
)
_MISSING_ROW = register(
    of=StudentTable,
    code="missing_row",
    rule="rows",
    means="a joint has no row",
    example=("planar-rr", "table", "a1, 0, 0, q1"),
    unlike={"1/d": "1"},
)
_MISSING_TOOL_ROW = register(
    of=StudentTable,
    code="missing_tool_row",
    rule="rows",
    means="the last row, from the last joint's frame to the end effector, is not there",
    example=("planar-rrr", "table", "0, 0, 0, q1 ↵ l1, 0, 0, q2 ↵ l2, 0, 0, q3"),
    unlike="0, 0, 0, q1 ↵ l2, 0, 0, q3 ↵ l3, 0, 0, 0",
)
_ROW_TOO_MANY = register(
    of=StudentTable,
    code="row_too_many",
    rule="rows",
    means="a fixed row that the arm does not need, in a wrong table: it earns nothing (a warning)",
    example=("planar-rr", "table", "a1, 0, 0, q1 ↵ 5, 0, 0, 0 ↵ a2, 0, 0, q2 ↵ a1, 0, 0, 0"),
    unlike={"2/a": "a1"},
)


def row_places(
    table: StudentTable, judgement: Judgement, convention: Convention, grading: Grading
) -> tuple[Finding, ...]:
    """Return a message on the rows that are graded under a new row number."""
    robot = grading.exercise.robot
    reference = robot.tables.get(convention)
    labels = [str(joint.index) for joint in robot.joints]
    if reference is not None:
        labels = list(reference.labels)
    handed_in = [row.entries for row in table.rows]
    graded = [judged.row and judged.row.entries for judged in judgement.rows]
    if graded == handed_in and [judged.label for judged in judgement.rows] == labels:
        return ()
    # Compare entries: rows with rounded angles made exact are new objects with the same entries.
    places = {id(row.entries): i for i, row in enumerate(table.rows)}
    first = next((i for i, each in enumerate(judgement.rows) if each.joint is not None), 0)
    moved = [
        _compared(place + 1, judged, is_first=i < first)
        for i, judged in enumerate(judgement.rows)
        if judged.row is not None
        for place in [places[id(judged.row.entries)]]
        if judged.label != (labels[place] if place < len(labels) else "e")
    ]
    if not moved:
        return ()
    rows = reduce(lambda one, other: say("{one}, {other}", one=one, other=other), moved)
    message = say("Your rows were compared in this way: {rows}.", rows=rows)
    return (_MATCHED.finding(message, severity=Severity.INFO),)


def _compared(row: int, judged: JudgedRow, *, is_first: bool) -> Sentence:
    if judged.joint is not None:
        return say("row {row} with joint {joint}", row=row, joint=judged.joint.index)
    if judged.label == "e":
        return say(_END_EFFECTOR, row=row)
    if not judged.label.startswith("0"):
        return say(_FIXED_BEHIND, row=row, label=judged.label)
    fixed = _FIXED_FIRST if is_first else _FIXED_BEFORE
    return say(fixed, row=row, label=judged.label)


def missing_row(judged: JudgedRow) -> Finding:
    """Return the finding on a missing row."""
    if judged.joint is not None:
        return _MISSING_ROW.finding(
            say("There is no row for joint {joint}.", joint=judged.joint.index)
        )
    return _MISSING_TOOL_ROW.finding(
        say("The fixed row that leads from the last joint's frame to the end effector is missing."),
    )


def row_too_many(i: int) -> Finding:
    """Return the finding on a fixed row that the arm does not need."""
    return _ROW_TOO_MANY.finding(
        say(
            "Row {row} of your table belongs to no joint and not to the end effector: check "
            "whether you need it.",
            row=i + 1,
        ),
        severity=Severity.WARNING,
    )


def extra_row(i: int) -> Finding:
    """Return the finding on a row that belongs neither to a joint nor to the end effector."""
    return EXTRA_ROW.finding(
        say(
            "Row {row} of your table belongs to no joint and not to the end effector: leave it "
            "out.",
            row=i + 1,
        ),
    )


# --- Choose the convention in which a submitted table is judged


_TAKEN = register(
    of=StudentTable,
    code="convention_taken",
    rule="convention",
    means="either convention will do and the answer names none: it was read in the one that fits "
    "best (an info)",
    example=("skew", "table", "a, alpha, d, theta ↵ 0, 60°, 0, theta1 ↵ a2, 0, 0, theta2"),
    unlike={"1/alpha": "0"},
)
_NOT_ASKED_FOR = register(
    of=StudentTable,
    code="convention_not_asked_for",
    rule="convention",
    means="the answer, or the links of a script, name another convention than the part; it was "
    "graded in the part's, and costs nothing by that",
    example=(
        "planar-rr",
        "table",
        {"convention": "modified", "rows": [["a1", "0", "0", "q1"], ["a2", "0", "0", "q2"]]},
    ),
    unlike="a2, 0, 0, theta2",
)


def judged_in_convention(
    part: DhTableSpec, table: StudentTable, grading: Grading
) -> tuple[Convention, Judgement, tuple[Finding, ...]]:
    """Choose the convention of a table, and judge the table; also return findings on the choice.

    If both conventions are allowed, the convention with fewer wrong cells is chosen, the
    reference's if the counts are equal.
    """
    if part.convention == "either" and table.convention is None:
        convention, judgement = _fitting(part, table, grading)
        return convention, judgement, (_taken(convention),)
    asked = table.convention if part.convention == "either" else part.convention
    assert asked is not None
    findings = _not_asked_for(asked, table)
    return asked, judged_table(part, table.rows, asked, grading), findings


def _fitting(
    part: DhTableSpec, table: StudentTable, grading: Grading
) -> tuple[Convention, Judgement]:
    own = grading.exercise.robot.convention
    first = judged_table(part, table.rows, own, grading)
    if not _misfit(first):
        return own, first
    [other] = set(Convention) - {own}
    second = judged_table(part, table.rows, other, grading)
    return (other, second) if _misfit(second) < _misfit(first) else (own, first)


def _misfit(judgement: Judgement) -> int:
    return judgement.wrong + len(COLUMNS) * len(judgement.extra) + (not judgement.reached)


def _taken(convention: Convention) -> Finding:
    if convention is Convention.STANDARD:
        hint = say(
            "The answer names no convention; it was read as standard, which fits it best. Check "
            "which convention you used, and name it."
        )
    else:
        hint = say(
            "The answer names no convention; it was read as modified, which fits it best. Check "
            "which convention you used, and name it."
        )
    return _TAKEN.finding(hint, severity=Severity.INFO)


def _not_asked_for(asked: Convention, table: StudentTable) -> tuple[Finding, ...]:
    if table.convention in (None, asked):
        return ()
    if asked is Convention.STANDARD:
        hint = say(
            "This part asks for the standard convention and was graded in it, but the answer says "
            "modified."
        )
    else:
        hint = say(
            "This part asks for the modified convention and was graded in it, but the answer says "
            "standard."
        )
    return (_NOT_ASKED_FOR.finding(hint, severity=Severity.WARNING),)


# --- Replace numbers in a table, or empty cells


def with_lazy_cells(answer: StudentTable, convention: Convention, grading: Grading) -> StudentTable:
    """Return the table with each empty or unreadable cell set to its joint variable or 0."""
    roles = roles_in(answer.rows, convention, grading, in_order=True)
    lazy = joint_variables([role.joint for role in roles], grading.samples)[: len(answer.rows)]
    return _filled(answer, np.asarray(np.isnan(answer.values).any(axis=-1)), lazy)


def with_wrong_cells(answer: StudentTable, cells: KnownCells, grading: Grading) -> StudentTable:
    """Return the table with numbers in ``cells`` ``(rows, 4)`` that are wrong in any frames."""
    numbers = out_of_place(len(answer.rows), grading.exercise.length_scale)
    return _filled(answer, cells, np.repeat(numbers, SAMPLES, axis=-1), GIVEN_UP)


def with_wrong_rows(answer: StudentTable, more: int, grading: Grading) -> StudentTable:
    """Return the table with ``more`` rows at its end of numbers that are wrong in any frames."""
    rows = len(answer.rows)
    numbers = out_of_place(rows + more, grading.exercise.length_scale)[rows:]
    values = np.repeat(numbers, SAMPLES, axis=-1)
    given_up = tuple(computed_row(row, GIVEN_UP) for row in values)
    return replace(
        answer, rows=(*answer.rows, *given_up), values=np.concatenate([answer.values, values])
    )


def with_empty_cells(answer: StudentTable, cells: KnownCells) -> StudentTable:
    """Return the table without its entries in ``cells`` ``(rows, 4)``."""
    return _filled(answer, cells, np.full_like(answer.values, np.nan), EMPTY)


def written_content(answer: StudentTable, given: Sequence[bool], grading: Grading) -> int:
    """Return the number of cells in which the student wrote more than 0 or a joint variable.

    ``given`` marks the rows that the exercise gives; their cells are not counted.
    """
    values = answer.values[..., None, :: SAMPLES - 1]
    variables = [grading.samples.values[joint.variable] for joint in grading.exercise.joints]
    lazy = np.array([np.zeros(SAMPLES), *variables, *(-each for each in variables)])
    scales = np.where(IS_ANGLE, 1.0, grading.exercise.length_scale)[:, None]
    known = known_cells(values, lazy[:, :: SAMPLES - 1], scales, IS_ANGLE[:, None, None])
    written = (known | np.isnan(values).any(axis=-1)).all(axis=-1) & ~empty_cells(answer)
    if len(given) == len(written):
        written = written[~np.array(given)]
    return int(np.count_nonzero(written))


def with_zeros(answer: StudentTable) -> Table:
    """Return the numbers of the table, with 0 in empty cells."""
    return np.where(empty_cells(answer)[..., None], 0.0, answer.values)


def empty_cells(answer: StudentTable) -> KnownCells:
    """Return a mask ``(rows, 4)`` of the empty cells."""
    return np.array(
        [[entry.verdict is Verdict.MISSING for entry in row.entries] for row in answer.rows]
    )


def _filled(
    answer: StudentTable, cells: KnownCells, numbers: Table, filling: Entry = COMPUTED
) -> StudentTable:
    values = np.where(cells[..., None], numbers, answer.values)
    rows = tuple(
        StudentRow(
            tuple(
                filling if is_filled else entry
                for entry, is_filled in zip(row.entries, cells[i].tolist(), strict=True)
            ),
            values[i],
        )
        for i, row in enumerate(answer.rows)
    )
    return replace(answer, rows=rows, values=values)


# --- Limit the points of a wrong table, so that an empty row never earns more than a wrong row
#
# A wrong table earns at least as much as the same table with one wrong row replaced by numbers that
# are wrong in all frames, and as the table without the wrong rows after the rows of all joints
# (there, empty rows are left out). A table with empty cells earns at most as much as the same table
# with such numbers in these cells.


# The most wrong cells that are looked for in all rows at once if nothing but the frames is free.
FEW = 2
# The work of judging a table with a row given up, as a share of that of a table with messages.
AGAIN = 0.5


@dataclass(frozen=True, slots=True)
class FairPoints:
    """Limits the points of a wrong table, so that empty rows never earn more than wrong rows.

    ``judged_again`` judges similar tables, whose points are the limits. ``work`` is the work of
    judging a table with messages.
    """

    part: DhTableSpec
    judged_again: Callable[[StudentTable], Judged]
    work: float
    grading: Grading

    def limited(self, answer: StudentTable, judged: Judged) -> Judged:
        """Return ``judged``, the judgement of a wrong table, with limits on its points."""
        budget = self.grading.reader.budget
        unread = np.isnan(answer.values).any(axis=-1)
        if missing := _missing_at_end(self.part, answer, judged, self.grading):
            # A missing row counts as a wrong one.
            if judged.count_wrong == missing * len(COLUMNS):
                return judged
            budget.charge_search(self.work)
            full = with_wrong_rows(answer, missing, self.grading)
            fair = self.limited(full, self.judged_again(full))
            least = None if unread.any() else self._without_a_row(answer, judged, fair)
            return replace(judged, at_most=fair, at_least=least)
        # A table without any readable cell earns nothing anyway.
        if unread.all():
            return judged
        shorter = self._without_wrong_end(answer, judged)
        if not unread.any():
            best = judged if shorter is None else min(judged, shorter, key=self._lost)
            best = self._without_a_row(answer, judged, best)
            return judged if best is judged else replace(judged, at_least=best)
        empty = empty_cells(answer)
        if not empty.any():
            return judged if shorter is None else replace(judged, at_least=shorter)
        budget.charge_search(self.work)
        others = [self.judged_again(with_wrong_cells(answer, empty, self.grading))]
        others += [] if judged.at_most is None else [judged.at_most]
        return replace(judged, at_most=max(others, key=self._lost), at_least=shorter)

    def _without_a_row(self, answer: StudentTable, judged: Judged, best: Judged) -> Judged:
        """Return the best judgement of several.

        The candidates are ``best`` and the judgements of the table without one wrong row.
        """
        part, grading = self.part, self.grading
        counts = _counts_wrong(judged)
        # All tables that differ from the answer in as few cells, or in one row, have been compared.
        is_searched = _has_given_ends(part, judged) and (
            sum(counts) <= FEW or np.count_nonzero(counts) == 1
        )
        wrong = _wrong_rows(part, judged, len(answer.rows))
        for row, content in _content_in_any_frames(part, answer, wrong, grading):
            least = least_lost(part, judged, content)
            if self._lost(best) <= least or (content and is_searched):
                continue
            if not grading.reader.budget.affords_search(AGAIN * self.work):
                break
            cells = np.zeros(answer.values.shape[:2], np.bool_)
            cells[row] = True
            other = self.judged_again(with_wrong_cells(answer, cells, grading))
            if other.is_right:
                # The row may be anything, such as the last one if the tool is free.
                other = self.judged_again(with_empty_cells(answer, cells))
            best = min(best, other, key=self._lost)
        return best

    def _without_wrong_end(self, answer: StudentTable, judged: Judged) -> Judged | None:
        """Return the judgement of the table without its wrong last rows.

        Return None if there are no such rows, or if the table is right without them.
        """
        budget = self.grading.reader.budget
        shorter = _shortened(self.part, answer, judged, self.grading)
        if shorter is None or not budget.affords_search(AGAIN * self.work):
            return None
        other = self.judged_again(shorter)
        # Rows that belong to no right table must cost something.
        return None if other.is_right else self.limited(shorter, other)

    def _lost(self, judged: Judged) -> int:
        return steps_lost(self.part, judged)


def _missing_at_end(
    part: DhTableSpec, answer: StudentTable, judged: Judged, grading: Grading
) -> int:
    convention = _convention_of(part, answer)
    # The other convention may need fewer rows.
    if convention is None or part.frames == "given" or judged.whole_cost is not None:
        return 0
    missing = usual_rows(convention, grading) - len(answer.rows)
    after = [cell for row in judged.rows[len(answer.rows) :] for cell in row.cells]
    is_at_end = all(cell.verdict is Verdict.MISSING for cell in after)
    return missing if is_at_end and len(after) == missing * len(COLUMNS) else 0


def _shortened(
    part: DhTableSpec, answer: StudentTable, judged: Judged, grading: Grading
) -> StudentTable | None:
    """Return the table up to its first wrong row after the joints' rows; None if all are right."""
    robot = grading.exercise.robot
    rows, kept = len(answer.rows), len(robot.joints)
    counts = _counts_wrong(judged)
    if part.frames == "given" or part.tool != "given" or len(counts) != rows:
        return None
    if rows > len(part.asked_table(robot).rows) or answer.rows[-1].is_given_up:
        return None
    kept += sum(1 for _ in takewhile(lambda count: not count, counts[kept:]))
    if kept >= rows:
        return None
    return replace(answer, rows=answer.rows[:kept], values=answer.values[:kept])


def _convention_of(part: DhTableSpec, answer: StudentTable) -> Convention | None:
    return answer.convention if part.convention == "either" else part.convention


def _wrong_rows(part: DhTableSpec, judged: Judged, rows: int) -> list[int]:
    # Rows with the most wrong cells come first.
    if part.frames == "given":
        return []
    if judged.whole_cost is not None:
        # A slip in several rows is not cured by one empty row.
        if judged.beside is not None:
            judged = judged.beside
        elif np.count_nonzero(_counts_wrong(judged)) > FEW:
            return []
    if len(judged.rows) != rows:
        return list(range(rows))
    counts = _counts_wrong(judged)
    has_given_ends = _has_given_ends(part, judged)
    if has_given_ends and sum(counts) == 1:
        # The other rows determine this row.
        return []
    # If base, tool or directions are free, a wrong row may make another one look wrong.
    takes_all = not has_given_ends and sum(counts) > FEW
    return sorted((i for i in range(rows) if counts[i] or takes_all), key=lambda i: -counts[i])


def _counts_wrong(judged: Judged) -> list[int]:
    return [sum(c.verdict is not Verdict.CORRECT for c in row.cells) for row in judged.rows]


def _has_given_ends(part: DhTableSpec, judged: Judged) -> bool:
    return freedom_of(part) == FrameFreedom() and judged.at_most is None


def _content_in_any_frames(
    part: DhTableSpec, answer: StudentTable, rows: list[int], grading: Grading
) -> list[tuple[int, int]]:
    # Two cells of a row are not trivial in any frames: the angle between its two axes, unless they
    # are parallel; and their distance, unless one axis only has a direction.
    convention = _convention_of(part, answer)
    table = grading.exercise.robot.tables.get(convention) if convention else None
    if not rows or table is None or len(table.rows) != len(answer.rows):
        return [(i, 0) for i in rows]
    cells = reference_values(table, grading.samples)
    turned = np.abs(np.sin(cells[:, ALPHA])).min(axis=-1) > SAME_CONTENT
    apart = np.abs(cells[:, A]).min(axis=-1) > SAME_CONTENT * grading.exercise.length_scale
    has_base = part.base != "free"
    has_tool = part.tool != "free" and len(table.joints) == len(table.rows)
    # For each axis, whether it is a line or only a direction; None for base and tool.
    is_line = [None, *(not joint.prismatic for joint in table.joints), None]
    first = 0 if convention is Convention.MODIFIED else 1
    found = []
    for i in rows:
        between = is_line[i + first : i + first + 2]
        is_fixed = (
            len(between) == 2
            and (between[0] is not None or has_base)
            and (between[1] is not None or has_tool)
        )
        is_apart = apart[i] and False not in between
        found.append((i, int(is_fixed and turned[i]) + int(is_fixed and is_apart)))
    return found
