"""Recorded attempts: rules of dates, limits and deductions, reports, hints, exactly once."""

import hashlib
import json
import secrets
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime
from enum import StrEnum
from functools import cached_property
from typing import Any, Final

from pydantic import ValidationError
from sqlalchemy import (
    ColumnElement,
    Connection,
    Row,
    Select,
    Table,
    and_,
    bindparam,
    delete,
    exists,
    false,
    func,
    insert,
    select,
    update,
)
from sqlalchemy.dialects import postgresql, sqlite

from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.catalogue.schema_fields import AttemptsSpec
from dh_grader.contract import HintFigures, TakenHint
from dh_grader.formats.documents import read_report, rendered
from dh_grader.formats.graded import with_texts
from dh_grader.grading import GradedAnswers, Report, graded_answers
from dh_grader.grading.report import PartReport
from dh_grader.store.database import Priority, queue_score
from dh_grader.store.tables import assignments, attempts, hints, line_items, outcomes
from dh_grader.submissions.bodies import GradeRequest
from dh_grader.translations import Language, Sentence, say, say_count, told

# --- The rules for attempts: dates, the limit, and deductions for lateness and for hints


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


def _formatted(moment: datetime) -> str:
    return moment.strftime("%Y-%m-%d at %H:%M %Z").rstrip()


# --- Database functions for the hints that learners take at recorded attempts
#
# A hint explains a message of a report. Its price reduces the points of the learner's later
# attempts at the exercise.


# What the learner's hints cost the next attempt, as a share of its points: a part of a statement
# that runs at every hand-in.
PRICE: Final = (
    select(func.coalesce(func.sum(hints.c.price), 0.0))
    .join_from(hints, attempts)
    .where(
        attempts.c.exercise == bindparam("exercise"),
        attempts.c.learner == bindparam("learner"),
        attempts.c.assignment.is_not_distinct_from(bindparam("assignment")),
    )
    .correlate(None)
    .scalar_subquery()
)
_TAKEN: Final = select(hints, attempts.c.id.label("attempt_id")).join_from(hints, attempts)


class HintRefusedError(Exception):
    """The hint is refused. The message is for the learner; ``name`` identifies the reason."""

    def __init__(self, name: str, message: str) -> None:
        self.name = name
        super().__init__(message)


@dataclass(frozen=True, slots=True)
class HintStepOf:
    """One step (sentence) of the hint for a message of a report."""

    part: str
    code: str
    # The place of the message; "" if the message is not about a row or a cell.
    row: str
    cell: str
    step: int


def attempt_with_course(connection: Connection, attempt_id: str) -> Row[Any] | None:
    """Return an attempt with the ids of its course and assignment, if any; None if unknown."""
    # PostgreSQL raises an error for some characters.
    if not attempt_id.isalnum():
        return None
    return connection.execute(
        select(
            attempts,
            assignments.c.course,
            assignments.c.choices,
            assignments.c.id.label("in_assignment"),
        )
        .join_from(attempts, assignments, isouter=True)
        .where(attempts.c.id == attempt_id)
    ).one_or_none()


def take(
    connection: Connection,
    attempt_id: str,
    wanted: HintStepOf,
    prices: Sequence[float],
    now: datetime,
) -> HintRefusedError | None:
    """Record that a learner took one step of a hint. Return an error if the step is refused."""
    # Two requests for the same step wait for each other.
    attempt = connection.execute(
        select(attempts).where(attempts.c.id == attempt_id).with_for_update()
    ).one()
    refused, is_taken = _ruling(connection, attempt, wanted)
    if refused is not None or is_taken:
        return refused
    values: dict[str, Any] = {name: getattr(wanted, name) for name in HintStepOf.__slots__}
    values |= {"attempt": attempt.number, "price": prices[wanted.step - 1], "at": now}
    connection.execute(insert(hints).values(values))
    return None


def hint_refusal(
    connection: Connection, attempt: Row[Any], wanted: HintStepOf
) -> HintRefusedError | None:
    """Return the error if this step of a hint is refused now, else None. Record nothing."""
    return _ruling(connection, attempt, wanted)[0]


