"""A launch: its login, the check of its message, the course that it opens, and tickets.

The routes are in ``web/lti_routes.py``; why a launch is refused is said in ``registrations.py``.
"""

import hmac
import json
import secrets
import time
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta
from hashlib import sha256
from typing import Any, Final, Literal, TypeVar
from urllib.parse import urlencode

import jwt
from cryptography.hazmat.primitives.asymmetric.rsa import RSAPublicKey
from pydantic import BaseModel, ConfigDict, ValidationError
from sqlalchemy import Connection, Row, delete, insert, select, update

from dh_grader.access import Scope, Secret, new_key_text
from dh_grader.access.key_ring import add_key, keys_at, settle
from dh_grader.catalogue import Exercise
from dh_grader.contract.courses import CourseAssignment, NewAssignment, NewCourse
from dh_grader.courses import CourseError, roll
from dh_grader.courses.assignments import add_assignment, assignment_of, pin_choices
from dh_grader.lti.grade_services import ensure_line_item, try_refused_again
from dh_grader.lti.registrations import (
    LtiError,
    LtiRole,
    Registration,
    add_deployments,
    deployments_of,
    role_of,
    same_place,
)
from dh_grader.store import tables
from dh_grader.store.attempts import insert_or_ignore
from dh_grader.store.tables import assignments, course_learners, launches
from dh_grader.translations import say

# --- Logins of a platform's users; each login can be used once
#
# The database has only digests of a login's state, nonce and browser secret.


LOGINS_LIFETIME: Final = timedelta(minutes=10)
# The fields of a login, which may come by GET or POST, and their longest values.
_LONGEST: Final = {
    "iss": 1000,
    "client_id": 255,
    "login_hint": 4000,
    "lti_message_hint": 8000,
    "target_link_uri": 1000,
    "lti_deployment_id": 255,
    "lti_storage_target": 255,
}
_NEEDED: Final = ("iss", "login_hint", "target_link_uri")


@dataclass(frozen=True, slots=True)
class NewLogin:
    """A login that begins now; ``browser`` is the secret that the browser stores."""

    state: str
    nonce: str
    browser: str
    fields: Mapping[str, str]
    registration: Registration

    @property
    def address(self) -> str:
        """The address of the platform to which the browser goes next."""
        known = self.registration
        query = {
            "scope": "openid",
            "response_type": "id_token",
            "response_mode": "form_post",
            "prompt": "none",
            "client_id": known.client_id,
            "redirect_uri": known.launch_url,
            "login_hint": self.fields["login_hint"],
            "state": self.state,
            "nonce": self.nonce,
        }
        if "lti_message_hint" in self.fields:
            query["lti_message_hint"] = self.fields["lti_message_hint"]
        joint = "&" if "?" in known.auth_url else "?"
        return f"{known.auth_url}{joint}{urlencode(query)}"


@dataclass(frozen=True, slots=True)
class Login:
    """A login that was begun; ``fields`` are the fields of its request."""

    state: str
    nonce: str
    browser: str
    registration: str
    target: str
    deployment: str | None
    storage_target: str | None
    fields: Mapping[str, str]

    def is_of_browser(self, secret: str) -> bool:
        """True if the browser with this secret has begun the login."""
        return hmac.compare_digest(digest(secret), self.browser)


def login_fields(given: Mapping[str, str]) -> dict[str, str]:
    """Return the known fields of a login request that have a value. Raises LtiError."""
    fields = {name: given[name] for name in _LONGEST if given.get(name)}
    for name, value in fields.items():
        if len(value) > _LONGEST[name]:
            raise LtiError("login-too-long", name=name)
    for name in _NEEDED:
        if name not in fields:
            raise LtiError("login-incomplete", name=name)
    return fields


def begin_login(
    connection: Connection, registration: Registration, fields: Mapping[str, str], now: datetime
) -> NewLogin:
    """Store a new login and return it. Raises LtiError."""
    if not same_place(fields["target_link_uri"], registration.launch_url):
        raise LtiError("foreign-target", target=fields["target_link_uri"])
    state, nonce, browser = (secrets.token_urlsafe(32) for _ in range(3))
    expires = now + LOGINS_LIFETIME
    # Those that are over for as long again are not told from unknown ones.
    connection.execute(delete(launches).where(launches.c.expires_at < now - LOGINS_LIFETIME))
    connection.execute(
        insert(launches).values(
            state=digest(state),
            nonce=digest(nonce),
            browser=digest(browser),
            registration=registration.id,
            target=fields["target_link_uri"],
            deployment=fields.get("lti_deployment_id"),
            storage_target=fields.get("lti_storage_target"),
            parameters=json.dumps(dict(fields)),
            expires_at=expires,
        )
    )
    return NewLogin(state, nonce, browser, fields, registration)


