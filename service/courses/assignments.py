"""Database functions for the assignments of a course and the extensions of learners."""

import json
import secrets
from collections.abc import Collection, Mapping
from datetime import datetime
from typing import Any
from zoneinfo import ZoneInfo

from sqlalchemy import Connection, Row, delete, insert, select, update

from service.attempts.policy import points_after
from service.attempts.recording import insert_or_ignore
from service.attempts.storage.score_queue import Priority, queue_scores
from service.attempts.storage.tables import assignments, attempts, course_learners, extensions
from service.contract.courses import (
    AssignmentChange,
    CourseAssignment,
    Extension,
    NewAssignment,
)
from service.courses import roll
from service.courses.errors import CourseError, unknown_assignment, unknown_learner
from service.courses.terms import extended
from service.courses.times import local, moment
from service.submissions.lookup import nearest
from service.translations import paragraph, say


def add_assignment(
    connection: Connection, course: str, new: NewAssignment, known: Collection[str]
) -> CourseAssignment:
    """Add an assignment; ``known`` are the ids of all exercises. Raises CourseError."""
    zone = _zone(connection, course)
    values = {"late_worth": 0.5, "solution": "never", "course": course, "id": new.id}
    values |= _values(new, zone, known)
    is_graded = len(new.feedback or ()) > 1
    values.setdefault("practice", "none" if new.limit or is_graded else "open")
    statement = insert_or_ignore(assignments)[connection.dialect.name].values(values)
    if not connection.execute(statement).rowcount:
        raise CourseError(
            "already-there",
            say("The course has an assignment {assignment} already.", assignment=new.id),
        )
    return _checked(connection, course, new.id)


def change_assignment(
    connection: Connection,
    course: str,
    assignment: str,
    change: AssignmentChange,
    known: Collection[str],
) -> CourseAssignment:
    """Change an assignment and return it. Raises CourseError."""
    # A later due date also applies to recorded attempts that were late. An earlier due date makes
    # no recorded attempt late.
    zone = _zone(connection, course)
    row = assignment_row(connection, course, assignment)
    values = dict(_values(change, zone, known))
    if row.variants is not None and change.variants:
        # Another secret would change the variants of all learners.
        del values["variants"], values["choices"]
    if values:
        mine = assignments.c.number == row.number
        connection.execute(update(assignments).where(mine).values(values))
    changed = _checked(connection, course, assignment)
    _excuse(connection, assignment_row(connection, course, assignment), zone)
    if change.exercises is not None:
        handed_in = attempts.c.assignment == row.number
        queue_scores(connection, handed_in, Priority.REGRADE)
    return changed


def extend(
    connection: Connection, course: str, assignment: str, extension: Extension
) -> CourseAssignment:
    """Change the dates or the limit of attempts for one learner. Raises CourseError.

    An empty extension ends the learner's extension.
    """
    # Attempts that are no longer late get their points back.
    zone = _zone(connection, course)
    row = assignment_row(connection, course, assignment)
    enrolled = (course_learners.c.course == course) & (
        course_learners.c.learner == extension.learner
    )
    if connection.scalar(select(course_learners.c.learner).where(enrolled)) is None:
        raise unknown_learner(extension.learner)
    values = {
        "due": _moment(extension.due, zone),
        "closes": _moment(extension.closes, zone),
        "max_attempts": extension.limit,
    }
    if extension.closes is not None and extension.due is None and row.due is None:
        raise _closes_needs_due()
    own = (extensions.c.assignment == row.number) & (extensions.c.learner == extension.learner)
    connection.execute(delete(extensions).where(own))
    if any(each is not None for each in values.values()):
        new = {"assignment": row.number, "learner": extension.learner}
        connection.execute(insert(extensions).values(new | values))
    _excuse(connection, row, zone)
    return assignment_of(connection, course, assignment)


def assignment_of(connection: Connection, course: str, assignment: str) -> CourseAssignment:
    """Return an assignment. Raises CourseError."""
    for each in assignments_of(connection, course):
        if each.id == assignment:
            return each
    raise unknown_assignment(assignment)