def _ruling(
    connection: Connection, attempt: Row[Any], wanted: HintStepOf
) -> tuple[HintRefusedError | None, bool]:
    # The second value is True if the learner has taken the step before.
    # Steps are counted for each cell, row or part: another message there does not start them again.
    earlier = connection.execute(
        select(hints.c.step, hints.c.attempt, attempts.c.answers_digest)
        .join_from(hints, attempts)
        .where(
            _same_place(attempt),
            *(hints.c[name] == getattr(wanted, name) for name in ("part", "row", "cell")),
        )
        .order_by(hints.c.step)
    ).all()
    if wanted.step <= len(earlier):
        return None, True
    # Errors are not raised, because that would roll back other jobs of the transaction.
    if wanted.step > len(earlier) + 1:
        first = say("Take the earlier steps of this hint first.")
        return HintRefusedError("earlier-step-first", first), False
    if earlier and (
        earlier[-1].attempt >= attempt.number
        or earlier[-1].answers_digest == attempt.answers_digest
    ):
        change = say("Change your answer and hand it in again. Then the next hint opens.")
        return HintRefusedError("try-first", change), False
    return None, False


def hints_before(connection: Connection, attempt_id: str) -> list[TakenHint]:
    """Return the hints that the learner had taken before an attempt, oldest first."""
    attempt = connection.execute(select(attempts).where(attempts.c.id == attempt_id)).one()
    earlier = _TAKEN.where(
        _same_place(attempt), hints.c.attempt < attempt.number, hints.c.at <= attempt.at
    )
    return [_taken(row) for row in connection.execute(earlier.order_by(hints.c.id))]


def hints_of(connection: Connection, learner: str) -> dict[tuple[int, str], list[TakenHint]]:
    """Return a learner's hints by assignment number and exercise, the oldest first."""
    mine = _TAKEN.add_columns(attempts.c.assignment, attempts.c.exercise).where(
        attempts.c.learner == learner, attempts.c.assignment.is_not(None)
    )
    found: dict[tuple[int, str], list[TakenHint]] = {}
    for row in connection.execute(mine.order_by(hints.c.id)):
        found.setdefault((row.assignment, row.exercise), []).append(_taken(row))
    return found


def hint_figures(connection: Connection, chosen: ColumnElement[bool]) -> list[HintFigures]:
    """Count the hints taken at the chosen attempts, the most frequent first."""
    counted = (
        select(hints.c.part, hints.c.code, hints.c.step, func.count().label("times"))
        .join_from(hints, attempts)
        .where(chosen)
        .group_by(hints.c.part, hints.c.code, hints.c.step)
    )
    steps: dict[tuple[str, str], Counter[int]] = {}
    for row in connection.execute(counted):
        steps.setdefault((row.part, row.code), Counter())[row.step] = row.times
    ordered = sorted(steps.items(), key=lambda each: (-each[1].total(), each[0]))
    return [
        HintFigures(part=part, code=code, taken=[taken[step] for step in (1, 2, 3)])
        for (part, code), taken in ordered
    ]


def _same_place(attempt: Row[Any]) -> ColumnElement[bool]:
    return and_(
        attempts.c.exercise == attempt.exercise,
        attempts.c.learner == attempt.learner,
        attempts.c.assignment.is_not_distinct_from(attempt.assignment),
    )


def _taken(row: Row[Any]) -> TakenHint:
    return TakenHint(
        attempt=row.attempt_id,
        part=row.part,
        code=row.code,
        row=row.row or None,
        cell=row.cell or None,
        step=row.step,
        price=row.price,
        at=row.at,
    )


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


# --- Data classes for new, recorded and listed attempts, and for filters of attempts
#
# This module loads no database driver.


MOST_ON_A_PAGE: Final = 100


def hint_points(price: float, max_points: float) -> float:
    """Return the points that hints cost, at most ``max_points``.

    ``price`` is the price of the hints as a fraction of ``max_points``.
    """
    return round(min(price, 1.0) * max_points, 6)


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


# --- Record each attempt exactly once, and number the attempts of each learner


