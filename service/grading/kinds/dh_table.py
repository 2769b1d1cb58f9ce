"""Answer kind ``dh_table``: a Denavit-Hartenberg table of the exercise's robot."""

from dataclasses import dataclass, replace

import numpy as np

from service.catalogue import Exercise
from service.catalogue.parts.dh_table import DhTableSpec
from service.expressions import Expression
from service.grading.comparison import Match
from service.grading.diagnosis.table_cell import diagnose
from service.grading.diagnosis.table_explained import explained, freedom_lost
from service.grading.diagnosis.wrong_value import WrongCell
from service.grading.feedback import ROUNDED, Finding
from service.grading.formula_text import sum_text
from service.grading.joint_motion import coefficients
from service.grading.judging.table import (
    JudgedRow,
    Judgement,
    column_scales,
    judged_table,
    roles_in,
)
from service.grading.part import Grading, OwnChain, PartTerms
from service.grading.reading.pasted import length_unit
from service.grading.reading.table import (
    IS_ANGLE,
    HandedInRow,
    HandedInTable,
    UnreadableTableError,
    read_table,
    values_of,
)
from service.grading.report import (
    CellReport,
    PartReport,
    RowReport,
    Severity,
    Verdict,
    row_report,
)
from service.kinematics.chain import COLUMNS, frames, links
from service.kinematics.dh import Convention
from service.kinematics.transforms import Matrices

EXACT = int(Match.EXACT)
_RIGHT = tuple(CellReport(label, Verdict.CORRECT) for label in COLUMNS)

# With so many wrong cells two misconceptions at once are looked for.
WRONG_THROUGHOUT = 3


@dataclass(frozen=True, slots=True)
class DhTableKind:
    """Grades tables in the reference's frames, or in the student's own where those are free."""

    def grade(self, part: DhTableSpec, answer: object, grading: Grading) -> PartReport:
        """The report on a table, row by row and cell by cell."""
        terms = PartTerms(part.id, part.kind, part.points, part.all_or_nothing)
        try:
            table = read_table(answer, grading.reader, length_unit(grading.exercise))
        except UnreadableTableError as error:
            return terms.unread(Verdict.UNREADABLE, grading.visible((error.finding,)))
        if not table.rows:
            return terms.unread(Verdict.MISSING)
        convention, findings = _convention(part, table, grading.exercise)
        judgement = judged_table(part, table.rows, convention, grading)
        judgement, found, lost = _of_the_whole(part, table.rows, judgement, convention, grading)
        rows = _row_reports(judgement, part.points, grading, found)
        told = grading.visible((*table.findings, *findings, *found, *lost, *judgement.findings))
        missing = tuple(
            message
            for judged in judgement.rows
            if judged.row is None
            for message in grading.visible((_missing(judged),), judged.label)
        )
        extra = grading.visible(tuple(_extra_row(i) for i in judgement.extra))
        return terms.report(rows, (*told, *missing, *extra), lost=judgement.lost)


def _of_the_whole(
    part: DhTableSpec,
    rows: tuple[HandedInRow, ...],
    judgement: Judgement,
    convention: Convention,
    grading: Grading,
) -> tuple[Judgement, tuple[Finding, ...], tuple[Finding, ...]]:
    """What explains the whole of a wrong table; or else which freedom its joints have lost.

    With the judgement that agrees with it.
    """
    if not judgement.wrong:
        return judgement, (), ()
    roles = judgement.roles or roles_in(rows, convention, grading)
    found: tuple[Finding, ...] = ()
    if judgement.wrong > 1:
        combine = judgement.wrong >= WRONG_THROUGHOUT
        found, judgement = explained(part, roles, convention, judgement, grading, combine=combine)
    # Where all is explained, what the table seems to describe was not meant.
    return judgement, found, () if found else freedom_lost(roles, convention, grading)


def _convention(
    part: DhTableSpec, table: HandedInTable, exercise: Exercise
) -> tuple[Convention, tuple[Finding, ...]]:
    """The convention that the table is read in, and what to say where the answer names another."""
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


