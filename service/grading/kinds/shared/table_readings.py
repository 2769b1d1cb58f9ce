"""Interpret a wrong table in several ways, called readings, and take the best one.

For example, one reading assumes that the columns are in a different order.
"""

# The first reading is the table as written.

# Others are the table with other joint numbers, with its columns in another order, with its lengths
# in another unit, or with a and d of one row exchanged. All readings are judged in the same way. A
# reading counts if it explains enough wrong cells. Three more readings only limit the points: the
# table without its extra rows; the table with each unread cell replaced by its joint variable or 0;
# and the table with one row given up (``fair_points``).

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple, TypeAlias

import numpy as np

from service.catalogue.parts.dh_table import DhTableSpec
from service.grading.diagnosis.tables.column_order import in_other_orders
from service.grading.diagnosis.tables.intended_table import IntendedTable, with_exchanged_row
from service.grading.diagnosis.tables.joint_numbering import by_other_numbering
from service.grading.diagnosis.tables.length_unit import in_other_length_unit
from service.grading.judging.marking.fair_points import FairPoints
from service.grading.judging.marking.marks import steps_lost
from service.grading.judging.own_frames.best_roles import rows_of_mechanism, usual_rows
from service.grading.judging.own_frames.remarks import OWN_FRAME_CHOICE
from service.grading.judging.own_frames.row_roles import FrameFreedom, freedom_of
from service.grading.judging.row_places import EXTRA_ROW, extra_row, row_too_many
from service.grading.judging.table_filled import with_lazy_cells, written_content
from service.grading.part import Grading, Judged
from service.grading.reading.tables.table import StudentTable
from service.grading.report import CellReport, Place, RowReport, Verdict, row_report
from service.grading.work_budget import WorkBudget
from service.kinematics.chain import COLUMNS
from service.kinematics.dh import Convention

# The share of the points that a slip of the whole table costs, regardless of the number of cells.
COST = 0.25
# The work of judging a wrong table once: with given frames, with free ones (more for each row), and
# with a free base or tool or free directions too.
GIVEN_WORK, FREE_WORK, FREE_ROW_WORK, ALL_FREE_WORK = 18.0, 20.0, 4.0, 60.0


class JudgedTable(NamedTuple):
    """The judgement of a table, and the convention in which it was judged."""

    judged: Judged
    convention: Convention


# A function that judges one reading of a table.
Judge: TypeAlias = Callable[[DhTableSpec, StudentTable, Grading], JudgedTable]


class _Reading(NamedTuple):
    # The reading counts if at most ``most_wrong`` of its cells are wrong; if ``most_wrong`` is
    # None, it always counts. With ``has_links``, a later part follows from this reading instead of
    # from the table as written.
    intended: IntendedTable
    most_wrong: int | None
    has_links: bool = False


def best_reading(
    part: DhTableSpec, table: StudentTable, first: JudgedTable, judge: Judge, grading: Grading
) -> Judged:
    """Return the judgement of a wrong table in its best interpretation.

    ``first`` is the judgement of the table as written.
    """
    # The points are limited.
    work = search_work(part, table, grading)
    readings = _Readings(part, judge, work, grading)
    written = readings.limited(table, first)
    # A table with unread cells has already been charged.
    if not np.isnan(table.values).any():
        grading.reader.budget.charge_search(work)
    best = readings.best(table, written)

    def judged_again(other: StudentTable) -> Judged:
        silent = readings.in_silence()
        return silent.best(other, silent.as_written(other))

    judged_once = _once(judged_again, grading.reader.budget)
    fair = FairPoints(part, judged_once, work, grading).limited(table, best)
    return replace(fair, written=written_content(table, fair.content.given, grading))


def _once(
    judge: Callable[[StudentTable], Judged], budget: WorkBudget
) -> Callable[[StudentTable], Judged]:
    """Return ``judge``, which does not judge the same table again.

    A table whose judgement was charged is judged again, so that the budget stays the same.
    """
    # The tables are kept, so that no other object gets the id of an entry.
    known: dict[object, tuple[StudentTable, Judged]] = {}

    def judged(table: StudentTable) -> Judged:
        entries = tuple(id(entry) for row in table.rows for entry in row.entries)
        written = tuple(row.handed_in.tobytes() for row in table.rows)
        key = entries, written, table.values.tobytes(), table.convention
        if key not in known:
            left = budget.searches, budget.explanations
            found = judge(table)
            if (budget.searches, budget.explanations) != left:
                return found
            known[key] = table, found
        return known[key][1]

    return judged


