"""Grade random tables, valid or with slips, and count the results."""

import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import cycle

import numpy as np
from dh_grader.catalogue import Exercise
from dh_grader.grading import PartReport, Severity, Submission, Verdict, grade

from tests.frame_choice.edits import Edit, random_edit
from tests.frame_choice.generator import Table, reassignment
from tests.frame_choice.oracle import is_equivalent
from tests.frame_choice.repairs import can_repair, repairing_cells
from tests.frame_choice.robots import (
    ALPHA,
    COLUMNS,
    GIVEN,
    MODIFIED,
    POLICIES,
    A,
    Policy,
    Robot,
    conventions,
    exercise,
)

Place = tuple[int, int]
DRAWS = 60


@dataclass(frozen=True)
class Grading:
    """A graded table, and its cells that are marked wrong."""

    report: PartReport
    blamed: frozenset[Place]
    milliseconds: float

    @property
    def full_marks(self) -> bool:
        return bool(self.report.points == self.report.max_points)

    @property
    def is_clean(self) -> bool:
        """True if all cells are correct and no message is an error."""
        messages = [
            *self.report.feedback,
            *(message for row in self.report.rows for message in row.feedback),
            *(m for row in self.report.rows for cell in row.cells for m in cell.feedback),
        ]
        told_of_errors = any(message.severity is Severity.ERROR for message in messages)
        return bool(self.report.verdict is Verdict.CORRECT) and not told_of_errors

    @property
    def rows(self) -> set[int]:
        return {row for row, _ in self.blamed}


class CrashError(Exception):
    """The service raised an exception on a table."""

    def __init__(self, table: Table) -> None:
        super().__init__(str(table.texts))
        self.table = table


def grade_rows(compiled: Exercise, rows: list[list[str]], convention: str) -> PartReport:
    """Return the report on a table."""
    cells = [dict(zip(COLUMNS, row, strict=True)) for row in rows]
    answer = {"rows": cells, "convention": convention}
    return grade(compiled, Submission({"table": answer})).parts[0]


def graded(table: Table) -> Grading:
    compiled = exercise(table.robot, table.policy)
    rows = table.texts
    start = time.perf_counter()
    try:
        report = grade_rows(compiled, rows, table.convention)
    except Exception as error:
        raise CrashError(table) from error
    took = 1e3 * (time.perf_counter() - start)
    labels = [row.label for row in report.rows]
    if table.robot.labels(len(labels)) != labels:
        # The rows were read in another order, so no place can be compared.
        return Grading(report, frozenset({(-1, -1)}), took)
    blamed = frozenset(
        (i, COLUMNS.index(cell.label))
        for i, row in enumerate(report.rows)
        for cell in row.cells
        if cell.verdict is not Verdict.CORRECT
    )
    return Grading(report, blamed, took)


def equivalent(table: Table) -> bool:
    """True if the table is valid."""
    return is_equivalent(table.robot, table.policy, table.texts, table.convention)


def has_parallel_neighbour(table: Table, row: int, column: int) -> bool:
    """True if the axes next to a cell are parallel."""
    # a and α belong to the link between two axes: these two axes must be parallel. d and θ are
    # measured on one axis: the previous or the next axis must be parallel to this one.
    link = row if table.convention != MODIFIED or column in (A, ALPHA) else row + 1
    if column in (A, ALPHA):
        return _joins_parallel_axes(table, link)
    return _joins_parallel_axes(table, link) or (link > 0 and _joins_parallel_axes(table, link - 1))


def _joins_parallel_axes(table: Table, link: int) -> bool:
    # True if the α of this row is 0 or 180°.
    #
    # A row number beyond the table also counts as parallel.
    if link >= len(table.rows):
        return True
    if table.convention == MODIFIED and link == 0:
        return False  # it begins at the base frame, which is on no joint axis
    return bool(abs(np.sin(table.rows[link][ALPHA].constant)) < 1e-9)


@dataclass(frozen=True)
class Miss:
    """A table that was graded wrongly."""

    what: str
    table: Table
    edits: tuple[Edit, ...]
    blamed: frozenset[Place]
    note: str = ""

    @property
    def where(self) -> tuple[str, str, str]:
        return self.table.robot.name, self.table.convention, self.table.policy.name

    def __str__(self) -> str:
        places = [f"{row + 1} {COLUMNS[column]}" for row, column in sorted(self.blamed)]
        lines = [
            f"{self.what}: {', '.join(self.where)}{self.note}",
            *(f"  {edit}" for edit in self.edits),
            f"  blamed: {', '.join(places) or 'nothing'}",
            *(f"    {' | '.join(row)}" for row in self.table.texts),
        ]
        return "\n".join(lines)


@dataclass
class Tally:
    """Counts of graded tables, grading times, and wrongly graded tables."""

    counts: Counter[str] = field(default_factory=Counter)
    right_ms: list[float] = field(default_factory=list)
    wrong_ms: list[float] = field(default_factory=list)
    misses: list[Miss] = field(default_factory=list)
    kinds: Counter[tuple[str, str, bool]] = field(default_factory=Counter)
    policies: Counter[tuple[str, str]] = field(default_factory=Counter)
    explain: bool = True

    def add(self, other: "Tally") -> None:
        self.counts += other.counts
        self.right_ms += other.right_ms
        self.wrong_ms += other.wrong_ms
        self.misses += other.misses
        self.kinds += other.kinds
        self.policies += other.policies

    def share(self, name: str, of: str) -> float:
        return self.counts[name] / self.counts[of] if self.counts[of] else 1.0


def policies(only_given: bool) -> Iterator[Policy]:
    return cycle([GIVEN] if only_given else POLICIES[1:])


