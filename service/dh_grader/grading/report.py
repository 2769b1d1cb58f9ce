"""The report of a grading, in the shape that the HTTP contract names, and what goes into it.

This file knows verdicts, findings, the messages of each feedback level, the sentences on lost
points, and the work that a submission may cost. It judges nothing.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Annotated, Any, Final, Literal, Self, TypeAlias

from pydantic import Field

from dh_grader.catalogue import FeedbackLevel
from dh_grader.expressions.reader import reading_cost
from dh_grader.pasting.source import GRID_LIMITS
from dh_grader.regex import regex
from dh_grader.slices import checkpoint
from dh_grader.translations import Sentence, listed, say, say_count, template

# --- The report: the result of a grading, in the shape that the HTTP contract names
#
# Plain frozen dataclasses, whose docstrings are part of the contract. A field that is None is left
# out where a report is sent.


# The rules that ``hints.py`` explains. ``of_column`` is the rule of the column of a DH table.
RuleName: TypeAlias = Literal[
    "of_column",
    "link_length",
    "link_twist",
    "link_offset",
    "joint_angle",
    "joint_variable",
    "rows",
    "convention",
    "angle_unit",
    "product",
    "rotation_columns",
    "position_vector",
    "frame_z",
    "frame_origin",
    "frame_x",
    "inverse",
    "sine_and_cosine",
    "angle_sum",
    "atan2",
    "euler_sequence",
    "elementary_turn",
    "screw_axis",
    "exponentials",
    "dependence",
]


class Verdict(StrEnum):
    """The verdict on a cell, a row or a part."""

    CORRECT = "correct"
    PARTIAL = "partial"
    INCORRECT = "incorrect"
    UNREADABLE = "unreadable"
    MISSING = "missing"


class Severity(StrEnum):
    """The weight of a message: an error costs points, an info costs nothing."""

    ERROR = "error"
    WARNING = "warning"
    HINT = "hint"
    INFO = "info"


@dataclass(frozen=True, slots=True)
class Correction:
    """The right entry, as the student would write it.

    A correction without ``latex`` is an instruction in words: "Exchange a and d."
    """

    text: str
    latex: str | None = None


@dataclass(frozen=True, slots=True)
class Place:
    """A row of the report, or one of its cells, by their labels.

    ``correction`` is the correction of this place, if a message has different corrections for its
    places.
    """

    row: str
    cell: str | None = None
    correction: Correction | None = None


@dataclass(frozen=True, slots=True)
class Feedback:
    """One message, which never contains the right value.

    ``places`` are the rows and cells that a message on a part is about. ``span`` is [from, to) in
    the text of the cell, or in the whole text if it was pasted. ``suggestion`` is the repaired text
    of an unreadable one. ``correction`` is only in reports at the level full. ``values`` is a
    counterexample for the first place: the values of the symbols, and "yours", the value of the
    entry there; at the level full, "expected" is the right value. ``reading`` is true if the
    message is on how a text was read, and ``rule`` is the rule that a hint explains; neither is
    part of a report.
    """

    code: str
    severity: Severity
    message: str
    places: tuple[Place, ...] | None = None
    span: tuple[int, int] | None = None
    suggestion: str | None = None
    correction: Correction | None = None
    values: dict[str, float | str] | None = None
    reading: Annotated[bool | None, Field(exclude=True)] = field(default=None, compare=False)
    rule: Annotated[RuleName | None, Field(exclude=True)] = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class ReadEntry:
    """An entry as it was read."""

    text: str
    latex: str


@dataclass(frozen=True, slots=True)
class CellReport:
    """One table cell or matrix entry; ``read`` is present if the submission asks for it."""

    label: str
    verdict: Verdict
    feedback: tuple[Feedback, ...] = ()
    read: ReadEntry | None = None


@dataclass(frozen=True, slots=True)
class RowReport:
    """One row with its cells, and its share of the part's points."""

    label: str
    verdict: Verdict
    points: float
    max_points: float
    cells: tuple[CellReport, ...]
    feedback: tuple[Feedback, ...] = ()