def login_of(connection: Connection, state: str, now: datetime) -> Login:
    """Return the login with this state. Raises LtiError if the login is not valid."""
    if not state:
        raise LtiError("no-state")
    mine = launches.c.state == digest(state)
    row = connection.execute(select(launches).where(mine)).one_or_none()
    if row is None:
        raise LtiError("unknown-state")
    if row.used_at is not None:
        raise LtiError("state-used")
    if row.expires_at <= now:
        raise LtiError("state-expired")
    return Login(
        row.state,
        row.nonce,
        row.browser,
        row.registration,
        row.target,
        row.deployment,
        row.storage_target,
        json.loads(row.parameters),
    )


def use_login(connection: Connection, login: Login, now: datetime) -> None:
    """Mark a login as used. Raises LtiError if it was used already."""
    mine = (launches.c.state == login.state) & launches.c.used_at.is_(None)
    if not connection.execute(update(launches).where(mine).values(used_at=now)).rowcount:
        raise LtiError("state-used")


def digest(text: str) -> str:
    """Return the digest of a secret text, to store instead of the text."""
    return sha256(text.encode(errors="replace")).hexdigest()


# --- Check the messages of platforms (id tokens); each fault has its own code


LTI: Final = "https://purl.imsglobal.org/spec/lti/claim/"
RESOURCE_LINK: Final = "LtiResourceLinkRequest"
DEEP_LINKING: Final = "LtiDeepLinkingRequest"
REVIEW: Final = "LtiSubmissionReviewRequest"
# The report on a file that a student has handed in at the platform, and the settings of reports.
REPORT: Final = "LtiReportReviewRequest"
SETTINGS: Final = "LtiAssetProcessorSettingsRequest"
# The types of messages that are accepted, and for each whether it has a resource link.
KINDS: Final[dict[str, bool]] = {
    RESOURCE_LINK: True,
    DEEP_LINKING: False,
    REVIEW: True,
    REPORT: False,
    SETTINGS: False,
}
_AGS: Final = "https://purl.imsglobal.org/spec/lti-ags/claim/endpoint"
_NRPS: Final = "https://purl.imsglobal.org/spec/lti-nrps/claim/namesroleservice"
_MESSAGES_ALGORITHM: Final = "RS256"
_LEEWAY: Final = 10
# The greatest age of a message (seconds).
_OLDEST: Final = 3600
_LONGEST_TOKEN: Final = 48_000
_LONGEST_NAME: Final = 255
_LONGEST_ADDRESS: Final = 1000
_JWS: Final = jwt.PyJWS()


@dataclass(frozen=True, slots=True)
class LaunchMessage:
    """A message that has passed all checks. ``sub`` is None for guests.

    ``reviewed`` is the user whose attempts are to be shown, or "". ``locale`` is the language of
    the user on the platform, or "".
    """

    registration: Registration
    kind: str
    deployment: str
    role: LtiRole
    sub: str | None
    context: str
    context_title: str
    link: str
    link_title: str
    custom: Mapping[str, str]
    lineitem_url: str | None
    lineitems_url: str | None
    scopes: str
    memberships_url: str | None
    reviewed: str
    locale: str
    claims: Mapping[str, Any]


def key_id_of(token: str) -> str:
    """Return the id of the key with which a token claims to be signed. Raises LtiError."""
    # Keys and addresses of keys in the token's header are never used.
    if not token:
        raise LtiError("no-token")
    if len(token) > _LONGEST_TOKEN:
        raise LtiError("token-too-long")
    try:
        header = jwt.get_unverified_header(token)
    except (jwt.InvalidTokenError, RecursionError) as error:
        raise LtiError("token-malformed") from error
    if header.get("alg") != _MESSAGES_ALGORITHM:
        raise LtiError("wrong-algorithm", algorithm=header.get("alg"))
    key_id = header.get("kid")
    if not isinstance(key_id, str) or not key_id:
        raise LtiError("no-key-id")
    return key_id


def message_in(
    token: str, key: RSAPublicKey, registration: Registration, login: Login, now: datetime
) -> LaunchMessage:
    """Return the message in a token, which must belong to ``login``. Raises LtiError."""
    claims = signed_claims(token, key)
    check_parties(claims, registration)
    check_times(claims, now.timestamp())
    _check_nonce(claims, login)
    _check_kind(claims)
    deployment = _deployment(claims, login)
    _check_target(claims, login)
    return _content(claims, registration, deployment)