def read_chain(part: DhTableSpec, answer: object, grading: Grading) -> OwnChain | None:
    """A table as the chain that later parts may follow from; None where not all of it is read."""
    read = _read_whole(part, answer, grading)
    if read is None:
        return None
    rows, convention = read
    judgement = judged_table(part, rows, convention, grading)
    return OwnChain(
        frames=frames(values_of(rows), convention),
        nearest_links=links(np.array([row.expected for row in judgement.rows]), convention),
    )


def read_frames(part: DhTableSpec, answer: object, grading: Grading) -> Matrices | None:
    """The frames of that chain alone, ``(rows + 1, SAMPLES, 4, 4)``, without a judgement."""
    read = _read_whole(part, answer, grading)
    if read is None:
        return None
    rows, convention = read
    return frames(values_of(rows), convention)


def _read_whole(
    part: DhTableSpec, answer: object, grading: Grading
) -> tuple[tuple[HandedInRow, ...], Convention] | None:
    """The rows of a table of which all was read, and the convention that it is read in."""
    try:
        table = read_table(answer, grading.reader, length_unit(grading.exercise))
    except UnreadableTableError:
        return None
    if not table.rows or np.isnan(values_of(table.rows)).any():
        return None
    convention, _ = _convention(part, table, grading.exercise)
    return table.rows, convention


def _row_reports(
    judgement: Judgement, points: float, grading: Grading, of_the_whole: tuple[Finding, ...]
) -> tuple[RowReport, ...]:
    """The rows with their cells, which belong to the slip of the whole table if there is one."""
    share = points / len(judgement.rows)
    slips = _slips(judgement, grading)
    if of_the_whole:
        belongs = replace(of_the_whole[0], hint=_PART_OF_IT)
        slips = {
            place: replace(belongs, correction=slip.correction) for place, slip in slips.items()
        }
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
    entry = judged.row.entries[column]
    if match == EXACT and not entry.findings:
        return _RIGHT[column]
    verdict, findings = entry.verdict, entry.findings
    if match == Match.ROUNDED:
        findings = (*findings, ROUNDED)
    elif entry.expression is not None and match < Match.ROUNDED:
        verdict = Verdict.INCORRECT
        findings = (*findings, slip) if slip else findings
    return CellReport(label, verdict, grading.visible(findings, judged.label, label))


def _slips(judgement: Judgement, grading: Grading) -> dict[tuple[int, int], Finding]:
    """What is to be said of each wrong cell that was read."""
    written: list[tuple[int, int, JudgedRow, HandedInRow, Expression]] = []
    for i, column in np.argwhere(judgement.matches < Match.ROUNDED).tolist():
        judged = judgement.rows[i]
        expression = judged.row.entries[column].expression if judged.row else None
        if judged.row is not None and expression is not None:
            written.append((i, column, judged, judged.row, expression))
    if not written:
        return {}
    joints, samples = grading.exercise.robot.joints, grading.samples
    actual = [row.handed_in[column] for _, column, _, row, _ in written]
    expected = [judged.expected[column] for _, column, judged, _, _ in written]
    angles = [bool(IS_ANGLE[column]) for _, column, *_ in written]
    contained = coefficients(np.array(actual + expected), joints, samples, np.array(angles * 2))
    scales = column_scales(grading).tolist()
    slips = {}
    for k, (i, column, judged, _, expression) in enumerate(written):
        wanted = contained[len(written) + k]
        slips[i, column] = diagnose(
            WrongCell(
                expression=expression,
                actual=actual[k],
                expected=expected[k],
                expected_text=sum_text(expected[k], wanted, angles[k], grading.exercise, samples),
                samples=samples,
                scale=scales[column],
                angle=angles[k],
                column=COLUMNS[column],
                joint=judged.joint,
                joints=joints,
                actual_coefficients=contained[k],
                expected_coefficients=wanted or (0,) * len(joints),
                shared=judged.shared,
            )
        )
    return slips


_PART_OF_IT = "This belongs to what is said of the table as a whole."


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
