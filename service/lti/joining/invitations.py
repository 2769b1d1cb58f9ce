"""Invitations: one-time links by which a platform registers itself.

The database has only a digest of the secret text in a link.
"""

# The secret text begins with ``held-`` if the registration must wait for ``dh-grader lti allow``.
# Nobody can remove ``held-``, because it is part of the digested text.

import secrets
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any, Final

from pydantic import ValidationError
from sqlalchemy import Connection, insert, select, update

from service.attempts.storage.lti_tables import invitations, registrations
from service.courses.errors import CourseError
from service.courses.times import zone_named
from service.lti.logins import digest
from service.lti.registrations import (
    LOCAL_HOSTS,
    NewRegistration,
    Registration,
    RegistrationError,
    add_registration,
    registration,
    unusable,
)
from service.translations import joined, say

LONGEST_DAYS: Final = 90
_HELD: Final = "held-"


@dataclass(frozen=True, slots=True)
class Invitation:
    """A valid invitation; ``waits`` is True if an admin must allow the registration."""

    digest: str
    name: str
    address: str
    zone: str
    waits: bool

    @property
    def is_development(self) -> bool:
        """True if the address of this service is local, as in development."""
        return any(self.address.startswith(f"http://{host}") for host in LOCAL_HOSTS)


def invite(
    connection: Connection,
    name: str,
    address: str,
    zone: str,
    now: datetime,
    *,
    days: int,
    waits: bool,
) -> str:
    """Make an invitation; return the link for the admin of the platform.

    Raises RegistrationError.
    """
    address = address.rstrip("/")
    if reason := unusable(address, local=True):
        raise RegistrationError(joined(": ", ["address", reason]))
    try:
        zone_named(zone)
    except CourseError as error:
        raise RegistrationError(error.args[0]) from error
    text = f"{_HELD if waits else ''}{secrets.token_urlsafe(24)}"
    values = {"digest": digest(text), "name": name, "address": address, "zone": zone}
    times = {"created_at": now, "expires_at": now + timedelta(days=days)}
    connection.execute(insert(invitations).values(values | times))
    return f"{address}/lti/register?invitation={text}"


def invitation_of(connection: Connection, text: str, now: datetime) -> Invitation:
    """Return the invitation with this secret text. Raises RegistrationError."""
    mine = invitations.c.digest == digest(text)
    row = connection.execute(select(invitations).where(mine)).one_or_none()
    if row is None or row.used_at is not None or row.expires_at <= now:
        raise RegistrationError(say("This link is not valid, was used already, or has expired."))
    return Invitation(row.digest, row.name, row.address, row.zone, text.startswith(_HELD))


def claim(connection: Connection, text: str, now: datetime) -> Invitation:
    """Mark an invitation as used, and return it. Raises RegistrationError."""
    found = invitation_of(connection, text, now)
    mine = (invitations.c.digest == found.digest) & invitations.c.used_at.is_(None)
    if not connection.execute(update(invitations).where(mine).values(used_at=now)).rowcount:
        raise RegistrationError(say("This link is being used just now."))
    return found


def release(connection: Connection, invitation: Invitation) -> None:
    """Make an invitation usable again after a failed registration."""
    mine = (invitations.c.digest == invitation.digest) & invitations.c.registration.is_(None)
    connection.execute(update(invitations).where(mine).values(used_at=None))


def accept(
    connection: Connection, invitation: Invitation, values: dict[str, Any], now: datetime
) -> Registration:
    """Add the registration of an invited platform. Raises RegistrationError."""
    try:
        new = NewRegistration(
            name=invitation.name,
            address=invitation.address,
            zone=invitation.zone,
            is_development=invitation.is_development,
            **values,
        )
    except ValidationError as error:
        raise RegistrationError(say("The platform has sent unusable values.")) from error
    made = add_registration(connection, new, now)
    if invitation.waits:
        mine = registrations.c.id == made.id
        connection.execute(update(registrations).where(mine).values(any_deployment=False))
    mine = invitations.c.digest == invitation.digest
    connection.execute(update(invitations).where(mine).values(registration=made.id))
    return made


def allow(connection: Connection, registration_id: str) -> None:
    """Allow a waiting registration to launch. Raises RegistrationError."""
    registration(connection, registration_id)
    mine = registrations.c.id == registration_id
    connection.execute(update(registrations).where(mine).values(any_deployment=True))
