"""Answer kind ``dh_row``: the DH row of a transform, or "none"."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from service.catalogue.parts.dh_row import DhRowSpec
from service.expressions import Expression
from service.expressions.printing.spelling import Spelling, spelling_for
from service.grading.diagnosis.tables.dh_row import WrongRow, has_a_row, violated
from service.grading.diagnosis.tables.table_cell import diagnose
from service.grading.diagnosis.wrong_value import WrongCell
from service.grading.feedback import Finding, UnreadableAnswerError, reading_error
from service.grading.formula_text import value_formula
from service.grading.judging.content import known_cells, of_one_row
from service.grading.judging.expected import given_values
from service.grading.judging.report_rows import cell_report
from service.grading.misconception import diagnosed
from service.grading.numerics.comparison import Match, entry_matches
from service.grading.part import Grading, Judged
from service.grading.reading.entry import MISSING, Entry
from service.grading.reading.tables.cells import (
    NamedCell,
    canonical_table,
    in_one_line,
    named_cells,
    says_none,
)
from service.grading.reading.tables.table import IS_ANGLE, StudentRow, read_table
from service.grading.report import CellReport, Verdict, row_report
from service.kinematics.chain import COLUMNS, Table
from service.kinematics.dh_row import row
from service.kinematics.transforms import Matrices, Numbers
from service.translations import say

LABEL = "1"
NONE = "none"


# A row, or the answer that there is none.
RowOrNone = StudentRow | Literal["none"]


def read_dh_row_answer(part: DhRowSpec, answer: object, grading: Grading) -> RowOrNone:
    """Read a row, or "none"."""
    return "none" if _says_none(answer) else _read_row(answer, grading)


def judge_dh_row_answer(part: DhRowSpec, answer: RowOrNone, grading: Grading) -> Judged:
    """Judge a row. The report has four cells; for the answer "none", it has a single cell."""
    transform = np.moveaxis(given_values(part, grading), -1, 0)
    broken = violated(transform, part.convention, grading.exercise.length_scale)
    known = np.array([True])
    if isinstance(answer, str):
        verdict = Verdict.CORRECT if broken else Verdict.INCORRECT
        cells: tuple[CellReport, ...] = (CellReport(NONE, verdict),)
        findings = [] if broken else [has_a_row(part.convention)]
    elif broken:
        cells = _cells(answer, np.full(len(COLUMNS), int(Match.DIFFERENT)), {}, grading)
        known = np.full(len(COLUMNS), True)
        # The message that there is no row makes sense only if the student wrote a complete row.
        findings = broken if all(entry.expression for entry in answer.entries) else []
    else:
        expected = row(transform, part.convention)
        cells, findings = _against_the_row(answer, expected, transform, part, grading)
        known = known_cells(expected, 0.0, _scale(grading), IS_ANGLE[:, None])
    messages = grading.messages(tuple(findings))
    return Judged((row_report(LABEL, cells, messages),), of_one_row(known))


def _cells(
    written: StudentRow, found: NDArray[np.int_], slips: Mapping[int, Finding], grading: Grading
) -> tuple[CellReport, ...]:
    return tuple(
        cell_report(written.entries[i], column, match, slips.get(i), grading)
        for i, (column, match) in enumerate(zip(COLUMNS, found.tolist(), strict=True))
    )


def _against_the_row(
    written: StudentRow, expected: Table, transform: Matrices, part: DhRowSpec, grading: Grading
) -> tuple[tuple[CellReport, ...], list[Finding]]:
    scale = _scale(grading)
    found = entry_matches(
        written.expressions, written.values, expected, scale, grading.samples, IS_ANGLE[:, None]
    )
    explained: Finding | None = None
    if (found < Match.ROUNDED).any() and np.isfinite(written.values).all():
        case = WrongRow(written.values, expected, scale, transform, part.convention)
        explained = diagnosed(case)
    spelling = grading.spelling(written.entries)
    slips = {
        i: _slip(i, expression, written.values[i], expected[i], spelling, grading)
        for i in np.flatnonzero(found < Match.ROUNDED).tolist()
        if (expression := written.entries[i].expression) is not None
    }
    if explained is not None:
        slips = {}
    return _cells(written, found, slips, grading), [explained] if explained else []


def _scale(grading: Grading) -> Numbers:
    return np.where(IS_ANGLE, 1.0, grading.exercise.length_scale)


def _slip(
    i: int,
    expression: Expression,
    actual: Numbers,
    expected: Numbers,
    spelling: Spelling,
    grading: Grading,
) -> Finding:
    angle = bool(IS_ANGLE[i])
    correction = None
    if grading.corrects:
        exercise, samples = grading.exercise, grading.samples
        own = spelling_for(expression.typed, spelling, exercise.vocabulary)
        correction = value_formula(expected, angle, exercise, samples, own)
    return diagnose(
        WrongCell(
            expression=expression,
            actual=actual,
            expected=expected,
            correction=correction,
            corrects=grading.corrects,
            spelling=spelling,
            samples=grading.samples,
            scale=1.0 if angle else grading.exercise.length_scale,
            angle=angle,
            column=i,
            joint=None,
            contained={},
            required={},
        )
    )


def _says_none(answer: object) -> bool:
    # Raises UnreadableAnswerError if the answer contains a row, too.
    if isinstance(answer, Mapping):
        named = answer.get(NONE)
        if named in _NOT_SAID:
            return _is_none_in_each_cell(answer)
        if _gives_a_row(answer):
            raise UnreadableAnswerError(_CONTRADICTION)
        return named is True
    return isinstance(answer, str) and says_none(answer)


def _gives_a_row(answer: Mapping[str, object]) -> bool:
    table = canonical_table([answer])
    cells = table["rows"][0].values() if isinstance(table, Mapping) else ()
    return any(map(_is_written, (answer.get("rows"), *cells)))


def _is_none_in_each_cell(answer: Mapping[str, object]) -> bool:
    # Every cell is empty or "none", and at least one is "none".
    written = [value for value in answer.values() if _is_written(value)]
    return bool(written) and all(isinstance(each, str) and says_none(each) for each in written)


def _is_written(value: object) -> bool:
    return bool(value.strip()) if isinstance(value, str) else value is not None and value != []


def _read_row(answer: object, grading: Grading) -> StudentRow:
    if isinstance(answer, str):
        if (named := named_cells(answer)) is not None:
            if not named:
                raise UnreadableAnswerError(_WRONG_TEXT)
            return _row_of(named, grading)
        answer = in_one_line(answer)
    else:
        answer = canonical_table(answer if _has_rows(answer) else [answer])
        if not isinstance(answer, Mapping):
            raise UnreadableAnswerError(_WRONG_SHAPE)
    try:
        table = read_table(answer, grading.reader)
    except UnreadableAnswerError as error:
        # The refusal speaks of a table, and this answer is none.
        wrong = error.finding.code == _WRONG_SHAPE.code
        finding = replace(_WRONG_TEXT, span=error.finding.span) if wrong else error.finding
        raise UnreadableAnswerError(finding) from error
    if len(table.rows) > 1:
        raise UnreadableAnswerError(_WRONG_SHAPE)
    if not table.rows:
        return StudentRow((MISSING,) * len(COLUMNS), np.full((len(COLUMNS), 1), np.nan))
    return table.rows[0]


def _row_of(named: Mapping[str, NamedCell], grading: Grading) -> StudentRow:
    cells = {column: cell.text for column, cell in named.items()}
    row = read_table({"rows": [{**dict.fromkeys(COLUMNS), **cells}]}, grading.reader).rows[0]
    entries = tuple(
        _moved(entry, named[column].start) if column in named else entry
        for column, entry in zip(COLUMNS, row.entries, strict=True)
    )
    return replace(row, entries=entries)


def _moved(entry: Entry, start: int) -> Entry:
    findings = tuple(
        replace(finding, span=finding.span and (start + finding.span[0], start + finding.span[1]))
        for finding in entry.findings
    )
    return replace(entry, findings=findings)


def _has_rows(answer: object) -> bool:
    if isinstance(answer, Mapping):
        return "rows" in answer
    return isinstance(answer, list) and any(isinstance(row, list | dict) for row in answer)


_NOT_SAID: tuple[object, ...] = (None, False, "")

_WRONG_SHAPE = reading_error(
    "wrong_shape",
    say(
        'One row is asked for: {{"a": …, "alpha": …, "d": …, "theta": …}}, or {{"none": true}} '
        "where there is none."
    ),
)
_WRONG_TEXT = reading_error(
    "wrong_shape",
    say(
        "One row is asked for: write a, α, d, θ in this order with commas between them, or by name "
        "as in a = …, d = …. Write none where there is no row."
    ),
)
_CONTRADICTION = reading_error(
    "contradiction",
    say(
        'The answer says that there is no row, and gives one: write {{"none": true}} alone, or the '
        "row alone."
    ),
)
