"""Registered platforms, the roles of their users, and why a launch is refused.

How a platform registers itself is in ``joining.py``.
"""

import re
import secrets
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from datetime import datetime
from enum import Enum
from string import Formatter
from typing import Annotated, Any, Final, NamedTuple
from urllib.parse import urlsplit

from pydantic import BaseModel, ConfigDict, Field, StringConstraints, field_validator
from sqlalchemy import Connection, Row, delete, select, update

from dh_grader.courses import zone_named
from dh_grader.regex import regex
from dh_grader.store import tables
from dh_grader.store.attempts import insert_or_ignore
from dh_grader.translations import Sentence, joined, say, template

# --- Registered platforms, and their addresses and ours


LAUNCH_PATH: Final = "/lti/launch"
LOGIN_PATH: Final = "/lti/login"
KEYS_PATH: Final = "/lti/jwks.json"
NOTICES_PATH: Final = "/lti/notices"
LOCAL_HOSTS: Final = ("localhost", "127.0.0.1", "::1")
# An address without characters that separate directives of a Content-Security-Policy.
_ADDRESS: Final = regex(r"https?://[^\s;,'\"<>\\@]+", re.ASCII)

# Issuers in the cloud, and the domain in which each of their customers has a host.
_CUSTOMERS: Final = (
    ("canvas.instructure.com", "instructure.com"),
    ("canvas.beta.instructure.com", "beta.instructure.com"),
    ("canvas.test.instructure.com", "test.instructure.com"),
    ("blackboard.com", "blackboard.com"),
)

_Name = Annotated[str, StringConstraints(min_length=1, max_length=255)]
_Address = Annotated[str, StringConstraints(min_length=1, max_length=1000)]


class RegistrationError(Exception):
    """A registration cannot be added, or does not exist. The message says why."""


class NewRegistration(BaseModel):
    """The values for registering a platform, and the address of this service."""

    model_config = ConfigDict(extra="forbid")

    id: Annotated[str, StringConstraints(pattern=r"^[a-z0-9]+(-[a-z0-9]+)*$", max_length=64)] = (
        Field(default_factory=lambda: secrets.token_hex(4))
    )
    name: Annotated[str, StringConstraints(min_length=1, max_length=200)]
    issuer: _Address
    client_id: _Name
    auth_url: _Address
    jwks_url: _Address
    token_url: _Address | None = None
    audience: _Address | None = None
    address: _Address
    zone: str = "UTC"
    deployments: Annotated[list[_Name], Field(max_length=1000)] = []
    is_development: bool = False

    @field_validator("zone")
    @classmethod
    def _is_zone(cls, zone: str) -> str:
        try:
            zone_named(zone)
        except Exception as error:
            raise ValueError(error.args[0]) from error
        return zone

    @field_validator("address")
    @classmethod
    def _has_no_slash(cls, address: str) -> str:
        return address.rstrip("/")

    def check_addresses(self) -> None:
        """Check that all addresses are usable. Raises RegistrationError."""
        for name in ("auth_url", "jwks_url", "token_url", "address"):
            value = getattr(self, name)
            if value is not None and (reason := unusable(value, local=self.is_development)):
                raise RegistrationError(joined(": ", [name, reason]))


def unusable(address: str, *, local: bool = False) -> str:
    """Return why an address cannot be used, or "". ``local`` allows HTTP on this machine."""
    try:
        parts = urlsplit(address)
        host, _ = parts.hostname, parts.port
    except ValueError:
        return say("is no address")
    if not (_ADDRESS.fullmatch(address) and host) or parts.fragment:
        return say("is no address of the form https://host/path")
    if parts.scheme == "https" or (local and host in LOCAL_HOSTS):
        return ""
    return say("must begin with https://")


