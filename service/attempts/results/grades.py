"""Choose the attempts that count, and export attempts for other programs."""

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import groupby
from typing import Any, Final, Literal

from sqlalchemy import Connection, Result, select

from service.attempts.attempt import AttemptFilter, GradesFormat, ListedAttempt
from service.attempts.results.listing import LISTED, condition
from service.attempts.storage.tables import attempts
from service.catalogue import Exercise
from service.catalogue.attempts import AttemptsSpec
from service.formats.shared import spreadsheet

Counting = Literal["best", "last"]

# The attempts that are read at once. An export of them takes about two milliseconds.
_PAGE: Final = 100


def counting_rules(exercises: Mapping[str, Exercise]) -> Callable[[str], Counting]:
    """Return a function that takes an exercise's id and returns its rule, "best" or "last".

    The rule chooses the attempt that counts for a learner.
    """

    def rule(exercise_id: str) -> Counting:
        exercise = exercises.get(exercise_id)
        return (AttemptsSpec() if exercise is None else exercise.attempts).counts

    return rule


@dataclass(frozen=True, slots=True)
class GradedAttempt:
    """An attempt; ``counts`` is True if it is the attempt that counts for the learner."""

    attempt: ListedAttempt
    counts: bool


def graded_attempts(
    connection: Connection,
    wanted: AttemptFilter,
    counting: Callable[[str], Counting],
    pause: Callable[[], None] = lambda: None,
) -> Iterator[GradedAttempt]:
    """Yield the wanted attempts, sorted by exercise, learner and time.

    ``counting`` takes the id of an exercise and returns the rule for the attempt that counts.
    ``pause`` is called after each page of attempts.
    """
    ordered = (
        select(*LISTED)
        .where(condition(wanted))
        .order_by(attempts.c.exercise, attempts.c.learner, attempts.c.at, attempts.c.number)
        .execution_options(yield_per=_PAGE)
    )
    found = _paged(connection.execute(ordered), pause)
    for (exercise, _), group in groupby(found, lambda each: (each.exercise, each.learner)):
        of_learner = list(group)
        chosen = _counting_attempt(of_learner, counting(exercise))
        yield from (GradedAttempt(each, each is chosen) for each in of_learner)


def _paged(rows: Result[Any], pause: Callable[[], None]) -> Iterator[ListedAttempt]:
    for page in rows.partitions():
        yield from (ListedAttempt(**row._mapping) for row in page)
        pause()


def _counting_attempt(of_learner: Iterable[ListedAttempt], rule: Counting) -> ListedAttempt | None:
    counted = [each for each in of_learner if each.ordinal is not None]
    if not counted:
        return None
    if rule == "last":
        return max(counted, key=lambda each: each.ordinal or 0)
    return max(counted, key=lambda each: (each.earned, -(each.ordinal or 0)))


def written(graded: Iterable[GradedAttempt], form: GradesFormat, title: str) -> Iterator[bytes]:
    """Yield the attempts in a format, line by line.

    Gradebooks (``canvas``, ``moodle``) have only the attempts that count. ``title`` is the heading
    of the points for Canvas.
    """
    match form:
        case GradesFormat.CSV:
            yield spreadsheet.line(_FIELDS)
            for each in graded:
                yield spreadsheet.line(map(_as_cell, _values(each)))
        case GradesFormat.JSONL:
            for each in graded:
                named = dict(zip(_FIELDS, _values(each), strict=True))
                known = {name: value for name, value in named.items() if value is not None}
                yield json.dumps(known, ensure_ascii=False).encode("utf-8", "replace") + b"\n"
        case GradesFormat.CANVAS:
            yield from _canvas((each.attempt for each in graded if each.counts), title)
        case GradesFormat.MOODLE:
            yield from _moodle(each.attempt for each in graded if each.counts)


_FIELDS: Final = (
    "exercise", "learner", "attempt", "ordinal", "at", "is_late", "points", "max_points",
    "report_points", "counts", "version", "grader", "variant",
)  # fmt: skip
_Value = str | float | bool | None


def _values(graded: GradedAttempt) -> tuple[_Value, ...]:
    each = graded.attempt
    return (
        each.exercise, each.learner, each.id, each.ordinal, each.at.isoformat(), each.is_late,
        each.earned, each.max_points, each.points, graded.counts, each.version, each.grader,
        each.variant,
    )  # fmt: skip


def _as_cell(value: _Value) -> str | float | None:
    return str(value).lower() if isinstance(value, bool) else value


def _canvas(counted: Iterable[ListedAttempt], title: str) -> Iterator[bytes]:
    # Source: Canvas, "How do I import grades in the Gradebook?".
    kept = list(counted)
    possible = max((each.max_points for each in kept), default=0.0)
    yield spreadsheet.line(("Student", "ID", "SIS User ID", "SIS Login ID", "Section", title))
    yield spreadsheet.line(("    Points Possible", "", "", "", "", possible))
    for each in kept:
        yield spreadsheet.line((each.learner, "", "", each.learner, "", each.earned))


def _moodle(counted: Iterable[ListedAttempt]) -> Iterator[bytes]:
    yield spreadsheet.line(spreadsheet.GRADEBOOK_HEAD)
    for each in counted:
        late = "late" if each.is_late else ""
        yield spreadsheet.line((each.learner, each.earned, each.max_points, late))
