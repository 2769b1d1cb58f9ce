"""What is recorded of an attempt, what counts, and what may go wrong.

Nothing here loads a database driver, so a service without a database needs none; the other files of
this package do.
"""

import hashlib
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from datetime import datetime
from enum import StrEnum
from functools import cached_property
from typing import Any, Final

from pydantic import ValidationError

from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.catalogue.schema_fields import AttemptsSpec
from dh_grader.formats.documents import read_report, rendered
from dh_grader.formats.graded import with_texts
from dh_grader.grading import GradedAnswers, Report, graded_answers
from dh_grader.grading.report import PartReport
from dh_grader.submissions.bodies import GradeRequest
from dh_grader.translations import Language, Sentence, say, say_count, told

# --- Whether an attempt is taken, and what its points are worth


class AttemptRefusedError(Exception):
    """The attempt is refused. The message is for the learner; ``name`` identifies the reason."""

    def __init__(self, name: str, message: str) -> None:
        self.name = name
        super().__init__(message)


@dataclass(frozen=True, slots=True)
class Ruling:
    """An accepted attempt: its number (1, 2, …), and the factor ``worth`` for its points.

    The factor is 1 for an attempt in time, and less for a late attempt.
    """

    ordinal: int
    is_late: bool
    worth: float


def ruling(rules: AttemptsSpec, counted: int, now: datetime) -> Ruling:
    """Return the number and the factor of a learner's next attempt.

    ``counted`` is the number of attempts that the learner has used. Raises AttemptRefusedError.
    """
    if rules.opens is not None and now < rules.opens:
        opens = say("This exercise opens on {moment}.", moment=_formatted(rules.opens))
        raise AttemptRefusedError("not-open", opens)
    is_late = rules.due is not None and now > rules.due
    end = rules.closes or rules.due
    if end is not None and now > end:
        closed = say("This exercise was closed on {moment}.", moment=_formatted(end))
        raise AttemptRefusedError("closed", closed)
    if rules.limit is not None and counted >= rules.limit:
        used = say_count(
            "No attempt is left: the attempt is used up.",
            "No attempt is left: the {count} attempts are used up.",
            count=rules.limit,
        )
        raise AttemptRefusedError("no-attempts-left", used)
    return Ruling(counted + 1, is_late, rules.late_worth if is_late else 1.0)


def points_after(points: float, max_points: float, hint_price: float, worth: float) -> float:
    """Return the points after deductions for hints and for lateness."""
    return round(max(0.0, points - hint_points(hint_price, max_points)) * worth, 6)


def hint_points(price: float, max_points: float) -> float:
    """Return the points that hints cost, at most ``max_points``.

    ``price`` is the price of the hints as a fraction of ``max_points``.
    """
    return round(min(price, 1.0) * max_points, 6)


def _formatted(moment: datetime) -> str:
    return moment.strftime("%Y-%m-%d at %H:%M %Z").rstrip()


# --- Data classes for new, recorded and listed attempts, and for filters of attempts


MOST_ON_A_PAGE: Final = 100


class GradesFormat(StrEnum):
    """The formats of exported attempts: all attempts, or a gradebook of those that count."""

    CSV = "csv"
    JSONL = "jsonl"
    CANVAS = "canvas"
    MOODLE = "moodle"

    @property
    def is_gradebook(self) -> bool:
        """True if the format is a gradebook, which has the points of one exercise only."""
        return self in (GradesFormat.CANVAS, GradesFormat.MOODLE)


@dataclass(frozen=True, slots=True)
class NewAttempt:
    """An attempt to be recorded; ``submission`` and ``report`` are JSON."""

    exercise: str
    learner: str
    # The attempt's number among the learner's counted attempts at the exercise; None if it does not
    # count.
    ordinal: int | None
    at: datetime
    is_late: bool
    worth: float
    submission: str
    answers_digest: str
    report: str
    version: str
    grader: str
    points: float
    max_points: float
    # The client that sent the attempt; idempotency keys are unique for each owner.
    owner: str
    idempotency_key: str | None
    request_digest: str
    # The number of an assignment of a course.
    assignment: int | None = field(default=None, kw_only=True)
    # The seed of a variant of the exercise.
    variant: str | None = field(default=None, kw_only=True)
    # The price of all hints that the learner has taken, as a share of the maximum points.
    hint_price: float = field(default=0.0, kw_only=True)


