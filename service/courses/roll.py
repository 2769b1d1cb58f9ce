"""Database functions for courses and their learners."""

import secrets
from collections.abc import Iterable
from datetime import datetime

from sqlalchemy import ColumnElement, Connection, func, insert, select, true, update

from service.attempts.recording import insert_or_ignore
from service.attempts.storage.tables import assignments, course_learners, courses
from service.contract.courses import Course, CourseChange, CourseLearner, NewCourse, NewLearner
from service.courses.errors import CourseError, unknown_course
from service.courses.links import links_until, people
from service.courses.times import zone_named
from service.translations import say


def add_course(connection: Connection, new: NewCourse, now: datetime) -> Course:
    """Add a course. Raises CourseError."""
    zone_named(new.zone)
    values = new.model_dump() | {"created_at": now}
    added = connection.execute(insert_or_ignore(courses)[connection.dialect.name].values(values))
    if not added.rowcount:
        raise CourseError(
            "already-there", say("There is a course {course} already.", course=new.id)
        )
    return course(connection, new.id)


def change_course(connection: Connection, course_id: str, change: CourseChange) -> Course:
    """Change the title or the time zone of a course. Raises CourseError."""
    if change.zone is not None:
        zone_named(change.zone)
    course(connection, course_id)
    if values := change.model_dump(exclude_none=True):
        connection.execute(update(courses).where(courses.c.id == course_id).values(values))
    return course(connection, course_id)


def course(connection: Connection, course_id: str) -> Course:
    """Return a course. Raises CourseError."""
    for found in _courses(connection, courses.c.id == course_id):
        return found
    raise unknown_course(course_id)


def all_courses(connection: Connection, only: str | None = None) -> list[Course]:
    """Return the courses, the newest first; ``only`` restricts the result to one course."""
    return _courses(connection, true() if only is None else courses.c.id == only)


def _courses(connection: Connection, condition: ColumnElement[bool]) -> list[Course]:
    of_course = course_learners.c.course == courses.c.id
    learners = select(func.count()).where(of_course).scalar_subquery()
    rows = connection.execute(
        select(courses.c.id, courses.c.title, courses.c.zone, learners.label("learners"))
        .where(condition)
        .order_by(courses.c.created_at.desc(), courses.c.id)
    ).all()
    ids: dict[str, list[str]] = {row.id: [] for row in rows}
    ordered = select(assignments.c.course, assignments.c.id).order_by(assignments.c.number)
    for course_id, assignment in connection.execute(ordered.where(assignments.c.course.in_(ids))):
        ids[course_id].append(assignment)
    return [Course(**row._mapping, assignments=ids[row.id]) for row in rows]


def learners(connection: Connection, course_id: str, now: datetime) -> list[CourseLearner]:
    """Return the learners of a course, by name. Raises CourseError."""
    rows = people(connection, course_id)
    until = links_until(connection, course_id, now)
    return [CourseLearner(**row._mapping, link_until=until.get(row.learner)) for row in rows]


def add_learners(connection: Connection, course_id: str, new: Iterable[NewLearner]) -> int:
    """Add or change learners; return the number of new learners. Raises CourseError.

    A learner without an id is found by the e-mail address.
    """
    course(connection, course_id)
    of_course = course_learners.c
    rows = connection.execute(
        select(of_course.learner, of_course.email).where(of_course.course == course_id)
    ).all()
    known = {row.learner for row in rows}
    by_email = {row.email.lower(): row.learner for row in rows if row.email}
    count = len(known)
    for each in new:
        email = each.email.lower() if each.email else None
        learner = each.learner or by_email.get(email or "") or secrets.token_hex(8)
        values = {"name": each.name, "family_name": each.family_name}
        values |= {"email": each.email} if each.email else {}
        where = {"course": course_id, "learner": learner}
        if learner in known:
            mine = (of_course.course == course_id) & (of_course.learner == learner)
            connection.execute(update(course_learners).where(mine).values(values))
        else:
            connection.execute(insert(course_learners).values(values | where))
            known.add(learner)
        if email is not None:
            by_email[email] = learner
    return len(known) - count
