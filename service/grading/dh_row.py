"""Answer kind ``dh_row``: the DH row of a transform, or that it has none."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from service.catalogue import DhRowSpec
from service.grading.compare import Match, matches
from service.grading.diagnosis.case import WrongCell
from service.grading.diagnosis.cells import diagnose
from service.grading.diagnosis.dh_row import RowCase, explain_row, has_a_row, violated
from service.grading.diagnosis.values import UNEXPLAINED
from service.grading.entries import MISSING
from service.grading.expected import own_values
from service.grading.findings import ROUNDED, Finding
from service.grading.formulas import formula_text
from service.grading.pasted import length_unit
from service.grading.protocol import Grading, PartTerms
from service.grading.report import CellReport, PartReport, Verdict, row_report
from service.grading.samples import Lanes
from service.grading.tables import IS_ANGLE, HandedInRow, UnreadableTableError, read_table
from service.kinematics.chain import COLUMNS
from service.kinematics.dh_row import row
from service.kinematics.transforms import Matrices

LABEL = "1"
NONE = "none"


@dataclass(frozen=True, slots=True)
class DhRowKind:
    """Grades the row of a transform cell by cell, or the claim that there is none."""

    def grade(self, part: DhRowSpec, answer: object, grading: Grading) -> PartReport:
        """The report on a row, or on "none"."""
        terms = PartTerms(part.id, part.kind, part.points, part.all_or_nothing)
        transform = _transform(part, grading)
        broken = violated(transform, part.convention, grading.exercise.length_scale)
        if _says_none(answer):
            slips = () if broken else (has_a_row(part.convention),)
            verdict = Verdict.CORRECT if broken else Verdict.INCORRECT
            cell = CellReport(NONE, verdict)
            report = row_report(LABEL, part.points, (cell,), grading.show(slips, LABEL))
            return terms.report((report,))
        try:
            written = _read_row(answer, grading)
        except UnreadableTableError as error:
            return terms.unread(Verdict.UNREADABLE, grading.show((error.finding,)))
        if broken:
            cells = tuple(
                CellReport(
                    label,
                    Verdict.INCORRECT if entry.readable else entry.verdict,
                    grading.show(entry.findings, LABEL, label),
                )
                for label, entry in zip(COLUMNS, written.entries, strict=True)
            )
            told = grading.show(tuple(broken), LABEL)
            return terms.report((row_report(LABEL, part.points, cells, told),))
        return self._against_the_row(written, transform, part, grading, terms)

    @staticmethod
    def _against_the_row(
        written: HandedInRow,
        transform: Matrices,
        part: DhRowSpec,
        grading: Grading,
        terms: PartTerms,
    ) -> PartReport:
        expected = row(transform, part.convention)
        scale = np.where(IS_ANGLE, 1.0, grading.exercise.length_scale)
        found = matches(written.values, expected, scale, IS_ANGLE[:, None], rounded=written.rounded)
        remark: Finding | None = None
        if (found < Match.ROUNDED).any() and np.isfinite(written.values).all():
            case = RowCase(
                written.values, transform, part.convention, grading.exercise.length_scale
            )
            remark = explain_row(case)
        cells = tuple(
            _cell(i, written, expected[i], match, grading, explained=remark is not None)
            for i, match in enumerate(found.tolist())
        )
        told = grading.show((remark,) if remark else (), LABEL)
        return terms.report((row_report(LABEL, part.points, cells, told),))


def _transform(part: DhRowSpec, grading: Grading) -> Matrices:
    values = own_values(part.id, grading.exercise, grading.samples)
    if values is None:
        raise LookupError(f"part {part.id!r} has no formulas")
    return np.moveaxis(values, -1, 0)


def _says_none(answer: object) -> bool:
    if isinstance(answer, Mapping):
        return answer.get(NONE) is True
    return isinstance(answer, str) and answer.strip().casefold() == NONE


def _read_row(answer: object, grading: Grading) -> HandedInRow:
    """The one row that was handed in. Raises UnreadableTableError."""
    if isinstance(answer, Mapping) and not answer.keys().isdisjoint(COLUMNS):
        answer = {"rows": [answer]}
    elif not isinstance(answer, str) and not (isinstance(answer, Mapping) and "rows" in answer):
        raise UnreadableTableError(_WRONG_SHAPE)
    table = read_table(answer, grading.reader, length_unit(grading.exercise))
    if len(table.rows) > 1:
        raise UnreadableTableError(_WRONG_SHAPE)
    if not table.rows:
        return HandedInRow((MISSING,) * len(COLUMNS), np.full((len(COLUMNS), 1), np.nan))
    return table.rows[0]


_WRONG_SHAPE = Finding(
    "wrong_shape",
    'This answer is one row, {"a": …, "alpha": …, "d": …, "theta": …}, or {"none": true} where '
    "there is none.",
    reading=True,
)


def _cell(
    i: int,
    written: HandedInRow,
    expected: Lanes,
    match: int,
    grading: Grading,
    *,
    explained: bool,
) -> CellReport:
    label, entry = COLUMNS[i], written.entries[i]
    verdict, findings = entry.verdict, entry.findings
    if match == Match.ROUNDED:
        findings = (*findings, ROUNDED)
    elif entry.expression is not None and match < Match.ROUNDED:
        verdict = Verdict.INCORRECT
        angle = bool(IS_ANGLE[i])
        slip = diagnose(
            WrongCell(
                expression=entry.expression,
                actual=written.values[i],
                expected=expected,
                expected_text=formula_text(expected, angle, grading.exercise, grading.samples),
                samples=grading.samples,
                scale=1.0 if angle else grading.exercise.length_scale,
                angle=angle,
                column=label,
                joint=None,
                joints=(),
            )
        )
        if not (explained and slip.code == UNEXPLAINED):
            findings = (*findings, slip)
    return CellReport(label, verdict, grading.show(findings, LABEL, label))
