"""Slips in a table: undone in an answer, or put into the robot's cells, rows and columns.

A slip explains a wrong table if the table describes the robot once the slip is corrected. Put into
the robot's table, it may explain a wrong pose: ``upstream.py`` searches for that. What a slip is,
and its kinds, is in ``slips_of_the_table.py``.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain, combinations, islice

import numpy as np
from numpy.typing import NDArray

from dh_grader.catalogue import Joint, ReferenceTable
from dh_grader.catalogue.kinds import DhTableSpec
from dh_grader.expressions import Symbol
from dh_grader.grading.diagnosis.slips_of_the_table import (
    ANGLE_LEFT_OUT,
    COLUMNS_SWAPPED,
    DISTANCE_LEFT_OUT,
    HALF_TURN,
    MISSING_LINK,
    OTHER_CONVENTION,
    PARAMETER_SIGN,
    QUARTER_TURN,
    ROW_ORDER,
    SIGN,
    Axis,
    CellChange,
    Names,
    Slip,
    SlipWords,
    home_slip,
    joint_slips,
    joint_variable_missing,
    joint_variable_sign,
    length_slips,
)
from dh_grader.grading.frames import (
    RepairedTable,
    Rereadable,
    Role,
    WrittenTable,
    freedom_of,
    reference_values,
    valid_tables,
    written_table,
)
from dh_grader.grading.frames.nearest import frames_from_reference, in_convention
from dh_grader.grading.judging import Grading
from dh_grader.grading.judging_table import Judgement, departures_of, judged_by_intended
from dh_grader.grading.misconception import (
    AXES,
    SYMBOLS,
    AnyHypothesis,
    Explained,
    Record,
    Repaired,
    axes_of_row,
    change_every_sign,
    each_hypothesis,
    misconception,
    records_of,
    says,
    wrong_throughout,
)
from dh_grader.grading.numbers import (
    CONSTANT,
    INTENDED_CELL,
    INTENDED_POSE,
    Match,
    difference,
)
from dh_grader.grading.reading.table import IS_ANGLE, table_values, values_of
from dh_grader.grading.report import Finding
from dh_grader.kinematics import ALPHA, COLUMNS, THETA, A, Convention, D, Numbers, Table
from dh_grader.translations import Sentence, listed, paragraph, say, template

# --- The findings on a wrong table as a whole


_OF_UNIT = frozenset({"degrees_as_radians", "radians_as_degrees"})

# If more lengths are in wrong cells, the search for two exchanged ones is not reliable.
MAX_LENGTHS = 4

# Samples of each half that are enough to compare dozens of tables.
TABLE_SAMPLES = 3


@dataclass(frozen=True, slots=True)
class WrongTable:
    """A wrong table at all samples, and at a few samples, which make comparisons fast."""

    written: WrittenTable
    subset: WrittenTable
    # Takes tables (T, rows, 4, samples) at these few samples, and returns a mask (T,) of the tables
    # that describe the robot.
    valid: Callable[[Table, Convention], NDArray[np.bool_]]

    def explained_by(self, hypotheses: Iterable[AnyHypothesis]) -> list[AnyHypothesis]:
        """Return the hypotheses (possible mistakes) that explain the table.

        The hypotheses must be tables at the few samples; all are compared at once.
        """
        tried = list(hypotheses)
        explains = np.zeros(len(tried), dtype=np.bool_)
        for convention in Convention:
            places = [i for i, each in enumerate(tried) if each.answer.convention is convention]
            if places:
                tables = np.array([tried[i].answer.values for i in places])
                explains[places] = self.valid(tables, convention)
                if convention is self.subset.convention:
                    change = np.abs(tables - self.subset.values).max(axis=(1, 2, 3))
                    explains[places] &= change > INTENDED_POSE
        return [tried[i] for i in np.flatnonzero(explains)]


@dataclass(frozen=True, slots=True)
class _Intended:
    # The slips that are corrected in the table.
    findings: tuple[Finding, ...]
    # (rows, 4, SAMPLES), or None if it needs other rows than the student wrote.
    table: Table | None
    # The cells (rows, 4) that differ from the student's table.
    changed: NDArray[np.bool_]
    # How far its frames are from the reference's frames.
    departures: float


def explained(
    part: DhTableSpec,
    roles: tuple[Role, ...],
    convention: Convention,
    judgement: Judgement,
    grading: Grading,
    *,
    combine: bool,
) -> tuple[tuple[Finding, ...], Judgement]:
    """Return the findings that explain a whole wrong table, and a judgement that fits them.

    Misconceptions that would make the whole table correct are compared with the cells that were
    found wrong. If none of them fits, there are no findings and the judgement is unchanged. Pairs
    of misconceptions are tried only if ``combine`` is true.
    """
    values = values_of([role.row for role in roles if role.row is not None])
    if len(values) < len(roles) or not np.isfinite(values).all():
        return (), judgement
    exchanges = tuple(_exchanges(judgement, roles, grading))
    case = _wrong_table(part, roles, convention, values, exchanges, grading)
    found = explaining(case, combine=combine)
    intended: list[_Intended] = []
    wrong = judgement.matches < Match.ROUNDED
    for repaired in found:
        intended.append(_intended(repaired, case.written, roles, grading))
        findings, table = intended[-1].findings, intended[-1].table
        if table is not None and not np.array_equal(intended[-1].changed, wrong):
            # A table that is right in the other convention is no coincidence of single cells.
            if _is_other_convention(intended[-1], judgement):
                break
            continue
        if table is None or _OF_UNIT.intersection(finding.code for finding in findings):
            # Converted numbers are rounded, so they do not show the frames.
            return findings, replace(judgement, findings=())
        # The student's frames are those of the table without the slip.
        chosen = judged_by_intended(table, roles, convention, grading).findings
        return findings, replace(judgement, findings=chosen)
    nearest = min(intended, key=lambda each: each.departures, default=None)
    if nearest is None or nearest.table is None:
        return (), judgement
    is_nearer = nearest.departures < judgement.departures
    if not (is_nearer or _is_other_convention(nearest, judgement)):
        return (), judgement
    return nearest.findings, judged_by_intended(nearest.table, roles, convention, grading)


def _wrong_table(
    part: DhTableSpec,
    roles: tuple[Role, ...],
    convention: Convention,
    values: Table,
    exchanges: tuple[tuple[str, str, Table], ...],
    grading: Grading,
) -> WrongTable:
    exercise, samples = grading.exercise, grading.samples
    table = exercise.robot.tables.get(convention)
    reference = None if table is None else reference_values(table, samples)
    written = written_table(values, convention, reference, exercise.robot.joints, samples)
    written = replace(written, exchanges=exchanges)
    freedom, subset = freedom_of(part), samples.subset(TABLE_SAMPLES)

    def valid(tables: Numbers, convention: Convention) -> NDArray[np.bool_]:
        return valid_tables(tables, roles, convention, freedom, exercise, subset, INTENDED_POSE)

    return WrongTable(written, written.subset(TABLE_SAMPLES), valid)


def _exchanges(
    judgement: Judgement, roles: Sequence[Role], grading: Grading
) -> Iterator[tuple[str, str, Table]]:
    # How the table changes if two lengths in wrong cells are exchanged.
    by_name = grading.exercise.vocabulary.by_name
    lengths: set[str] = set()
    for i, column in np.argwhere(judgement.matches < Match.ROUNDED).tolist():
        row = judgement.rows[i].row
        expression = None if row is None else row.expressions[column]
        if expression is not None:
            lengths.update(name for name in expression.symbols if _is_length(by_name.get(name)))
    if not 2 <= len(lengths) <= MAX_LENGTHS:
        return
    rows = [role.row for role in roles if role.row is not None]
    written = table_values(rows, grading.samples)
    for one, other in combinations(sorted(lengths), 2):
        exchanged = grading.samples.renamed({one: other, other: one})
        yield one, other, table_values(rows, exchanged) - written


def _is_length(symbol: Symbol | None) -> bool:
    return symbol is not None and symbol.kind == "length" and symbol.joint is None


def _intended(
    repaired: Explained, written: WrittenTable, roles: tuple[Role, ...], grading: Grading
) -> _Intended:
    table = in_convention(repaired.answer, written.convention)
    if table is None:
        nothing = np.zeros(written.values.shape[:2], np.bool_)
        return _Intended(repaired.findings, None, nothing, np.inf)
    error = np.abs(difference(table, written.values, IS_ANGLE[:, None])).max(axis=-1)
    frames = frames_from_reference(table, roles, written.convention, grading)
    departures = departures_of(frames, grading)
    return _Intended(repaired.findings, table, error > INTENDED_CELL, departures)


def _is_other_convention(intended: _Intended, judgement: Judgement) -> bool:
    codes = [finding.code for finding in intended.findings]
    return codes == ["other_convention"] and intended.departures <= judgement.departures


def explaining(case: WrongTable, *, combine: bool) -> list[Explained]:
    """Return all misconceptions that explain the whole table.

    If there are none, and ``combine`` is true, return the first pair of misconceptions that
    explains the table together.
    """
    records = records_of(WrittenTable)
    found = list(_explaining(case, [partial(each_hypothesis, (each,)) for each in records]))
    if found or not combine:
        return found
    pairs = [
        partial(_with_another, each, records[i + 1 :])
        for i, each in enumerate(records_of(Rereadable))
    ]
    return list(islice(_explaining(case, pairs), 1))


def _explaining(
    case: WrongTable, ways: Sequence[Callable[[WrittenTable], Iterator[Explained]]]
) -> Iterator[Explained]:
    tried = [(build, list(build(case.subset))) for build in ways]
    every = chain.from_iterable(hypotheses for _, hypotheses in tried)
    explains = set(map(id, case.explained_by(every)))
    for build, hypotheses in tried:
        if not explains.isdisjoint(map(id, hypotheses)):
            # At all samples a misconception may yield fewer, if a value jumps between samples.
            for at_subset, complete in zip(hypotheses, build(case.written), strict=False):
                if id(at_subset) in explains:
                    yield complete


def _with_another(
    basic: Record, others: Sequence[Record], table: WrittenTable
) -> Iterator[Explained]:
    for first in each_hypothesis((basic,), table):
        for second in each_hypothesis(others, first.answer):
            yield Repaired(second.answer, partial(_both, first, second), record=second.record)


def _both(first: Explained, second: Explained) -> tuple[Finding, ...]:
    return (*first.findings, *second.findings)


# --- Slips of which one explains a wrong table: it describes the robot once they are corrected


_LINK_COLUMNS = slice(A, ALPHA + 1)


@misconception(
    of=WrittenTable,
    rank=50,
    code="link_columns_shifted",
    rule="convention",
    means=template("the columns a and α, or one of them, are one row too early or too late"),
    example=("three-link-cylindrical", "table", {"1/alpha": "-90deg", "2/alpha": "0"}),
    unlike={"2/a": "d3", "3/d": "0"},
)
def link_columns_shifted(table: WrittenTable) -> Iterator[RepairedTable]:
    """Column a, column α or both are shifted by one row."""
    rows = list(range(len(table.constants)))
    up, down = [*rows[1:], rows[0]], [rows[-1], *rows[:-1]]
    for columns in (_LINK_COLUMNS, slice(A, A + 1), slice(ALPHA, ALPHA + 1)):
        for late, order, end in ((True, up, -1), (False, down, 0)):
            of_other = late == (table.convention is Convention.STANDARD)
            other = table.convention.other if of_other and columns == _LINK_COLUMNS else None
            finding = partial(_shifted, listed(SYMBOLS[columns]), late, other)
            constants = table.constants.copy()
            constants[:, columns] = table.constants[order, columns]
            yield Repaired(table.changed(constants), finding)
            is_open = np.abs(table.values[-1 - end, columns]).max() < INTENDED_CELL
            if table.reference is not None and is_open:
                # The cells that belong at the open end are not in the student's table.
                completed = constants.copy()
                completed[end, columns] = table.reference[end, columns]
                yield Repaired(table.changed(completed), finding)


def _shifted(named: str, late: bool, other: Convention | None) -> Finding:
    # ``other`` is the convention in which the columns are in the correct place, or None.
    in_other = ""
    if other is Convention.STANDARD:
        in_other = say("In the standard convention they stand there.")
    elif other is Convention.MODIFIED:
        in_other = say("In the modified convention they stand there.")
    if late:
        hint = say(
            "{columns} stand one row too late: check which link each of them describes.",
            columns=named,
        )
        return says(paragraph(hint, in_other), say("Move {columns} up by one row.", columns=named))
    hint = say(
        "{columns} stand one row too early: check which link each of them describes.",
        columns=named,
    )
    return says(paragraph(hint, in_other), say("Move {columns} down by one row.", columns=named))


@misconception(
    of=WrittenTable,
    rank=60,
    code="column_sign",
    rule="of_column",
    means=template("one of a, α, d, θ has the wrong sign in every row"),
    example=("rrrp", "table", "-l2, 0, l1, q1 ↵ -l3, 180°, 0, q2 ↵ 0, 0, l4, q3 ↵ 0, 0, q4, 0"),
    unlike="l2, 0, l1, q1 ↵ l3, 180deg, 0, q2 ↵ q3, l4, 0, 0 ↵ 0, 0, q4, 0",
)
def column_sign(table: WrittenTable) -> Iterator[RepairedTable]:
    """One column has the wrong sign in all rows.

    Its joint variables have the wrong sign, too, or not.
    """
    for column in range(len(COLUMNS)):
        constants, motion = table.constants.copy(), table.motion.copy()
        constants[:, column] *= -1
        motion[:, column] *= -1
        if table.constants[:, column].any():
            yield Repaired(table.changed(constants), partial(_turned_sign, column))
        if table.motion[:, column].any():
            yield Repaired(table.changed(constants, motion), partial(_turned_sign, column))


def _turned_sign(column: int) -> Finding:
    return says(wrong_throughout(column), change_every_sign(column))


@misconception(
    of=WrittenTable,
    rank=70,
    code="columns_swapped",
    rule="of_column",
    means=template("a and d, or α and θ, are exchanged, throughout or in one row"),
    example=("planar-rr", "table", {"1/a": "0", "1/d": "a1"}),
    unlike={"2/d": "90°"},
)
def columns_swapped(table: WrittenTable) -> Iterator[RepairedTable]:
    """Two columns are exchanged: a with d, or α with θ.

    The exchange is in all rows or in one, with or without the joint variables.
    """
    for one, other in ((A, D), (ALPHA, THETA)):
        still = np.abs(table.constants[:, one] - table.constants[:, other]).max(axis=-1) > 0
        moving = np.abs(table.motion[:, one] - table.motion[:, other]).max(axis=-1) > 0
        for row in (None, *range(len(still))):
            rows = slice(None) if row is None else slice(row, row + 1)
            finding = partial(exchanged_columns, one, other)
            constants = _exchanged(table.constants, rows, one, other)
            if still[rows].any():
                yield Repaired(table.changed(constants), finding)
            if moving[rows].any():
                motion = _exchanged(table.motion, rows, one, other)
                yield Repaired(table.changed(constants, motion), finding)


def _exchanged(cells: Table, rows: slice, one: int, other: int) -> Table:
    exchanged = cells.copy()
    exchanged[rows, [one, other]] = cells[rows, [other, one]]
    return exchanged


def exchanged_columns(one: int, other: int) -> Finding:
    """Return the finding that two columns are exchanged, in all rows or in one row."""
    hint = say("a and d are exchanged: a is measured along x, d along z.")
    if one == ALPHA:
        hint = say("α and θ are exchanged: α is measured about x, θ about z.")
    names = {"one": SYMBOLS[one], "other": SYMBOLS[other]}
    return Finding("columns_swapped", hint, say("Exchange {one} and {other}.", **names))


@misconception(
    of=WrittenTable,
    rank=80,
    code="row_order",
    rule="rows",
    means=template("two rows are exchanged, or all rows, or all but the last, are reversed"),
    example=(
        "planar-rr",
        "table",
        {"1/a": "a2", "1/theta": "theta2", "2/a": "a1", "2/theta": "theta1"},
    ),
    unlike={"2/d": "90°"},
)
def row_order(table: WrittenTable) -> Iterator[RepairedTable]:
    """Two rows are exchanged, or the rows are in reverse order.

    The last row may keep its place.
    """
    rows = range(len(table.constants))
    exchanges = [{i: j, j: i} for i, j in combinations(rows, 2)]
    orders = [[exchange.get(row, row) for row in rows] for exchange in exchanges]
    if len(rows) > 2:
        orders.append([*reversed(rows)])
    if len(rows) > 3:
        orders.append([*reversed(rows[:-1]), rows[-1]])
    for order in orders:
        repaired = table.changed(table.constants[order], table.motion[order])
        yield Repaired(repaired, partial(_reordered, order))


def _reordered(order: list[int]) -> Finding:
    moved = [str(i + 1) for i, row in enumerate(order) if row != i]
    return says(
        say(
            "Rows {rows} stand in the wrong order: row i belongs to joint i, counted from the "
            "base.",
            rows=listed(moved) if len(moved) == 2 else ", ".join(moved),
        ),
    )


@misconception(
    of=WrittenTable,
    rank=40,
    code="lengths_exchanged",
    rule="of_column",
    means=template("two lengths are exchanged: a1 for a2, and a2 for a1"),
    example=("spatial-rrr", "table", {"1/a": "L2", "3/a": "R"}),
    unlike={"3/a": "0", "3/d": "L2"},
)
def lengths_exchanged(table: WrittenTable) -> Iterator[RepairedTable]:
    """Two lengths were exchanged, but not a and d of the same row."""
    for one, other, change in table.exchanges:
        repaired = table.constants + change
        rows = np.flatnonzero(change.any(axis=(1, 2)))
        if len(rows) == 1:
            row = slice(rows[0], rows[0] + 1)
            swapped = _exchanged(table.constants, row, A, D)
            if np.abs(repaired - swapped).max() < INTENDED_CELL:
                continue
        yield Repaired(table.changed(repaired), partial(_exchanged_lengths, one, other))


def _exchanged_lengths(one: str, other: str) -> Finding:
    return says(
        say(
            "{one} and {other} are exchanged: check which length each of them is.",
            one=one,
            other=other,
        ),
        say("Exchange {one} and {other}.", one=one, other=other),
    )


# --- Slips in the cells of the robot's table that lead to a wrong pose
#
# A slip has the same code here as in a cell of a submitted table (``table_cells.py``).


QUARTER = np.pi / 2


@dataclass(frozen=True, slots=True)
class Cell:
    """A cell of a table, and the words about it in messages."""

    table: ReferenceTable
    row: int
    column: int
    # True if the student chose other frames: the correct value of the cell may differ from table.
    own_frames: bool

    @property
    def label(self) -> str:
        """The label of the cell's row."""
        return self.table.labels[self.row]

    @property
    def axes(self) -> str:
        """The two axes between which the cell's angle is measured."""
        axis = "z" if self.column == ALPHA else "x"
        return axes_of_row(axis, self.label, self.table.joints[-1].index)

    @property
    def correction(self) -> str:
        """A sentence with the correct formula, or "" if the formula is unknown."""
        if self.own_frames:
            return ""
        return say(
            "{symbol} in row {row} is {formula}.",
            symbol=SYMBOLS[self.column],
            row=self.label,
            formula=self.table.rows[self.row][self.column].text(),
        )

    @property
    def parameter(self) -> Sentence:
        """The parameter in words, such as "the offset along the axis of joint 2"."""
        return _parameter(self.table, self.row, self.column)

    def name(self, names: Names) -> str:
        """Return the student's name for the cell's only constant, or a, α, d or θ."""
        letters = _letters(self.table, self.row, self.column)
        if len(letters) == 1 and not self.own_frames:
            return names.shown(min(letters)) or SYMBOLS[self.column]
        return SYMBOLS[self.column]