def assignments_of(connection: Connection, course: str) -> list[CourseAssignment]:
    """Return the assignments of a course in the order in which they were added.

    Raises CourseError.
    """
    zone = _zone(connection, course)
    mine = assignments.c.course == course
    extensions_of: dict[int, list[Extension]] = {}
    given = select(extensions).join_from(extensions, assignments).where(mine)
    for row in connection.execute(given.order_by(extensions.c.learner)):
        extension = Extension(
            learner=row.learner,
            due=local(row.due, zone),
            closes=local(row.closes, zone),
            limit=row.max_attempts,
        )
        extensions_of.setdefault(row.assignment, []).append(extension)
    rows = connection.execute(select(assignments).where(mine).order_by(assignments.c.number))
    return [
        CourseAssignment(
            id=row.id,
            title=row.title,
            opens=local(row.opens, zone),
            due=local(row.due, zone),
            closes=local(row.closes, zone),
            late_worth=row.late_worth,
            exercises=json.loads(row.exercises),
            limit=row.max_attempts,
            feedback=None if row.feedback is None else json.loads(row.feedback),
            practice=row.practice,
            solution=row.solution,
            variants=row.variants is not None,
            hint_prices=None if row.hint_prices is None else json.loads(row.hint_prices),
            extensions=extensions_of.get(row.number, []),
        )
        for row in rows
    ]


def _zone(connection: Connection, course: str) -> ZoneInfo:
    return ZoneInfo(roll.course(connection, course).zone)


def assignment_row(connection: Connection, course: str, assignment: str) -> Row[Any]:
    """Return the row of an assignment. Raises CourseError."""
    mine = (assignments.c.course == course) & (assignments.c.id == assignment)
    found = connection.execute(select(assignments).where(mine)).one_or_none()
    if found is None:
        raise unknown_assignment(assignment)
    return found


def _moment(written: datetime | None, zone: ZoneInfo) -> datetime | None:
    return None if written is None else moment(written, zone)


def _values(change: AssignmentChange, zone: ZoneInfo, known: Collection[str]) -> Mapping[str, Any]:
    given = change.model_dump(mode="python", exclude_unset=True, exclude={"id", "renew_variants"})
    values: dict[str, Any] = {}
    for name, value in given.items():
        match name:
            case "opens" | "due" | "closes":
                values[name] = _moment(value, zone)
            case "limit":
                values["max_attempts"] = value
            case "feedback" | "hint_prices":
                values[name] = None if value is None else json.dumps(value)
            case "variants" if value is not None:
                values[name] = secrets.token_hex(32) if value else None
                values["choices"] = None
            case "exercises" if value is not None:
                _check_exercises([each["exercise"] for each in value], known)
                values[name] = json.dumps(value)
            case _ if value is not None:
                values[name] = value
    return values


def _check_exercises(chosen: list[str], known: Collection[str]) -> None:
    for i, exercise in enumerate(chosen):
        if exercise not in known:
            meant = nearest(exercise, known)
            message = paragraph(
                say("There is no exercise {exercise}.", exercise=exercise),
                say("Did you mean {meant}?", meant=meant) if meant else "",
                say(
                    "A new file must be in a folder of DH_GRADER_EXERCISES_DIR. The service reads "
                    "it when it starts, or at once with DH_GRADER_RELOAD_EXERCISES=true."
                ),
            )
            raise CourseError("unusable", message)
        if exercise in chosen[:i]:
            raise CourseError(
                "unusable", say("The exercise {exercise} is there twice.", exercise=exercise)
            )


def _checked(connection: Connection, course: str, assignment: str) -> CourseAssignment:
    found = assignment_of(connection, course, assignment)
    if found.closes is not None and found.due is None:
        raise _closes_needs_due()
    moments = [each for each in (found.opens, found.due, found.closes) if each is not None]
    if moments != sorted(moments):
        order = say("opens, due and closes must follow each other in this order")
        raise CourseError("unusable", order)
    return found


def _closes_needs_due() -> CourseError:
    message = say("closes says how long late attempts are taken: it needs due")
    return CourseError("unusable", message)


def _excuse(connection: Connection, row: Row[Any], zone: ZoneInfo) -> None:
    # Restore the points of attempts that were late, and are in time by the current dates.
    named = ("number", "learner", "at", "report", "max_points", "hint_price")
    late = select(*(attempts.c[name] for name in named)).where(
        attempts.c.assignment == row.number, attempts.c.is_late
    )
    given = select(extensions).where(extensions.c.assignment == row.number)
    own = {each.learner: each for each in connection.execute(given)}
    excused = []
    for attempt in connection.execute(late).all():
        mine = own.get(attempt.learner)
        due = extended(row, zone, None if mine is None else mine.due).due
        if due is None or attempt.at <= due:
            points = json.loads(attempt.report)["points"]
            points = points_after(points, attempt.max_points, attempt.hint_price, 1.0)
            connection.execute(
                update(attempts)
                .where(attempts.c.number == attempt.number)
                .values(is_late=False, worth=1.0, points=points)
            )
            excused.append(attempt.number)
    if excused:
        queue_scores(connection, attempts.c.number.in_(excused))
