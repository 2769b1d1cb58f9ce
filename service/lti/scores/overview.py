"""Database functions: list a course's scores for tutors, and queue scores again."""

from datetime import datetime
from typing import Any

from sqlalchemy import ColumnElement, Connection, and_, exists, or_, select, update

from service.attempts.storage.lti_tables import line_items, resource_links, scores
from service.attempts.storage.score_queue import QUEUED, Priority
from service.attempts.storage.tables import assignments, attempts, course_learners
from service.contract.scores import PlatformScore, SendAgainRequest
from service.courses import roll
from service.courses.assignments import assignment_of
from service.courses.names import place_of
from service.lti.scores.score_problems import told
from service.translations import ENGLISH, Language


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
            problem=told(row.refusal, language) or None,
        )
        for row in ordered
    ]


def send_again(connection: Connection, course: str, wanted: SendAgainRequest, now: datetime) -> int:
    """Queue scores to be sent again; return their number. Raises CourseError."""
    # A score whose attempts have expired and were deleted is not sent: it stays at the platform as
    # it is.
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