def table_slips(
    table: ReferenceTable,
    constants: Table,
    axis: Axis,
    *,
    home: bool = False,
    whole: bool = True,
) -> Iterator[Slip]:
    """Yield all slips in a table.

    ``constants`` ``(rows, 4, samples)`` is the table with all joint variables 0. With ``home``, the
    answer is for the home position, so that only constants can be wrong. With ``whole``, slips of
    whole rows and columns are yielded, too.
    """
    if not home:
        yield from joint_slips(table.joints, table.joints, axis)
        yield from home_slip(table.joints)
    for i in range(len(table.rows)):
        yield from row_slips(table, i, constants[i, :, 0].tolist(), axis, home=home)
    yield from length_slips(*lengths_of(table))
    if whole:
        rows = TableRows(constants[..., 0], table.joints, table.labels, table.convention, home)
        yield from slips_of_rows(rows)


def lengths_of(table: ReferenceTable) -> tuple[list[str], list[str]]:
    """Return all lengths of the table, and the lengths that occur only once, alone in a cell."""
    cells = [_letters(table, i, column) for i in range(len(table.rows)) for column in (A, D)]
    names = list(dict.fromkeys(name for cell in cells for name in sorted(cell)))
    once = [name for name in names if sum(name in cell for cell in cells) == 1]
    return names, [name for name in once if {name} in cells]


