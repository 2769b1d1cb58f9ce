"""Logins of a platform's users; each login can be used once.

The database has only digests of a login's state, nonce and browser secret.
"""

import hmac
import json
import secrets
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime, timedelta
from hashlib import sha256
from typing import Final
from urllib.parse import urlencode

from sqlalchemy import Connection, delete, insert, select, update

from service.attempts.storage.lti_tables import launches
from service.lti.problems import LtiError
from service.lti.registrations import Registration, same_place

LIFETIME: Final = timedelta(minutes=10)
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
    expires = now + LIFETIME
    # Those that are over for as long again are not told from unknown ones.
    connection.execute(delete(launches).where(launches.c.expires_at < now - LIFETIME))
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
