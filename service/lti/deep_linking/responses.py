"""The response to a deep linking message: links, signed with our key."""

import secrets
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Any, Final

import jwt
from sqlalchemy import Connection

from service.access.keys import Secret
from service.lti.deep_linking.requests import FILES, LINK, LINKING
from service.lti.handed_files.grading import KIND
from service.lti.messages import LTI
from service.lti.own_keys import ensure_key, signing_key
from service.lti.registrations import Registration
from service.lti.tickets import LinkingTicket

# How long the platform may take to read the answer.
_LIFETIME: Final = timedelta(minutes=10)


@dataclass(frozen=True, slots=True)
class NewLink:
    """A link for the platform: exercises with their points, or an existing assignment."""

    title: str
    points: Mapping[str, float]
    assignment: str = ""
    opens: datetime | None = None
    due: datetime | None = None
    variants: bool = False

    @property
    def parameters(self) -> dict[str, str]:
        """The custom parameters by which a launch finds the chosen exercises."""
        if self.assignment:
            return {"assignment": self.assignment}
        listed = ",".join(f"{name}={points:.10g}" for name, points in self.points.items())
        dates = {"opens": self.opens, "due": self.due}
        varied = {"variants": "true"} if self.variants else {}
        given = {name: _moment(date) for name, date in dates.items() if date is not None}
        return {"exercise": listed} | given | varied


def signed_response(
    connection: Connection,
    ticket: LinkingTicket,
    known: Registration,
    links: Iterable[NewLink],
    secret: Secret,
    now: datetime,
    locale: str = "",
) -> str:
    """Return the signed response that gives the platform links to exercises. Raises LtiError.

    ``locale`` is the language of reports on files.
    """
    # There may be no links.
    made = [
        _for_files(each, known, locale) if ticket.notices_url else _item(each, ticket, known)
        for each in links
    ]
    ensure_key(connection, secret, now)
    key = signing_key(connection, secret, now)
    claims: dict[str, Any] = {
        "iss": known.client_id,
        "aud": known.issuer,
        "iat": int(now.timestamp()),
        "exp": int((now + _LIFETIME).timestamp()),
        "nonce": secrets.token_urlsafe(24),
        f"{LTI}deployment_id": ticket.deployment,
        f"{LTI}message_type": "LtiDeepLinkingResponse",
        f"{LTI}version": "1.3.0",
        f"{LINKING}content_items": made,
    }
    if ticket.data is not None:
        claims[f"{LINKING}data"] = ticket.data
    return jwt.encode(claims, key.private_key, "RS256", {"kid": key.id})


def _item(link: NewLink, ticket: LinkingTicket, known: Registration) -> dict[str, Any]:
    item: dict[str, Any] = {
        "type": LINK,
        "title": link.title,
        "url": known.launch_url,
        "custom": link.parameters,
    }
    if ticket.takes_line_items:
        item["lineItem"] = {"label": link.title, "scoreMaximum": sum(link.points.values())}
    if link.opens is not None:
        item["available"] = {"startDateTime": _moment(link.opens)}
    if link.due is not None:
        item["submission"] = {"endDateTime": _moment(link.due)}
    return item


def _for_files(link: NewLink, known: Registration, locale: str) -> dict[str, Any]:
    return {
        "type": FILES,
        "title": link.title,
        "url": known.launch_url,
        "custom": {**link.parameters, "locale": locale},
        "report": {
            "url": known.launch_url,
            "supportedTypes": [KIND],
            "released": True,
            "indicator": True,
        },
    }


def _moment(when: datetime) -> str:
    return when.astimezone(UTC).isoformat(timespec="seconds").replace("+00:00", "Z")
