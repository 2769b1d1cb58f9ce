"""Slips in a whole table.

A slip explains a wrong table if the table describes the robot once the slip is corrected.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain, combinations, islice

import numpy as np
from numpy.typing import NDArray

from dh_grader.catalogue.kinds import DhTableSpec
from dh_grader.expressions import Symbol
from dh_grader.grading.frames.nearest import frames_from_reference, in_convention
from dh_grader.grading.frames.rows import (
    RepairedTable,
    Rereadable,
    Role,
    WrittenTable,
    freedom_of,
    reference_values,
    valid_tables,
    written_table,
)
from dh_grader.grading.grading import Grading
from dh_grader.grading.judging_table import Judgement, departures_of, judged_by_intended
from dh_grader.grading.misconception import (
    SYMBOLS,
    AnyHypothesis,
    Explained,
    Record,
    Repaired,
    change_every_sign,
    each_hypothesis,
    misconception,
    records_of,
    says,
    wrong_throughout,
)
from dh_grader.grading.numbers import INTENDED_CELL, INTENDED_POSE, Match, difference
from dh_grader.grading.reading.table import IS_ANGLE, table_values, values_of
from dh_grader.grading.report import Finding
from dh_grader.kinematics import ALPHA, COLUMNS, THETA, A, Convention, D, Numbers, Table
from dh_grader.translations import listed, paragraph, say, template

_OF_LINK = slice(A, ALPHA + 1)


@dataclass(frozen=True, slots=True)
class WrongTable:
    """A wrong table."""

    # The table at all samples.
    written: WrittenTable
    # The table at a few samples, which make comparisons fast.
    subset: WrittenTable
    # Takes tables (T, rows, 4, samples) at these few samples, and returns a mask (T,) of the tables
    # that describe the robot.
    valid: Callable[[Table, Convention], NDArray[np.bool_]]

    def explained_by(self, hypotheses: Iterable[AnyHypothesis]) -> list[AnyHypothesis]:
        """Return the hypotheses (possible mistakes) that explain the table."""
        # The hypotheses must be tables at the few samples; all are compared at once.
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
    for columns in (_OF_LINK, slice(A, A + 1), slice(ALPHA, ALPHA + 1)):
        for late, order, end in ((True, up, -1), (False, down, 0)):
            of_other = late == (table.convention is Convention.STANDARD)
            other = table.convention.other if of_other and columns == _OF_LINK else None
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
    # other is the convention in which the columns are in the correct place, or None.
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
    """One column has the wrong sign in all rows."""
    # With or without its joint variables.
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
    """Two columns are exchanged: a with d, or α with θ."""
    # The exchange is in all rows or in one, with or without the joint variables.
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
    """Return the finding that two columns are exchanged."""
    # In all rows or in one row.
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
    """Two rows are exchanged, or the rows are in reverse order."""
    # The last row may keep its place.
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


def _with_another(
    basic: Record, others: Sequence[Record], table: WrittenTable
) -> Iterator[Explained]:
    for first in each_hypothesis((basic,), table):
        for second in each_hypothesis(others, first.answer):
            yield Repaired(second.answer, partial(_both, first, second), record=second.record)


def _both(first: Explained, second: Explained) -> tuple[Finding, ...]:
    return (*first.findings, *second.findings)


def explaining(case: WrongTable, *, combine: bool) -> list[Explained]:
    """Return all misconceptions that explain the whole table."""
    # If there are none, and combine is true, return the first pair of misconceptions that explains
    # the table together.
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


# The findings on a wrong table as a whole.


_OF_UNIT = frozenset({"degrees_as_radians", "radians_as_degrees"})

# If more lengths are in wrong cells, the search for two exchanged ones is not reliable.
MAX_LENGTHS = 4

# Samples of each half that are enough to compare dozens of tables.
TABLE_SAMPLES = 3


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

    Pairs of misconceptions are tried only if ``combine`` is true.
    """
    # Misconceptions that would make the whole table correct are compared with the cells that were
    # found wrong. If none of them fits, there are no findings and the judgement is unchanged.
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


def _is_other_convention(intended: _Intended, judgement: Judgement) -> bool:
    codes = [finding.code for finding in intended.findings]
    return codes == ["other_convention"] and intended.departures <= judgement.departures


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