def row_slips(
    table: ReferenceTable,
    row: int,
    constants: Sequence[float],
    axis: Axis,
    *,
    own_frames: bool = False,
    home: bool = False,
) -> Iterator[Slip]:
    """Yield the slips in one row.

    ``constants`` are the cells of the row at one sample, with all joint variables 0. With
    ``own_frames``, the student chose other frames, so that they differ from the table. With
    ``home``, the answer is for the home position, so that no joint moves.
    """
    joint = table.joints[row] if row < len(table.joints) and not home else None
    for column in (A, ALPHA, D, THETA):
        cell, constant = Cell(table, row, column, own_frames), constants[column]
        moves = joint is not None and column == (D if joint.prismatic else THETA)
        if IS_ANGLE[column]:
            yield from _angle_slips(cell, constant, moves=moves)
        elif abs(constant) > CONSTANT:
            yield _sign(cell)
            yield _left_out(cell, DISTANCE_LEFT_OUT)
        if moves and joint is not None and abs(constant) > CONSTANT:
            yield joint_variable_sign(joint, axis, CellChange(row, column, -1.0))
            yield joint_variable_missing(joint, CellChange(row, column, 0.0))
    slides = joint is not None and joint.prismatic
    yield from exchanged_in_row(row, table.labels[row], constants, slides=slides)


