"""Find the course, the assignment and the learner of a launch, or make them.

A context of the platform is a course here, a resource link is an assignment, and a user is a
learner.
"""

# Everything is done on one connection, in the transaction that uses up the login.

import hmac
import json
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta
from hashlib import sha256
from typing import Any, Final

from pydantic import ValidationError
from sqlalchemy import Connection, Row, insert, select, update

from service.access.caller import Scope
from service.access.key_table import add_key, keys_at, settle
from service.access.key_text import new_key_text
from service.access.keys import Secret
from service.attempts.recording import insert_or_ignore
from service.attempts.storage import lti_tables as tables
from service.attempts.storage.tables import assignments, course_learners, courses
from service.catalogue import Exercise
from service.contract.courses import CourseAssignment, NewAssignment, NewCourse
from service.courses import roll
from service.courses.assignments import add_assignment, assignment_of
from service.courses.dealing import pin_choices
from service.courses.errors import CourseError
from service.lti.messages import LaunchMessage
from service.lti.problems import LtiError
from service.lti.registrations import add_deployments, deployments_of
from service.lti.roles import LtiRole
from service.lti.scores.line_items import ensure_line_item, try_refused_again
from service.translations import say

# The lifetime of the key of a course, and how long before its end the next one is made.
_KEY_LIFETIME: Final = timedelta(days=400)
_KEY_RENEWAL: Final = timedelta(days=30)
# The last launch of a platform is noted once in this time.
_MINUTE: Final = timedelta(minutes=1)
# The custom parameters that are dates of an assignment.
DATES: Final = ("opens", "due")


@dataclass(frozen=True, slots=True)
class Landing:
    """The course and the assignment that a launch opens.

    ``context`` and ``link`` are row numbers, or 0 if nothing is recorded. ``assignment`` is None
    until exercises are chosen.
    """

    role: LtiRole
    context: int = 0
    link: int = 0
    course: str = ""
    course_title: str = ""
    key_id: str = ""
    learner: str = ""
    link_title: str = ""
    assignment: CourseAssignment | None = None


def enter(
    connection: Connection,
    message: LaunchMessage,
    secret: Secret,
    catalogue: Mapping[str, Exercise],
    now: datetime,
) -> Landing:
    """Record a launch and return what it opens. Raises LtiError."""
    # For previews and guests nothing is recorded; they see only what exists already.
    if not settle(connection, secret, now):
        raise LtiError("no-secret")
    check_deployment(connection, message, now)
    mine = message.registration.id
    if message.role in (LtiRole.PREVIEW, LtiRole.GUEST):
        return _visit(connection, message)
    launched = update(tables.registrations).where(tables.registrations.c.id == mine)
    # Launches of a class must not wait for each other: they change the rows that they share only if
    # something is new. Otherwise this row is a lock, so that nothing is made twice.
    if _is_set_up(connection, message):
        last = tables.registrations.c.launched_at
        launched = launched.where(last.is_(None) | (last < now - _MINUTE))
    connection.execute(launched.values(launched_at=now))
    context = context_of(connection, message, now)
    link = _link(connection, message, context, catalogue, now)
    learner = ""
    if message.role is LtiRole.LEARNER:
        assert message.sub is not None
        learner = enrolled(connection, mine, message.sub, context.course, secret, now)
        try_refused_again(connection, learner, now)
    ensure_line_item(connection, link.number)
    return Landing(
        role=message.role,
        context=context.number,
        link=link.number,
        course=context.course,
        course_title=roll.course(connection, context.course).title,
        key_id=context.key,
        learner=learner,
        link_title=link.title,
        assignment=linked_assignment(connection, context.course, link.assignment),
    )


def pseudonym(registration: str, sub: str, secret: Secret) -> str:
    """Return the pseudonym of a platform's user, which is the learner's id."""
    # Users of two platforms get different ids, even if their ``sub`` is the same.
    content = json.dumps([registration, sub]).encode()
    return f"lti-{hmac.digest(secret.lti_secret, b'learner ' + content, 'sha256').hex()[:24]}"


def pseudonymous_name(learner: str) -> str:
    """Return the pseudonym that is shown instead of a learner's real name."""
    return f"Learner {learner[-6:]}"


