"""Courses in the database, their learners, and the personal links of learners.

The assignments of a course are in ``assignments.py``.
"""

import secrets
from collections.abc import Collection, Iterable, Iterator, Sequence
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import ColumnElement, Connection, Row, func, insert, select, true, update

from dh_grader.access import WRONG_SECRET, Key, Scope, Secret
from dh_grader.access.key_ring import insert_key, link_keys, settle
from dh_grader.contract.courses import (
    Course,
    CourseChange,
    CourseLearner,
    LinksRequest,
    NewCourse,
    NewLearner,
    PersonalLink,
)
from dh_grader.courses import CourseError, place_of, unknown_course, unknown_learner, zone_named
from dh_grader.formats import texts
from dh_grader.store import tables
from dh_grader.store.attempts import insert_or_ignore
from dh_grader.store.tables import course_learners, courses, keys
from dh_grader.translations import say

# --- Courses and their learners


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


def learners(connection: Connection, course_id: str, now: datetime) -> list[CourseLearner]:
    """Return the learners of a course, by name. Raises CourseError."""
    rows = people(connection, course_id)
    until = links_until(connection, course_id, now)
    return [CourseLearner(**row._mapping, link_until=until.get(row.learner)) for row in rows]


def people(connection: Connection, course: str) -> list[Row[Any]]:
    """Return the learners of a course in alphabetical order. Raises CourseError."""
    if connection.scalar(select(courses.c.id).where(courses.c.id == course)) is None:
        raise unknown_course(course)
    of_course = course_learners.c
    named = select(of_course.learner, of_course.name, of_course.family_name, of_course.email)
    return sorted(connection.execute(named.where(of_course.course == course)), key=place_of)


def _courses(connection: Connection, condition: ColumnElement[bool]) -> list[Course]:
    of_course = course_learners.c.course == courses.c.id
    learners = select(func.count()).where(of_course).scalar_subquery()
    rows = connection.execute(
        select(courses.c.id, courses.c.title, courses.c.zone, learners.label("learners"))
        .where(condition)
        .order_by(courses.c.created_at.desc(), courses.c.id)
    ).all()
    ids: dict[str, list[str]] = {row.id: [] for row in rows}
    of = tables.assignments.c
    ordered = select(of.course, of.id).order_by(of.number)
    for course_id, assignment in connection.execute(ordered.where(of.course.in_(ids))):
        ids[course_id].append(assignment)
    return [Course(**row._mapping, assignments=ids[row.id]) for row in rows]


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


# --- Personal links: each contains an API key for one learner
#
# The key is computed from the secret of the installation, and only its hash is stored. The service
# can compute the key again, so a tutor can print the links of a class twice.


# The page of a learner, relative to the service. The key is in the fragment, which browsers neither
# send to a server nor name as referrer.
_PAGE = "learn#"


def issue_links(
    connection: Connection,
    course: str,
    wanted: LinksRequest,
    secret: Secret,
    address: str,
    now: datetime,
) -> list[PersonalLink]:
    """Return the personal links of learners, and make missing ones. Raises CourseError.

    With ``wanted.renew``, all learners get new links. ``address`` is the address of the service.
    """
    if not settle(connection, secret, now):
        raise CourseError("unusable", WRONG_SECRET)
    valid = {} if wanted.renew else _valid(connection, course, now)
    chosen = _chosen(connection, course, wanted.learners)
    absent = [row.learner for row in chosen if row.learner not in valid]
    if absent:
        revoke_links(connection, course, absent, now)
    until = now.replace(microsecond=0) + timedelta(days=wanted.days)
    links = []
    for row in chosen:
        key = valid.get(row.learner)
        if key is None:
            scopes = frozenset({Scope.GRADE, Scope.RECORD})
            key_id = secrets.token_hex(4)
            key = Key(key_id, "", scopes, None, now, until, course=course, learner=row.learner)
            insert_key(connection, key, secret.key_digest(secret.link_key(key_id)))
        link = f"{address.rstrip('/')}/{_PAGE}{secret.link_key(key.id)}"
        links.append(PersonalLink(**row._mapping, link=link, expires_at=key.expires_at))
    return links


def written_links(links: Iterable[PersonalLink]) -> Iterator[bytes]:
    """Yield the lines of a CSV file with personal links, for a mail merge."""
    yield texts.line(("learner", "name", "email", "link", "expires"))
    for each in links:
        until = f"{each.expires_at:%Y-%m-%d}"
        yield texts.line((each.learner, each.name, each.email, each.link, until))


def revoke_links(
    connection: Connection, course: str, learners: Collection[str] | None, now: datetime
) -> int:
    """Revoke the links of ``learners``, or of all learners; return the number of revoked links."""
    mine = (keys.c.course == course) & keys.c.learner.is_not(None) & keys.c.revoked_at.is_(None)
    if learners is not None:
        mine &= keys.c.learner.in_(learners)
    return connection.execute(update(keys).where(mine).values(revoked_at=now)).rowcount


def links_until(connection: Connection, course: str, now: datetime) -> dict[str, datetime]:
    """Return when the link of each learner expires, by learner id."""
    return {learner: key.expires_at for learner, key in _valid(connection, course, now).items()}


def _valid(connection: Connection, course: str, now: datetime) -> dict[str, Key]:
    found = link_keys(connection, course)
    return {each.learner: each for each in found if each.learner and each.expires_at > now}


def _chosen(
    connection: Connection, course: str, only: Collection[str] | None
) -> Sequence[Row[Any]]:
    rows = people(connection, course)
    if only is None:
        return rows
    if unknown := sorted(set(only) - {row.learner for row in rows}):
        raise unknown_learner(unknown[0])
    return [row for row in rows if row.learner in set(only)]
