"""The messages of a report as text: their places, corrections and counterexamples."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from itertools import chain, groupby
from typing import Final

from service.formats.shared.graded import GradedSubmission
from service.formats.shared.plain_text import number, percent, points, visible
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
from service.translations import Sentence, paragraph, say, say_count, told
from service.translations.sentence import Translation

# The sign of each verdict.
SIGNS: Final[Mapping[Verdict, str]] = {
    Verdict.CORRECT: "✓",
    Verdict.PARTIAL: "~",
    Verdict.INCORRECT: "✗",
    Verdict.UNREADABLE: "?",
    Verdict.MISSING: "–",
}

# The names of verdicts and severities in reports.
VERDICT_NAMES: Final[Mapping[Verdict, str]] = {
    Verdict.CORRECT: say("correct"),
    Verdict.PARTIAL: say("partial"),
    Verdict.INCORRECT: say("incorrect"),
    Verdict.UNREADABLE: say("unreadable"),
    Verdict.MISSING: say("missing"),
}
PASSED: Final = say("Passed")
NOT_PASSED: Final = say("Not passed")
NOT_GRADED: Final = say("Not graded")
# The headings of the first and the last column of a table.
ROW: Final = say("row")
POINTS: Final = say("points")
_SEVERITY_NAMES: Final[Mapping[Severity, str]] = {
    Severity.WARNING: say("warning"),
    Severity.HINT: say("hint"),
    Severity.INFO: say("info"),
}

_RESULTS: Final = (YOURS, EXPECTED)

# A message, its places, and the verdict there.
_Placed = tuple[Feedback, tuple[Place, ...], Verdict]


@dataclass(frozen=True, slots=True)
class Message:
    """A message in the parts that a reader sees; each part is one line of text."""

    severity: Severity
    # The verdict on the place of the message.
    verdict: Verdict
    # For an error, the sign of the verdict; otherwise the name of the severity.
    label: str
    # The rows and cells; may be empty.
    places: str
    text: str
    # What to write instead; may be empty.
    offers: str
    # A counterexample; may be empty.
    example: str

    @property
    def line(self) -> str:
        """Return the whole message in one line, such as ``row 2 alpha: …``."""
        pieces = (f"{self.places}:" if self.places else "", self.text, self.offers, self.example)
        return " ".join(filter(None, pieces))


def total_points(submission: GradedSubmission) -> str:
    """Return the points and the score of a submission as a sentence."""
    return say(
        "{points} points, {score}.",
        points=points(submission.points, submission.max_points),
        score=percent(submission.score),
    )


def messages(part: PartReport, translation: Translation | None = None) -> Iterator[Message]:
    """Yield the messages on a part, its rows and its cells, in a language; None is English."""
    if part.verdict is Verdict.MISSING and not part.feedback and not part.rows:
        nothing = Feedback("missing", Severity.ERROR, say("Nothing was handed in."))
        yield _message(nothing, (), Verdict.MISSING, (), translation)
    for feedback, places, verdict in _once_for_each_row(messages_of(part)):
        yield _message(feedback, places, verdict, part.rows, translation)


def _once_for_each_row(found: Iterable[_Placed]) -> Iterator[_Placed]:
    # If neighbouring cells of a row have the same message, tell it once.
    def same(each: _Placed) -> object:
        feedback, places, verdict = each
        is_on_a_cell = len(places) == 1 and places[0].cell is not None
        return feedback, verdict, places[0].row if is_on_a_cell else places

    for _, group in groupby(found, same):
        first, *more = group
        feedback, places, verdict = first
        yield feedback, (*places, *chain.from_iterable(each[1] for each in more)), verdict


def marks(
    part: PartReport, weight: float = 1.0, translation: Translation | None = None
) -> list[str]:
    """Return lines about lost points and their places, such as ``−0.5: α in row 2``."""
    lost = [
        f"−{number(each.points * weight)}: {told(each.message, translation)}"
        for each in part.lost
        # A message already reports missing and unreadable answers.
        if each.code not in (NO_ANSWER, NOT_READ)
    ]
    notes = [told(part.little_worth.message, translation)] if part.little_worth else []
    return [visible(line) for line in filter(None, ["; ".join(lost), *notes])]


def _message(
    feedback: Feedback,
    places: Iterable[Place],
    verdict: Verdict,
    rows: Sequence[RowReport],
    translation: Translation | None,
) -> Message:
    text = told(feedback.message, translation)
    question = told(_suggestion(feedback), translation)
    # A message may already ask whether the repaired text was meant.
    offers = paragraph("" if question in text else question, _correction(feedback, rows))
    return Message(
        severity=feedback.severity,
        verdict=verdict,
        label=told(_SEVERITY_NAMES.get(feedback.severity, SIGNS[verdict]), translation),
        places=visible(told(places_in_words(places, rows), translation)),
        text=visible(text),
        offers=visible(told(offers, translation)),
        example=visible(told(_counterexample(feedback.values or {}), translation)),
    )


def places_in_words(places: Iterable[Place], rows: Sequence[RowReport] = ()) -> str:
    """Return places in words, such as ``row 1 d, theta; rows 2, 3``.

    ``rows`` are the rows of the part.
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
    said = [_rows_and_columns(labels, columns) for columns, labels in alike.items()]
    if not said:
        return ""
    return reduce(lambda one, other: say("{one}; {other}", one=one, other=other), said)


def _rows_and_columns(rows: Sequence[str], columns: Sequence[str]) -> Sentence:
    named = ", ".join(rows)
    if not columns:
        return say_count("row {rows}", "rows {rows}", count=len(rows), rows=named)
    # Translators: {columns} is a list of names, or such as "columns 1, 3".
    return say_count(
        "row {rows} {columns}",
        "rows {rows} {columns}",
        count=len(rows),
        rows=named,
        columns=_columns(columns),
    )


def _columns(labels: Sequence[str]) -> str:
    named = ", ".join(labels)
    if not labels[0].isdigit():
        return named
    return say_count("column {columns}", "columns {columns}", count=len(labels), columns=named)


def _suggestion(feedback: Feedback) -> str:
    if feedback.suggestion is None:
        return ""
    return say("Did you mean {suggestion}?", suggestion=feedback.suggestion)


def _correction(feedback: Feedback, rows: Sequence[RowReport]) -> str:
    found = [] if feedback.correction is None else [_in_words(feedback.correction)]
    at: dict[Correction, list[Place]] = {}
    for place in feedback.places or ():
        if place.correction is not None:
            at.setdefault(place.correction, []).append(place)
    placed = [
        say(
            "{places}: {correction}",
            places=places_in_words(places, rows),
            correction=_in_words(correction),
        )
        for correction, places in at.items()
    ]
    return paragraph(*found, *placed)


def _in_words(correction: Correction) -> str:
    if correction.latex is None:
        return correction.text
    return say("It should be {formula}.", formula=correction.text)


def _counterexample(values: Mapping[str, float | str]) -> str:
    at = ", ".join(f"{name} = {value}" for name, value in values.items() if name not in _RESULTS)
    yours, right = str(values.get(YOURS, "")), str(values.get(EXPECTED, ""))
    if not yours:
        return say("(with {values})", values=at) if at else ""
    if not right:
        if not at:
            return say("(yours gives {yours})", yours=yours)
        return say("(with {values}, yours gives {yours})", values=at, yours=yours)
    if not at:
        return say("(yours gives {yours}, not {right})", yours=yours, right=right)
    return say(
        "(with {values}, yours gives {yours}, not {right})", values=at, yours=yours, right=right
    )