def _angle_slips(cell: Cell, constant: float, *, moves: bool) -> Iterator[Slip]:
    quarters = constant / QUARTER
    is_multiple = abs(quarters - round(quarters)) < CONSTANT
    is_quarter = is_multiple and round(quarters) % 2 == 1
    if is_quarter or not is_multiple:
        yield _sign(cell)
    if not is_multiple:
        yield _left_out(cell, ANGLE_LEFT_OUT)
    # For a joint's angle, ``joint_slips`` has these slips.
    if not moves:
        yield _turned(cell, QUARTER_TURN, QUARTER)
        yield _turned(cell, QUARTER_TURN, -QUARTER)
        if not is_quarter:
            yield _turned(cell, HALF_TURN, np.pi)


def _sign(cell: Cell) -> Slip:
    def words(names: Names) -> SlipWords:
        name, axis = cell.name(names), AXES[cell.column]
        clause = say("{name}, {parameter}, has the wrong sign", name=name, parameter=cell.parameter)
        hint = say(
            "{name}, {parameter}, has the wrong sign: it is measured along {axis}, positive in the "
            "direction of the axis.",
            name=name,
            parameter=cell.parameter,
            axis=axis,
        )
        if IS_ANGLE[cell.column]:
            hint = say(
                "{name}, {parameter}, has the wrong sign: it is measured about {axis}, positive by "
                "the right-hand rule.",
                name=name,
                parameter=cell.parameter,
                axis=axis,
            )
        return SlipWords(clause, hint, cell.correction)

    return Slip(SIGN, words, cells=(CellChange(cell.row, cell.column, -1.0),))