@dataclass(frozen=True, slots=True)
class Registration:
    """A registered platform; see the table ``lti_registrations``."""

    id: str
    name: str
    issuer: str
    client_id: str
    auth_url: str
    jwks_url: str
    token_url: str | None
    audience: str | None
    address: str
    zone: str
    any_deployment: bool
    is_development: bool
    created_at: datetime
    launched_at: datetime | None
    refused_at: datetime | None
    refusal: str | None

    @property
    def launch_url(self) -> str:
        """The address to which the platform sends its messages (``redirect_uri``)."""
        return self.address + LAUNCH_PATH

    @property
    def login_url(self) -> str:
        """The address at which the platform begins a login."""
        return self.address + LOGIN_PATH

    @property
    def keys_url(self) -> str:
        """The address of this service's public keys."""
        return self.address + KEYS_PATH

    @property
    def platform_origin(self) -> str:
        """The origin of the platform's pages."""
        return origin_of(self.auth_url)

    @property
    def frame_origins(self) -> tuple[str, ...]:
        """The origins whose pages may show our pages in a frame."""
        known = [self.platform_origin]
        if _ADDRESS.fullmatch(self.issuer) and not unusable(self.issuer, local=True):
            known.append(origin_of(self.issuer))
        known += [f"https://*.{domain}" for domain in self._customers]
        return tuple(dict.fromkeys(known))

    @property
    def _customers(self) -> tuple[str, ...]:
        # The domains of the issuer's customers, if the issuer serves several customers.
        return tuple(
            domain for issuer, domain in _CUSTOMERS if same_place(self.issuer, f"https://{issuer}")
        )

    def is_own(self, address: str) -> bool:
        """True if a usable address belongs to the platform."""
        origin = origin_of(address)
        if origin in self.frame_origins:
            return True
        host = urlsplit(origin).netloc
        return origin.startswith("https:") and any(
            host.endswith(f".{domain}") for domain in self._customers
        )


def origin_of(address: str) -> str:
    """Return the origin of an address, as browsers write it."""
    parts = urlsplit(address)
    host = f"[{parts.hostname}]" if ":" in (parts.hostname or "") else parts.hostname
    usual = {"https": 443, "http": 80}[parts.scheme]
    return f"{parts.scheme}://{host}{'' if parts.port in (None, usual) else f':{parts.port}'}"


def same_place(one: str, other: str) -> bool:
    """True if two addresses have the same origin and path."""
    try:
        parts = [urlsplit(each) for each in (one, other)]
        return (
            {each.scheme for each in parts} <= {"http", "https"}
            and all(each.hostname and not each.username for each in parts)
            and origin_of(one) == origin_of(other)
            and parts[0].path == parts[1].path
        )
    except (ValueError, KeyError):
        return False


def add_registration(connection: Connection, new: NewRegistration, now: datetime) -> Registration:
    """Add a registration. Raises RegistrationError."""
    new.check_addresses()
    values: dict[str, Any] = new.model_dump(exclude={"deployments"})
    values |= {"any_deployment": not new.deployments, "created_at": now}
    known = tables.registrations
    added = insert_or_ignore(known)[connection.dialect.name].values(values)
    if not connection.execute(added).rowcount:
        raise RegistrationError(
            say("There is a registration with this id, or this issuer and client.")
        )
    add_deployments(connection, new.id, new.deployments, now)
    return registration(connection, new.id)


def add_deployments(
    connection: Connection, registration_id: str, ids: Iterable[str], now: datetime
) -> None:
    """Add new deployments (installations at the platform) to a registration."""
    for each in ids:
        values = {"registration": registration_id, "deployment": each, "created_at": now}
        statement = insert_or_ignore(tables.deployments)[connection.dialect.name]
        connection.execute(statement.values(values))


def registration(connection: Connection, registration_id: str) -> Registration:
    """Return the registration with this id. Raises RegistrationError."""
    mine = tables.registrations.c.id == registration_id
    row = connection.execute(select(tables.registrations).where(mine)).one_or_none()
    if row is None:
        raise RegistrationError(f"There is no registration {registration_id}.")
    return _registration(row)


