"""Answer kind ``dh_row``: the DH row of a transform, or that it has none."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from service.catalogue.parts.dh_row import DhRowSpec
from service.grading.comparison import Match, matches
from service.grading.diagnosis.dh_row import RowCase, explain_row, has_a_row, violated
from service.grading.diagnosis.table_cell import diagnose
from service.grading.diagnosis.wrong_value import UNEXPLAINED, WrongCell
from service.grading.feedback import ROUNDED, Finding
from service.grading.formula_text import formula_text
from service.grading.judging.expected import own_values
from service.grading.part import Grading, PartTerms
from service.grading.reading.entry import MISSING
from service.grading.reading.pasted import length_unit
from service.grading.reading.table import IS_ANGLE, HandedInRow, UnreadableTableError, read_table
from service.grading.reading.table_json import canonical_table
from service.grading.report import CellReport, PartReport, Verdict, row_report
from service.kinematics.chain import COLUMNS
from service.kinematics.dh_row import row
from service.kinematics.transforms import Matrices, Numbers

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
        try:
            written = None if _says_none(answer) else _read_row(answer, grading)
        except UnreadableTableError as error:
            return terms.unread(Verdict.UNREADABLE, grading.visible((error.finding,)))
        if written is None:
            slips = () if broken else (has_a_row(part.convention),)
            verdict = Verdict.CORRECT if broken else Verdict.INCORRECT
            cell = CellReport(NONE, verdict)
            report = row_report(LABEL, part.points, (cell,), grading.visible(slips, LABEL))
            return terms.report((report,))
        if broken:
            cells = tuple(
                CellReport(
                    label,
                    Verdict.INCORRECT if entry.readable else entry.verdict,
                    grading.visible(entry.findings, LABEL, label),
                )
                for label, entry in zip(COLUMNS, written.entries, strict=True)
            )
            told = grading.visible(tuple(broken), LABEL)
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
        told = grading.visible((remark,) if remark else (), LABEL)
        return terms.report((row_report(LABEL, part.points, cells, told),))


def _transform(part: DhRowSpec, grading: Grading) -> Matrices:
    values = own_values(part.id, grading.exercise, grading.samples)
    if values is None:
        raise LookupError(f"part {part.id!r} has no formulas")
    return np.moveaxis(values, -1, 0)


def _says_none(answer: object) -> bool:
    """Whether the answer is that there is no row. Raises UnreadableTableError for one with both."""
    if isinstance(answer, Mapping):
        named = answer.get(NONE)
        if named in _NOT_SAID:
            return False
        if _gives_a_row(answer):
            raise UnreadableTableError(_CONTRADICTION)
        return named is True
    return isinstance(answer, str) and _NONE.fullmatch(answer.strip()) is not None


def _gives_a_row(answer: Mapping[str, object]) -> bool:
    """Whether a value is written for any cell, or rows are."""
    table = canonical_table([answer])
    cells = table["rows"][0].values() if isinstance(table, Mapping) else ()
    return any(map(_is_written, (answer.get("rows"), *cells)))


def _is_written(value: object) -> bool:
    return bool(value.strip()) if isinstance(value, str) else value is not None and value != []


def _read_row(answer: object, grading: Grading) -> HandedInRow:
    """The one row that was handed in. Raises UnreadableTableError."""
    if not isinstance(answer, str):
        answer = canonical_table(answer if _has_rows(answer) else [answer])
        if not isinstance(answer, Mapping):
            raise UnreadableTableError(_WRONG_SHAPE)
    try:
        table = read_table(answer, grading.reader, length_unit(grading.exercise))
    except UnreadableTableError as error:
        # A table of another shape; of this answer nobody expects a table.
        wrong = error.finding.code == _WRONG_SHAPE.code
        finding = replace(_WRONG_TEXT, span=error.finding.span) if wrong else error.finding
        raise UnreadableTableError(finding) from error
    if len(table.rows) > 1:
        raise UnreadableTableError(_WRONG_SHAPE)
    if not table.rows:
        return HandedInRow((MISSING,) * len(COLUMNS), np.full((len(COLUMNS), 1), np.nan))
    return table.rows[0]


def _has_rows(answer: object) -> bool:
    """Whether the row lies in a list of rows."""
    if isinstance(answer, Mapping):
        return "rows" in answer
    return isinstance(answer, list) and any(isinstance(row, list | dict) for row in answer)


# The text alone, and the JSON for it as text.
_NONE = re.compile(r"""["']?none["']?\.?|\{\s*["']?none["']?\s*:\s*true\s*\}""", re.IGNORECASE)
_NOT_SAID: tuple[object, ...] = (None, False, "")

_WRONG_SHAPE = Finding(
    "wrong_shape",
    'This answer is one row, {"a": …, "alpha": …, "d": …, "theta": …}, or {"none": true} where '
    "there is none.",
    reading=True,
)
_WRONG_TEXT = Finding(
    "wrong_shape",
    "This answer is one row: write its four values in the order a, α, d, θ with commas between "
    "them, or none where there is no row.",
    reading=True,
)
_CONTRADICTION = Finding(
    "contradiction",
    'This answer says that there is no row, and gives one: write {"none": true} alone, or the '
    "row alone.",
    reading=True,
)


def _cell(
    i: int,
    written: HandedInRow,
    expected: Numbers,
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
    return CellReport(label, verdict, grading.visible(findings, LABEL, label))