@dataclass(frozen=True, slots=True)
class LostPoints:
    """Points that a part has lost, and where: ``message`` follows "−0.5: ".

    ``row`` and ``cells`` are labels; both are absent if the answer has lost them as a whole.
    """

    code: str
    points: float
    message: str
    row: str | None = None
    cells: tuple[str, ...] | None = None


@dataclass(frozen=True, slots=True)
class LittleWorth:
    """The reason why rows of zeros are worth few points."""

    rows: tuple[str, ...]
    points: float
    message: str


@dataclass(frozen=True, slots=True)
class PartReport:
    """One part: its rows share its points.

    The points of ``lost`` sum to ``max_points`` - ``points``. In reports of older versions,
    ``lost`` is empty. ``little_worth`` is present if a right row of zeros earned few points.
    """

    part: str
    kind: str
    verdict: Verdict
    points: float
    max_points: float
    follow_through: bool
    rows: tuple[RowReport, ...]
    feedback: tuple[Feedback, ...] = ()
    lost: Annotated[tuple[LostPoints, ...], Field(json_schema_extra={"x-added-later": True})] = ()
    little_worth: LittleWorth | None = None


@dataclass(frozen=True, slots=True)
class Report:
    """The whole grading. ``score`` is points / max_points, 0..1.

    ``grader`` is the program's version, ``feedback`` the level of the report. ``gradable`` is false
    if nothing could be read, so that a site need not count the attempt.
    """

    exercise: str
    version: str
    grader: str
    feedback: FeedbackLevel
    gradable: bool
    points: float
    max_points: float
    score: float
    parts: tuple[PartReport, ...]


_UNREAD: Final = (Verdict.MISSING, Verdict.UNREADABLE)


def was_read(part: PartReport) -> bool:
    """True if any cell of a part could be read. A report without rows has a verdict only."""
    if not part.rows:
        return part.verdict not in _UNREAD
    return any(cell.verdict not in _UNREAD for row in part.rows for cell in row.cells)


def was_read_in_full(part: PartReport) -> bool:
    """True if each cell of a part has an entry that could be read."""
    if not part.rows:
        return part.verdict not in _UNREAD
    return not any(cell.verdict in _UNREAD for row in part.rows for cell in row.cells)


def messages_of(part: PartReport) -> Iterator[tuple[Feedback, tuple[Place, ...], Verdict]]:
    """Yield the messages on a part, its rows and cells, with their places and verdicts."""
    verdicts: dict[tuple[str, str | None], Verdict] = {}
    for row in part.rows:
        verdicts[row.label, None] = row.verdict
        verdicts |= {(row.label, cell.label): cell.verdict for cell in row.cells}
    for message in part.feedback:
        places = message.places or ()
        found = [verdicts.get((place.row, place.cell), part.verdict) for place in places[:1]]
        yield message, places, found[0] if found else part.verdict
    for row in part.rows:
        yield from ((message, (Place(row.label),), row.verdict) for message in row.feedback)
        for cell in row.cells:
            at = (Place(row.label, cell.label),)
            yield from ((message, at, cell.verdict) for message in cell.feedback)


def combined(verdicts: Iterable[Verdict]) -> Verdict:
    """Return the verdict on a whole: the verdict of its pieces if all have the same verdict.

    Otherwise the whole is partial if some piece is right, else incorrect if some piece is wrong,
    else unreadable.
    """
    found = set(verdicts)
    if not found:
        return Verdict.MISSING
    if len(found) == 1:
        return found.pop()
    if found & {Verdict.CORRECT, Verdict.PARTIAL}:
        return Verdict.PARTIAL
    return Verdict.INCORRECT if Verdict.INCORRECT in found else Verdict.UNREADABLE


def rounded_points(points: float) -> float:
    """Return points without floating-point rounding errors."""
    return round(points, 6)


