"""Personal links: each contains an API key for one learner.

The key is computed from the secret of the installation. Only a hash of the key is stored.
"""

# The service can compute the key again, so a tutor can print the links of a class twice.

import secrets
from collections.abc import Collection, Iterable, Iterator, Sequence
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import Connection, Row, select, update

from service.access.caller import Scope
from service.access.key_table import insert_key, link_keys, settle
from service.access.keys import WRONG_SECRET, Key, Secret
from service.attempts.storage.tables import course_learners, courses, keys
from service.contract.courses import LinksRequest, PersonalLink
from service.courses.errors import CourseError, unknown_course, unknown_learner
from service.courses.names import place_of
from service.formats.shared import spreadsheet

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
    yield spreadsheet.line(("learner", "name", "email", "link", "expires"))
    for each in links:
        until = f"{each.expires_at:%Y-%m-%d}"
        yield spreadsheet.line((each.learner, each.name, each.email, each.link, until))


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


def people(connection: Connection, course: str) -> list[Row[Any]]:
    """Return the learners of a course in alphabetical order. Raises CourseError."""
    if connection.scalar(select(courses.c.id).where(courses.c.id == course)) is None:
        raise unknown_course(course)
    of_course = course_learners.c
    named = select(of_course.learner, of_course.name, of_course.family_name, of_course.email)
    return sorted(connection.execute(named.where(of_course.course == course)), key=place_of)


def _chosen(
    connection: Connection, course: str, only: Collection[str] | None
) -> Sequence[Row[Any]]:
    rows = people(connection, course)
    if only is None:
        return rows
    if unknown := sorted(set(only) - {row.learner for row in rows}):
        raise unknown_learner(unknown[0])
    return [row for row in rows if row.learner in set(only)]
