"""Scores on their way to platforms: the thread that sends, the message, and the queue.

Scores are queued by ``store/database.py``, and sent by means of ``grade_services.py``.
"""

import json
import logging
import random
import secrets
import threading
from collections.abc import Callable, Collection
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Any, Final, NamedTuple, Protocol

from sqlalchemy import (
    ColumnElement,
    Connection,
    Engine,
    Row,
    and_,
    delete,
    event,
    exists,
    or_,
    select,
    update,
)
from sqlalchemy.exc import SQLAlchemyError

from dh_grader.access import Secret
from dh_grader.contract.courses import PlatformScore, SendAgainRequest
from dh_grader.courses import place_of, roll
from dh_grader.courses.assignments import assignment_of
from dh_grader.courses.gradebook import SHARE
from dh_grader.lti.grade_services import (
    AccessTokens,
    Column,
    GradeServices,
    LaterError,
    NotThereError,
    RefusedError,
    ScoreError,
    ThisLaterError,
    available_key,
    problem_told,
)
from dh_grader.lti.registrations import Registration, registration
from dh_grader.store.database import FORGOTTEN, QUEUED, Priority, in_transaction
from dh_grader.store.tables import (
    assignments,
    attempts,
    contexts,
    course_learners,
    line_items,
    resource_links,
    scores,
)
from dh_grader.translations import ENGLISH, Language

# --- Threads that send what is queued in the database


_log = logging.getLogger(__name__)

# How often a thread looks for work that other processes have queued (seconds).
_LOOK: Final = 20.0
_LEAST: Final = 0.05


class Sender(Protocol):
    """Sends queued items one by one, in the thread of a BackgroundSending."""

    now: Callable[[], datetime]

    def send_next(self) -> bool:
        """Send the next item that is due; return False if none is due."""

    def next_due(self) -> datetime | None:
        """Return when the next item may be sent; None if no item waits."""


class BackgroundSending:
    """A thread that sends queued items as soon as this process has committed them."""

    def __init__(self, engine: Engine, sender: Sender, queued: str) -> None:
        # A transaction that queues an item sets ``queued`` in Connection.info. No other thread may
        # commit during this call, because a commit iterates over the listeners.
        self._sender, self._queued = sender, queued
        self._wake = threading.Event()
        self._closed = threading.Event()
        event.listen(engine, "commit", self._committed)
        self._thread = threading.Thread(target=self._run, name=queued, daemon=True)

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def close(self) -> None:
        """Stop the thread after the current item."""
        self._closed.set()
        self._wake.set()
        self._thread.join()

    def _committed(self, connection: Connection) -> None:
        # One that is closed leaves the note to its successor.
        if not self._closed.is_set() and connection.info.pop(self._queued, False):
            self._wake.set()

    def _run(self) -> None:
        while not self._closed.is_set():
            self._wake.clear()
            seconds = _LOOK
            try:
                while not self._closed.is_set() and self._sender.send_next():
                    pass
                due = self._sender.next_due()
                if due is not None:
                    wait = (due - self._sender.now()) / timedelta(seconds=1)
                    seconds = min(_LOOK, max(_LEAST, wait))
            except SQLAlchemyError:
                _log.warning("LTI: the database does not respond")
            except Exception:  # noqa: BLE001 - the next one may be sent
                _log.exception("LTI: sending failed (%s)", self._queued)
            self._wake.wait(seconds)


# --- Compute a learner's score in an assignment, and make the message that sends it to a platform


_CANVAS: Final = "https://canvas.instructure.com/lti/submission"


class LearnerScore(NamedTuple):
    """A learner's points in an assignment, or None if no attempt counts.

    ``submitted_at`` is the time of the last attempt that counts.
    """

    points: float | None
    max_points: float
    submitted_at: datetime | None