@dataclass(frozen=True, slots=True)
class RecordedAttempt(NewAttempt):
    """An attempt in the database."""

    number: int
    id: str

    @property
    def hint_points(self) -> float | None:
        """The points lost by hints taken before the attempt, or None."""
        return hint_points(self.hint_price, self.max_points) or None


@dataclass(frozen=True, slots=True)
class Standing:
    """A summary of a learner's attempts at an exercise, read just before a new attempt."""

    # The attempts that count towards the limit: those in the assignment or, without an assignment,
    # those outside of all assignments.
    counted: int
    # The attempt that was already recorded under the same idempotency key.
    earlier: RecordedAttempt | None
    # The highest ``ordinal`` of all attempts.
    last: int = 0
    # The price of all hints taken so far, as a share of the points.
    hint_price: float = 0.0


@dataclass(frozen=True, slots=True)
class AttemptFilter:
    """Conditions that select attempts; None means no condition."""

    # The id of an exercise, which selects all its variants, or the id of one variant.
    exercise: str | None = None
    learner: str | None = None
    # Inclusive; ``until`` is exclusive.
    since: datetime | None = None
    until: datetime | None = None
    counted: bool | None = None
    course: str | None = None
    # The id of an assignment of ``course``.
    assignment: str | None = None


@dataclass(frozen=True, slots=True)
class ListedAttempt:
    """An attempt without its answers and its report; ``awarded`` are points given by a tutor."""

    number: int
    id: str
    exercise: str
    learner: str
    ordinal: int | None
    at: datetime
    is_late: bool
    points: float
    max_points: float
    awarded: float | None
    version: str
    grader: str
    variant: str | None = None
    hint_price: float = 0.0

    @property
    def hint_points(self) -> float | None:
        """The points lost by hints taken before the attempt, or None."""
        return hint_points(self.hint_price, self.max_points) or None

    @property
    def earned(self) -> float:
        """The points that count: points given by a tutor, or else the points of the report."""
        return self.points if self.awarded is None else self.awarded


# --- The outcome of a report: verdicts and message codes, without the answers


@dataclass(frozen=True)
class Outcome:
    """The verdicts and message codes of one report, as JSON in ``content``."""

    exercise: str
    content: str

    @cached_property
    def digest(self) -> str:
        """The SHA-256 of the content; equal outcomes have equal digests."""
        return hashlib.sha256(self.content.encode()).hexdigest()


def outcome_of(report: Report) -> Outcome:
    """Return the verdicts and message codes of a report.

    The feedback level of the report must be higher than ``score``.
    """
    content = {part.part: _part(part) for part in report.parts}
    return Outcome(report.exercise.partition("~")[0], json.dumps(content, separators=(",", ":")))


def _part(part: PartReport) -> dict[str, object]:
    cells = {
        f"{row.label}/{cell.label}": str(cell.verdict) for row in part.rows for cell in row.cells
    }
    messages = [
        *part.feedback,
        *(message for row in part.rows for message in row.feedback),
        *(message for row in part.rows for cell in row.cells for message in cell.feedback),
    ]
    codes = sorted({message.code for message in messages if message.severity != "info"})
    return {"verdict": str(part.verdict), "cells": cells, "codes": codes}


# --- Grade an attempt: the report for the learner, and the outcome for statistics


@dataclass(frozen=True, slots=True)
class AttemptReport:
    """A report, its JSON, and its outcome (verdicts and message codes) for statistics."""

    report: Report
    text: str
    outcome: Outcome


