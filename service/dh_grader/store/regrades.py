"""Regrade outdated attempts, in steps or in several processes, with reports in memory.

What an attempt is and how it is graded is in ``dh_grader.store``.
"""

import json
import sys
import time
from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import partial
from typing import Any, Final, TypeAlias

from sqlalchemy import (
    ColumnElement,
    Connection,
    Engine,
    Row,
    Select,
    bindparam,
    delete,
    func,
    insert,
    literal,
    or_,
    select,
    update,
)
from sqlalchemy.exc import SQLAlchemyError

from dh_grader import VERSION
from dh_grader.catalogue import Exercise, FeedbackLevel, least
from dh_grader.regex import regex
from dh_grader.store import (
    AttemptFilter,
    AttemptGrading,
    BadCursorError,
    Outcome,
    StoreDownError,
    points_after,
)
from dh_grader.store.attempts import insert_or_ignore, outcome_ids
from dh_grader.store.database import (
    Priority,
    in_transaction,
    queue_scores,
    reason,
    without_time_limit,
)
from dh_grader.store.results import BY_TIME, TimePlace, condition, cursor_of, later_than, place_of
from dh_grader.store.tables import assignments, attempts, earlier_reports, regrade_queue
from dh_grader.submissions.bodies import GradeRequest
from dh_grader.translations import say
from dh_grader.variants import NoVariantError, hidden_variant, pinned, values_of, variant_of

# --- Reports in memory, with a limit in bytes; the least recently used ones are dropped


# A report on a table takes 6 kB with its answers; an attacker's may take a hundred times as much.
# 64 MB hold 10,000 different tables and are half the memory of the program.
MOST_BYTES: Final = 64 * 2**20

# The verdict and the points of each part.
PartResults: TypeAlias = Mapping[str, tuple[str, float]]


@dataclass(frozen=True, slots=True)
class WrittenReport:
    """The JSON of a report, and values of the report that are needed without parsing it."""

    text: str
    points: float
    max_points: float
    parts: PartResults
    outcome: Outcome
    version: str

    @property
    def size(self) -> int:
        """The approximate size in bytes."""
        return sys.getsizeof(self.text) + sys.getsizeof(self.outcome.content) + 1000


class MemoizedReports:
    """The most recently used reports by submission and feedback level."""

    def __init__(self, most_bytes: int = MOST_BYTES) -> None:
        self._most_bytes = most_bytes
        self._bytes = 0
        self._reports: OrderedDict[tuple[str, FeedbackLevel], WrittenReport] = OrderedDict()

    def get(
        self, submission: str, level: FeedbackLevel, grade: Callable[[], WrittenReport]
    ) -> WrittenReport:
        """Return a report from the cache, or call ``grade`` and store its result in the cache."""
        key = submission, level
        if (found := self._reports.get(key)) is not None:
            self._reports.move_to_end(key)
            return found
        self._reports[key] = report = grade()
        self._bytes += _size(submission, report)
        while self._bytes > self._most_bytes:
            (oldest, _), dropped = self._reports.popitem(last=False)
            self._bytes -= _size(oldest, dropped)
        return report


def _size(submission: str, report: WrittenReport) -> int:
    return sys.getsizeof(submission) + report.size


# --- Regrade outdated attempts; several processes may share the work through the database
#
# A worker locks the attempts that it takes until it commits. If the worker dies, the database
# releases the locks, and another worker takes the attempts.


# The most attempts in one commit, and the time after which a batch ends (seconds).
BATCH: Final = 50
_BATCH_SECONDS: Final = 0.5


@dataclass(frozen=True, slots=True)
class CountedPoints:
    """The points of an attempt in its assignment, as the gradebook shows them."""

    before: float
    after: float
    max_points: float
    awarded: float | None


@dataclass(frozen=True, slots=True)
class RegradedAttempt:
    """The points of an attempt before and after a regrade."""

    id: str
    learner: str
    ordinal: int | None
    # Points on the scale of the exercise file.
    before: float
    after: float
    max_points: float
    # Points with which a tutor has overridden the report; a regrade does not change them.
    awarded: float | None
    # The parts whose result has changed.
    reasons: tuple[str, ...]
    # The points on the scale of the assignment; None if no assignment has the exercise.
    counted: CountedPoints | None

    @property
    def is_changed(self) -> bool:
        """True if the points or the result of a part have changed."""
        counted = self.counted
        counts_otherwise = counted is not None and counted.before != counted.after
        return self.before != self.after or bool(self.reasons) or counts_otherwise