def row_report(
    label: str, cells: tuple[CellReport, ...], feedback: tuple[Feedback, ...] = ()
) -> RowReport:
    """Make a row from its cells, without points."""
    return RowReport(label, combined([cell.verdict for cell in cells]), 0.0, 0.0, cells, feedback)


# --- Findings: hints with corrections


# In a counterexample, what the entry gives, and the right number, which only a tutor is told.
YOURS = "yours"
EXPECTED = "expected"


@dataclass(frozen=True, slots=True)
class Finding:
    """A hint where to look, and the correction. The hint never contains the correct value."""

    # Stable, so that mistakes can be counted by their codes.
    code: str
    hint: str
    # A formula, an instruction in words, or empty.
    correction: Correction | str = ""
    severity: Severity = Severity.ERROR
    span: tuple[int, int] | None = None
    # A counterexample.
    values: dict[str, float | str] | None = None
    # True for a finding on how a text was read; it reveals nothing and is visible at every level.
    reading: bool = False
    # The repaired form of an unreadable text.
    suggestion: str | None = None
    # The rule that the hint explains.
    rule: RuleName | None = None

    def message(self, places: tuple[Place, ...] = (), *, corrects: bool) -> Feedback:
        """Return the message, with the correction only if ``corrects`` is true."""
        correction, values = self.correction or None, self.values
        if not corrects:
            correction = None
            values = values and {name: values[name] for name in values if name != EXPECTED}
        return Feedback(
            code=self.code,
            severity=self.severity,
            message=self.hint,
            places=places or None,
            span=self.span,
            suggestion=self.suggestion,
            correction=Correction(correction) if isinstance(correction, str) else correction,
            values=values,
            reading=self.reading or None,
            rule=self.rule,
        )


def reading_error(code: str, message: str, span: tuple[int, int] | None = None) -> Finding:
    """Return the finding that a text cannot be read."""
    return Finding(code, message, span=span, reading=True)


def reading_note(code: str, message: str, span: tuple[int, int] | None = None) -> Finding:
    """Return a finding on how a text was read."""
    return Finding(code, message, severity=Severity.INFO, span=span, reading=True)


class UnreadableAnswerError(Exception):
    """An answer is unreadable as a whole; ``finding`` says what is expected."""

    def __init__(self, finding: Finding) -> None:
        super().__init__(finding.hint)
        self.finding = finding


ROUNDED = Finding(
    "rounded",
    say("Accepted, but rounded. Write the exact number: a fraction, a root or a multiple of π."),
    severity=Severity.INFO,
)


# --- The messages that each feedback level shows, equal ones once


Messages = tuple[Feedback, ...]

_LEVELS_WITH_HINTS: Final = (FeedbackLevel.FULL, FeedbackLevel.HINTS)
# The note on the reading that is redundant beside the message on a slip, by the slip's code.
_NOTES_ON: Final = {"swapped_atan2": "atan2_order", "degrees_as_radians": "bare_radians"}


def parts_at_level(
    parts: Iterable[PartReport], level: FeedbackLevel, left_out: Feedback | None
) -> tuple[PartReport, ...]:
    """Return the reports on all answers with the messages of this feedback level, each once.

    ``left_out`` is the message that explanations are incomplete, or None.
    """
    # Corrections are not removed here: at lower levels, messages are made without corrections.
    has_hints = level in _LEVELS_WITH_HINTS
    visible = _with_hints if has_hints else _on_reading
    shown = [with_shared_messages(_filtered(part, visible)) for part in parts]
    if left_out is not None and has_hints:
        shown = _with_left_out(shown, left_out)
    if level is FeedbackLevel.SCORE:
        shown = [_without_rows(part) for part in shown]
    return tuple(shown)


def _filtered(part: PartReport, visible: Callable[[Messages], Messages]) -> PartReport:
    if not part.feedback and not any(map(_has_messages, part.rows)):
        return part
    rows = tuple(_filtered_row(row, visible) if _has_messages(row) else row for row in part.rows)
    return replace(part, rows=rows, feedback=visible(part.feedback))