def run(
    robot: Robot,
    convention: str,
    only_given: bool,
    tables: int,
    rng: np.random.Generator,
    *,
    slips: int | None = None,
    explain: bool = True,
) -> Tally:
    """Grade random valid tables of a robot, some of them again with slips."""
    # `slips` is the number of tables that are also graded with slips; None means all. If `explain`
    # is True, check whether new values in the cells that are marked wrong could repair the table.
    # This takes long.
    tally = Tally(explain=explain)
    in_turn = policies(only_given)
    for i in range(tables):
        policy = next(in_turn)
        while convention not in conventions(robot, policy):
            policy = next(in_turn)
        table, _ = reassignment(robot, policy, convention, rng)
        if not equivalent(table):
            raise AssertionError(f"the generator drew a table that is not valid: {table.texts}")
        attempts = (_try_whole, _try_one_slip, _try_two_slips)
        for attempt in attempts[: 3 if slips is None or i < slips else 1]:
            try:
                attempt(table, tally, rng)
            except CrashError as error:
                tally.counts["crashed"] += 1
                cause = error.__cause__
                tally.misses.append(Miss("crash", error.table, (), frozenset(), f"; {cause!r}"))
    return tally


def _try_whole(table: Table, tally: Tally, _: np.random.Generator) -> None:
    # Counted before grading: a table that raises an exception is not accepted.
    tally.counts["valid"] += 1
    tally.policies[table.policy.name, "valid"] += 1
    found = graded(table)
    tally.right_ms.append(found.milliseconds)
    if found.full_marks and found.is_clean:
        tally.counts["valid accepted"] += 1
        tally.policies[table.policy.name, "valid accepted"] += 1
    else:
        tally.misses.append(Miss("valid, not accepted", table, (), found.blamed))


def one_slip(table: Table, rng: np.random.Generator, not_in_row: int | None = None) -> Edit | None:
    """Return a random slip that makes the table wrong, or None."""
    for _ in range(DRAWS):
        edit = random_edit(table, rng, not_in_row)
        if not equivalent(table.edited(edit.row, edit.column, edit.cell)):
            return edit
    return None


def _try_one_slip(table: Table, tally: Tally, rng: np.random.Generator) -> None:
    edit = one_slip(table, rng)
    if edit is None:
        return
    wrong = table.edited(edit.row, edit.column, edit.cell)
    place = (edit.row, edit.column)
    group = "parallel" if has_parallel_neighbour(table, *place) else "skew"
    tally.counts["slip"] += 1
    tally.counts[group] += 1
    tally.policies[table.policy.name, "slip"] += 1
    found = graded(wrong)
    exact = found.blamed == {place}
    one_row = len(found.rows) == 1 and min(found.rows) >= 0
    tally.wrong_ms.append(found.milliseconds)
    tally.counts["slip caught"] += not found.full_marks
    tally.policies[table.policy.name, "slip caught"] += not found.full_marks
    tally.counts[f"{group} exact"] += exact
    tally.counts[f"{group} one row"] += one_row
    if found.full_marks:
        tally.misses.append(Miss("wrong, full marks", wrong, (edit,), found.blamed))
    if table.policy == GIVEN:
        repairs = repairing_cells(table.robot, wrong.texts, table.convention)
        if place not in repairs:
            raise AssertionError(f"the oracle does not see that {edit} repairs {table.texts}")
        if len(repairs) == 1:
            tally.counts[f"{group} unshared"] += 1
            tally.counts[f"{group} unshared exact"] += exact
    as_good = exact or (tally.explain and is_repaired(wrong, found.blamed, at_most=1))
    tally.counts["as good"] += as_good
    tally.kinds[group, edit.kind, exact] += 1
    if not exact:
        how = "shared" if as_good else "worse" if tally.explain else "missed"
        tally.misses.append(Miss(f"one slip, {group}, {how}", wrong, (edit,), found.blamed))


def is_repaired(table: Table, blamed: frozenset[Place], at_most: int) -> bool:
    # True if at most `at_most` cells are marked wrong, and new values there repair the table.
    if not 0 < len(blamed) <= at_most or any(
        row < 0 or row >= len(table.rows) for row, _ in blamed
    ):
        return False
    return can_repair(table.robot, table.policy, table.texts, table.convention, sorted(blamed))


def _is_unshared(table: Table, edit: Edit) -> bool:
    # True if no change of another single cell would make the table valid.
    wrong = table.edited(edit.row, edit.column, edit.cell)
    return len(repairing_cells(table.robot, wrong.texts, table.convention)) == 1


def _try_two_slips(table: Table, tally: Tally, rng: np.random.Generator) -> None:
    one = one_slip(table, rng)
    other = one_slip(table, rng, one.row) if one else None
    if one is None or other is None:
        return
    wrong = table.edited(one.row, one.column, one.cell)
    wrong = wrong.edited(other.row, other.column, other.cell)
    if equivalent(wrong):
        return
    if table.policy == GIVEN and repairing_cells(table.robot, wrong.texts, table.convention):
        return  # not independent: one cell alone repairs both
    tally.counts["two slips"] += 1
    found = graded(wrong)
    tally.wrong_ms.append(found.milliseconds)
    tally.counts["two caught"] += not found.full_marks
    both = {one.row, other.row} <= found.rows
    if table.policy == GIVEN and all(_is_unshared(table, edit) for edit in (one, other)):
        tally.counts["two unshared"] += 1
        tally.counts["two unshared found"] += both
    as_good = both or (tally.explain and is_repaired(wrong, found.blamed, at_most=2))
    tally.counts["two found"] += both
    tally.counts["two as good"] += as_good
    if not both:
        how = "shared" if as_good else "worse" if tally.explain else "missed"
        tally.misses.append(Miss(f"two slips, {how}", wrong, (one, other), found.blamed))
