"""Database functions for the registrations of platforms."""

import re
import secrets
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import datetime
from typing import Annotated, Any, Final
from urllib.parse import urlsplit

from pydantic import BaseModel, ConfigDict, Field, StringConstraints, field_validator
from sqlalchemy import Connection, Row, delete, select, update

from service.attempts.recording import insert_or_ignore
from service.attempts.storage import lti_tables as tables
from service.courses.times import zone_named
from service.lti.problems import LtiError
from service.regex import regex
from service.translations import joined, say

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
    """Remove a registration. Raises RegistrationError."""
    # The courses of the registration and their attempts stay.
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