def _has_messages(row: RowReport) -> bool:
    # Not by `any`: most rows say nothing, and most time went into its generator.
    return bool(row.feedback or [cell for cell in row.cells if cell.feedback])


def _filtered_row(row: RowReport, visible: Callable[[Messages], Messages]) -> RowReport:
    cells = tuple(
        replace(cell, feedback=visible(cell.feedback)) if cell.feedback else cell
        for cell in row.cells
    )
    return replace(row, cells=cells, feedback=visible(row.feedback))


def _with_hints(messages: Messages) -> Messages:
    needless = {_NOTES_ON[message.code] for message in messages if message.code in _NOTES_ON}
    return tuple(_unmarked(each) for each in messages if each.code not in needless)


def _on_reading(messages: Messages) -> Messages:
    return tuple(_unmarked(each) for each in messages if each.reading)


def _unmarked(message: Feedback) -> Feedback:
    return replace(message, reading=None) if message.reading else message


def _with_left_out(parts: list[PartReport], left_out: Feedback) -> list[PartReport]:
    # The first part with an unexplained cell gets the message ``left_out``.
    for i, part in enumerate(parts):
        if _has_unexplained_cells(part):
            told = replace(part, feedback=(*part.feedback, left_out))
            return [*parts[:i], told, *parts[i + 1 :]]
    return parts


def _has_unexplained_cells(part: PartReport) -> bool:
    messages = [each for each in part.feedback if each.severity is Severity.ERROR]
    if any(message.places is None for message in messages):
        return False
    told = {(place.row, place.cell) for each in messages for place in each.places or ()}
    return any(
        cell.verdict is Verdict.INCORRECT and not cell.feedback and not row.feedback
        for row in part.rows
        for cell in row.cells
        if (row.label, cell.label) not in told and (row.label, None) not in told
    )


def _without_rows(report: PartReport) -> PartReport:
    # The messages on unreadable cells stay: they reveal nothing, and students need them. Instead of
    # the points lost in each row, the report has their sum.
    reading = tuple(
        replace(message, places=(Place(row.label, cell.label),))
        for row in report.rows
        for cell in row.cells
        for message in cell.feedback
    )
    lost = without_places(report.lost) if report.rows else report.lost
    feedback = (*report.feedback, *reading)
    return replace(report, rows=(), feedback=feedback, lost=lost, little_worth=None)


# Notes that need no span: if several cells share one, it is shown once, without spans.
_WORDS_ENOUGH = frozenset({"equation", "letter_case"})

# The content of a message: its code, its sentence, the repaired text.
_Said = tuple[str, str, str | None]


def with_shared_messages(report: PartReport) -> PartReport:
    """Replace equal messages on several cells by one message on the whole answer.

    Messages are equal if they have the same code, sentence and repaired text. The first
    counterexample is kept. Most messages on a piece of the text in a cell stay with their cell.
    """
    in_cells: dict[_Said, list[tuple[Place, Feedback]]] = {}
    for row in report.rows:
        for cell in row.cells:
            for message in cell.feedback:
                if _is_shareable(message):
                    place = Place(row.label, cell.label)
                    in_cells.setdefault(_said(message), []).append((place, message))
    shared = {said: told for said, told in in_cells.items() if len(told) > 1}
    if not shared and len(report.feedback) < 2:
        return report
    rows = tuple(
        replace(row, cells=tuple(_without(cell, shared.keys()) for cell in row.cells))
        for row in report.rows
    )
    messages = (*report.feedback, *map(_together, shared.values()))
    return replace(report, rows=rows, feedback=_joined(messages))


def _is_shareable(message: Feedback) -> bool:
    return message.span is None or message.code in _WORDS_ENOUGH


def _said(message: Feedback) -> _Said:
    return message.code, message.message, message.suggestion