def learner_score(connection: Connection, assignment: int, learner: str) -> LearnerScore:
    """Return the score of a learner in an assignment."""
    mine = assignments.c.number == assignment
    text = connection.execute(select(assignments.c.exercises).where(mine)).scalar_one()
    points = {each["exercise"]: each["points"] for each in json.loads(text)}
    of = attempts.c
    counted = (
        select(of.exercise, SHARE.label("share"), of.at)
        .where(
            of.assignment == assignment,
            of.learner == learner,
            or_(of.ordinal.is_not(None), of.awarded.is_not(None)),
        )
        .order_by(of.number)
    )
    best: dict[str, tuple[float, datetime]] = {}
    for exercise, share, at in connection.execute(counted):
        if exercise not in points:
            continue
        # Of equal attempts, the first one counts: a later one does not make the score late.
        if exercise not in best or (share or 0.0) > best[exercise][0]:
            best[exercise] = (share or 0.0, at)
    most = float(round(sum(points.values()), 6))
    if not best:
        return LearnerScore(None, most, None)
    earned = sum(round(share * points[name], 6) for name, (share, _) in best.items())
    return LearnerScore(float(round(earned, 6)), most, max(at for _, at in best.values()))


def score_message(score: LearnerScore, sub: str, stamp: datetime, address: str) -> dict[str, Any]:
    """Return the message that sends a score to a platform.

    A score without points deletes the platform's score. ``address`` launches the assignment.
    """
    # Some fields of the message are only for Canvas.
    message: dict[str, Any] = {"userId": sub, "timestamp": _written(stamp)}
    if score.points is None:
        return message | {"activityProgress": "Initialized", "gradingProgress": "NotReady"}
    # Without data of a submission, Canvas shows 0 points as "needs grading".
    submission = {
        "new_submission": False,
        "submission_type": "basic_lti_launch",
        "submission_data": address,
    }
    message |= {
        "scoreGiven": score.points,
        "scoreMaximum": score.max_points,
        "activityProgress": "Completed",
        "gradingProgress": "FullyGraded",
    }
    if score.submitted_at is not None:
        message["submission"] = {"submittedAt": _written(score.submitted_at)}
        submission["submitted_at"] = _written(score.submitted_at)
    return message | {_CANVAS: submission}


def _written(moment: datetime) -> str:
    return moment.isoformat(timespec="milliseconds").replace("+00:00", "Z")


# --- The queue of scores to send; each score is leased to one process
#
# If a process dies, its lease ends, and another process sends the score again: with a later
# timestamp, so that in the end the platform has the correct score.


# How long a score belongs to the process that has taken it. Sending takes at most half of that.
LEASE: Final = timedelta(seconds=90)
# Timestamps are this much in the past, because clocks differ. Moodle compares whole seconds.
_PAST: Final = timedelta(seconds=2)
_STEP: Final = timedelta(seconds=1)
# Scores of forgotten learners are given up after this time.
_FORGETTING: Final = timedelta(days=7)
# The most scores that are passed over in one transaction, because the platform has them.
_MOST_PASSED: Final = 100
_FREE: Final = scores.c.leased_until.is_(None)


@dataclass(frozen=True, slots=True)
class TakenScore:
    """A score that is leased to this process."""

    registration: Registration
    line_item: int
    url: str | None
    column: Column
    learner: str
    sub: str
    version: int
    tries: int
    score: LearnerScore
    stamp: datetime

    @property
    def is_forgotten(self) -> bool:
        """True if the learner's data were deleted, so that the platform should clear the score."""
        return self.learner.startswith(FORGOTTEN)


