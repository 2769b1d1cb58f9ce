"""Answer kind ``dh_table``: a Denavit-Hartenberg table of the exercise's robot."""

from dataclasses import replace

import numpy as np

from service.catalogue.parts.dh_table import DhTableSpec
from service.grading.diagnosis.tables.table_cell import diagnose_cells, wrong_cells
from service.grading.diagnosis.tables.table_explained import explained
from service.grading.diagnosis.tables.table_freedom import freedom_lost
from service.grading.feedback import Finding
from service.grading.follow_through import stands_still
from service.grading.judging.convention import judged_in_convention
from service.grading.judging.own_frames.best_roles import roles_in
from service.grading.judging.report_rows import (
    Slips,
    cell_report,
    is_right_throughout,
    right_row,
)
from service.grading.judging.row_places import extra_row, missing_row, row_places
from service.grading.judging.table import JudgedRow, Judgement
from service.grading.judging.table_content import table_content
from service.grading.judging.table_filled import with_zeros
from service.grading.kinds.shared.given_rows import with_given_rows
from service.grading.kinds.shared.table_readings import (
    COST,
    JudgedTable,
    best_reading,
    search_work,
)
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
from service.grading.report import CellReport, Place, RowReport, Verdict, row_report
from service.kinematics.chain import COLUMNS, D, frames, links
from service.kinematics.dh import Convention
from service.kinematics.transforms import Matrices

# The share of the points that a slip costs if it is not that of every slip of a whole table.
COSTS = {"other_convention": 0.5}
_QUANTITIES = tuple(QUANTITIES.values())
# The budgeted work of finding a motion that the student's arm cannot make.
FREEDOM_WORK = 8.0
# The number of wrong cells from which two simultaneous misconceptions are searched.
WRONG_THROUGHOUT = 3


def read_dh_table_answer(
    part: DhTableSpec, answer: object, grading: Grading
) -> StudentTable | None:
    """Read the rows of a table; return None if there are none."""
    empty_is_zero = part.empty_cells == "zero"
    table = read_table(answer, grading.reader, empty_is_zero=empty_is_zero)
    if not table.rows:
        return None
    # With a free tool, a table may be right without row e. There, an empty row e costs as much as a
    # wrong one.
    if part.tool == "given" and table.rows[-1].is_missing:
        robot = grading.exercise.robot
        table = without_empty_end(table, len(robot.joints), len(part.asked_table(robot).rows))
    return with_given_rows(part, table, grading) if part.given else table


def judge_dh_table_answer(part: DhTableSpec, answer: StudentTable, grading: Grading) -> Judged:
    """Judge the table row by row and cell by cell.

    A wrong table is also judged under alternative assumptions, for example that its columns are in
    a different order.
    """
    if np.isnan(answer.values).any():
        # Values for unread cells are looked for with what the judging itself leaves.
        grading.reader.budget.charge_search(search_work(part, answer, grading))
    first = judged_once(part, answer, grading)
    if first.judged.is_right:
        return first.judged
    return best_reading(part, answer, first, judged_once, grading)


def judged_once(part: DhTableSpec, answer: StudentTable, grading: Grading) -> JudgedTable:
    """Judge the table as written, in its convention."""
    # A correct table is not diagnosed.
    convention, judgement, findings = judged_in_convention(part, answer, grading)
    notes = grading.messages((*answer.findings, *findings))
    judge_rows = _judged_wrong if judgement.wrong or judgement.slips else _judged_right
    judged = judge_rows(part, answer, convention, judgement, grading)
    if notes:
        judged = replace(judged, feedback=(*notes, *judged.feedback))
    return JudgedTable(judged, convention)


def _judged_right(
    part: DhTableSpec,
    answer: StudentTable,
    convention: Convention,
    judgement: Judgement,
    grading: Grading,
) -> Judged:
    of_rows = _row_places(answer, judgement, convention, grading)
    return Judged(
        _row_reports(judgement, grading, {}),
        table_content(part, judgement, convention, grading),
        grading.messages((*judgement.findings, *of_rows)),
        lost=judgement.lost,
        chain=lambda: _chain(answer, judgement, convention),
    )


def _judged_wrong(
    part: DhTableSpec,
    answer: StudentTable,
    convention: Convention,
    first: Judgement,
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
    missing = tuple(
        message
        for judged in judgement.rows
        if judged.row is None and not found
        for message in grading.messages((missing_row(judged),), (Place(judged.label),))
    )
    extra = tuple(map(extra_row, judgement.extra))
    of_rows = _row_places(answer, judgement, convention, grading)
    return Judged(
        _row_reports(judgement, grading, slips),
        table_content(part, judgement, convention, grading),
        (
            *grading.messages(found, places),
            *grading.messages((*lost, *judgement.findings)),
            *missing,
            *grading.messages((*extra, *of_rows)),
        ),
        slips=judgement.slips,
        whole_cost=_cost_of(found) if found else None,
        stands_still=judgement.wrong > 0 and stands_still(with_zeros(answer), _QUANTITIES, grading),
        lost=first.lost,
        chain=lambda: _chain(answer, first, convention),
    )


def _row_places(
    answer: StudentTable, judgement: Judgement, convention: Convention, grading: Grading
) -> tuple[Finding, ...]:
    return () if judgement.in_place else row_places(answer, judgement, convention, grading)


def _of_the_whole(
    part: DhTableSpec,
    rows: tuple[StudentRow, ...],
    judgement: Judgement,
    convention: Convention,
    grading: Grading,
) -> tuple[Judgement, tuple[Finding, ...], tuple[Finding, ...]]:
    # The judgement, the findings that explain the table, and the findings on a motion that the
    # student's arm cannot make. If the table is explained, the judgement is revised to fit the
    # explanation.
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
    if np.isnan(answer.values).any():
        return None

    def frames_at(samples: Samples) -> Matrices:
        return frames(np.array([row.values_at(samples) for row in answer.rows]), convention)

    return StudentChain(
        frames(answer.values, convention),
        frames_at,
        nearest_links=links(np.array([row.expected for row in judgement.rows]), convention),
    )


def _cost_of(found: tuple[Finding, ...]) -> float:
    return sum(COSTS.get(finding.code, COST) for finding in found)


def _row_reports(judgement: Judgement, grading: Grading, slips: Slips) -> tuple[RowReport, ...]:
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
