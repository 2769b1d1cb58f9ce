"""Answer kind ``dh_table``: a Denavit-Hartenberg table of the exercise's robot."""

from dataclasses import replace

import numpy as np

from service.catalogue.parts.dh_table import DhTableSpec
from service.grading.diagnosis.tables.column_order import in_other_orders
from service.grading.diagnosis.tables.intended_table import IntendedTable, with_exchanged_row
from service.grading.diagnosis.tables.joint_numbering import by_other_numbering
from service.grading.diagnosis.tables.table_cell import diagnose_cells, wrong_cells
from service.grading.diagnosis.tables.table_explained import explained, freedom_lost
from service.grading.feedback import Finding
from service.grading.follow_through import stands_still
from service.grading.judging.convention import judged_in_convention
from service.grading.judging.marking.fair_points import with_fair_points
from service.grading.judging.own_frames.best_roles import (
    roles_in,
    rows_of_mechanism,
    usual_rows,
)
from service.grading.judging.own_frames.remarks import OWN_FRAME_CHOICE
from service.grading.judging.own_frames.row_roles import FrameFreedom, freedom_of
from service.grading.judging.report_rows import (
    Slips,
    cell_report,
    is_right_throughout,
    right_row,
)
from service.grading.judging.row_places import (
    EXTRA_ROW,
    extra_row,
    missing_row,
    row_places,
    row_too_many,
)
from service.grading.judging.table import JudgedRow, Judgement
from service.grading.judging.table_content import table_content
from service.grading.judging.table_filled import with_lazy_cells, with_zeros
from service.grading.kinds.shared.given_rows import with_given_rows
from service.grading.numerics.comparison import Match
from service.grading.numerics.samples import Samples
from service.grading.part import Grading, Judged, StudentChain
from service.grading.reading.tables.column_headers import QUANTITIES
from service.grading.reading.tables.table import (
    StudentRow,
    StudentTable,
    read_table,
    without_empty_end,
)
from service.grading.report import (
    CellReport,
    Place,
    RowReport,
    Verdict,
    row_report,
)
from service.kinematics.chain import COLUMNS, D, frames, links
from service.kinematics.dh import Convention
from service.kinematics.transforms import Matrices

# The share of the points that a slip of the whole table costs, regardless of the number of cells.
COST = 0.25
COSTS = {"other_convention": 0.5}
_QUANTITIES = tuple(QUANTITIES.values())
# The budgeted work of finding a motion that the student's arm cannot make.
FREEDOM_WORK = 8.0
# The work of judging a wrong table once: with given frames, with free ones (more for each row), and
# with a free base or tool or free directions too.
GIVEN_WORK, FREE_WORK, FREE_ROW_WORK, ALL_FREE_WORK = 18.0, 20.0, 4.0, 60.0
# The number of wrong cells from which two simultaneous misconceptions are searched.
WRONG_THROUGHOUT = 3


def read(part: DhTableSpec, answer: object, grading: Grading) -> StudentTable | None:
    """Read the rows of a table; return None if there are none."""
    empty_is_zero = part.empty_cells == "zero"
    table = read_table(answer, grading.reader, empty_is_zero=empty_is_zero)
    table = without_empty_end(table, len(grading.exercise.robot.joints))
    return with_given_rows(part, table, grading) if table.rows else None


def judge(part: DhTableSpec, answer: StudentTable, grading: Grading) -> Judged:
    """Judge the table row by row and cell by cell.

    If all joints are numbered differently, or the columns are in another order, the intended table
    is judged.
    """
    budget = grading.reader.budget
    has_unread_cells = bool(np.isnan(answer.values).any())
    work = _search_work(part, answer, grading)
    # Values for unread cells are looked for with what the judging itself leaves.
    if has_unread_cells:
        budget.charge_search(work)
    judged = _judged_as_read(part, answer, grading)
    if judged.is_right:
        return judged
    if not has_unread_cells:
        budget.charge_search(work)
    judged = _as_intended(part, answer, judged, work, grading)

    def judged_again(table: StudentTable) -> Judged:
        """Judge a table with numbers that are wrong in any frames; only its points count."""
        in_silence = replace(grading, explains=False)
        again = _judged_as_read(part, table, in_silence)
        return _as_intended(part, table, again, work, in_silence)

    return with_fair_points(part, answer, judged, judged_again, work, grading)


