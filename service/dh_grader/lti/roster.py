"""The members of a course from its platform, page by page, and what they change here.

Tutors who add learners by hand, or by a class list, do so by ``dh_grader.courses``.
"""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from http import HTTPStatus
from time import monotonic
from typing import Any, Final
from urllib.parse import parse_qs, urljoin, urlsplit, urlunsplit

from sqlalchemy import Connection, Row, bindparam, delete, select, update

from dh_grader.access import Secret
from dh_grader.contract.courses import MOST_LEARNERS
from dh_grader.formats.texts import visible
from dh_grader.lti.fetching import FetchError, SigningKey, answer, content, ensure_key, signing_key
from dh_grader.lti.grade_services import ScoreError, fetched_token
from dh_grader.lti.launch import pseudonym, pseudonymous_name
from dh_grader.lti.registrations import (
    LtiError,
    LtiRole,
    Registration,
    origin_of,
    registration,
    role_of,
    unusable,
)
from dh_grader.store import tables
from dh_grader.store.attempts import insert_or_ignore
from dh_grader.store.tables import course_learners
from dh_grader.translations import say

# --- Read the members of a course from its platform, page by page


SCOPE: Final = "https://purl.imsglobal.org/spec/lti-nrps/scope/contextmembership.readonly"
_MEDIA_TYPE: Final = "application/vnd.ims.lti-nrps.v2.membershipcontainer+json"
# Limits of what a platform may send.
MOST_PAGES: Final = 200
LARGEST_PAGE: Final = 4 * 1024 * 1024
# How long all pages together may take (seconds), and the learners that we ask for on one page: a
# page of a whole course would take platforms longer than one exchange may.
_ROSTER_TIME: Final = 60.0
_PAGE_SIZE: Final = 200
_LONGEST_ID: Final = 255
_LONGEST_NAME: Final = 200


@dataclass(frozen=True, slots=True)
class Member:
    """A learner in the roster of a platform; ``name`` is "" if the platform does not send it."""

    sub: str
    name: str
    family_name: str = ""


def read_members(registration: Registration, url: str, token: str) -> list[Member]:
    """Return the active learners of a course, each once. Raises FetchError.

    Inactive and deleted members, test users and members with other roles are left out.
    """
    found: dict[str, Member] = {}
    for page in _pages(registration, url, token):
        listed = page.get("members")
        if not isinstance(listed, list):
            raise FetchError(say("the answer has no list of members"))
        for each in listed:
            member = _member(each)
            if member is not None:
                found[member.sub] = member
        if len(found) > MOST_LEARNERS:
            raise FetchError(say("the course has more than {most} learners", most=MOST_LEARNERS))
    return list(found.values())


def _pages(registration: Registration, url: str, token: str) -> Iterator[Mapping[str, Any]]:
    # All pages must have the same origin.
    local, first = registration.is_development, url
    until = monotonic() + _ROSTER_TIME
    url = _in_pages(url)
    for _ in range(MOST_PAGES):
        page, following = _page(url, token, until, local=local)
        yield page
        if not following:
            return
        url = urljoin(url, following)
        if unusable(url, local=local) or origin_of(url) != origin_of(first):
            raise FetchError(say("the next page is at another host"))
    raise FetchError(say("the roster has more than {most} pages", most=MOST_PAGES))


def _page(url: str, token: str, until: float, *, local: bool) -> tuple[Mapping[str, Any], str]:
    # The address of the next page may be "".
    headers = {"Authorization": f"Bearer {token}", "Accept": _MEDIA_TYPE}
    with answer(url, local=local, headers=headers, until=until) as response:
        if response.status_code != HTTPStatus.OK:
            raise FetchError(
                say("the platform does not give the roster ({status})", status=response.status_code)
            )
        try:
            page = json.loads(content(response, LARGEST_PAGE))
        except (ValueError, RecursionError) as error:
            raise FetchError(say("the roster is not JSON")) from error
        following = response.links.get("next", {}).get("url", "")
    if not isinstance(page, dict):
        raise FetchError(say("the answer has no list of members"))
    return page, following


def _in_pages(url: str) -> str:
    # The platform may choose another size. A size in its own address stays.
    parts = urlsplit(url)
    if "limit" in parse_qs(parts.query):
        return url
    query = "&".join(filter(None, (parts.query, f"limit={_PAGE_SIZE}")))
    return urlunsplit(parts._replace(query=query))


def _member(entry: Any) -> Member | None:
    if not isinstance(entry, dict) or entry.get("status", "Active") != "Active":
        return None
    sub, roles = entry.get("user_id"), entry.get("roles")
    if not isinstance(sub, str) or not 0 < len(sub) <= _LONGEST_ID or not isinstance(roles, list):
        return None
    full = {_full(each) for each in roles if isinstance(each, str)}
    if role_of(full, has_id=True) is not LtiRole.LEARNER:
        return None
    name = entry.get("name")
    if not isinstance(name, str) or not name.strip():
        parts = [entry.get(each) for each in ("given_name", "family_name")]
        name = " ".join(each for each in parts if isinstance(each, str))
    family = entry.get("family_name")
    return Member(sub, _line(name), _line(family if isinstance(family, str) else ""))


def _line(text: str) -> str:
    return visible(" ".join(text.split()))[:_LONGEST_NAME].strip()


def _full(role: str) -> str:
    # In rosters, roles of a course may be short: ``Learner``.
    is_short = "/" not in role and ":" not in role
    return f"http://purl.imsglobal.org/vocab/lis/v2/membership#{role}" if is_short else role


# --- Update the learners of a course from the roster (list of members) of its platform


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


def roster_context(connection: Connection, course: str) -> Row[Any] | None:
    """Return the row that connects a course with its platform's roster, or None."""
    of = tables.contexts.c
    mine = (of.course == course) & of.memberships_url.is_not(None)
    return connection.execute(select(tables.contexts).where(mine).limit(1)).one_or_none()


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