class Regrading:
    """Regrades attempts with the current versions of the exercise and the program.

    With ``course``, it regrades only attempts in this course.
    """

    def __init__(
        self, exercise: Exercise, ceiling: FeedbackLevel, course: str | None = None
    ) -> None:
        self._condition = condition(AttemptFilter(exercise.id, course=course))
        self._exercise = exercise
        self._ceiling = ceiling
        self._course = course
        # Equal answers get equal reports.
        self._memoized = MemoizedReports()

    def outdated(self, connection: Connection) -> list[int]:
        """Return the row numbers of attempts that were not graded with the current versions."""
        numbers = select(attempts.c.number).where(self._is_outdated()).order_by(attempts.c.number)
        return list(connection.scalars(numbers))

    def outdated_count(self, connection: Connection) -> int:
        """Count the attempts that were not graded with the current exercise and program."""
        return connection.scalar(select(func.count()).where(self._is_outdated())) or 0

    def outdated_after(
        self, connection: Connection, place: TimePlace | None, most: int
    ) -> list[TimePlace]:
        """Return time and row number of the outdated attempts after ``place``, the oldest first."""
        following = select(*BY_TIME).where(self._is_outdated())
        if place is not None:
            following = following.where(later_than(place))
        found = connection.execute(following.order_by(*BY_TIME).limit(most))
        return [(at, number) for at, number in found]

    def preview(self, connection: Connection, numbers: Sequence[int]) -> list[RegradedAttempt]:
        """Return what regrading these attempts would change; write nothing."""
        rows = self._rows(connection, numbers)
        return [
            self._regraded(row)[0]
            for row in rows
            if attempted_exercise(self._exercise, row) is not None
        ]

    def enqueue(self, connection: Connection) -> None:
        """Put all outdated attempts into the queue, each at most once."""
        without_time_limit(connection)
        waiting = select(attempts.c.number, literal(self._exercise.id)).where(self._is_outdated())
        connection.execute(
            insert_or_ignore(regrade_queue)[connection.dialect.name].from_select(
                ["attempt", "exercise"], waiting.order_by(attempts.c.number)
            )
        )

    def waiting(self, connection: Connection) -> int:
        """Count the attempts in the queue, including those that another worker has locked."""
        waiting = select(func.count()).select_from(regrade_queue).where(self._is_queued())
        return connection.scalar(waiting) or 0

    def next_batch(self, engine: Engine) -> list[RegradedAttempt]:
        """Regrade some queued attempts in one transaction.

        The result is empty if no attempts are left for this worker.
        """
        prepared = self._prepared(engine) if engine.dialect.name == "sqlite" else None
        return in_transaction(engine, partial(self.work, among=prepared))

    def work(
        self, connection: Connection, among: Sequence[int] | None = None
    ) -> list[RegradedAttempt]:
        """Regrade some queued attempts and remove them from the queue.

        If ``among`` is given, take only these attempts.
        """
        waiting = self._waiting()
        if among is not None:
            waiting = waiting.where(regrade_queue.c.attempt.in_(among))
        taken = connection.scalars(waiting.with_for_update(skip_locked=True)).all()
        rows = self._rows(connection, taken)
        graded = self._graded_in_time(rows)
        if done := [(row, *result) for row, result in graded if result]:
            self._write(connection, done)
        ended = [row.number for row, _ in graded]
        connection.execute(delete(regrade_queue).where(regrade_queue.c.attempt.in_(ended)))
        return [change for _, change, _ in done]

    def _waiting(self) -> Select[int]:
        waiting = select(regrade_queue.c.attempt).where(self._is_queued())
        return waiting.order_by(regrade_queue.c.attempt).limit(BATCH)

    def _is_queued(self) -> ColumnElement[bool]:
        mine = regrade_queue.c.exercise == self._exercise.id
        if self._course is None:
            return mine
        return mine & regrade_queue.c.attempt.in_(select(attempts.c.number).where(self._condition))

    def _prepared(self, engine: Engine) -> list[int]:
        # In SQLite only one process can write: grade first, and lock the file only while writing.
        with engine.connect() as connection:
            rows = self._rows(connection, connection.scalars(self._waiting()).all())
        return [row.number for row, _ in self._graded_in_time(rows)]

    def _graded_in_time(
        self, rows: Sequence[Row[Any]]
    ) -> list[tuple[Row[Any], tuple[RegradedAttempt, WrittenReport] | None]]:
        graded: list[tuple[Row[Any], tuple[RegradedAttempt, WrittenReport] | None]] = []
        end = time.monotonic() + _BATCH_SECONDS
        for row in rows:
            graded.append((row, self._regraded(row) if self._needs(row) else None))
            if time.monotonic() >= end:
                break
        return graded

    def _is_outdated(self) -> ColumnElement[bool]:
        exercise, version = self._exercise, attempts.c.version
        if exercise.vary is None:
            another = version != exercise.version
        else:
            # The versions of all variants begin with that of the file.
            another = version.not_like(f"{exercise.vary.base_version}-%")
        return self._condition & or_(another, attempts.c.grader != VERSION)

    def _needs(self, row: Row[Any]) -> bool:
        exercise = attempted_exercise(self._exercise, row)
        return exercise is not None and (row.version, row.grader) != (exercise.version, VERSION)

    def _rows(self, connection: Connection, numbers: Sequence[int]) -> Sequence[Row[Any]]:
        of_assignment = (assignments.c.choices, assignments.c.exercises)
        chosen = select(attempts, *of_assignment).join(assignments, isouter=True)
        chosen = chosen.where(attempts.c.number.in_(numbers))
        return connection.execute(chosen.order_by(attempts.c.number)).all()

    def _regraded(self, row: Row[Any]) -> tuple[RegradedAttempt, WrittenReport]:
        before = json.loads(row.report)
        exercise = attempted_exercise(self._exercise, row)
        assert exercise is not None, "the variant has other values"
        # Never above the level of the old report: the service may have had a lower ceiling than
        # this process.
        level = least(
            exercise.feedback_at(row.ordinal or 1),
            self._ceiling,
            FeedbackLevel(before["feedback"]),
        )
        report = self._memoized.get(
            f"{exercise.id} {exercise.version} {row.submission}",
            level,
            lambda: self._report(exercise, row.submission, level),
        )
        after = points_after(report.points, report.max_points, row.hint_price, row.worth)
        reasons = tuple(_reasons(_results(before), report.parts))
        change = RegradedAttempt(
            row.id,
            row.learner,
            row.ordinal,
            row.points,
            after,
            report.max_points,
            row.awarded,
            reasons,
            _counted(row, after, report.max_points),
        )
        return change, report

    def _report(self, exercise: Exercise, submission: str, level: FeedbackLevel) -> WrittenReport:
        body = GradeRequest.model_validate_json(submission)
        # A corrected exercise may have lost a part, or renamed it.
        answers = {part: it for part, it in body.answers.items() if exercise.part(part)}
        body = body.model_copy(update={"answers": answers})
        graded = AttemptGrading(exercise, body).at(level)
        report = graded.report
        parts = {part.part: (str(part.verdict), part.points) for part in report.parts}
        return WrittenReport(
            graded.text, report.points, report.max_points, parts, graded.outcome, exercise.version
        )

    def _write(
        self,
        connection: Connection,
        done: Sequence[tuple[Row[Any], RegradedAttempt, WrittenReport]],
    ) -> None:
        now = datetime.now(UTC)
        ids = outcome_ids(connection, [report.outcome for _, _, report in done])
        kept = ("report", "version", "grader", "points", "max_points")
        connection.execute(
            insert(earlier_reports),
            [
                {"attempt": row.number, "replaced_at": now}
                | {name: getattr(row, name) for name in kept}
                for row, _, _ in done
            ],
        )
        connection.execute(
            update(attempts).where(attempts.c.number == bindparam("which")),
            [
                {
                    "which": row.number,
                    "report": report.text,
                    "version": report.version,
                    "grader": VERSION,
                    "points": change.after,
                    "max_points": report.max_points,
                    "outcome": ids[report.outcome],
                }
                for row, change, report in done
            ],
        )
        changed = [
            row.number
            for row, change, report in done
            if (change.before, row.max_points) != (change.after, report.max_points)
        ]
        if changed:
            queue_scores(connection, attempts.c.number.in_(changed), Priority.REGRADE)