def _left_out(cell: Cell, kind: Record) -> Slip:
    def words(names: Names) -> SlipWords:
        name = cell.name(names)
        clause = say("{name}, {parameter}, is left out", name=name, parameter=cell.parameter)
        hint = say(
            "{name}, {parameter}, is left out: check {link}.",
            name=name,
            parameter=cell.parameter,
            link=f"A{cell.label}",
        )
        return SlipWords(clause, hint, cell.correction)

    return Slip(kind, words, cells=(CellChange(cell.row, cell.column, 0.0),))


def _turned(cell: Cell, kind: Record, turn: float) -> Slip:
    def words(names: Names) -> SlipWords:
        name = cell.name(names)
        clause = say("{name}, {parameter}, is not right", name=name, parameter=cell.parameter)
        hint = say(
            "{name}, {parameter}, is not right: compare {axes} in the home position.",
            name=name,
            parameter=cell.parameter,
            axes=cell.axes,
        )
        error = say("It is off by a quarter turn (90°).")
        if kind is HALF_TURN:
            error = say("It is off by half a turn (180°).")
        return SlipWords(clause, hint, paragraph(cell.correction, error))

    return Slip(kind, words, cells=(CellChange(cell.row, cell.column, 1.0, turn),))


def _letters(table: ReferenceTable, row: int, column: int) -> frozenset[str]:
    variables = {joint.variable for joint in table.joints}
    return table.rows[row][column].symbols - variables