def _together(told: Sequence[tuple[Place, Feedback]]) -> Feedback:
    # The result has the places of all these messages.
    first = replace(told[0][1], span=None)
    if len({message.correction for _, message in told}) == 1:
        return replace(first, places=tuple(dict.fromkeys(place for place, _ in told)))
    places = tuple(replace(place, correction=message.correction) for place, message in told)
    return replace(first, places=places, correction=None)


def _without(cell: CellReport, shared: Set[_Said]) -> CellReport:
    own = tuple(m for m in cell.feedback if not _is_shareable(m) or _said(m) not in shared)
    return cell if len(own) == len(cell.feedback) else replace(cell, feedback=own)


def _joined(messages: Iterable[Feedback]) -> tuple[Feedback, ...]:
    # Equal messages become one message with all their places.
    found: dict[object, Feedback] = {}
    for i, message in enumerate(messages):
        is_placed = message.places is not None and message.span is None
        key: object = (_said(message), message.correction) if is_placed else i
        places = (*((key in found and found[key].places) or ()), *(message.places or ()))
        found[key] = replace(found.get(key, message), places=tuple(dict.fromkeys(places)) or None)
    return tuple(found.values())


# --- The sentences that say where points were lost


CELLS: Final = "cells"
WHOLE: Final = "whole"
OUTSIDE: Final = "outside_cells"
SHARED: Final = "shared_by_rows"
NO_JOINT_MOVES: Final = "no_motion"
ALL_OR_NOTHING: Final = "all_or_nothing"
NOT_READ: Final = "not_read"
NO_ANSWER: Final = "no_answer"
PART: Final = "part"

# The sentence of each code of a loss without a row, as it follows "−0.5: ".
_SENTENCES: Final = {
    WHOLE: template(
        "mistakes that run through the answer, charged once for the whole part (its rows share "
        "the loss)"
    ),
    OUTSIDE: template("an extra row, or rows that do not lead to the end effector"),
    SHARED: template(
        "mistakes that cost more than their own rows are worth (the other rows share this loss)"
    ),
    NO_JOINT_MOVES: template("no joint moves this answer"),
    ALL_OR_NOTHING: template("only a right answer earns points here"),
    NOT_READ: template("the answer cannot be read"),
    NO_ANSWER: template("no answer"),
    PART: template("somewhere in this part"),
}
# Rows that are a single thing of their own and no row of a table, by their labels.
_SINGLE: Final = {
    # Translators: what the student has marked as the mistake, after "−0.5: ".
    "marked": template("the mark"),
    # Translators: the table without the mistake, after "−0.5: ".
    "table": template("the mended table"),
}
_NAMES: Final = {"alpha": "α", "theta": "θ", "axis": say("axis")}
# A row of zeros is worth at most this share of the part.
_MOST_OF_ZEROS: Final = 0.125


def lost_points(code: str, points: float) -> LostPoints:
    """Return the points that an answer lost as a whole, not in one row."""
    return LostPoints(code, rounded_points(points), say(_SENTENCES[code]))


def without_places(lost: Sequence[LostPoints]) -> tuple[LostPoints, ...]:
    """Return lost points as one sum, without naming rows or cells."""
    return (lost_points(PART, sum(each.points for each in lost)),) if lost else ()


def lost_in_row(row: RowReport, points: float) -> LostPoints:
    """Return the points that a row lost, and its cells that are not correct."""
    cells = tuple(cell.label for cell in row.cells if cell.verdict is not Verdict.CORRECT)
    if cells == (row.label,) and row.label in _SINGLE:
        message = say(_SINGLE[row.label])
    elif 0 < len(cells) < len(row.cells):
        message = _cells_in_row(cells, row.label)
    else:
        message = say("row {row}", row=row.label)
    return LostPoints(CELLS, rounded_points(points), message, row.label, cells)


def _cells_in_row(labels: Sequence[str], row: str) -> Sentence:
    # For example "a and α in row 2" or "columns 1, 2 and 4 in row 3".
    cells = listed([_NAMES.get(label, label) for label in labels])
    if not labels[0].isdigit():
        return say("{cells} in row {row}", cells=cells, row=row)
    return say_count(
        "column {cells} in row {row}",
        "columns {cells} in row {row}",
        count=len(labels),
        cells=cells,
        row=row,
    )