def _as_intended(
    part: DhTableSpec, answer: StudentTable, judged: Judged, work: float, grading: Grading
) -> Judged:
    """Judge a wrong table again if one systematic slip explains it.

    ``judged`` is the judgement of the table as read; ``work`` is that of judging it once more.
    """
    budget = grading.reader.budget
    if (intended := by_other_numbering(answer, grading)) is not None:
        without = _judged_as_read(part, intended.table, grading)
        return _with_slip(intended, without, judged, grading)
    if judged.whole_cost is not None:
        return judged
    wrong = _count_wrong(judged)
    unread = int(np.isnan(answer.values).any(axis=-1).sum())
    # What was not read is not read in any order.
    for intended in in_other_orders(answer, grading) if 3 * unread <= wrong else ():
        if not budget.affords_search(work):
            return judged
        without = _judged_as_read(part, intended.table, grading)
        if 3 * _count_wrong(without) <= wrong:
            # A student with columns in another order still multiplies out the intended links.
            return replace(_with_slip(intended, without, judged, grading), chain=without.chain)
    if wrong <= 1:
        return judged
    convention = part.convention if part.convention != "either" else answer.convention
    exchanged = with_exchanged_row(answer, convention, grading)
    if exchanged is not None and budget.affords_search(work):
        without = _judged_as_read(part, exchanged.table, grading)
        if _count_wrong(without) < wrong:
            return _with_slip(exchanged, without, judged, grading)
    return judged


def _search_work(part: DhTableSpec, answer: StudentTable, grading: Grading) -> float:
    """Return the work of judging a wrong table once, as written or as intended."""
    rows = len(answer.rows)
    once = FREE_WORK + FREE_ROW_WORK * rows
    if part.frames == "given":
        once = GIVEN_WORK
    elif freedom_of(part) != FrameFreedom():
        once = ALL_FREE_WORK
    convention = answer.convention if part.convention == "either" else part.convention
    ways = 2 if convention is None else 1
    has_rows_too_many = rows > usual_rows(convention or grading.exercise.robot.convention, grading)
    has_unread_cells = np.isnan(answer.values).any()
    return once * (ways + int(has_rows_too_many) + int(has_unread_cells))


def _count_wrong(judged: Judged) -> int:
    return sum(cell.verdict is not Verdict.CORRECT for row in judged.rows for cell in row.cells)


def _with_slip(
    intended: IntendedTable, without: Judged, judged: Judged, grading: Grading
) -> Judged:
    """Return the judgement of a table with a systematic slip.

    ``without`` judges the table without the slip, ``judged`` as read. The cells of the slip are
    wrong, and together cost as much as a slip of the whole table.
    """
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


def _judged_as_read(part: DhTableSpec, answer: StudentTable, grading: Grading) -> Judged:
    """Judge the table as read, without other numberings or column orders.

    A wrong table earns no more than it would without its extra rows, because the points belong to
    the rows of the mechanism. It earns no more than with lazy entries in its unread cells, whose
    right values are unknown.
    """
    convention, first, findings = judged_in_convention(part, answer, grading)
    judged = _judged(part, answer, convention, first, findings, grading)
    if judged.is_right:
        return judged
    fixed = replace(answer, convention=convention)
    kept = rows_of_mechanism(answer.rows, convention, grading)
    if len(kept) < len(answer.rows):
        return _with_extra_rows(part, fixed, kept, judged, grading)
    unread = np.isnan(answer.values).any(axis=-1)
    # A table without any readable cell earns nothing anyway.
    if unread.any() and not unread.all():
        filled = with_lazy_cells(fixed, convention, grading)
        in_silence = replace(grading, explains=False)
        return replace(judged, at_most=_judged_as_read(part, filled, in_silence))
    return judged


def _with_extra_rows(
    part: DhTableSpec, answer: StudentTable, kept: list[int], judged: Judged, grading: Grading
) -> Judged:
    """Judge a wrong table with extra rows; ``kept`` are the indices of the mechanism's rows."""
    rows = tuple(answer.rows[i] for i in kept)
    without = _judged_as_read(part, replace(answer, rows=rows, values=answer.values[kept]), grading)
    extra = [i for i, row in enumerate(answer.rows) if i not in kept and not row.is_zero]
    is_told = any(message.code in EXTRA_ROW.codes for message in judged.feedback)
    # If nothing that was read is wrong, the table may be right.
    tells = judged.is_wrong and not is_told
    messages = grading.messages(tuple(map(row_too_many, extra))) if tells else ()
    of_mechanism = {row.label for row in without.rows}
    beside = [row for row in judged.rows if row.label not in of_mechanism]
    wrong = [row for row in beside if row.verdict is not Verdict.CORRECT]
    return replace(
        judged,
        rows=_explained_without(judged.rows, without.rows),
        feedback=(*(m for m in judged.feedback if m.code != OWN_FRAME_CHOICE), *messages),
        slips=judged.slips + len(wrong),
        at_most=without,
    )