def enrolled(
    connection: Connection, registration: str, sub: str, course: str, secret: Secret, now: datetime
) -> str:
    """Enrol a platform's user in a course; return the learner's id."""
    learner = pseudonym(registration, sub, secret)
    values = {"registration": registration, "sub": sub, "learner": learner, "launched_at": now}
    statement = insert_or_ignore(tables.learners)[connection.dialect.name]
    connection.execute(statement.values(values))
    mine = tables.learners.c.learner == learner
    connection.execute(update(tables.learners).where(mine).values(launched_at=now))
    new = {"course": course, "learner": learner, "name": pseudonymous_name(learner)}
    enrolment = insert_or_ignore(course_learners)[connection.dialect.name]
    connection.execute(enrolment.values(new))
    return learner


def _is_set_up(connection: Connection, message: LaunchMessage) -> bool:
    context = known_context(connection, message)
    link = None if context is None else _known_link(connection, context.number, message.link)
    return link is not None and link.assignment is not None


def context_of(connection: Connection, message: LaunchMessage, now: datetime) -> Row[Any]:
    """Return the row of a message's context (its course); make missing rows."""
    found = known_context(connection, message)
    if found is None:
        course = f"lti-{_short(message.registration.id, message.deployment, message.context)}"
        title = message.context_title or f"Course of {message.registration.name}"[:200]
        if connection.scalar(select(courses.c.id).where(courses.c.id == course)) is None:
            new = NewCourse(id=course, title=title, zone=message.registration.zone)
            roll.add_course(connection, new, now)
        values = {
            "registration": message.registration.id,
            "deployment": message.deployment,
            "context": message.context,
            "course": course,
            "shows_names": False,
        }
        statement = insert_or_ignore(tables.contexts)[connection.dialect.name]
        connection.execute(statement.values(values))
        found = known_context(connection, message)
        assert found is not None
    changes = {"key": _course_key(connection, found, message, now)}
    if message.memberships_url:
        changes["memberships_url"] = message.memberships_url
    mine = tables.contexts.c.number == found.number
    if any(found._mapping[name] != value for name, value in changes.items()):
        connection.execute(update(tables.contexts).where(mine).values(changes))
    return connection.execute(select(tables.contexts).where(mine)).one()


def assign(
    connection: Connection, link: int, new: NewAssignment, catalogue: Mapping[str, Exercise]
) -> CourseAssignment:
    """Return the assignment of a resource link (a link in a course); make a missing one.

    Raises CourseError.
    """
    row = connection.execute(
        select(tables.resource_links, tables.contexts.c.course)
        .join_from(tables.resource_links, tables.contexts)
        .where(tables.resource_links.c.number == link)
    ).one_or_none()
    if row is None:
        raise CourseError("unknown-assignment", say("The resource link is not there any more."))
    found = linked_assignment(connection, row.course, row.assignment)
    if found is not None:
        return found
    made = add_assignment(connection, row.course, new, catalogue.keys())
    pin_choices(connection, row.course, made.id, catalogue)
    _set_assignment(connection, link, row.course, made.id)
    ensure_line_item(connection, link)
    return made


def new_assignment_id(link: int) -> str:
    """Return the id for a new assignment of a resource link (a link in a course)."""
    return f"lti-{link}"


def linked_assignment(
    connection: Connection, course: str, number: int | None
) -> CourseAssignment | None:
    """Return the assignment with this row number, or None."""
    if number is None:
        return None
    mine = (assignments.c.number == number) & (assignments.c.course == course)
    found = connection.scalar(select(assignments.c.id).where(mine))
    return None if found is None else assignment_of(connection, course, found)


def check_deployment(connection: Connection, message: LaunchMessage, now: datetime) -> None:
    """Check that the message's deployment (installation at the platform) is allowed.

    Raises LtiError.
    """
    mine = message.registration
    if message.deployment in deployments_of(connection, mine.id):
        return
    if not mine.any_deployment:
        raise LtiError("unknown-deployment", deployment=message.deployment)
    if message.role in (LtiRole.TUTOR, LtiRole.LEARNER):
        add_deployments(connection, mine.id, [message.deployment], now)


def _visit(connection: Connection, message: LaunchMessage) -> Landing:
    context = known_context(connection, message)
    if context is None:
        return Landing(message.role, link_title=message.link_title)
    link = _known_link(connection, context.number, message.link)
    number = None if link is None else link.assignment
    return Landing(
        message.role,
        course=context.course,
        key_id=context.key or "",
        link_title=message.link_title,
        assignment=linked_assignment(connection, context.course, number),
    )


def known_context(connection: Connection, message: LaunchMessage) -> Row[Any] | None:
    """Return the row of a message's context (its course), or None."""
    of = tables.contexts.c
    mine = (
        (of.registration == message.registration.id)
        & (of.deployment == message.deployment)
        & (of.context == message.context)
    )
    return connection.execute(select(tables.contexts).where(mine)).one_or_none()