def little_worth(rows: Sequence[RowReport], most: float) -> LittleWorth | None:
    """Return why correct rows of zeros earned few points, or None if there are no such rows.

    ``rows`` are the rows without a cell that needs knowledge. ``most`` is the number of points of
    the part.
    """
    found = [
        row
        for row in rows
        if row.verdict is Verdict.CORRECT and 0 < row.max_points <= _MOST_OF_ZEROS * most
    ]
    if not found:
        return None
    labels = tuple(row.label for row in found)
    message = say_count(
        "Row {rows} is worth little: zeros, and the joint variable in its usual place, need no "
        "geometry.",
        "Rows {rows} are worth little: zeros, and the joint variable in its usual place, need no "
        "geometry.",
        count=len(labels),
        rows=listed(labels),
    )
    return LittleWorth(labels, rounded_points(sum(row.max_points for row in found)), message)


# --- Limit the work for grading one submission
#
# Work is counted instead of timed, so that the same submission gives the same report.


# The pose of a seven-joint arm, multiplied out without simplification and printed as LaTeX or
# JavaScript, has up to 13,900 symbols, weighted by their cost.
MAX_SYMBOLS = 14_000
# For reading a table again with its columns in another order; an ordinary table has 300 symbols.
MAX_SYMBOLS_AGAIN = 2_400
# Searching for the repair of an unreadable text costs more than any other reading.
MAX_REPAIRS = 24
# For each of these numbers of symbols that a repair reads, it counts as one more repair.
SYMBOLS_PER_REPAIR = 100

# The characters of pasted texts that are cut into cells; the symbols in the cells are counted again
# when they are read. The longest allowed text leaves half its length for the other parts.
MAX_PASTED = 36_000
# The brackets and quotation marks in these texts, for which partners are searched. The longest pose
# has 4,100 of them.
MAX_PASTED_SIGNS = 8_000

# The unit is the least work of a grading: multiplying out six links at all samples.
MAX_EXPLANATIONS = 145.0
# Enough to judge a table with unread cells in either convention, and to search for their values.
MAX_SEARCHES = 280.0
# The limit for reading, searches and explanations together.
MAX_WORK = 285.0
# The work of reading a symbol, of cutting a pasted character into a cell, of finding the partner of
# a pasted bracket, and of a repair.
SYMBOL_WORK, PASTED_WORK, SIGN_WORK, REPAIR_WORK = 1 / 100, 1 / 800, 1 / 200, 1.5

# The MathML of the pose of a seven-joint arm has 57,000 characters. Nobody reads longer formulas.
MAX_PRINTED = 60_000

# The limit for a drawing, as a number of symbols: the table, its figure, and the printed formulas.
# Those of a seven-joint arm cost 13,700.
MAX_SYMBOLS_DRAWN = 16_000
SYMBOLS_PER_FIGURE = 2_200
SYMBOLS_PER_PRINTED_NODE = 2.5

_SIGN: Final = regex(r"""[][(){}'"]""")