def all_registrations(connection: Connection) -> list[Registration]:
    """Return all registrations, the oldest first."""
    ordered = select(tables.registrations).order_by(tables.registrations.c.created_at)
    return [_registration(row) for row in connection.execute(ordered)]


def find_registration(connection: Connection, issuer: str, client_id: str | None) -> Registration:
    """Return the only registration with this issuer and client id. Raises LtiError."""
    mine = tables.registrations.c.issuer == issuer
    if client_id is not None:
        mine &= tables.registrations.c.client_id == client_id
    rows = connection.execute(select(tables.registrations).where(mine).limit(2)).all()
    if not rows:
        raise LtiError("unknown-platform", issuer=issuer)
    if len(rows) > 1:
        raise LtiError("several-platforms", issuer=issuer)
    return _registration(rows[0])


def deployments_of(connection: Connection, registration_id: str) -> list[str]:
    """Return the ids of a registration's known deployments (installations at the platform)."""
    mine = tables.deployments.c.registration == registration_id
    return sorted(connection.scalars(select(tables.deployments.c.deployment).where(mine)))


def remove_registration(connection: Connection, registration_id: str) -> None:
    """Remove a registration; its courses and their attempts stay. Raises RegistrationError."""
    registration(connection, registration_id)
    mine = select(tables.contexts.c.number).where(tables.contexts.c.registration == registration_id)
    items = select(tables.line_items.c.number).where(tables.line_items.c.context.in_(mine))
    connection.execute(delete(tables.scores).where(tables.scores.c.line_item.in_(items)))
    for table in (tables.line_items, tables.resource_links):
        connection.execute(delete(table).where(table.c.context.in_(mine)))
    by_registration = (
        tables.contexts,
        tables.learners,
        tables.launches,
        tables.handed_files,
        tables.deployments,
        tables.invitations,
    )
    for each in by_registration:
        connection.execute(delete(each).where(each.c.registration == registration_id))
    known = tables.registrations
    connection.execute(delete(known).where(known.c.id == registration_id))


def note_refusal(connection: Connection, registration_id: str, name: str, now: datetime) -> None:
    """Store why and when a launch was refused."""
    mine = tables.registrations.c.id == registration_id
    values = {"refused_at": now, "refusal": name}
    connection.execute(update(tables.registrations).where(mine).values(values))


def _registration(row: Row[Any]) -> Registration:
    return Registration(**row._mapping)


# --- The roles of users
#
# Roles are compared by their full URIs.


_VOCABULARY: Final = "http://purl.imsglobal.org/vocab/lis/v2/"
_MEMBER: Final = f"{_VOCABULARY}membership"
_TEST_USER: Final = "http://purl.imsglobal.org/vocab/lti/system/person#TestUser"
# Teachers of an institution are no tutors of each of its courses; its administrators are.
_TUTORS: Final = frozenset(
    {
        f"{_MEMBER}#Instructor",
        f"{_MEMBER}#Administrator",
        f"{_MEMBER}#ContentDeveloper",
        f"{_VOCABULARY}institution/person#Administrator",
        f"{_VOCABULARY}system/person#Administrator",
        f"{_VOCABULARY}system/person#SysAdmin",
    }
)
# Roles of a kind: TeachingAssistant, Lecturer, Grader, …
_OF_TUTORS: Final = (f"{_MEMBER}/Instructor#", f"{_MEMBER}/ContentDeveloper#")
_LEARNER: Final = f"{_MEMBER}#Learner"
_OF_LEARNERS: Final = f"{_MEMBER}/Learner#"


class LtiRole(Enum):
    """The role of a user in a course. A preview or a guest records nothing."""

    TUTOR = "tutor"
    LEARNER = "learner"
    PREVIEW = "preview"
    GUEST = "guest"