# Build the statements once: building one takes longer than running it.
_WRITTEN: Final = tuple(NewAttempt.__dataclass_fields__)
_RECORDED: Final = tuple(RecordedAttempt.__dataclass_fields__)
_EARLIER: Final = select(*(attempts.c[name] for name in _RECORDED)).where(
    attempts.c.number == bindparam("number")
)
_OF_LEARNER: Final = and_(
    attempts.c.exercise == bindparam("exercise"), attempts.c.learner == bindparam("learner")
)
_ALL: Final = func.count(attempts.c.ordinal)


def _standing(counted: ColumnElement[int]) -> Select[Any]:
    earlier = select(attempts.c.number).where(
        attempts.c.owner == bindparam("owner"),
        attempts.c.idempotency_key == bindparam("idempotency_key"),
    )
    # Deleted attempts leave gaps in the ordinals.
    last = func.coalesce(func.max(attempts.c.ordinal), 0)
    columns = (
        last.label("last"),
        counted.label("counted"),
        earlier.label("earlier"),
        PRICE.label("hint_price"),
    )
    return select(*columns).where(_OF_LEARNER)


def _counted(assigned: ColumnElement[bool]) -> ColumnElement[int]:
    return select(_ALL).where(_OF_LEARNER, assigned).scalar_subquery()


_IN_ASSIGNMENT: Final = _standing(_counted(attempts.c.assignment == bindparam("assignment")))
_OUTSIDE: Final = _standing(_ALL - _counted(attempts.c.assignment.is_not(None)))
_OUTCOMES: Final = select(outcomes.c.id, outcomes.c.exercise, outcomes.c.digest).where(
    outcomes.c.exercise.in_(bindparam("exercises", expanding=True)),
    outcomes.c.digest.in_(bindparam("digests", expanding=True)),
)


def insert_or_ignore(table: Table) -> dict[str, postgresql.Insert | sqlite.Insert]:
    """Return INSERT statements that skip conflicting rows, by the name of the SQL dialect."""
    return {
        "postgresql": postgresql.insert(table).on_conflict_do_nothing(),
        "sqlite": sqlite.insert(table).on_conflict_do_nothing(),
    }


def _as_written(name: str) -> ColumnElement[Any]:
    return bindparam(name, type_=attempts.c[name].type)


# An attempt gets the row of its outcome; if there is none, nothing is written. ``is_sent`` is true
# if a platform has a line item for the score.
_OF_OUTCOME: Final = select(
    *(_as_written(name) for name in (*_WRITTEN, "id")), outcomes.c.id.label("outcome")
).where(
    outcomes.c.exercise == bindparam("exercise"), outcomes.c.digest == bindparam("outcome_digest")
)
_NEW_OUTCOME: Final = insert_or_ignore(outcomes)
# Changes no row, but fails if the tables are missing or not writable.
_ALIVE: Final = update(attempts).values(number=attempts.c.number).where(false())
# What a rehearsal writes (bytes): an attempt takes 12 pages of 4 KiB, and more for long answers.
_REHEARSED: Final = 64 * 1024
_NEW_ATTEMPT: Final = {
    kind: statement.from_select((*_WRITTEN, "id", "outcome"), _OF_OUTCOME).returning(
        attempts.c.number,
        exists().where(line_items.c.assignment == bindparam("assignment")).label("is_sent"),
    )
    for kind, statement in insert_or_ignore(attempts).items()
}


def standing(
    connection: Connection,
    exercise: str,
    learner: str,
    owner: str,
    idempotency_key: str | None,
    assignment: int | None = None,
) -> Standing:
    """Return a summary of a learner's earlier attempts at an exercise."""
    which: dict[str, str | int | None] = {
        "exercise": exercise,
        "learner": learner,
        "owner": owner,
        "idempotency_key": idempotency_key,
        "assignment": assignment,
    }
    # Only attempts in the same assignment count or, without one, those outside of all assignments.
    statement = _OUTSIDE if assignment is None else _IN_ASSIGNMENT
    row = connection.execute(statement, which).one()
    found = row.earlier and connection.execute(_EARLIER, {"number": row.earlier}).one_or_none()
    earlier = RecordedAttempt(**found._mapping) if found else None
    return Standing(row.counted, earlier, row.last, float(row.hint_price))