@dataclass(slots=True)
class WorkBudget:
    """The work that is still allowed for one submission, with all its parts and pasted texts."""

    # The names, numbers and signs that may still be read.
    symbols: int = MAX_SYMBOLS
    # The unreadable texts for which a repair may still be searched.
    repairs: int = MAX_REPAIRS
    # The characters that may still be cut into cells.
    pasted: int = MAX_PASTED
    # The brackets and quotation marks whose partners may still be searched.
    pasted_signs: int = MAX_PASTED_SIGNS
    # The work left for explaining mistakes, on which no verdict depends.
    explanations: float = MAX_EXPLANATIONS
    # The work left for finding the intended table: values of unread cells, other column orders.
    searches: float = MAX_SEARCHES
    # The characters of formulas that a preview may still print.
    printed: int = MAX_PRINTED
    # True if an explanation was too expensive.
    has_left_out: bool = False
    # The texts that could not be read.
    unreadable: set[object] = field(default_factory=set)
    # What was found in each pasted text, by the way of reading it; each text is charged once.
    found: dict[tuple[object, ...], Any] = field(default_factory=dict)
    # What was searched for in these texts and in their pieces.
    searched: dict[tuple[object, str], Any] = field(default_factory=dict)
    _charged: set[str] = field(default_factory=set)
    # The whole submission; the work for reading its later parts is reserved.
    answers: object = None
    _expected: int = -1

    @classmethod
    def of_drawing(cls, *, with_figure: bool) -> Self:
        """Return the budget for drawing the frames, formulas and figure of a table."""
        return cls(MAX_SYMBOLS_DRAWN - (SYMBOLS_PER_FIGURE if with_figure else 0))

    @property
    def left(self) -> float:
        """The work left for explanations.

        It is the total work minus that of searches and of reading, including the later parts.
        """
        if self._expected < 0:
            self._expected = _symbols_of(self.answers)
        read = (
            SYMBOL_WORK * max(MAX_SYMBOLS - max(self.symbols, 0), self._expected)
            + PASTED_WORK * (MAX_PASTED - max(self.pasted, 0))
            + SIGN_WORK * (MAX_PASTED_SIGNS - max(self.pasted_signs, 0))
            + REPAIR_WORK * (MAX_REPAIRS - max(self.repairs, 0))
        )
        return MAX_WORK - read - (MAX_SEARCHES - self.searches)

    def affords(self, work: float) -> bool:
        """Charge ``work`` for an explanation; return True if enough work was left.

        The work is also taken if too little is left.
        """
        checkpoint()
        self.explanations -= work
        left = min(self.explanations, self.left - (MAX_EXPLANATIONS - self.explanations))
        self.has_left_out |= left < 0
        return left >= 0

    def affords_search(self, work: float) -> bool:
        """Charge ``work`` for a search if enough is left; return True if it was charged.

        The result does not depend on earlier explanations.
        """
        is_afforded = work <= min(self.searches, self.left)
        if is_afforded:
            self.charge_search(work)
        return is_afforded

    def charge_search(self, work: float) -> None:
        """Charge the work of a necessary search, even if not enough is left."""
        checkpoint()
        self.searches -= work

    def charge_reading(self, symbols: int) -> bool:
        """Charge the reading of a text; return True if it may be read."""
        self.symbols -= symbols
        return self.symbols >= 0

    def charge_pasted(self, text: str) -> bool:
        """Charge the cutting of a pasted text, only once; return True if it may be cut."""
        checkpoint()
        if text not in self._charged:
            self._charged.add(text)
            self.pasted -= len(text)
            self.pasted_signs -= len(_SIGN.findall(text))
        return self.pasted >= 0 and self.pasted_signs >= 0

    def charge_printing(self, nodes: int) -> bool:
        """Charge the printing of a formula of ``nodes``; return True if it may be printed."""
        return self.charge_reading(math.ceil(SYMBOLS_PER_PRINTED_NODE * nodes))

    def charge_repair(self, text: object, tried: int) -> None:
        """Charge the repair of an unreadable text, only once for each text.

        ``tried`` is the number of symbols that were read for the repair.
        """
        if text not in self.unreadable:
            self.unreadable.add(text)
            self.repairs -= 1 + tried // SYMBOLS_PER_REPAIR


def _symbols_of(answer: object) -> int:
    found, waiting = 0, [answer]
    # No recursion, because lists may be nested deeper than Python's call stack.
    while waiting and found < MAX_SYMBOLS:
        match waiting.pop():
            # Longer texts are never read.
            case str() as text if len(text) <= GRID_LIMITS.characters:
                found += reading_cost(text)
            case Mapping() as fields:
                waiting.extend(fields.values())
            case list() as items:
                waiting.extend(items)
    return min(found, MAX_SYMBOLS)
