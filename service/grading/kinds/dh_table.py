"""Answer kind ``dh_table``: a Denavit-Hartenberg table of the exercise's robot."""

import numpy as np

from service.catalogue import Exercise
from service.catalogue.parts.dh_table import DhTableSpec
from service.grading.diagnosis.table_cell import diagnose_cells
from service.grading.diagnosis.table_explained import explained, freedom_lost
from service.grading.feedback import Finding
from service.grading.follow_through import stands_still
from service.grading.judging.own_frames.best_roles import roles_in
from service.grading.judging.report_rows import Slips, cell_report
from service.grading.judging.table import JudgedRow, Judgement, judged_table
from service.grading.part import Grading, Judged, StudentChain
from service.grading.reading.table import StudentRow, StudentTable, read_table
from service.grading.report import (
    CellReport,
    Correction,
    Place,
    RowReport,
    Severity,
    Verdict,
    row_report,
)
from service.grading.samples import Samples
from service.kinematics.chain import COLUMNS, frames, links
from service.kinematics.dh import Convention
from service.kinematics.transforms import Matrices

# With so many wrong cells two misconceptions at once are looked for.
WRONG_THROUGHOUT = 3


def read(part: DhTableSpec, answer: object, grading: Grading) -> StudentTable | None:
    """The rows of a table; None where there are none."""
    table = read_table(answer, grading.reader)
    return table if table.rows else None


def judge(part: DhTableSpec, answer: StudentTable, grading: Grading) -> Judged:
    """The table row by row and cell by cell."""
    convention, findings = _convention(part, answer, grading.exercise)
    first = judged_table(part, answer.rows, convention, grading)
    judgement, found, lost = _of_the_whole(part, answer.rows, first, convention, grading)
    slips = diagnose_cells(judgement, grading)
    places = tuple(
        Place(judgement.rows[i].label, COLUMNS[column], _formula(slip, grading))
        for (i, column), slip in slips.items()
    )
    messages = (
        *grading.visible((*answer.findings, *findings)),
        *grading.visible(found, places),
        *grading.visible((*lost, *judgement.findings)),
    )
    missing = tuple(
        message
        for judged in judgement.rows
        if judged.row is None
        for message in grading.visible((_missing(judged),), (Place(judged.label),))
    )
    extra = grading.visible(tuple(_extra_row(i) for i in judgement.extra))
    return Judged(
        _row_reports(judgement, part.points, grading, {} if found else slips),
        (*messages, *missing, *extra),
        lost=judgement.lost,
        stands_still=stands_still(answer.values),
        chain=lambda: _chain(answer, first, convention),
    )


def _of_the_whole(
    part: DhTableSpec,
    rows: tuple[StudentRow, ...],
    judgement: Judgement,
    convention: Convention,
    grading: Grading,
) -> tuple[Judgement, tuple[Finding, ...], tuple[Finding, ...]]:
    """The explanation of a wrong table as a whole, or else the freedom that its joints have lost.

    Returned with the judgement that agrees with it.
    """
    if not judgement.wrong:
        return judgement, (), ()
    roles = judgement.roles or roles_in(rows, convention, grading)
    found: tuple[Finding, ...] = ()
    if judgement.wrong > 1:
        combine = judgement.wrong >= WRONG_THROUGHOUT
        found, judgement = explained(part, roles, convention, judgement, grading, combine=combine)
    # An explained table is not the one that the student intended, so its freedom says nothing.
    return judgement, found, () if found else freedom_lost(roles, convention, grading)


def _convention(
    part: DhTableSpec, table: StudentTable, exercise: Exercise
) -> tuple[Convention, tuple[Finding, ...]]:
    """The convention that the table is read in, and the finding where the answer names another."""
    if part.convention == "either":
        return table.convention or exercise.robot.convention, ()
    if table.convention in (None, part.convention):
        return part.convention, ()
    return part.convention, (
        Finding(
            "convention_not_asked_for",
            f"This part asks for the {part.convention.value} convention and was graded in it, but "
            f"the answer says {table.convention.value if table.convention else ''}.",
            severity=Severity.WARNING,
        ),
    )


def _chain(
    answer: StudentTable, judgement: Judgement, convention: Convention
) -> StudentChain | None:
    """A table as a chain; None where not all of it has a value."""
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


def _formula(slip: Finding, grading: Grading) -> Correction | None:
    """The correction of a cell whose slip is that of the whole table."""
    return slip.correction if grading.corrects and isinstance(slip.correction, Correction) else None


def _row_reports(
    judgement: Judgement, points: float, grading: Grading, slips: Slips
) -> tuple[RowReport, ...]:
    """The rows with their cells."""
    share = points / len(judgement.rows)
    return tuple(
        row_report(
            judged.label,
            share,
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


def _missing(judged: JudgedRow) -> Finding:
    if judged.joint is not None:
        return Finding("missing_row", f"There is no row for joint {judged.joint.index}.")
    return Finding(
        "missing_tool_row",
        "The fixed row that leads from the last joint's frame to the end effector is missing.",
    )


def _extra_row(i: int) -> Finding:
    return Finding(
        "extra_row",
        f"Row {i + 1} of what was handed in answers to no joint of this robot; it was left out.",
    )
