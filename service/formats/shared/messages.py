"""The messages of a report in words: the places, what to do, and a counterexample."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from service.formats.shared.plain_text import visible
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
    """One message in words. All texts are visible ones, in one line.

    ``places`` are the rows and cells in few words, ``text`` is the message itself, ``offers`` what
    to write instead, ``example`` a counterexample; the latter may be empty. ``verdict`` is that on
    the place.
    """

    severity: Severity
    verdict: Verdict
    places: str
    text: str
    offers: str
    example: str

    @property
    def label(self) -> str:
        """The sign of the verdict for a message that costs points, else the severity in words."""
        return SIGNS[self.verdict] if self.severity is Severity.ERROR else self.severity.value

    @property
    def line(self) -> str:
        """All of it in one line, ``row 2 alpha: …`` for example."""
        pieces = (f"{self.places}:" if self.places else "", self.text, self.offers, self.example)
        return " ".join(filter(None, pieces))


def messages(part: PartReport) -> Iterator[Message]:
    """The messages on a part, its rows and cells."""
    if part.verdict is Verdict.MISSING and not part.feedback and not part.rows:
        nothing = Feedback("missing", Severity.ERROR, "Nothing was handed in.")
        yield _message(nothing, (), Verdict.MISSING, ())
    for feedback, places, verdict in messages_of(part):
        yield _message(feedback, places, verdict, part.rows)


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
    """The places in few words: ``row 1 d, theta; rows 2, 3``.

    Of ``rows`` all the cells are known, so that a whole one is not told cell by cell.
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
    """The repaired text as a question, unless the message asks it itself."""
    question = f"Did you mean {feedback.suggestion}?"
    return "" if feedback.suggestion is None or question in feedback.message else question


def _correction(feedback: Feedback, rows: Sequence[RowReport]) -> str:
    """The instruction, or the right entry in a sentence: the one, or one for each place."""
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
    """``(with q1 = 0.4, yours gives 1.2, not 0.9)``, from the values of one sample."""
    given = [f"{name} = {value}" for name, value in values.items() if name not in (YOURS, EXPECTED)]
    at = f"with {', '.join(given)}" if given else ""
    yours = f"yours gives {values[YOURS]}" if YOURS in values else ""
    right = f"not {values[EXPECTED]}" if EXPECTED in values else ""
    return visible(f"({', '.join(filter(None, [at, yours, right]))})")