def record(connection: Connection, new: NewAttempt, outcome: Outcome) -> RecordedAttempt | None:
    """Write the attempt; return None if its number or idempotency key is already taken."""
    values: dict[str, Any] = {name: getattr(new, name) for name in _WRITTEN}
    values["id"] = secrets.token_hex(16)
    statement = _NEW_ATTEMPT[connection.dialect.name]
    row = values | {"outcome_digest": outcome.digest}
    written = connection.execute(statement, row).one_or_none()
    if written is None and _add_outcome(connection, outcome):
        written = connection.execute(statement, row).one_or_none()
    if written is None:
        return None
    if new.ordinal is not None and written.is_sent:
        queue_score(connection, new.assignment, new.learner, Priority.HAND_IN)
    return RecordedAttempt(**values, number=written.number)


def fail_if_read_only(connection: Connection) -> None:
    """Raise SQLAlchemyError if the tables are missing or cannot be written; write nothing."""
    connection.execute(_ALIVE)


def rehearse(connection: Connection) -> None:
    """Write as much as an attempt needs, and delete it again.

    Raises SQLAlchemyError if attempts cannot be recorded, for example because the disk is full.
    """
    fail_if_read_only(connection)
    # SQLite overwrites what it deletes (``secure_delete``), so the commit writes all pages.
    row = {"exercise": "", "digest": secrets.token_hex(32), "content": "0" * _REHEARSED}
    connection.execute(insert(outcomes), row)
    written = and_(outcomes.c.exercise == "", outcomes.c.digest == row["digest"])
    connection.execute(delete(outcomes).where(written))


# Returns the next attempt after a standing, or None if none is allowed or prepared.
AttemptAfter = Callable[[Standing], tuple[NewAttempt, Outcome] | None]


def record_next(
    connection: Connection, before: Standing, attempt_after: AttemptAfter
) -> RecordedAttempt | Standing:
    """Call ``attempt_after`` with the learner's earlier attempts, and write its result.

    If the result is None, write nothing and return the earlier attempts.
    """
    now = before
    while (attempt := attempt_after(now)) is not None:
        new, outcome = attempt
        written = record(connection, new, outcome)
        if written is not None:
            return written
        # In each round an earlier job or another process has recorded an attempt.
        now = standing(
            connection, new.exercise, new.learner, new.owner, new.idempotency_key, new.assignment
        )
    return now


def outcome_ids(connection: Connection, wanted: Iterable[Outcome]) -> dict[Outcome, int]:
    """Return the row ids of the outcomes; insert those that the database does not have."""
    # Always in the same order: otherwise two workers could deadlock.
    ordered = sorted(set(wanted), key=lambda each: (each.exercise, each.digest))
    ids = _written_outcomes(connection, ordered)
    if new := [each for each in ordered if each not in ids]:
        rows = [{"content": each.content} | _key(each) for each in new]
        connection.execute(_NEW_OUTCOME[connection.dialect.name], rows)
        ids |= _written_outcomes(connection, new)
    return ids


def _written_outcomes(connection: Connection, wanted: Iterable[Outcome]) -> dict[Outcome, int]:
    by_digest = {(each.exercise, each.digest): each for each in wanted}
    exercises, digests = zip(*by_digest, strict=True)
    which = {"exercises": list(set(exercises)), "digests": list(digests)}
    found = connection.execute(_OUTCOMES, which)
    return {by_digest[exercise, digest]: row for row, exercise, digest in found}


def _key(outcome: Outcome) -> dict[str, str]:
    return {"exercise": outcome.exercise, "digest": outcome.digest}


def _add_outcome(connection: Connection, outcome: Outcome) -> bool:
    new = _key(outcome) | {"content": outcome.content}
    statement = _NEW_OUTCOME[connection.dialect.name].returning(outcomes.c.id)
    return connection.scalar(statement, new) is not None