def role_of(roles: Collection[str], *, has_id: bool) -> LtiRole:
    """Return the LtiRole of a user with these roles; ``has_id`` is False for anonymous users.

    A test user is a preview, even with the role of a learner. Mentors and observers are guests.
    """
    if not has_id:
        return LtiRole.GUEST
    if _TEST_USER in roles:
        return LtiRole.PREVIEW
    if any(role in _TUTORS or role.startswith(_OF_TUTORS) for role in roles):
        return LtiRole.TUTOR
    if any(role == _LEARNER or role.startswith(_OF_LEARNERS) for role in roles):
        return LtiRole.LEARNER
    return LtiRole.GUEST


# --- The reasons why a launch is refused, in words for students and for operators


# What the student can do.
_AGAIN: Final = say(
    "Go back to your course, reload the page there, and open the exercise once more."
)
_TEACHER: Final = say(
    "You have done nothing wrong. Tell your teacher, who passes the reference number on to the "
    "people that run this service."
)


class LtiProblem(NamedTuple):
    """Why a launch is refused. ``cause`` has placeholders in braces; ``advice`` is for students."""

    cause: str
    advice: str = _TEACHER


# By their names. The first ones are of logins, the others in the order in which they are checked.
LTI_PROBLEMS: Final[Mapping[str, LtiProblem]] = {
    "login-incomplete": LtiProblem(template("The login has no {name}.")),
    "login-too-long": LtiProblem(template("The field {name} of the login is too long.")),
    "unknown-platform": LtiProblem(
        template("No registration has the issuer {issuer} and this client id.")
    ),
    "several-platforms": LtiProblem(
        template(
            "Several registrations have the issuer {issuer}, and the login names no client id."
        )
    ),
    "foreign-target": LtiProblem(
        template("The login is for the address {target}, which is not ours.")
    ),
    "platform-error": LtiProblem(template("The platform answered with the error {error}."), _AGAIN),
    "no-state": LtiProblem(template("The message has no state."), _AGAIN),
    "unknown-state": LtiProblem(template("No login has this state, or it is over."), _AGAIN),
    "state-expired": LtiProblem(template("The login was begun more than ten minutes ago."), _AGAIN),
    "state-used": LtiProblem(
        template("The state was used already: the message is a copy."), _AGAIN
    ),
    "other-browser": LtiProblem(template("The login was begun in another browser."), _AGAIN),
    "binding-from-elsewhere": LtiProblem(
        template("The page of another site has sent the message."), _AGAIN
    ),
    "cookies-blocked": LtiProblem(
        template("The browser keeps no cookies, and the platform has no storage."),
        say(
            "Your browser does not accept cookies from this page. Allow them, or use another "
            "browser."
        ),
    ),
    "no-token": LtiProblem(template("The message has no id_token.")),
    "token-too-long": LtiProblem(template("The id_token is too long.")),
    "token-malformed": LtiProblem(template("The id_token is not a JSON Web Token.")),
    "wrong-algorithm": LtiProblem(template("The id_token is signed by {algorithm}, not by RS256.")),
    "no-key-id": LtiProblem(template("The id_token names no key (kid).")),
    "keys-unreachable": LtiProblem(
        template("The keys of the platform cannot be read: {reason}"), _AGAIN
    ),
    "unknown-key": LtiProblem(template("The platform has no key with the id in the id_token.")),
    "unusable-key": LtiProblem(
        template("The key of the platform is not an RSA key of 2048 bits or more.")
    ),
    "wrong-signature": LtiProblem(template("The signature of the id_token is wrong.")),
    "wrong-issuer": LtiProblem(template("The id_token is from another issuer.")),
    "wrong-audience": LtiProblem(template("The id_token is for another client id.")),
    "wrong-party": LtiProblem(template("The id_token is authorised for another client id (azp).")),
    "no-expiry": LtiProblem(template("The id_token has no expiry (exp).")),
    "expired": LtiProblem(template("The id_token has expired. Compare the clocks."), _AGAIN),
    "no-issue-time": LtiProblem(template("The id_token has no time of issue (iat).")),
    "issued-later": LtiProblem(
        template("The id_token is from the future. Compare the clocks."), _AGAIN
    ),
    "issued-before": LtiProblem(template("The id_token is older than an hour."), _AGAIN),
    "not-yet-valid": LtiProblem(
        template("The id_token is not valid yet (nbf). Compare the clocks."), _AGAIN
    ),
    "no-nonce": LtiProblem(template("The id_token has no nonce.")),
    "wrong-nonce": LtiProblem(
        template("The nonce of the id_token is that of another login."), _AGAIN
    ),
    "wrong-version": LtiProblem(template("The message is not of LTI version 1.3.0.")),
    "wrong-message": LtiProblem(template("Messages of the type {kind} are not known here.")),
    "no-deployment": LtiProblem(template("The message has no deployment id.")),
    "other-deployment": LtiProblem(template("The login was for another deployment.")),
    "unknown-deployment": LtiProblem(template("The deployment {deployment} is not registered.")),
    "no-target": LtiProblem(template("The message has no target_link_uri.")),
    "other-target": LtiProblem(template("The message is for another address than the login.")),
    "no-roles": LtiProblem(template("The message has no list of roles.")),
    "bad-user": LtiProblem(template("The user's id (sub) is empty, too long, or not a text.")),
    "no-context": LtiProblem(
        template("The message has no context: it was not opened from a course.")
    ),
    "no-resource-link": LtiProblem(template("The message has no resource link.")),
    "not-a-tutor": LtiProblem(template("Only tutors choose exercises, and the user is none.")),
    "no-linking-settings": LtiProblem(template("The message has no settings of deep linking.")),
    "no-return-address": LtiProblem(
        template("The settings of deep linking have no usable return address.")
    ),
    "foreign-return-address": LtiProblem(
        template("The return address {address} does not belong to the registered platform.")
    ),
    "no-links-accepted": LtiProblem(template("The platform does not accept links at this place.")),
    "no-notices": LtiProblem(
        template("The platform does not say how to be told of handed-in files.")
    ),
    "wrong-notice": LtiProblem(template("Notices of the type {kind} are not known here.")),
    "no-files": LtiProblem(
        template("The notice does not say which files were handed in, and where.")
    ),
    "bad-address": LtiProblem(template("The address {address} in the notice {reason}.")),
    "unknown-report": LtiProblem(template("No such file was handed in, or its report is too old.")),
    "foreign-report": LtiProblem(template("The report is on the file of another student.")),
    "file-unreadable": LtiProblem(
        template("The platform does not give the file: {reason}"), _AGAIN
    ),
    "bad-claim": LtiProblem(template("The claim {claim} does not have the right shape.")),
    "no-longer-registered": LtiProblem(template("The registration was removed after the login.")),
    "ticket-expired": LtiProblem(template("The page was open for too long."), _AGAIN),
    "no-secret": LtiProblem(template("The secret is not the one with which the keys were made.")),
}


class LtiError(Exception):
    """A launch that is refused; ``name`` is one of ``LTI_PROBLEMS``."""

    def __init__(self, name: str, /, **values: object) -> None:
        problem = LTI_PROBLEMS[name]
        self.name = name
        self.advice = problem.advice
        shown = {key: short_value(value) for key, value in values.items()}
        super().__init__(Sentence(problem.cause, shown))


def short_value(value: object) -> str:
    """Return a value for a message, as a translatable Sentence or as a short text."""
    said = value.args[0] if isinstance(value, Exception) and value.args else value
    return said if isinstance(said, Sentence) else str(value)[:200]


def cause_without_values(name: str) -> str:
    """Return the cause of the refusal ``name`` as a text, with "…" for each value."""
    problem = LTI_PROBLEMS.get(name)
    if problem is None:
        return name
    places = (place for _, place, _, _ in Formatter().parse(problem.cause) if place)
    return Sentence(problem.cause, dict.fromkeys(places, "…"))
