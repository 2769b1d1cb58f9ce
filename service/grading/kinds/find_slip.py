"""Answer kind ``find_slip``: mark the mistake (slip) in a given table, and correct the table."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache, lru_cache, partial
from typing import Final

import numpy as np

from service.catalogue import Exercise, PartSpec
from service.catalogue.parts.find_slip import FindSlipSpec
from service.catalogue.shapes import AnswerShape
from service.grading.diagnosis.wrong_value import WrongCell
from service.grading.feedback import Finding, UnreadableAnswerError, reading_error
from service.grading.judging.own_frames.best_roles import roles_in
from service.grading.judging.own_frames.nearest.few_cells import single_repairs
from service.grading.judging.own_frames.written_table import Rereadable
from service.grading.kinds.dh_table import judge_dh_table_answer, read_dh_table_answer
from service.grading.misconception import all_records
from service.grading.numerics.samples import draw
from service.grading.part import Content, Grading, Judged
from service.grading.reading.entry import Reader
from service.grading.reading.tables.marked_cells import MarkedCells, read_marks
from service.grading.reading.tables.table import StudentTable, read_table
from service.grading.report import (
    CellReport,
    Feedback,
    RowReport,
    Severity,
    Verdict,
    combined,
    row_report,
)
from service.kinematics.chain import COLUMNS
from service.kinematics.factors import CellIndex
from service.learning.find_slip import DrawnSlip, NoSlipError, TableBlame, drawn_slip
from service.learning.table_texts import TableTexts, as_rows
from service.regex import regex
from service.translations import say

MARKED: Final = "marked"
TABLE: Final = "table"
# The classes of wrong cells and tables, whose records are about tables.
_OF_TABLES: Final = (WrongCell, Rereadable, StudentTable)
# The line before a pasted table that marks the slip, also in LaTeX.
_MARK_LINE: Final = regex(r"(?:\\text\{)?\s*marked\s*[:=](.*?)\}?\s*", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class FoundSlip:
    """An answer: the marked cells and the corrected table.

    ``table`` is None if it is missing or unreadable.
    """

    # ``unread`` has the reason.
    marked: MarkedCells
    table: StudentTable | None
    unread: Finding | None = None


def read_find_slip_answer(part: FindSlipSpec, answer: object, grading: Grading) -> FoundSlip | None:
    """Read the marked cells and the table; return None if both are empty."""
    marks, table = _split(answer)
    marked = read_marks(marks, grading.exercise.robot.tables[part.convention].labels)
    unread = None
    read = None
    if table is not None:
        try:
            read = read_table(table, grading.reader)
        except UnreadableAnswerError as error:
            unread = error.finding
        if read is not None and not read.rows:
            read = None
    if marked.verdict is Verdict.MISSING and read is None:
        if unread is not None:
            raise UnreadableAnswerError(unread)
        return None
    return FoundSlip(marked, read, unread)


def _split(answer: object) -> tuple[object, object]:
    if isinstance(answer, str):
        first, _, rest = answer.strip().partition("\n")
        if found := _MARK_LINE.fullmatch(first):
            return found[1], rest
        return None, answer
    if isinstance(answer, Mapping) and answer.keys() <= {MARKED, TABLE}:
        return answer.get(MARKED), answer.get(TABLE)
    if isinstance(answer, Mapping) and "rows" in answer and MARKED not in answer:
        return None, answer
    raise UnreadableAnswerError(_WRONG_SHAPE)


def judge_find_slip_answer(part: FindSlipSpec, answer: FoundSlip, grading: Grading) -> Judged:
    """Judge the marked cells and the corrected table.

    If the marked cells are wrong, the report does not show which cells of the table are wrong.
    """
    # Otherwise a student could find the slip by submitting the given table.
    drawn = slip_of(part, grading.exercise)
    is_found = _is_found(answer.marked.cells, drawn)
    table = (
        None if answer.table is None else judge_dh_table_answer(part.table, answer.table, grading)
    )
    is_mended = table is not None and table.is_right
    row = _marked_row(answer.marked, is_found=is_found, is_mended=is_mended, drawn=drawn)
    marked = row_report(MARKED, (CellReport(MARKED, row.verdict, grading.messages(row.findings)),))
    if table is not None and (is_mended or is_found):
        rows, feedback = table.rows, table.feedback
        content = _content(rows, drawn)
    else:
        hidden = _hidden_table(answer, table, grading, is_found=is_found)
        rows, feedback = (hidden,), _on_reading(table)
        content = Content(((True,), (True,)), ((0,), (1,)), equal=True)
    return Judged(
        (marked, *rows),
        content,
        feedback,
        slips=table.slips if table is not None and is_found else 0,
        chain=table.chain if table is not None else lambda: None,
    )


@dataclass(frozen=True, slots=True)
class _MarkedRow:
    verdict: Verdict
    findings: tuple[Finding, ...]


def _marked_row(
    marked: MarkedCells, *, is_found: bool, is_mended: bool, drawn: DrawnSlip
) -> _MarkedRow:
    if marked.verdict is not None:
        return _MarkedRow(marked.verdict, marked.findings)
    if is_found:
        return _MarkedRow(Verdict.CORRECT, (_named(drawn.misconception),) if is_mended else ())
    return _MarkedRow(Verdict.INCORRECT, (_NOT_THERE,))


def _hidden_table(
    answer: FoundSlip, table: Judged | None, grading: Grading, *, is_found: bool
) -> RowReport:
    verdict, findings = Verdict.MISSING, tuple[Finding, ...]()
    if answer.unread is not None:
        verdict, findings = Verdict.UNREADABLE, (answer.unread,)
    elif answer.table is None or table is None:
        findings = (_NOT_MENDED,) if is_found else ()
    else:
        entries = [entry for row in answer.table.rows for entry in row.entries]
        unread = [entry for entry in entries if not entry.readable]
        findings = tuple(dict.fromkeys(each for entry in unread for each in entry.findings))
        is_wrong = table.is_wrong or not unread
        verdict = Verdict.INCORRECT if is_wrong else combined(each.verdict for each in unread)
    return row_report(TABLE, (CellReport(TABLE, verdict, grading.messages(findings)),))


def _on_reading(table: Judged | None) -> tuple[Feedback, ...]:
    return () if table is None else tuple(each for each in table.feedback if each.reading)


def _is_found(marked: frozenset[CellIndex], drawn: DrawnSlip) -> bool:
    # A whole row or column may be marked if at least two of its cells are wrong.
    return any(_covers(marked, wrong) for wrong in drawn.places)


def _covers(marked: frozenset[CellIndex], wrong: frozenset[CellIndex]) -> bool:
    if not wrong <= marked:
        return False
    rows = {row for row, _ in marked}
    count = max(row for row, _ in wrong | marked) + 1
    lines = [frozenset((row, column) for column in range(len(COLUMNS))) for row in rows]
    lines += [frozenset((row, column) for row in range(count)) for column in range(len(COLUMNS))]
    allowed = wrong.union(*(line for line in lines if line <= marked and len(line & wrong) > 1))
    return marked <= allowed


def _content(rows: tuple[RowReport, ...], drawn: DrawnSlip) -> Content:
    # One half for the marked cells, one half for the table. In a correct table, the cells of the
    # slip share the half of the table. In any other table, all cells that are not correct share
    # this half, so that the table earns nothing.
    wrong = [[cell.verdict is not Verdict.CORRECT for cell in row.cells] for row in rows]
    if not any(map(any, wrong)):
        wrong = [
            [(i, j) in drawn.cells for j in range(len(row.cells))] for i, row in enumerate(rows)
        ]
    if not any(map(any, wrong)):
        wrong = [[True] * len(row.cells) for row in rows]
    known = ((True,), *(tuple(row) for row in wrong))
    groups = ((0,), *((1,) * len(row.cells) for row in rows))
    return Content(known, groups, equal=True)


# --- the given table


def slip_of(part: FindSlipSpec, exercise: Exercise) -> DrawnSlip:
    """Return the given table and its mistake (slip)."""
    # If the slip that the part asks for does not fit the robot, the table has another slip;
    # ``exercises check`` reports this.
    return _slip_of(_Asked(exercise.version, part.id, part, exercise))


def shown_shape(part: PartSpec, exercise: Exercise) -> AnswerShape:
    """Return the shape of an answer to a part, with the given table if the part has one."""
    shape = part.shape(exercise.reference)
    if not isinstance(part, FindSlipSpec):
        return shape
    given = [list(row) for row in slip_of(part, exercise).texts]
    return shape.model_copy(update={"given": given})


@dataclass(frozen=True, slots=True)
class _Asked:
    # A cache key, compared by the exercise version and the part's id.
    version: str
    part_id: str
    part: FindSlipSpec = field(compare=False)
    exercise: Exercise = field(compare=False)


@lru_cache(maxsize=256)
def _slip_of(asked: _Asked) -> DrawnSlip:
    part, exercise = asked.part, asked.exercise

    def judge_table(texts: TableTexts, turn: int) -> TableBlame | None:
        return blame(part, exercise, texts, turn)

    drawn = partial(drawn_slip, exercise, part.convention, part.seed, judge_table)
    try:
        return drawn(part.slip)
    except NoSlipError:
        return drawn()


def blame(
    part: FindSlipSpec, exercise: Exercise, texts: TableTexts, turn: int = 0
) -> TableBlame | None:
    """Return what is wrong in a table; None if it is correct or unreadable.

    Each ``turn`` (0, 1, …) uses different random samples.
    """
    answer = {"rows": as_rows(texts)}
    samples = draw(exercise, [answer, turn] if turn else answer)
    grading = Grading(exercise, samples, Reader.of(exercise, samples, "radians"))
    table = read_dh_table_answer(part.table, answer, grading)
    if table is None or not all(entry.readable for row in table.rows for entry in row.entries):
        return None
    judged = judge_dh_table_answer(part.table, table, grading)
    labels = exercise.robot.tables[part.convention].labels
    if judged.is_right or judged.slips or [row.label for row in judged.rows] != list(labels):
        return None
    messages = [
        *judged.feedback,
        *(message for row in judged.rows for message in row.feedback),
        *(message for row in judged.rows for cell in row.cells for message in cell.feedback),
    ]
    wrong = frozenset(
        (i, j)
        for i, row in enumerate(judged.rows)
        for j, cell in enumerate(row.cells)
        if cell.verdict is not Verdict.CORRECT
    )
    codes = frozenset(each.code for each in messages if each.severity is Severity.ERROR)
    single = wrong
    if len(wrong) == 1 and part.frames == "free" and np.isfinite(table.values).all():
        roles = roles_in(table.rows, part.convention, grading, in_order=True)
        single |= single_repairs(roles, part.convention, grading)
    return TableBlame(codes, wrong, single)


@cache
def _meaning(slip: str) -> str:
    return next(
        record.meaning(slip)
        for record in all_records()
        if slip in record.codes and issubclass(record.of, _OF_TABLES)
    )


def _named(slip: str) -> Finding:
    hint = say("This was the slip: {meaning}.", meaning=say(_meaning(slip)))
    return Finding("slip_found", hint, severity=Severity.INFO)


_NOT_THERE: Final = Finding(
    "slip_elsewhere",
    say("The slip is not here, or not only here. Mark the wrong cells and no others."),
)
_NOT_MENDED: Final = Finding(
    "not_mended",
    say("The mark is right. Now write the mended table below, and check again."),
    severity=Severity.INFO,
)
_WRONG_SHAPE: Final = reading_error(
    "wrong_shape",
    say('The answer is written {{"marked": "2.alpha", "table": {{"rows": […]}}}}.'),
)
