"""Database functions that delete courses and assignments, and that remove learners."""

from datetime import datetime

from sqlalchemy import (
    ColumnElement,
    Connection,
    Select,
    Table,
    delete,
    func,
    select,
    true,
    update,
)

from service.attempts.learner_data import delete_attempts
from service.attempts.storage.lti_tables import contexts, line_items, resource_links, scores
from service.attempts.storage.score_queue import queue_scores
from service.attempts.storage.tables import (
    assignments,
    attempts,
    course_learners,
    courses,
    deals,
    extensions,
    keys,
)
from service.contract.courses import DeletedData, DeletionRequest, RemovalRequest
from service.courses import roll
from service.courses.assignments import assignment_of
from service.courses.errors import CourseError, unknown_learner
from service.courses.links import people
from service.translations import say, template

_COURSE_HAS_ATTEMPTS = template(
    "The course {name} has {count} recorded attempts. Delete them, too: with_attempts."
)
_ASSIGNMENT_HAS_ATTEMPTS = template(
    "The assignment {name} has {count} recorded attempts. Delete them, too: with_attempts."
)


def delete_course(
    connection: Connection, course: str, wanted: DeletionRequest, now: datetime
) -> DeletedData:
    """Delete a course with its assignments, and end its keys and links. Raises CourseError."""
    roll.course(connection, course)
    mine = _assignments(connection, course, true())
    ending = (keys.c.course == course) & keys.c.revoked_at.is_(None)
    enrolled = course_learners.c.course == course
    data = DeletedData(
        deleted=wanted.apply,
        assignments=_count(connection, assignments, assignments.c.course == course),
        learners=_count(connection, course_learners, enrolled),
        extensions=_count(connection, extensions, extensions.c.assignment.in_(mine)),
        keys=_count(connection, keys, ending & (keys.c.expires_at > now)),
        attempts=_count(connection, attempts, attempts.c.assignment.in_(mine)),
    )
    if wanted.apply:
        _require_none(data, wanted, _COURSE_HAS_ATTEMPTS, course)
        _delete_assignments(connection, mine)
        # The next launch from there makes a new course.
        of_course = select(contexts.c.number).where(contexts.c.course == course)
        connection.execute(delete(resource_links).where(resource_links.c.context.in_(of_course)))
        connection.execute(delete(contexts).where(contexts.c.course == course))
        connection.execute(delete(course_learners).where(enrolled))
        connection.execute(update(keys).where(ending).values(revoked_at=now))
        connection.execute(delete(courses).where(courses.c.id == course))
    return data


def delete_assignment(
    connection: Connection, course: str, assignment: str, wanted: DeletionRequest
) -> DeletedData:
    """Delete an assignment with its extensions. Raises CourseError."""
    assignment_of(connection, course, assignment)
    mine = _assignments(connection, course, assignments.c.id == assignment)
    data = DeletedData(
        deleted=wanted.apply,
        assignments=1,
        learners=0,
        extensions=_count(connection, extensions, extensions.c.assignment.in_(mine)),
        keys=0,
        attempts=_count(connection, attempts, attempts.c.assignment.in_(mine)),
    )
    if wanted.apply:
        _require_none(data, wanted, _ASSIGNMENT_HAS_ATTEMPTS, assignment)
        _delete_assignments(connection, mine)
    return data


def remove_learner(
    connection: Connection, course: str, wanted: RemovalRequest, now: datetime
) -> DeletedData:
    """Remove a learner from a course. Raises CourseError.

    Without ``with_attempts`` the learner's attempts stay.
    """
    # The attempts count again if the learner comes back.
    learner = wanted.learner
    if learner not in {each.learner for each in people(connection, course)}:
        raise unknown_learner(learner)
    mine = _assignments(connection, course, true())
    ending = (keys.c.course == course) & (keys.c.learner == learner) & keys.c.revoked_at.is_(None)
    extended = extensions.c.assignment.in_(mine) & (extensions.c.learner == learner)
    handed_in = attempts.c.assignment.in_(mine) & (attempts.c.learner == learner)
    data = DeletedData(
        deleted=wanted.apply,
        assignments=0,
        learners=1,
        extensions=_count(connection, extensions, extended),
        keys=_count(connection, keys, ending & (keys.c.expires_at > now)),
        attempts=_count(connection, attempts, handed_in),
    )
    if wanted.apply:
        if wanted.with_attempts:
            queue_scores(connection, handed_in)
            delete_attempts(connection, handed_in)
            dealt = deals.c.assignment.in_(mine) & (deals.c.learner == learner)
            connection.execute(delete(deals).where(dealt))
        connection.execute(delete(extensions).where(extended))
        connection.execute(update(keys).where(ending).values(revoked_at=now))
        enrolled = (course_learners.c.course == course) & (course_learners.c.learner == learner)
        connection.execute(delete(course_learners).where(enrolled))
    return data


def _assignments(
    connection: Connection, course: str, chosen: ColumnElement[bool]
) -> Select[tuple[int]]:
    # Nobody can hand in at these assignments until the transaction ends, because they are locked.
    mine = select(assignments.c.number).where(assignments.c.course == course, chosen)
    connection.execute(mine.with_for_update()).all()
    return mine


def _delete_assignments(connection: Connection, numbers: Select[tuple[int]]) -> None:
    delete_attempts(connection, attempts.c.assignment.in_(numbers))
    # What platforms know already stays in their gradebooks.
    items = select(line_items.c.number).where(line_items.c.assignment.in_(numbers))
    connection.execute(delete(scores).where(scores.c.line_item.in_(items)))
    connection.execute(delete(line_items).where(line_items.c.assignment.in_(numbers)))
    linked = resource_links.c.assignment.in_(numbers)
    connection.execute(update(resource_links).where(linked).values(assignment=None))
    for table in (extensions, deals):
        connection.execute(delete(table).where(table.c.assignment.in_(numbers)))
    connection.execute(delete(assignments).where(assignments.c.number.in_(numbers)))


def _require_none(data: DeletedData, wanted: DeletionRequest, told: str, name: str) -> None:
    if data.attempts and not wanted.with_attempts:
        raise CourseError("has-attempts", say(told, name=name, count=data.attempts))


def _count(connection: Connection, table: Table, condition: ColumnElement[bool]) -> int:
    return connection.scalar(select(func.count()).select_from(table).where(condition)) or 0
