"""Update the learners of a course from the roster (list of members) of its platform."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from sqlalchemy import Connection, Row, bindparam, delete, select, update

from service.access.keys import Secret
from service.attempts.recording import insert_or_ignore
from service.attempts.storage import lti_tables as tables
from service.attempts.storage.tables import course_learners
from service.lti.fetching import FetchError
from service.lti.linking import pseudonym, pseudonymous_name
from service.lti.own_keys import SigningKey, ensure_key, signing_key
from service.lti.problems import LtiError
from service.lti.registrations import Registration, registration
from service.lti.roster.members import SCOPE, Member, read_members
from service.lti.scores.access_tokens import fetched_token
from service.lti.scores.score_problems import ScoreError
from service.translations import say


class RosterError(Exception):
    """The roster was not read, and nothing has changed. The message says why."""


@dataclass(frozen=True, slots=True)
class RosterQuestion:
    """The data for reading a course's roster from its platform."""

    context: Row[Any]
    registration: Registration
    key: SigningKey
    now: datetime


@dataclass(frozen=True, slots=True)
class RosterChange:
    """How many learners a roster has added, removed and renamed in a course.

    ``learners`` is the number of learners in the roster.
    """

    learners: int
    added: int
    removed: int
    renamed: int


def roster_context(connection: Connection, course: str) -> Row[Any] | None:
    """Return the row that connects a course with its platform's roster, or None."""
    of = tables.contexts.c
    mine = (of.course == course) & of.memberships_url.is_not(None)
    return connection.execute(select(tables.contexts).where(mine).limit(1)).one_or_none()


def ask_for_roster(
    connection: Connection, course: str, secret: Secret, now: datetime
) -> RosterQuestion:
    """Return the data for reading the roster of a course. Raises RosterError."""
    context = roster_context(connection, course)
    if context is None:
        raise RosterError(say("The platform of this course does not tell its roster."))
    ensure_key(connection, secret, now)
    try:
        key = signing_key(connection, secret, now)
    except LtiError as error:
        raise RosterError(error.args[0]) from error
    return RosterQuestion(context, registration(connection, context.registration), key, now)


def read_roster(question: RosterQuestion) -> Sequence[Member]:
    """Return the active learners in a roster. Raises RosterError."""
    known = question.registration
    try:
        token, _ = fetched_token(known, SCOPE, question.key, question.now)
        members = read_members(known, question.context.memberships_url, token)
    except (FetchError, ScoreError) as error:
        reason = error.args[0]
        if reason.endswith("."):
            raise RosterError(say("The roster cannot be read: {reason}", reason=reason)) from error
        raise RosterError(say("The roster cannot be read: {reason}.", reason=reason)) from error
    if not members:
        # A platform that forgets its learners must not empty the course.
        raise RosterError(say("The roster has no learner. Nothing was changed."))
    return members


def enrol_members(
    connection: Connection,
    question: RosterQuestion,
    members: Sequence[Member],
    secret: Secret,
    *,
    shows_names: bool | None = None,
) -> RosterChange:
    """Enrol and rename the learners of a roster; remove learners who are not in the roster.

    ``shows_names`` turns the display of real names on or off; None changes nothing.
    """
    context, now = question.context, question.now
    if shows_names is None:
        shows_names = context.shows_names
    mine, course, kind = context.registration, context.course, connection.dialect.name
    learners = {pseudonym(mine, each.sub, secret): each for each in members}
    rows = [
        {"registration": mine, "sub": each.sub, "learner": learner}
        for learner, each in learners.items()
    ]
    connection.execute(insert_or_ignore(tables.learners)[kind], rows)
    wanted = {
        learner: (each.name if shows_names else "") or pseudonymous_name(learner)
        for learner, each in learners.items()
    }
    family = {
        learner: (each.family_name if shows_names and each.name else "") or None
        for learner, each in learners.items()
    }
    there = _enrolled(connection, mine, course)
    new = [
        {"course": course, "learner": learner, "name": name, "family_name": family[learner]}
        for learner, name in wanted.items()
        if learner not in there
    ]
    renamed = [
        {"of_learner": learner, "new_name": name, "new_family_name": family[learner]}
        for learner, name in wanted.items()
        if there.get(learner, (name, family[learner])) != (name, family[learner])
    ]
    gone = [{"of_learner": learner} for learner in there if learner not in wanted]
    of = course_learners.c
    one = (of.course == course) & (of.learner == bindparam("of_learner"))
    if new:
        connection.execute(insert_or_ignore(course_learners)[kind], new)
    if renamed:
        changed = (
            update(course_learners)
            .where(one)
            .values(name=bindparam("new_name"), family_name=bindparam("new_family_name"))
        )
        connection.execute(changed, renamed)
    if gone:
        # Attempts and extensions stay: a learner who comes back has them again.
        connection.execute(delete(course_learners).where(one), gone)
    noted = update(tables.contexts).where(tables.contexts.c.number == context.number)
    connection.execute(noted.values(shows_names=shows_names, roster_at=now))
    return RosterChange(len(wanted), len(new), len(gone), len(renamed))


def _enrolled(
    connection: Connection, registration_id: str, course: str
) -> dict[str, tuple[str, str | None]]:
    # Learners whom a tutor has added are left out, so that a roster does not remove them.
    of = course_learners.c
    joined = select(of.learner, of.name, of.family_name).join(
        tables.learners, tables.learners.c.learner == of.learner
    )
    mine = (of.course == course) & (tables.learners.c.registration == registration_id)
    rows = connection.execute(joined.where(mine))
    return {row.learner: (row.name, row.family_name) for row in rows}