def _parameter(table: ReferenceTable, row: int, column: int) -> Sentence:
    joints = [joint.index for joint in table.joints]
    if row < len(joints) and column == D:
        return say("the offset along the axis of joint {joint}", joint=joints[row])
    if row < len(joints) and column == THETA:
        return say("the angle about the axis of joint {joint}", joint=joints[row])
    # The number of joints before the x axis along which a and α are measured.
    before = row + (table.convention is Convention.STANDARD)
    if column in (D, THETA) or before > len(joints):
        return say("the parameter in row {row}", row=table.labels[row])
    return _length(joints, before) if column == A else _twist(joints, before)


def _length(joints: Sequence[int], before: int) -> Sentence:
    if before == 0:
        return say(
            "the length between {axis} and the axis of joint {joint}",
            axis=f"z{joints[0] - 1}",
            joint=joints[0],
        )
    if before == len(joints):
        return say(
            "the length between the axis of joint {joint} and the last z axis", joint=joints[-1]
        )
    return say(
        "the length between the axes of joints {joint} and {next}",
        joint=joints[before - 1],
        next=joints[before],
    )


def _twist(joints: Sequence[int], before: int) -> Sentence:
    if before == 0:
        return say(
            "the twist between {axis} and the axis of joint {joint}",
            axis=f"z{joints[0] - 1}",
            joint=joints[0],
        )
    if before == len(joints):
        return say(
            "the twist between the axis of joint {joint} and the last z axis", joint=joints[-1]
        )
    return say(
        "the twist between the axes of joints {joint} and {next}",
        joint=joints[before - 1],
        next=joints[before],
    )


# --- Slips in whole rows and columns of the robot's table; they change numbers, but no symbols


@dataclass(frozen=True, slots=True)
class TableRows:
    """The rows of a wrong DH table; each possible mistake is tried on them."""

    # The cells (rows, 4) at one sample, with all joint variables 0.
    constants: Numbers
    # The joints of the first rows.
    joints: Sequence[Joint]
    # The labels of all rows.
    labels: Sequence[str]
    convention: Convention
    # True if the answer is for the home position, so that no joint moves.
    home: bool = False
    # True if the answer is the product of the links, False if it is the links themselves.
    multiplied: bool = True

    def moves(self, row: int, column: int) -> bool:
        """True if a cell contains a joint variable."""
        if self.home or row >= len(self.joints):
            return False
        return column == (D if self.joints[row].prismatic else THETA)


