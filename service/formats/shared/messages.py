"""The messages of a report as text: their places, corrections and counterexamples."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from service.formats.shared.plain_text import number, visible
from service.grading import (
    Correction,
    Feedback,
    PartReport,
    Place,
    RowReport,
    Severity,
    Verdict,
)
from service.grading.feedback import EXPECTED, YOURS
from service.grading.lost_points import NO_ANSWER, NOT_READ
from service.grading.report import messages_of

# The sign of each verdict.
SIGNS: Final[Mapping[Verdict, str]] = {
    Verdict.CORRECT: "✓",
    Verdict.PARTIAL: "~",
    Verdict.INCORRECT: "✗",
    Verdict.UNREADABLE: "?",
    Verdict.MISSING: "–",
}


@dataclass(frozen=True, slots=True)
class Message:
    """A message as visible texts of one line each.

    ``places`` names the rows and cells, ``text`` is the message itself, ``offers`` says what to
    write instead, and ``example`` is a counterexample; all but ``text`` may be empty. ``verdict``
    is the verdict on the place.
    """

    severity: Severity
    verdict: Verdict
    places: str
    text: str
    offers: str
    example: str

    @property
    def label(self) -> str:
        """Return the sign of the verdict for an error, otherwise the severity."""
        return SIGNS[self.verdict] if self.severity is Severity.ERROR else self.severity.value

    @property
    def line(self) -> str:
        """Return the whole message in one line, such as ``row 2 alpha: …``."""
        pieces = (f"{self.places}:" if self.places else "", self.text, self.offers, self.example)
        return " ".join(filter(None, pieces))


def messages(part: PartReport) -> Iterator[Message]:
    """Yield the messages on a part, its rows and its cells."""
    if part.verdict is Verdict.MISSING and not part.feedback and not part.rows:
        nothing = Feedback("missing", Severity.ERROR, "Nothing was handed in.")
        yield _message(nothing, (), Verdict.MISSING, ())
    for feedback, places, verdict in messages_of(part):
        yield _message(feedback, places, verdict, part.rows)


def marks(part: PartReport, weight: float = 1.0) -> list[str]:
    """Return a line with the lost points and their places, such as ``−0.5: α in row 2``.

    A second line says why a row of zeros earned little. A message already says that an answer is
    missing or cannot be read.
    """
    lost = [
        f"−{number(each.points * weight)}: {each.message}"
        for each in part.lost
        if each.code not in (NO_ANSWER, NOT_READ)
    ]
    notes = [part.little_worth.message] if part.little_worth else []
    return [visible(line) for line in filter(None, ["; ".join(lost), *notes])]


def _message(
    feedback: Feedback, places: Iterable[Place], verdict: Verdict, rows: Sequence[RowReport]
) -> Message:
    offers = filter(None, (_suggestion(feedback), _correction(feedback, rows)))
    return Message(
        severity=feedback.severity,
        verdict=verdict,
        places=visible(places_in_words(places, rows)),
        text=visible(feedback.message),
        offers=visible(" ".join(offers)),
        example=_counterexample(feedback.values) if feedback.values else "",
    )


def places_in_words(places: Iterable[Place], rows: Sequence[RowReport] = ()) -> str:
    """Return places in words, such as ``row 1 d, theta; rows 2, 3``.

    ``rows`` are the rows of the part. If the places include all cells of a row, only the row is
    named.
    """
    complete = {row.label: [cell.label for cell in row.cells] for row in rows}
    cells: dict[str, list[str]] = {}
    for place in places:
        named = cells.setdefault(place.row, [])
        if place.cell is not None:
            named.append(place.cell)
    alike: dict[tuple[str, ...], list[str]] = {}
    for row, named in cells.items():
        columns = () if len(named) > 1 and named == complete.get(row) else tuple(named)
        alike.setdefault(columns, []).append(row)
    return "; ".join(
        f"row{'s' if len(labels) > 1 else ''} {', '.join(labels)}{_columns(columns)}"
        for columns, labels in alike.items()
    )


def _columns(labels: Sequence[str]) -> str:
    if not labels:
        return ""
    noun = "" if not labels[0].isdigit() else "column " if len(labels) == 1 else "columns "
    return f" {noun}{', '.join(labels)}"


def _suggestion(feedback: Feedback) -> str:
    """Return a question that offers the repaired text, unless the message already asks it."""
    question = f"Did you mean {feedback.suggestion}?"
    return "" if feedback.suggestion is None or question in feedback.message else question


def _correction(feedback: Feedback, rows: Sequence[RowReport]) -> str:
    """Return the correction of a message, and the corrections of its places, in sentences."""
    found = [] if feedback.correction is None else [_told(feedback.correction)]
    at: dict[Correction, list[Place]] = {}
    for place in feedback.places or ():
        if place.correction is not None:
            at.setdefault(place.correction, []).append(place)
    told = [
        f"{places_in_words(places, rows)}: {_told(correction)}" for correction, places in at.items()
    ]
    return " ".join([*found, *told])


def _told(correction: Correction) -> str:
    return correction.text if correction.latex is None else f"It should be {correction.text}."


def _counterexample(values: Mapping[str, float | str]) -> str:
    """Return ``(with q1 = 0.4, yours gives 1.2, not 0.9)`` from the values of one sample."""
    given = [f"{name} = {value}" for name, value in values.items() if name not in (YOURS, EXPECTED)]
    at = f"with {', '.join(given)}" if given else ""
    yours = f"yours gives {values[YOURS]}" if YOURS in values else ""
    right = f"not {values[EXPECTED]}" if EXPECTED in values else ""
    return visible(f"({', '.join(filter(None, [at, yours, right]))})")
