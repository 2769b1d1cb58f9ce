"""Findings (hints with corrections), and the messages that each feedback level shows."""

from collections.abc import Callable, Iterable, Sequence, Set
from dataclasses import dataclass, replace
from typing import Final

from service.catalogue import FeedbackLevel
from service.grading.lost_points import without_places
from service.grading.report import (
    CellReport,
    Correction,
    Feedback,
    PartReport,
    Place,
    RowReport,
    RuleName,
    Severity,
    Verdict,
)
from service.translations import say

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


Messages = tuple[Feedback, ...]

_LEVELS_WITH_HINTS: Final = (FeedbackLevel.FULL, FeedbackLevel.HINTS)
# The note on the reading that is redundant beside the message on a slip, by the slip's code.
_NOTES_ON: Final = {"swapped_atan2": "atan2_order", "degrees_as_radians": "bare_radians"}


def parts_at_level(
    parts: Iterable[PartReport], level: FeedbackLevel, left_out: Feedback | None
) -> tuple[PartReport, ...]:
    """Return the reports on all answers with the messages that this feedback level shows."""
    # Without repetitions. left_out is the message that explanations are incomplete, or None.
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
    # The first part with an unexplained cell gets the message left_out.
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
    """Replace equal messages on several cells by one message on the whole answer."""
    # Messages are equal if they have the same code, sentence and repaired text. The first
    # counterexample is kept. Most messages on a piece of the text in a cell stay with their cell.
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