def _course_key(
    connection: Connection, context: Row[Any], message: LaunchMessage, now: datetime
) -> str:
    if context.key is not None:
        found = keys_at(connection, [("id", context.key)]).get(("id", context.key))
        is_valid = found is not None and found.revoked_at is None
        if found is not None and is_valid and found.expires_at > now + _KEY_RENEWAL:
            return found.id
    # Nobody ever knows the text of this key: tokens and sessions name it by its id.
    unknown = sha256(new_key_text().encode()).hexdigest()
    name = f"LTI: {message.registration.name}"[:200]
    made = add_key(connection, name, unknown, Scope, None, now, now + _KEY_LIFETIME, context.course)
    return made.id


def _known_link(connection: Connection, context: int, link: str) -> Row[Any] | None:
    of = tables.resource_links.c
    mine = (of.context == context) & (of.link == link)
    return connection.execute(select(tables.resource_links).where(mine)).one_or_none()


def _link(
    connection: Connection,
    message: LaunchMessage,
    context: Row[Any],
    catalogue: Mapping[str, Exercise],
    now: datetime,
) -> Row[Any]:
    values = {
        "title": message.link_title or "Exercises",
        "lineitem_url": message.lineitem_url,
        "lineitems_url": message.lineitems_url,
        "scopes": message.scopes,
        "launched_at": now,
    }
    where = {"context": context.number, "link": message.link}
    found = _known_link(connection, context.number, message.link)
    if found is None:
        connection.execute(insert(tables.resource_links).values(where | values))
        found = _known_link(connection, context.number, message.link)
        assert found is not None
    elif any(
        found._mapping[name] != each for name, each in values.items() if name != "launched_at"
    ):
        mine = tables.resource_links.c.number == found.number
        connection.execute(update(tables.resource_links).where(mine).values(values))
    if found.assignment is None:
        _assign_by_parameters(connection, message, found, context.course, catalogue)
    found = _known_link(connection, context.number, message.link)
    assert found is not None
    return found


def _assign_by_parameters(
    connection: Connection,
    message: LaunchMessage,
    link: Row[Any],
    course: str,
    catalogue: Mapping[str, Exercise],
) -> None:
    # Do nothing if the parameters ask for no assignment, or for one that cannot be used.
    wanted = message.custom.get("assignment") or new_assignment_id(link.number)
    mine = (assignments.c.course == course) & (assignments.c.id == wanted)
    if connection.scalar(select(assignments.c.id).where(mine)) is None:
        new = parameters_assignment(message.custom, wanted, link.title, catalogue)
        if new is None:
            return
        try:
            with connection.begin_nested():
                add_assignment(connection, course, new, catalogue.keys())
                pin_choices(connection, course, wanted, catalogue)
        except CourseError:
            return
    elif "assignment" not in message.custom:
        return
    _set_assignment(connection, link.number, course, wanted)


def parameters_assignment(
    custom: Mapping[str, str], wanted: str, title: str, catalogue: Mapping[str, Exercise]
) -> NewAssignment | None:
    """Return the assignment that a launch's custom parameters ask for, or None.

    ``exercise`` names the exercises, perhaps with points: ``planar-rr=10,scara``.
    """
    # A date without a time zone is in the time zone of the course. With ``variants=true``, each
    # learner gets variants of their own.
    named = [each.strip() for each in custom.get("exercise", "").split(",")]
    exercises = []
    for name, _, points in (each.partition("=") for each in named if each):
        if name not in catalogue:
            return None
        exercises.append({"exercise": name, "points": points or _points(catalogue[name])})
    try:
        dates = {name: custom[name] for name in DATES if custom.get(name)}
        varied = custom.get("variants", "").lower() == "true"
        fields = {"id": wanted, "title": title, "exercises": exercises, "variants": varied, **dates}
        return NewAssignment.model_validate(fields)
    except ValidationError:
        return None


def _points(exercise: Exercise) -> float:
    return sum(part.points for part in exercise.parts)


def _set_assignment(connection: Connection, link: int, course: str, assignment: str) -> None:
    mine = (assignments.c.course == course) & (assignments.c.id == assignment)
    number = connection.scalar(select(assignments.c.number).where(mine))
    chosen = update(tables.resource_links).where(tables.resource_links.c.number == link)
    connection.execute(chosen.values(assignment=number))


def _short(*parts: str) -> str:
    return sha256(json.dumps(parts).encode()).hexdigest()[:12]