def _explained_without(
    rows: tuple[RowReport, ...], without: tuple[RowReport, ...]
) -> tuple[RowReport, ...]:
    """Return the rows without messages on cells that are wrong only because of an extra row.

    ``without`` are the rows of the report on the table without its extra rows.
    """
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


def _judged(
    part: DhTableSpec,
    answer: StudentTable,
    convention: Convention,
    first: Judgement,
    findings: tuple[Finding, ...],
    grading: Grading,
) -> Judged:
    judgement, found, lost = _of_the_whole(part, answer.rows, first, convention, grading)
    cases = wrong_cells(judgement, grading) if judgement.wrong else {}
    # A slip of the whole table gets one message; its cells contribute only the corrections.
    slips = diagnose_cells(cases, judgement) if cases and not found else {}
    places = tuple(
        Place(judgement.rows[i].label, COLUMNS[column], case.correction)
        for (i, column), case in cases.items()
    )
    messages = (
        *grading.messages((*answer.findings, *findings)),
        *grading.messages(found, places),
        *grading.messages((*lost, *judgement.findings)),
    )
    missing = tuple(
        message
        for judged in judgement.rows
        if judged.row is None and not found
        for message in grading.messages((missing_row(judged),), (Place(judged.label),))
    )
    extra = grading.messages(tuple(extra_row(i) for i in judgement.extra))
    row_messages = grading.messages(row_places(answer, judgement, convention, grading))
    return Judged(
        _row_reports(judgement, grading, slips),
        table_content(part, judgement, convention, grading),
        (*messages, *missing, *extra, *row_messages),
        slips=judgement.slips,
        whole_cost=_cost_of(found) if found else None,
        stands_still=judgement.wrong > 0 and stands_still(with_zeros(answer), _QUANTITIES, grading),
        lost=first.lost,
        chain=lambda: _chain(answer, first, convention),
    )


def _of_the_whole(
    part: DhTableSpec,
    rows: tuple[StudentRow, ...],
    judgement: Judgement,
    convention: Convention,
    grading: Grading,
) -> tuple[Judgement, tuple[Finding, ...], tuple[Finding, ...]]:
    """Explain a wrong table as a whole, or find the motion that its arm cannot make.

    Return the judgement that fits the explanation, the explanation, and the lost motion.
    """
    if not judgement.wrong:
        return judgement, (), ()
    roles = judgement.roles or roles_in(rows, convention, grading)
    found: tuple[Finding, ...] = ()
    # No slip explains a number that is wrong in any frames.
    if judgement.wrong + len(judgement.extra) > 1 and not any(row.is_given_up for row in rows):
        combine = judgement.wrong >= WRONG_THROUGHOUT
        found, judgement = explained(part, roles, convention, judgement, grading, combine=combine)
    # An explained table is not the intended one, so its lost motion is irrelevant. Axes that are
    # wrong because of another slip, such as an offset of θ, do not concern a and α.
    of_links = bool((judgement.matches[:, :D] < Match.ROUNDED).any())
    is_asked = of_links and not found and grading.affords(FREEDOM_WORK)
    lost = freedom_lost(roles, convention, grading) if is_asked else ()
    return judgement, found, lost


def _chain(
    answer: StudentTable, judgement: Judgement, convention: Convention
) -> StudentChain | None:
    """Return the table as a chain; None unless all cells have a value."""
    if np.isnan(answer.values).any():
        return None

    def tool_at(samples: Samples) -> Matrices:
        table = np.array([row.values_at(samples) for row in answer.rows])
        return np.asarray(frames(table, convention)[-1])

    return StudentChain(
        frames(answer.values, convention),
        tool_at,
        nearest_links=links(np.array([row.expected for row in judgement.rows]), convention),
    )


def _cost_of(found: tuple[Finding, ...]) -> float:
    """Return the share of the points that slips of the whole table cost."""
    return sum(COSTS.get(finding.code, COST) for finding in found)


def _row_reports(judgement: Judgement, grading: Grading, slips: Slips) -> tuple[RowReport, ...]:
    """Return the report rows with their cells."""
    return tuple(
        right_row(judged.label, COLUMNS)
        if judged.row is not None and is_right_throughout(judged.row.entries, row, grading)
        else row_report(
            judged.label,
            tuple(
                _cell(judged, column, match, slips.get((i, column)), grading)
                for column, match in enumerate(row)
            ),
        )
        for i, (judged, row) in enumerate(
            zip(judgement.rows, judgement.matches.tolist(), strict=True)
        )
    )


def _cell(
    judged: JudgedRow, column: int, match: int, slip: Finding | None, grading: Grading
) -> CellReport:
    label = COLUMNS[column]
    if judged.row is None:
        return CellReport(label, Verdict.MISSING)
    return cell_report(judged.row.entries[column], label, match, slip, grading)