class AttemptGrading:
    """Grades the answers of one request, and makes reports at different feedback levels."""

    def __init__(self, exercise: Exercise, body: GradeRequest) -> None:
        self._exercise = exercise
        self._body = body
        self._graded: dict[FeedbackLevel, GradedAnswers] = {}
        self._reports: dict[FeedbackLevel, AttemptReport] = {}

    def has(self, most: FeedbackLevel) -> bool:
        """True if ``at(most)`` can return the report without grading again."""
        return _grading_level(self._level(most)) in self._graded

    def at(self, most: FeedbackLevel) -> AttemptReport:
        """Return the report at the requested feedback level, or at ``most`` if that is lower."""
        level = self._level(most)
        if level not in self._reports:
            self._reports[level] = self._report(most, level)
        return self._reports[level]

    def _report(self, most: FeedbackLevel, level: FeedbackLevel) -> AttemptReport:
        # The outcome needs rows, which the report at level ``score`` does not have.
        enough = _grading_level(level)
        if enough not in self._graded:
            submission = replace(self._body.submission(most), feedback=enough)
            self._graded[enough] = graded_answers(self._exercise, submission)
        graded = self._graded[enough]
        report = graded.report(enough)
        outcome = outcome_of(report)
        shown = report if level is enough else graded.report(level)
        return AttemptReport(shown, recorded_report(shown), outcome)

    def _level(self, most: FeedbackLevel) -> FeedbackLevel:
        return self._body.submission(most).feedback


def _grading_level(level: FeedbackLevel) -> FeedbackLevel:
    return FeedbackLevel.FULL if level is FeedbackLevel.FULL else FeedbackLevel.HINTS


# --- Recorded reports: JSON in English, with the sentences that can be translated
#
# A recorded report begins with ``sentences``, a list of templates with their values. The rest is
# the report as it was sent.


_START: Final = '{"sentences":'
_BRACES: Final = frozenset("{}")
_DECODER: Final = json.JSONDecoder()


def recorded_report(report: Report) -> str:
    """Return a report as JSON for the database, with its translatable sentences."""
    text = rendered(report).decode()
    found: dict[str, Sentence] = {}

    def collect(text: str) -> str:
        if isinstance(text, Sentence):
            found[text] = text
        return text

    with_texts(report, collect)
    if not found:
        return text
    kept = [_written(each) for each in found.values() if each.values or _BRACES & set(each)]
    listed = json.dumps(kept, ensure_ascii=False, separators=(",", ":"))
    return f"{_START}{listed},{text[1:]}"


def shown_report(recorded: str, language: Language) -> str:
    """Return a recorded report as JSON in a language."""
    sentences, text = _divided(recorded)
    translation = language.translation
    if translation is None or sentences is None:
        return text
    known = _known(sentences)
    try:
        report = read_report(text.encode())
    except ValidationError:
        # A report of another version may have another shape.
        return text
    return rendered(with_texts(report, lambda each: told(known(each), translation))).decode()


def sentence_in(report: Mapping[str, Any], text: str) -> str:
    """Find the sentence that has this English text in a recorded report."""
    sentences = report.get("sentences")
    return text if sentences is None else _known(sentences)(text)


def _divided(recorded: str) -> tuple[list[Any] | None, str]:
    if not recorded.startswith(_START):
        return None, recorded
    sentences, end = _DECODER.raw_decode(recorded, len(_START))
    return sentences, "{" + recorded[end + 1 :]


def _known(sentences: list[Any]) -> Callable[[str], str]:
    known = {str(each): each for each in map(_read, sentences)}

    def sentence(text: str) -> str:
        if text in known or not text or _BRACES & set(text):
            return known.get(text, text)
        return Sentence(text)

    return sentence


def _written(sentence: Sentence) -> list[Any]:
    values = {
        name: _written(value) if isinstance(value, Sentence) else value
        for name, value in sentence.values.items()
    }
    return [sentence.template, values, *filter(None, [sentence.plural])]


def _read(written: list[Any]) -> Sentence:
    template, values, *plural = written
    read = {
        name: _read(value) if isinstance(value, list) else value for name, value in values.items()
    }
    return Sentence(template, read, *plural)


# --- The errors that the store of attempts raises


class StoreDownError(Exception):
    """The database cannot be reached, cannot write, or does not respond.

    Nothing was written, unless only the database's reply to a commit was lost.
    """


class UnusableDatabaseError(Exception):
    """The database at this URL cannot be used; the message says why."""


class UnknownAttemptError(LookupError):
    """No attempt has this id."""


class UnusablePointsError(ValueError):
    """The number of points is not allowed; the message says why."""


class BadCursorError(ValueError):
    """The text is not a valid cursor."""