def take(
    connection: Connection, sender: str, now: datetime, without: Collection[str]
) -> TakenScore | None:
    """Lease the next score to ``sender`` and return it; None if none is due.

    Registrations in ``without`` are skipped. Scores that the platform already has are marked as
    sent.
    """
    for _ in range(_MOST_PASSED):
        row = connection.execute(_next(now, without)).one_or_none()
        if row is None:
            return None
        found = learner_score(connection, row.assignment, row.learner)
        is_new = row.stamp is None and found.points is None
        is_same = (row.tries, row.sent_points, row.max_points) == (
            0,
            found.points,
            found.max_points,
        )
        if is_new or _is_replaced(connection, row):
            connection.execute(delete(scores).where(_is(row.line_item, row.learner)))
        elif is_same and row.sent_at is not None:
            connection.execute(
                update(scores).where(_is(row.line_item, row.learner)).values(state="sent")
            )
        elif row.stamp is not None and row.stamp + _STEP > now:
            # Several changes in a few seconds: a timestamp must not be in the future.
            later = {"next_try_at": row.stamp + _STEP}
            connection.execute(update(scores).where(_is(row.line_item, row.learner)).values(later))
        else:
            return _taken(connection, row, found, sender, now)
    return None


def _next(now: datetime, without: Collection[str]) -> Any:
    chosen = (
        select(
            scores,
            line_items.c.url,
            line_items.c.assignment,
            contexts.c.registration,
            resource_links.c.lineitems_url,
            resource_links.c.scopes,
            resource_links.c.link,
            assignments.c.title,
            assignments.c.id.label("assignment_id"),
        )
        .join_from(scores, line_items)
        .join(contexts, contexts.c.number == line_items.c.context)
        .join(resource_links, resource_links.c.number == line_items.c.resource_link)
        .join(assignments, assignments.c.number == line_items.c.assignment)
        .where(
            scores.c.state == "waiting",
            scores.c.next_try_at <= now,
            or_(_FREE, scores.c.leased_until <= now),
            contexts.c.registration.not_in(without),
        )
    )
    ordered = chosen.order_by(scores.c.priority, scores.c.next_try_at).limit(1)
    return ordered.with_for_update(of=scores, skip_locked=True)


def _is_replaced(connection: Connection, row: Row[Any]) -> bool:
    # A learner whose data were deleted has come back, and has a new score.
    if not row.learner.startswith(FORGOTTEN):
        return False
    again = (scores.c.line_item == row.line_item) & (scores.c.sub == row.sub)
    others = select(scores.c.learner).where(again, scores.c.learner != row.learner)
    return connection.scalar(others.where(scores.c.learner.not_like(f"{FORGOTTEN}%"))) is not None


