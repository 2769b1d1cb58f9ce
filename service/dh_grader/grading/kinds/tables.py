"""Answer kinds ``dh_table``, ``find_slip`` and ``dh_row``: read and judge the answer to a part.

Each kind has a function that reads and one that judges (``AnswerKind``). They only put together
what ``reading``, ``judging_table.py`` and ``diagnosis`` know.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cache, lru_cache, partial
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from dh_grader.catalogue import Exercise, PartSpec, ReferenceTable
from dh_grader.catalogue.kinds import DhRowSpec, DhTableSpec, FindSlipSpec
from dh_grader.catalogue.part import AnswerShape
from dh_grader.expressions import Expression
from dh_grader.expressions.printing import Spelling, spelling_for
from dh_grader.grading.diagnosis.table_cells import (
    WrongRow,
    diagnose,
    diagnose_cells,
    has_a_row,
    violated,
    wrong_cells,
)
from dh_grader.grading.diagnosis.table_readings import (
    COST,
    JudgedTable,
    best_reading,
    freedom_lost,
    search_work,
)
from dh_grader.grading.diagnosis.whole_tables import explained
from dh_grader.grading.frames import Rereadable
from dh_grader.grading.frames.nearest import single_repairs
from dh_grader.grading.frames.roles import roles_in
from dh_grader.grading.judging import (
    Content,
    Grading,
    Judged,
    Slips,
    StudentChain,
    cell_report,
    given_values,
    is_right_throughout,
    known_cells,
    of_one_row,
    right_row,
)
from dh_grader.grading.judging_table import (
    JudgedRow,
    Judgement,
    column_scales,
    extra_row,
    judged_in_convention,
    missing_row,
    row_places,
    table_content,
    with_zeros,
)
from dh_grader.grading.marks import stands_still
from dh_grader.grading.misconception import (
    WrongCell,
    all_records,
    diagnosed,
    register,
    value_formula,
)
from dh_grader.grading.numbers import Match, Samples, draw, entry_matches, nearly_equal
from dh_grader.grading.reading.entries import MISSING, Entry, Reader
from dh_grader.grading.reading.headers import QUANTITIES
from dh_grader.grading.reading.pasted_table import MarkedCells, read_marks
from dh_grader.grading.reading.table import (
    IS_ANGLE,
    StudentRow,
    StudentTable,
    read_table,
    without_empty_end,
)
from dh_grader.grading.reading.table_cells import (
    NamedCell,
    canonical_table,
    in_one_line,
    named_cells,
    says_none,
)
from dh_grader.grading.report import (
    CellReport,
    Finding,
    Place,
    RowReport,
    Severity,
    UnreadableAnswerError,
    Verdict,
    combined,
    reading_error,
    row_report,
)
from dh_grader.kinematics import (
    COLUMNS,
    CellIndex,
    Convention,
    D,
    Matrices,
    Numbers,
    Table,
    frames,
    links,
    row,
)
from dh_grader.learning import DrawnSlip, NoSlipError, TableBlame, TableTexts, as_rows, drawn_slip
from dh_grader.regex import regex
from dh_grader.translations import say

# --- Answer kind ``dh_table``: a Denavit-Hartenberg table of the exercise's robot


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
    """Judge the table as written, in its convention; only a wrong table is diagnosed."""
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
    judgement, found, lost = _explained_as_a_whole(part, answer.rows, first, convention, grading)
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
        whole_cost=sum(COSTS.get(each.code, COST) for each in found) if found else None,
        stands_still=judgement.wrong > 0 and stands_still(with_zeros(answer), _QUANTITIES, grading),
        lost=first.lost,
        chain=lambda: _chain(answer, first, convention),
    )


def _row_places(
    answer: StudentTable, judgement: Judgement, convention: Convention, grading: Grading
) -> tuple[Finding, ...]:
    return () if judgement.in_place else row_places(answer, judgement, convention, grading)


def _explained_as_a_whole(
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


# --- Put the rows that an exercise gives into a submitted table


_CHANGED = register(
    of=StudentTable,
    code="given_row_changed",
    rule="rows",
    means="a given row says something else in the answer; it was graded as it is given, and costs "
    "nothing (a warning)",
    example=(
        "planar-rrr-faded",
        "table",
        "0, 0, 0, q1 ↵ l2, 0, 0, q2 ↵ l2, 0, 0, q3 ↵ l3, 0, 0, 0",
    ),
    unlike={"3/a": "l1"},
)


def with_given_rows(part: DhTableSpec, table: StudentTable, grading: Grading) -> StudentTable:
    """Return the table with the rows that the exercise gives.

    A table with too many rows is unchanged.
    """
    if not part.given or not table.rows:
        return table
    robot = grading.exercise.robot
    reference = robot.tables[robot.convention]
    given = {i - 1: _given_row(reference, i - 1, grading) for i in part.given}
    handed_in = _in_places(table.rows, given, len(reference.rows), grading)
    if handed_in is None:
        return table
    filled = tuple(row for i, own in enumerate(handed_in) if (row := given.get(i, own)) is not None)
    findings = tuple(
        _changed(reference.labels[i])
        for i, right in given.items()
        if (row := handed_in[i]) is not None and _is_changed(row, right, grading)
    )
    reread = table.reread
    return replace(
        table,
        rows=filled,
        values=np.array([row.values for row in filled]),
        findings=(*table.findings, *findings),
        reread=reread and (lambda order: with_given_rows(part, reread(order), grading)),
    )


def _in_places(
    rows: tuple[StudentRow, ...],
    given: Mapping[int, StudentRow],
    count: int,
    grading: Grading,
) -> list[StudentRow | None] | None:
    # None in the list where the student submitted no row; None instead of a list if there are too
    # many rows.
    if len(rows) == count:
        return list(rows)
    own = [
        row
        for row in rows
        if not any(_is_taken_over(row, each, grading) for each in given.values())
    ]
    if len(own) > count - len(given):
        return None
    others = iter(own)
    return [None if i in given else next(others, None) for i in range(count)]


def _given_row(reference: ReferenceTable, i: int, grading: Grading) -> StudentRow:
    entries = tuple(map(Entry, reference.rows[i]))
    samples = grading.samples
    values: Table = np.array(
        [
            np.broadcast_to(formula.evaluate(samples.values), samples.count)
            for formula in reference.rows[i]
        ]
    )
    return StudentRow(entries, values)


def _is_taken_over(row: StudentRow, right: StudentRow, grading: Grading) -> bool:
    is_full = all(entry.verdict is not Verdict.MISSING for entry in row.entries)
    return is_full and not _is_changed(row, right, grading)


def _is_changed(row: StudentRow, right: StudentRow, grading: Grading) -> bool:
    scales = column_scales(grading)
    equal = nearly_equal(row.values, right.values, scales, IS_ANGLE[:, None])
    cells = zip(row.entries, right.entries, equal.tolist(), strict=True)
    return not all(
        is_equal or own.verdict is Verdict.MISSING or _text(own) == _text(given)
        for own, given, is_equal in cells
    )


def _text(entry: Entry) -> str | None:
    return None if entry.expression is None else entry.expression.source


def _changed(label: str) -> Finding:
    return _CHANGED.finding(
        say(
            "Row {row} is given, and your answer has something else there. It was graded as it is "
            "given: take it over as it stands, and look at the other rows.",
            row=label,
        ),
        severity=Severity.WARNING,
    )


# --- Answer kind ``find_slip``: mark the mistake (slip) in a given table, and correct the table


MARKED: Final = "marked"
TABLE: Final = "table"
# The classes of wrong cells and tables, whose records are about tables.
_OF_TABLES: Final = (WrongCell, Rereadable, StudentTable)
# The line before a pasted table that marks the slip, also in LaTeX.
_MARK_LINE: Final = regex(r"(?:\\text\{)?\s*marked\s*[:=](.*?)\}?\s*", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class FoundSlip:
    """An answer: the marked cells and the corrected table.

    ``table`` is None if it is missing or unreadable; then ``unread`` has the reason.
    """

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
    raise UnreadableAnswerError(_NOT_MARKED_AND_MENDED)


def judge_find_slip_answer(part: FindSlipSpec, answer: FoundSlip, grading: Grading) -> Judged:
    """Judge the marked cells and the corrected table.

    If the marked cells are wrong, the report does not show which cells of the table are wrong:
    otherwise a student could find the slip by submitting the given table.
    """
    drawn = slip_of(part, grading.exercise)
    is_found = any(_covers(answer.marked.cells, wrong) for wrong in drawn.places)
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
        rows = (hidden,)
        feedback = tuple(each for each in table.feedback if each.reading) if table else ()
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


def _covers(marked: frozenset[CellIndex], wrong: frozenset[CellIndex]) -> bool:
    # A whole row or column may be marked if at least two of its cells are wrong.
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


_NOT_MARKED_AND_MENDED: Final = reading_error(
    "wrong_shape",
    say('The answer is written {{"marked": "2.alpha", "table": {{"rows": […]}}}}.'),
)

_NOT_THERE: Final = Finding(
    "slip_elsewhere",
    say("The slip is not here, or not only here. Mark the wrong cells and no others."),
)
_NOT_MENDED: Final = Finding(
    "not_mended",
    say("The mark is right. Now write the mended table below, and check again."),
    severity=Severity.INFO,
)


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


# --- The given table of the kind ``find_slip``, and its mistake


def slip_of(part: FindSlipSpec, exercise: Exercise) -> DrawnSlip:
    """Return the given table and its mistake (slip).

    If the slip that the part asks for does not fit the robot, the table has another slip;
    ``exercises check`` reports this.
    """
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


# --- Answer kind ``dh_row``: the DH row of a transform, or "none"


LABEL = "1"
NONE = "none"
# A row, or the answer that there is none.
RowOrNone = StudentRow | Literal["none"]

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
        known = known_cells(expected, 0.0, column_scales(grading), IS_ANGLE[:, None])
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
    scale = column_scales(grading)
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