def signed_claims(token: str, key: RSAPublicKey) -> dict[str, Any]:
    """Return the claims of a token that is signed with this key. Raises LtiError."""
    try:
        claims = json.loads(_JWS.decode(token, key, [_MESSAGES_ALGORITHM]))
    except jwt.InvalidSignatureError as error:
        raise LtiError("wrong-signature") from error
    except (jwt.InvalidTokenError, ValueError, RecursionError) as error:
        raise LtiError("token-malformed") from error
    if not isinstance(claims, dict):
        raise LtiError("token-malformed")
    return claims


def check_parties(claims: Mapping[str, Any], registration: Registration) -> None:
    """Check that claims come from this platform and are addressed to us. Raises LtiError."""
    if claims.get("iss") != registration.issuer:
        raise LtiError("wrong-issuer")
    audience = claims.get("aud")
    listed = audience if isinstance(audience, list) else [audience]
    if registration.client_id not in listed:
        raise LtiError("wrong-audience")
    party = claims.get("azp")
    if party != registration.client_id and (party is not None or len(listed) > 1):
        raise LtiError("wrong-party")


def check_times(claims: Mapping[str, Any], now: float) -> None:
    """Check that claims are neither old nor from the future. Raises LtiError."""
    expires, issued, begins = (_number(claims.get(name)) for name in ("exp", "iat", "nbf"))
    if expires is None:
        raise LtiError("no-expiry")
    if expires <= now - _LEEWAY:
        raise LtiError("expired")
    if issued is None:
        raise LtiError("no-issue-time")
    if issued > now + _LEEWAY:
        raise LtiError("issued-later")
    if issued < now - _OLDEST:
        raise LtiError("issued-before")
    if begins is not None and begins > now + _LEEWAY:
        raise LtiError("not-yet-valid")


def _number(value: Any) -> float | None:
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return value if is_number and abs(value) < 1e12 else None


def _check_nonce(claims: Mapping[str, Any], login: Login) -> None:
    nonce = claims.get("nonce")
    if not isinstance(nonce, str) or not nonce:
        raise LtiError("no-nonce")
    if digest(nonce) != login.nonce:
        raise LtiError("wrong-nonce")


def _check_kind(claims: Mapping[str, Any]) -> None:
    if claims.get(f"{LTI}version") != "1.3.0":
        raise LtiError("wrong-version")
    kind = claims.get(f"{LTI}message_type")
    if not isinstance(kind, str) or kind not in KINDS:
        raise LtiError("wrong-message", kind=kind)


def _check_target(claims: Mapping[str, Any], login: Login) -> None:
    target = claims.get(f"{LTI}target_link_uri")
    # Deep Linking 2.0 does not ask for a target, and some platforms send none. The target of the
    # login was checked already: it is our registered address.
    if target is None and claims[f"{LTI}message_type"] == DEEP_LINKING:
        return
    if not isinstance(target, str) or not target:
        raise LtiError("no-target")
    if not same_place(target, login.target):
        raise LtiError("other-target")


def _deployment(claims: Mapping[str, Any], login: Login) -> str:
    deployment = claims.get(f"{LTI}deployment_id")
    if not isinstance(deployment, str) or not 0 < len(deployment) <= _LONGEST_NAME:
        raise LtiError("no-deployment")
    if login.deployment not in (None, deployment):
        raise LtiError("other-deployment")
    return deployment


def _content(
    claims: Mapping[str, Any], registration: Registration, deployment: str
) -> LaunchMessage:
    kind = claims[f"{LTI}message_type"]
    roles = claims.get(f"{LTI}roles")
    if not isinstance(roles, list) or not all(isinstance(each, str) for each in roles):
        raise LtiError("no-roles")
    sub = claims.get("sub")
    if sub is not None and not (isinstance(sub, str) and 0 < len(sub) <= _LONGEST_NAME):
        raise LtiError("bad-user")
    context = _object(claims, f"{LTI}context")
    if not (context_id := _name(context.get("id"))):
        raise LtiError("no-context")
    link = _object(claims, f"{LTI}resource_link")
    link_id = _name(link.get("id"))
    if KINDS[kind] and not link_id:
        raise LtiError("no-resource-link")
    grades, roster = _object(claims, _AGS), _object(claims, _NRPS)
    scopes = grades.get("scope", [])
    return LaunchMessage(
        registration=registration,
        kind=kind,
        deployment=deployment,
        role=role_of(roles, has_id=sub is not None),
        sub=sub,
        context=context_id,
        context_title=_line(context.get("title")) or _line(context.get("label")),
        link=link_id,
        link_title=_line(link.get("title")),
        custom={
            name: value
            for name, value in _object(claims, f"{LTI}custom").items()
            if isinstance(value, str)
        },
        lineitem_url=_address(grades.get("lineitem")),
        lineitems_url=_address(grades.get("lineitems")),
        scopes=" ".join(each for each in scopes if isinstance(each, str))[:2000]
        if isinstance(scopes, list)
        else "",
        reviewed=_reviewed(claims) if kind == REVIEW else "",
        locale=_locale(claims.get(f"{LTI}launch_presentation")),
        memberships_url=_address(roster.get("context_memberships_url")),
        claims=claims,
    )