def slips_of_rows(rows: TableRows) -> Iterator[Slip]:
    """Yield the slips in whole rows and columns."""
    yield from exchanged_throughout(rows)
    yield from negated_columns(rows)
    yield from other_table(rows)
    yield from exchanged_rows(rows)
    yield from missing_links(rows) if rows.multiplied else other_formula(rows)


def exchanged_in_row(
    row: int, label: str, constants: Sequence[float], *, slides: bool
) -> Iterator[Slip]:
    """Yield the slips in which a and d are exchanged in one row.

    If the joint slides, the last slip also moves the joint variable from d to a.
    """

    def words(_: Names) -> SlipWords:
        return SlipWords(
            say("the length a and the offset d are exchanged in row {row}", row=label),
            say(
                "The length a and the offset d are exchanged in row {row}: a is measured along x, "
                "d along z.",
                row=label,
            ),
            say("Exchange a and d in row {row}.", row=label),
        )

    ways = [False] if abs(constants[A] - constants[D]) > CONSTANT else []
    for moving in [*ways, True] if slides else ways:
        yield Slip(COLUMNS_SWAPPED, words, cells=_exchanged_cells(row, moving=moving))


def exchanged_throughout(rows: TableRows) -> Iterator[Slip]:
    """Yield the slip in which a and d are exchanged in all rows."""

    def words(_: Names) -> SlipWords:
        return SlipWords(
            say("the lengths a and the offsets d are exchanged throughout"),
            say(
                "The lengths a and the offsets d are exchanged throughout: a is measured along x, "
                "d along z."
            ),
            say("Exchange a and d in every row."),
        )

    cells = tuple(cell for i in range(len(rows.constants)) for cell in _exchanged_cells(i))
    yield Slip(COLUMNS_SWAPPED, words, cells=cells)


def _exchanged_cells(row: int, *, moving: bool = False) -> tuple[CellChange, ...]:
    return (
        CellChange(row, A, source=(row, D), moving=moving),
        CellChange(row, D, source=(row, A), moving=moving),
    )


def negated_columns(rows: TableRows) -> Iterator[Slip]:
    """Yield the slips in which all signs of one column are wrong.

    The joint variables in the column have the wrong sign, too, or keep their signs.
    """
    for column in range(len(COLUMNS)):
        cells = rows.constants[:, column]
        sizes = np.sin(cells) if IS_ANGLE[column] else cells
        wrong = {i for i, size in enumerate(sizes.tolist()) if abs(size) > CONSTANT}
        moved = {i for i in range(len(cells)) if rows.moves(i, column)}
        # In one row alone it is a slip of the cell.
        if len(wrong) > 1:
            yield _negated(column, wrong, moving=False)
        if moved and len(wrong | moved) > 1:
            yield _negated(column, wrong | moved, moving=True)


def _negated(column: int, rows: Iterable[int], *, moving: bool) -> Slip:
    def words(_: Names) -> SlipWords:
        clause = say("{symbol} has the wrong sign throughout", symbol=SYMBOLS[column])
        return SlipWords(clause, wrong_throughout(column), change_every_sign(column))

    cells = tuple(CellChange(i, column, -1.0, moving=moving) for i in rows)
    return Slip(PARAMETER_SIGN, words, cells=cells)


def other_table(rows: TableRows) -> Iterator[Slip]:
    """Yield the slips in which the table was written in the other DH convention.

    Then a and α are in a neighbouring row.
    """
    last = len(rows.constants) - 1
    cells: list[CellChange] = []
    if rows.convention is Convention.STANDARD:
        moved = [(i + 1, i) for i in range(last)]
        cells = [cell for i, source in moved for cell in _of_link(i, source)]
        cells += [CellChange(0, column, 0.0) for column in (A, ALPHA)]
        if rows.multiplied and np.abs(rows.constants[last, : ALPHA + 1]).max() > CONSTANT:
            yield _other_table(rows.convention, (*cells, *_of_link(last + 1, last)))
    elif np.abs(rows.constants[0, : ALPHA + 1]).max() < CONSTANT:
        cells = [cell for i in range(last) for cell in _of_link(i, i + 1)]
        cells += [CellChange(last, column, 0.0) for column in (A, ALPHA)]
    if cells:
        yield _other_table(rows.convention, tuple(cells))


def _of_link(row: int, source: int) -> tuple[CellChange, ...]:
    return tuple(CellChange(row, column, source=(source, column)) for column in (A, ALPHA))