def attempted_exercise(exercise: Exercise, row: Row[Any]) -> Exercise | None:
    """Return the exercise or variant of an attempt; None if the variant's values have changed."""
    if row.variant is None:
        return exercise
    make = variant_of if row.assignment is None else hidden_variant
    try:
        variant = make(pinned(exercise, row.choices), row.variant)
    except NoVariantError:
        return None
    return variant if values_of(variant.version) == values_of(row.version) else None


def _counted(row: Row[Any], after: float, max_points: float) -> CountedPoints | None:
    chosen = json.loads(row.exercises or "[]")
    assigned = next((it["points"] for it in chosen if it["exercise"] == row.exercise), None)
    if assigned is None:
        return None

    def scaled(points: float, most: float) -> float:
        return round(points / most * assigned, 6) if most else 0.0

    awarded = None if row.awarded is None else scaled(row.awarded, max_points)
    return CountedPoints(
        scaled(row.points, row.max_points), scaled(after, max_points), assigned, awarded
    )


def _results(report: Mapping[str, Any]) -> PartResults:
    return {part["part"]: (part["verdict"], part["points"]) for part in report["parts"]}


def _reasons(old: PartResults, new: PartResults) -> list[str]:
    reasons: list[str] = []
    for name in dict.fromkeys((*old, *new)):
        if name not in new:
            reasons.append(say("{name} is no part any more", name=name))
        elif name not in old:
            reasons.append(say("{name} is new, {verdict}", name=name, verdict=new[name][0]))
        elif old[name] != new[name]:
            before, after = old[name][0], new[name][0]
            reasons.append(
                say("{name} {verdict}, other points", name=name, verdict=after)
                if before == after
                else f"{name} {before} → {after}"
            )
    return reasons