def search_work(part: DhTableSpec, table: StudentTable, grading: Grading) -> float:
    """Return the amount of computation for judging a wrong table once."""
    rows = len(table.rows)
    once = FREE_WORK + FREE_ROW_WORK * rows
    if part.frames == "given":
        once = GIVEN_WORK
    elif freedom_of(part) != FrameFreedom():
        once = ALL_FREE_WORK
    convention = table.convention if part.convention == "either" else part.convention
    ways = 2 if convention is None else 1
    has_rows_too_many = rows > usual_rows(convention or grading.exercise.robot.convention, grading)
    has_unread_cells = np.isnan(table.values).any()
    return once * (ways + int(has_rows_too_many) + int(has_unread_cells))


@dataclass(frozen=True, slots=True)
class _Readings:
    # ``work`` is the work of judging one table.
    part: DhTableSpec
    judge: Judge
    work: float
    grading: Grading

    def in_silence(self) -> "_Readings":
        return replace(self, grading=replace(self.grading, explains=False))

    def as_written(self, table: StudentTable) -> Judged:
        return self.limited(table, self.judge(self.part, table, self.grading))

    def best(self, table: StudentTable, judged: Judged) -> Judged:
        """Return the judgement of the best reading.

        ``judged`` is the judgement of the table as written.
        """
        chosen: tuple[_Reading, Judged] | None = None
        for reading in self._others(table, judged):
            # Several orders of the columns may fit, but the other readings are alternatives.
            if chosen is not None and not reading.has_links:
                break
            is_certain = reading.most_wrong is None
            if not is_certain and not self.grading.reader.budget.affords_search(self.work):
                break
            without = self.as_written(reading.intended.table)
            if reading.most_wrong is None or without.count_wrong <= reading.most_wrong:
                if chosen is None or without.count_wrong < chosen[1].count_wrong:
                    chosen = reading, without
                if without.is_right:
                    break
        if chosen is None:
            return judged
        reading, without = chosen
        found = _with_slip(reading.intended, without, judged, self.grading)
        if steps_lost(self.part, found) > steps_lost(self.part, judged):
            found = replace(found, at_least=judged)
        return replace(found, chain=without.chain) if reading.has_links else found

    def _others(self, table: StudentTable, judged: Judged) -> Iterator[_Reading]:
        # The readings that explain most come first.
        if (renumbered := by_other_numbering(table, self.grading)) is not None:
            yield _Reading(renumbered, None)
            return
        if judged.whole_cost is not None:
            return
        wrong = judged.count_wrong
        # An unread cell is not read in any order.
        if 3 * np.count_nonzero(np.isnan(table.values).any(axis=-1)) <= wrong:
            for reordered in in_other_orders(table, self.grading):
                # A student with columns in another order still multiplies out the intended links.
                yield _Reading(reordered, wrong // 3, has_links=True)
        if wrong > 1:
            convention = self.part.convention
            named = table.convention if convention == "either" else convention
            if (converted := in_other_length_unit(table, named, self.grading)) is not None:
                yield _Reading(converted, wrong // 2)
            if (exchanged := with_exchanged_row(table, named, self.grading)) is not None:
                yield _Reading(exchanged, wrong - 1)

    def limited(self, table: StudentTable, first: JudgedTable) -> Judged:
        # A wrong table earns no more than it would without its extra rows, because the points
        # belong to the rows of the mechanism. A table with unread cells, whose right values are
        # unknown, earns no more than if each of these cells contained its joint variable or 0.
        judged, convention = first
        if judged.is_right:
            return judged
        fixed = replace(table, convention=convention)
        kept = rows_of_mechanism(table.rows, convention, self.grading)
        if len(kept) < len(table.rows):
            rows = tuple(table.rows[i] for i in kept)
            without = self.as_written(replace(fixed, rows=rows, values=table.values[kept]))
            return _with_extra_rows(fixed, kept, judged, without, self.grading)
        unread = np.isnan(table.values).any(axis=-1)
        # A table without any readable cell earns nothing anyway.
        if unread.any() and not unread.all():
            filled = with_lazy_cells(fixed, convention, self.grading)
            return replace(judged, at_most=self.in_silence().as_written(filled))
        return judged


def _with_slip(
    intended: IntendedTable, without: Judged, judged: Judged, grading: Grading
) -> Judged:
    # ``without`` is the judgement of the table without the mistake, ``judged`` that of the table as
    # written. The cells with the mistake are wrong; together they cost as much as a mistake in the
    # whole table.
    rows = tuple(
        row_report(
            row.label,
            tuple(
                replace(cell, verdict=Verdict.INCORRECT)
                if (i, j) in intended.cells and cell.verdict is Verdict.CORRECT
                else cell
                for j, cell in enumerate(row.cells)
            ),
            row.feedback,
        )
        for i, row in enumerate(without.rows)
    )
    places = tuple(
        Place(rows[i].label, COLUMNS[column])
        for i, column in sorted(intended.cells)
        if i < len(rows)
    )
    return replace(
        without,
        rows=rows,
        feedback=(*grading.messages((intended.finding,), places), *without.feedback),
        whole_cost=COST,
        beside=without,
        lost=judged.lost,
        chain=judged.chain,
    )


def _with_extra_rows(
    table: StudentTable, kept: list[int], judged: Judged, without: Judged, grading: Grading
) -> Judged:
    # ``kept`` are the indices of the mechanism's rows; ``without`` is the judgement of only these
    # rows.
    extra = [i for i, row in enumerate(table.rows) if i not in kept and not row.is_zero]
    is_at_end = kept == list(range(len(kept)))
    if extra and is_at_end and without.is_right and not np.isnan(table.values[extra]).any():
        # Nothing but the rows at the end is wrong.
        messages = grading.messages(tuple(map(extra_row, extra)))
        feedback = (*without.feedback, *messages)
        return replace(without, feedback=feedback, slips=len(extra), chain=judged.chain)
    is_told = any(message.code in EXTRA_ROW.codes for message in judged.feedback)
    of_mechanism = {row.label for row in without.rows}
    beside = [row for row in judged.rows if row.label not in of_mechanism]
    wrong = [row for row in beside if row.verdict is not Verdict.CORRECT]
    # The student's frames may need the rows: then these are right, and another row is wrong.
    is_right = len(beside) == len(table.rows) - len(kept) and not (wrong or judged.slips)
    needs_all = bool(extra) and is_right
    # If nothing that was read is wrong, the table may be right.
    tells = judged.is_wrong and not is_told and not needs_all
    messages = grading.messages(tuple(map(row_too_many, extra))) if tells else ()
    return replace(
        judged,
        rows=_explained_without(judged.rows, without.rows),
        feedback=(*(m for m in judged.feedback if m.code != OWN_FRAME_CHOICE), *messages),
        slips=judged.slips + len(wrong),
        at_most=without,
        needs_all=needs_all,
    )


def _explained_without(
    rows: tuple[RowReport, ...], without: tuple[RowReport, ...]
) -> tuple[RowReport, ...]:
    # ``without`` are the rows of the report on the table without its extra rows. Messages on cells
    # that are wrong only because of an extra row are left out.
    right = {
        (row.label, cell.label): cell
        for row in without
        for cell in row.cells
        if cell.verdict is Verdict.CORRECT
    }
    labels = {row.label for row in without}

    def silent(row: RowReport, cell: CellReport) -> CellReport:
        if cell.verdict is not Verdict.INCORRECT:
            return cell
        if row.label not in labels:
            return replace(cell, feedback=())
        found = right.get((row.label, cell.label))
        return cell if found is None else replace(cell, feedback=found.feedback)

    return tuple(
        row_report(row.label, tuple(silent(row, cell) for cell in row.cells), row.feedback)
        for row in rows
    )