def _other_table(convention: Convention, cells: tuple[CellChange, ...]) -> Slip:
    is_standard = convention is Convention.STANDARD
    words = _modified_table_multiplied if is_standard else _standard_table_multiplied
    return Slip(OTHER_CONVENTION, words, cells=cells)


def _modified_table_multiplied(_: Names) -> SlipWords:
    return SlipWords(
        say(
            "a table of the modified convention is multiplied with the link transform of the "
            "standard one"
        ),
        say(
            "A table of the modified convention is multiplied with the link transform of the "
            "standard one: use the same convention for both."
        ),
        say("In the other convention a and α stand one row higher or lower."),
    )


def _standard_table_multiplied(_: Names) -> SlipWords:
    return SlipWords(
        say(
            "a table of the standard convention is multiplied with the link transform of the "
            "modified one"
        ),
        say(
            "A table of the standard convention is multiplied with the link transform of the "
            "modified one: use the same convention for both."
        ),
        say("In the other convention a and α stand one row higher or lower."),
    )


def other_formula(rows: TableRows) -> Iterator[Slip]:
    """Yield the slip in which the links are computed with the formula of the other convention."""
    has_twists = (np.cos(rows.constants[:, ALPHA]) < 1 - CONSTANT).any()
    if rows.convention is Convention.STANDARD and not has_twists:
        return
    is_standard = rows.convention is Convention.STANDARD
    words = _modified_formula if is_standard else _standard_formula
    yield Slip(OTHER_CONVENTION, words, misread=True)


def _modified_formula(_: Names) -> SlipWords:
    return SlipWords(
        say(
            "the link transform of the modified convention is used with a table of the standard one"
        ),
        say(
            "The link transform of the modified convention is used with a table of the standard "
            "one: use the same convention for both."
        ),
        say("Use the link transform of the standard convention."),
    )


def _standard_formula(_: Names) -> SlipWords:
    return SlipWords(
        say(
            "the link transform of the standard convention is used with a table of the modified one"
        ),
        say(
            "The link transform of the standard convention is used with a table of the modified "
            "one: use the same convention for both."
        ),
        say("Use the link transform of the modified convention."),
    )


def exchanged_rows(rows: TableRows) -> Iterator[Slip]:
    """Yield the slips in which two rows are exchanged, with or without their joint variables."""
    count = len(rows.constants)
    kinds = [joint.prismatic for joint in rows.joints]
    for i, j in combinations(range(count), 2):
        labels = rows.labels[i], rows.labels[j]
        # The reverse order of all links is a slip of the product.
        if not (rows.multiplied and i == 0 and j == count - 1 <= 2):
            words = partial(_rows_or_links, *labels)
            yield Slip(ROW_ORDER, words, cells=_rows_exchanged(i, j, moving=True))
        if j < len(kinds) and kinds[i] == kinds[j] and not rows.home:
            words = partial(_rows_but_variables, *labels)
            yield Slip(ROW_ORDER, words, cells=_rows_exchanged(i, j, moving=False))


def _rows_or_links(one: str, other: str, _: Names) -> SlipWords:
    return SlipWords(
        say(
            "rows {one} and {other}, or their link transforms, are exchanged", one=one, other=other
        ),
        say(
            "Rows {one} and {other}, or their link transforms, are exchanged: check which joint "
            "each row of the table belongs to.",
            one=one,
            other=other,
        ),
    )


def _rows_but_variables(one: str, other: str, _: Names) -> SlipWords:
    return SlipWords(
        say(
            "rows {one} and {other} are exchanged, but for their joint variables",
            one=one,
            other=other,
        ),
        say(
            "Rows {one} and {other} are exchanged, but for their joint variables: check which "
            "joint each row of the table belongs to.",
            one=one,
            other=other,
        ),
    )


def _rows_exchanged(one: int, other: int, *, moving: bool) -> tuple[CellChange, ...]:
    return tuple(
        CellChange(row, column, source=(source, column), moving=moving)
        for row, source in ((one, other), (other, one))
        for column in range(len(COLUMNS))
    )


def missing_links(rows: TableRows) -> Iterator[Slip]:
    """Yield the slips in which a row, neither the first nor the last, is missing in the product."""
    for row in range(1, len(rows.constants) - 1):
        cells = tuple(CellChange(row, column, 0.0, moving=True) for column in range(len(COLUMNS)))
        yield Slip(MISSING_LINK, partial(_missing_link, f"A{rows.labels[row]}"), cells=cells)


def _missing_link(link: str, _: Names) -> SlipWords:
    clause = say("{link} is missing in the product", link=link)
    return SlipWords(clause, clause)
