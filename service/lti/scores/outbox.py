"""The queue of scores to send; each score is leased to one process.

If a process dies, its lease ends, and another process sends the score again.
"""

# The second time, the score has a later timestamp, so that in the end the platform has the correct
# score.

from collections.abc import Collection
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any, Final

from sqlalchemy import Connection, Row, delete, or_, select, update

from service.attempts.storage.lti_tables import contexts, line_items, resource_links, scores
from service.attempts.storage.score_queue import FORGOTTEN
from service.attempts.storage.tables import assignments
from service.lti.registrations import Registration, registration
from service.lti.scores.grade_services import Column
from service.lti.scores.learner_score import LearnerScore, learner_score
from service.lti.scores.score_problems import ScoreError

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

    Registrations in ``without`` are skipped.
    """
    # Scores that the platform already has are marked as sent.
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
    """Mark a score as sent."""
    # A score that has changed meanwhile stays queued.
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