def _taken(
    connection: Connection, row: Row[Any], found: LearnerScore, sender: str, now: datetime
) -> TakenScore:
    later_than = [now - _PAST]
    if row.stamp is not None:
        later_than.append(row.stamp + _STEP)
    if found.submitted_at is not None:
        # A score is not from before what it is for.
        later_than.append(found.submitted_at)
    stamp = max(later_than)
    stamp = stamp.replace(microsecond=stamp.microsecond // 1000 * 1000)
    values = {
        "points": found.points,
        "max_points": found.max_points,
        "submitted_at": found.submitted_at,
        "tries": row.tries + 1,
        "leased_by": sender,
        "leased_until": now + LEASE,
        "stamp": stamp,
    }
    connection.execute(update(scores).where(_is(row.line_item, row.learner)).values(values))
    return TakenScore(
        registration=registration(connection, row.registration),
        line_item=row.line_item,
        url=row.url,
        column=Column(
            row.lineitems_url,
            row.scopes,
            row.link,
            row.title,
            row.assignment_id,
            found.max_points,
        ),
        learner=row.learner,
        sub=row.sub,
        version=row.version,
        tries=row.tries,
        score=found,
        stamp=stamp,
    )


def note_sent(connection: Connection, taken: TakenScore, sender: str, now: datetime) -> None:
    """Mark a score as sent, unless it has changed meanwhile."""
    mine = _is(taken.line_item, taken.learner) & (scores.c.leased_by == sender)
    if taken.is_forgotten:
        connection.execute(delete(scores).where(mine))
        return
    values = {
        "tries": 0,
        "leased_by": None,
        "leased_until": None,
        "sent_at": now,
        "sent_points": taken.score.points,
        "refusal": None,
    }
    connection.execute(update(scores).where(mine).values(values))
    unchanged = _unchanged(taken)
    connection.execute(update(scores).where(unchanged).values(state="sent"))


def note_refused(
    connection: Connection, taken: TakenScore, sender: str, problem: ScoreError
) -> None:
    """Mark a score as refused by the platform."""
    mine = _is(taken.line_item, taken.learner) & (scores.c.leased_by == sender)
    if taken.is_forgotten:
        connection.execute(delete(scores).where(mine))
        return
    values = {"leased_by": None, "leased_until": None, "refusal": problem.stored}
    connection.execute(update(scores).where(mine).values(values))
    connection.execute(update(scores).where(_unchanged(taken)).values(state="refused"))


def note_later(
    connection: Connection, taken: TakenScore, sender: str, at: datetime, problem: ScoreError | None
) -> None:
    """Store when to send a score again, and the problem, if there is one."""
    mine = _is(taken.line_item, taken.learner) & (scores.c.leased_by == sender)
    given_up = mine & (scores.c.wanted_at < at - _FORGETTING)
    if taken.is_forgotten and connection.execute(delete(scores).where(given_up)).rowcount:
        return
    values: dict[str, Any] = {"leased_by": None, "leased_until": None}
    if problem is not None:
        values["refusal"] = problem.stored
    connection.execute(update(scores).where(mine).values(values))
    # A score that has changed meanwhile does not wait.
    later = update(scores).where(_unchanged(taken))
    connection.execute(later.values(next_try_at=at))


def next_due(connection: Connection) -> datetime | None:
    """Return when the next score is due, or None if none waits."""
    waiting = select(scores.c.next_try_at, scores.c.leased_until).where(scores.c.state == "waiting")
    row = connection.execute(waiting.order_by(scores.c.next_try_at).limit(1)).one_or_none()
    if row is None:
        return None
    found: datetime = max(row.next_try_at, row.leased_until or row.next_try_at)
    return found


def lease_line_item(connection: Connection, line_item: int, now: datetime) -> bool:
    """Lease a gradebook column to this process; return False if another process has it."""
    free = or_(line_items.c.found_at.is_(None), line_items.c.found_at <= now)
    mine = (line_items.c.number == line_item) & free
    leased = update(line_items).where(mine).values(found_at=now + LEASE)
    return bool(connection.execute(leased).rowcount)


def note_line_item(
    connection: Connection, line_item: int, url: str | None, now: datetime, *, is_made: bool = False
) -> None:
    """End the lease of a gradebook column, and store its address, if known."""
    values: dict[str, Any] = {"found_at": now}
    if url is not None:
        values["url"] = url
    if is_made:
        values["is_own"] = True
    connection.execute(update(line_items).where(line_items.c.number == line_item).values(values))


def _unchanged(taken: TakenScore) -> Any:
    return _is(taken.line_item, taken.learner) & (scores.c.version == taken.version)


def _is(line_item: int, learner: str) -> Any:
    return (scores.c.line_item == line_item) & (scores.c.learner == learner)


# --- Send queued scores to platforms, one after the other; several processes may do so


# The pause after the first failure, and the longest one.
_FIRST: Final = timedelta(seconds=5)
_LONGEST: Final = timedelta(hours=4)
_MOST_ASKED: Final = timedelta(hours=24)
# How long others wait for the process that makes a line item.
_LINE_ITEM: Final = timedelta(seconds=3)


def utc_now() -> datetime:
    """Return the current time in UTC."""
    return datetime.now(UTC)


def pause_after(failures: int, chance: float) -> timedelta:
    """Return the pause after some failures, each of which doubles it.

    ``chance`` is a random number from 0 to 1, on which half of the pause depends.
    """
    return min(_FIRST * (1 << min(failures, 20)), _LONGEST) * (0.5 + 0.5 * chance)


@dataclass(slots=True)
class _Pause:
    until: datetime
    failures: int


class ScoreSender:
    """Sends scores. After a failure, a platform gets no scores for a while."""

    def __init__(
        self,
        engine: Engine,
        secret: Secret,
        now: Callable[[], datetime] = utc_now,
        chance: Callable[[], float] = random.random,
    ) -> None:
        # ``now`` returns the time, ``chance`` a random number from 0 to 1 for each pause.
        self._engine = engine
        self.now, self._chance = now, chance
        self._name = secrets.token_hex(8)
        self._pauses: dict[str, _Pause] = {}
        self._services = GradeServices(
            AccessTokens(now, lambda: available_key(engine, secret, now()))
        )

    def send_next(self) -> bool:
        """Send the next score that is due; return False if none is due."""
        now = self.now()
        resting = [name for name, pause in self._pauses.items() if now < pause.until]
        taken = in_transaction(self._engine, lambda it: take(it, self._name, now, resting))
        if taken is None:
            return False
        try:
            self._send(taken)
        except RefusedError as error:
            self._pauses.pop(taken.registration.id, None)
            problem = error
            in_transaction(self._engine, lambda it: note_refused(it, taken, self._name, problem))
            _log.warning("LTI: the score was refused (%s): %s", taken.registration.id, error)
        except LaterError as error:
            self._rest(taken, error)
        except ThisLaterError as error:
            self._later(taken, self._doubled(taken.tries), error)
        except Exception:  # noqa: BLE001 - other scores must go on
            _log.exception("LTI: a score could not be sent")
            self._later(taken, self._doubled(taken.tries), ScoreError("failed"))
        return True

    def next_due(self) -> datetime | None:
        """Return when the next score may be sent; None if no score waits."""
        with self._engine.connect() as connection:
            due = next_due(connection)
        now = self.now()
        if due is None or due > now:
            return due
        resting = [pause.until for pause in self._pauses.values() if pause.until > now]
        return min(resting, default=due)

    def _send(self, taken: TakenScore) -> None:
        url = taken.url or self._line_item(taken)
        if url is None:
            return
        message = score_message(taken.score, taken.sub, taken.stamp, taken.registration.launch_url)
        try:
            self._services.send_score(taken.registration, url, message)
        except NotThereError:
            # The line item may have a new address.
            found = self._services.found_line_item(taken.registration, taken.column)
            if found is None and taken.column.lineitems_url is not None:
                raise RefusedError("no-line-item") from None
            if found in (None, url):
                raise
            now = self.now()
            in_transaction(self._engine, lambda it: note_line_item(it, taken.line_item, found, now))
            self._services.send_score(taken.registration, found, message)
        self._pauses.pop(taken.registration.id, None)
        now = self.now()
        in_transaction(self._engine, lambda it: note_sent(it, taken, self._name, now))

    def _line_item(self, taken: TakenScore) -> str | None:
        # If another process is making the line item, the score is delayed.
        now, number = self.now(), taken.line_item
        if not in_transaction(self._engine, lambda it: lease_line_item(it, number, now)):
            self._later(taken, now + _LINE_ITEM, None)
            return None
        url, is_made = None, False
        try:
            url, is_made = self._services.line_item(taken.registration, taken.column)
        finally:
            found, now = url, self.now()
            in_transaction(
                self._engine,
                lambda it: note_line_item(it, number, found, now, is_made=is_made),
            )
        return url

    def _rest(self, taken: TakenScore, error: LaterError) -> None:
        # The pause is at least as long as the platform asks, up to a limit.
        name, now = taken.registration.id, self.now()
        before = self._pauses.get(name)
        failures = 0 if before is None else before.failures
        until = self._doubled(failures)
        if error.seconds is not None:
            asked = min(timedelta(seconds=error.seconds), _MOST_ASKED)
            until = max(now + asked, until if failures else now)
        self._pauses[name] = _Pause(until, failures + 1)
        self._later(taken, until, error)
        _log.warning("LTI: %s gets no scores until %s: %s", name, until.isoformat(), error)

    def _later(self, taken: TakenScore, at: datetime, problem: ScoreError | None) -> None:
        in_transaction(self._engine, lambda it: note_later(it, taken, self._name, at, problem))

    def _doubled(self, failures: int) -> datetime:
        return self.now() + pause_after(failures, self._chance())


# --- For tutors: list a course's scores, and queue scores again


def scores_of(
    connection: Connection, course: str, wanted: SendAgainRequest, language: Language = ENGLISH
) -> list[PlatformScore]:
    """Return the scores of a course, ordered by assignment and learner. Raises CourseError.

    The problems of scores are in ``language``.
    """
    _check(connection, course, wanted)
    enrolled = and_(
        course_learners.c.course == course, course_learners.c.learner == scores.c.learner
    )
    rows = connection.execute(
        select(
            scores,
            course_learners.c.name,
            course_learners.c.family_name,
            line_items.c.assignment.label("of_assignment"),
            assignments.c.id.label("assignment"),
            resource_links.c.title.label("link"),
        )
        .join_from(scores, line_items)
        .join(assignments, assignments.c.number == line_items.c.assignment)
        .join(resource_links, resource_links.c.number == line_items.c.resource_link)
        .join(course_learners, enrolled)
        .where(_chosen(course, wanted))
    ).all()
    ordered = sorted(rows, key=lambda it: (it.of_assignment, place_of(it), it.line_item))
    return [
        PlatformScore(
            learner=row.learner,
            name=row.name,
            assignment=row.assignment,
            link=row.link,
            state=row.state,
            sent_points=row.sent_points,
            sent_at=row.sent_at,
            max_points=row.max_points,
            tries=row.tries,
            next_try_at=row.next_try_at if row.state == "waiting" else None,
            problem=problem_told(row.refusal, language) or None,
        )
        for row in ordered
    ]


def send_again(connection: Connection, course: str, wanted: SendAgainRequest, now: datetime) -> int:
    """Queue scores to be sent again; return their number. Raises CourseError.

    A score whose attempts have expired and were deleted stays at the platform as it is.
    """
    _check(connection, course, wanted)
    has_attempt = exists().where(
        attempts.c.assignment == line_items.c.assignment,
        attempts.c.learner == scores.c.learner,
        or_(attempts.c.ordinal.is_not(None), attempts.c.awarded.is_not(None)),
    )
    chosen = (
        select(scores.c.line_item, scores.c.learner)
        .join_from(scores, line_items)
        .join(assignments, assignments.c.number == line_items.c.assignment)
        .where(_chosen(course, wanted), has_attempt)
    )
    places = connection.execute(chosen).all()
    for line_item, learner in places:
        mine = (scores.c.line_item == line_item) & (scores.c.learner == learner)
        # A try without success: the score is sent even if the platform has these points.
        values = {
            "state": "waiting",
            "version": scores.c.version + 1,
            "priority": int(Priority.CHANGE),
            "tries": 1,
            "next_try_at": now,
        }
        connection.execute(update(scores).where(mine).values(values))
    if places:
        connection.info[QUEUED] = True
    return len(places)


def _check(connection: Connection, course: str, wanted: SendAgainRequest) -> None:
    roll.course(connection, course)
    if wanted.assignment is not None:
        assignment_of(connection, course, wanted.assignment)


def _chosen(course: str, wanted: SendAgainRequest) -> ColumnElement[bool]:
    chosen: Any = assignments.c.course == course
    if wanted.assignment is not None:
        chosen &= assignments.c.id == wanted.assignment
    if wanted.learner is not None:
        chosen &= scores.c.learner == wanted.learner
    if wanted.failed:
        tried_in_vain = (scores.c.state == "waiting") & scores.c.refusal.is_not(None)
        chosen &= (scores.c.state == "refused") | tried_in_vain
    return and_(chosen)