def _reviewed(claims: Mapping[str, Any]) -> str:
    name = f"{LTI}for_user"
    if not (user := _name(_object(claims, name).get("user_id"))):
        raise LtiError("bad-claim", claim=name)
    return user


def _locale(presentation: Any) -> str:
    # An invalid language does not prevent a launch.
    return _line(presentation.get("locale")) if isinstance(presentation, dict) else ""


def _object(claims: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    value = claims.get(name, {})
    if not isinstance(value, dict):
        raise LtiError("bad-claim", claim=name)
    return value


def _name(value: Any) -> str:
    return value if isinstance(value, str) and len(value) <= _LONGEST_NAME else ""


def _line(value: Any) -> str:
    return " ".join(value.split())[:200].strip() if isinstance(value, str) else ""


def _address(value: Any) -> str | None:
    return value if isinstance(value, str) and 0 < len(value) <= _LONGEST_ADDRESS else None


# --- Find the course, the assignment and the learner of a launch, or make them
#
# A context of the platform is a course here, a resource link is an assignment, and a user is a
# learner. Everything is done on one connection, in the transaction that uses up the login.


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
    """Record a launch and return what it opens. Raises LtiError.

    For previews and guests nothing is recorded; they see only what exists already.
    """
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
    """Return the pseudonym of a platform's user, which is the learner's id.

    Users of two platforms get different ids, even if their ``sub`` is the same.
    """
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
        if (
            connection.scalar(select(tables.courses.c.id).where(tables.courses.c.id == course))
            is None
        ):
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


# --- Tickets: short-lived signed texts in a tutor's page, which prove what the launch has allowed
#
# A page in a frame has no cookie; its forms send the ticket instead.


TICKETS_LIFETIME: Final = timedelta(hours=1)
_TICKETS_ALGORITHM: Final = "HS256"


class FormTicket(BaseModel):
    """The common fields of all tickets (signed texts in the forms of a page).

    Each kind of ticket has its own ``iss``, so kinds cannot be confused.
    """

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    iss: str
    registration: str
    exp: int = 0


class LtiTicket(FormTicket):
    """The ticket (signed text) in a tutor's page about a course and a link to exercises.

    ``learner`` is the learner whose attempts the tutor wants to see, or "".
    """

    iss: Literal["dh-grader lti"] = "dh-grader lti"
    context: int
    link: int
    learner: str = ""


class LinkingTicket(FormTicket):
    """The ticket (signed text) in a page on which a tutor chooses exercises for the platform.

    ``data`` is sent back unchanged. ``course`` is "" until somebody launches the course.
    ``notices_url`` is "" unless the exercises are for files that students hand in at the platform.
    """

    iss: Literal["dh-grader lti deep linking"] = "dh-grader lti deep linking"
    deployment: str
    course: str
    return_url: str
    data: str | None
    takes_several: bool
    takes_line_items: bool
    notices_url: str = ""


_T = TypeVar("_T", bound=FormTicket)


def signed_ticket(ticket: FormTicket, secret: Secret, now: datetime) -> str:
    """Return a ticket as a signed text."""
    until = int((now + TICKETS_LIFETIME).timestamp())
    return jwt.encode(ticket.model_dump() | {"exp": until}, _key(secret), _TICKETS_ALGORITHM)


def ticket_in(text: str, kind: type[_T], secret: Secret) -> _T:
    """Return the ticket of this kind from its signed text. Raises LtiError."""
    try:
        ticket = kind.model_validate_json(_JWS.decode(text, _key(secret), [_TICKETS_ALGORITHM]))
    except (jwt.InvalidTokenError, ValidationError) as error:
        raise LtiError("ticket-expired") from error
    if ticket.exp <= time.time():
        raise LtiError("ticket-expired")
    return ticket


def _key(secret: Secret) -> bytes:
    return hmac.digest(secret.lti_secret, b"tickets", "sha256")