# --- Regrading in steps, each short enough for one request


# A step ends after the batch with which it reaches this time or this number of attempts.
_SECONDS: Final = 1.0
_MOST: Final = 20 * BATCH
# The batch size of a preview: fifty costly answers would take seconds.
_PREVIEW_BATCH: Final = 10
# The place where a step ended, and the number of attempts that are left after it.
_CURSOR: Final = regex(r"(?P<place>[0-9a-f]{1,20}\.[0-9a-f]{1,20})?:(?P<left>[0-9a-f]{1,15})")


@dataclass(frozen=True, slots=True)
class RegradeStep:
    """The attempts of one step, the number of attempts left, and the cursor of the next step."""

    regraded: Sequence[RegradedAttempt]
    left: int
    following: str | None


def preview_step(engine: Engine, regrading: Regrading, cursor: str | None) -> RegradeStep:
    """Regrade some outdated attempts without writing. Raises BadCursorError, StoreDownError."""
    place, left = (None, 0) if cursor is None else _read(cursor)
    done: list[RegradedAttempt] = []
    end = time.monotonic() + _SECONDS
    try:
        with engine.connect() as connection:
            if cursor is None:
                left = regrading.outdated_count(connection)
            found = regrading.outdated_after(connection, place, _PREVIEW_BATCH)
            while found:
                done += regrading.preview(connection, [number for _, number in found])
                place = found[-1]
                if time.monotonic() >= end or len(done) >= _MOST:
                    break
                found = regrading.outdated_after(connection, place, _PREVIEW_BATCH)
    except SQLAlchemyError as error:
        raise StoreDownError(reason(error)) from error
    # In the meantime, attempts may have been recorded or regraded.
    left = max(left - len(done), 0)
    following = f"{cursor_of(place)}:{left:x}" if found and place is not None else None
    return RegradeStep(done, left, following)


def apply_step(engine: Engine, regrading: Regrading, cursor: str | None) -> RegradeStep:
    """Regrade some outdated attempts; several processes may do so at once.

    The first step has no cursor. Raises BadCursorError, StoreDownError.
    """
    if cursor is not None:
        _read(cursor)
    done: list[RegradedAttempt] = []
    end = time.monotonic() + _SECONDS
    try:
        if cursor is None:
            in_transaction(engine, regrading.enqueue)
        while batch := regrading.next_batch(engine):
            done += batch
            if time.monotonic() >= end or len(done) >= _MOST:
                break
        with engine.connect() as connection:
            left = regrading.waiting(connection)
    except SQLAlchemyError as error:
        raise StoreDownError(reason(error)) from error
    return RegradeStep(done, left, f":{left:x}" if left else None)


def _read(cursor: str) -> tuple[TimePlace | None, int]:
    found = _CURSOR.fullmatch(cursor)
    if found is None:
        raise BadCursorError(cursor)
    place = found["place"]
    return None if place is None else place_of(place), int(found["left"], 16)
