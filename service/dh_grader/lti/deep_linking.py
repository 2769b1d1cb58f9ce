"""Deep linking: a platform asks for links to exercises, and gets them signed.

The page on which a tutor chooses them is in ``web/lti_pages.py``.
"""

import secrets
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Any, Final

import jwt
from sqlalchemy import Connection, update

from dh_grader.access import Secret
from dh_grader.access.key_ring import settle
from dh_grader.lti.fetching import ensure_key, signing_key
from dh_grader.lti.handed_files import KIND
from dh_grader.lti.launch import LTI, LaunchMessage, LinkingTicket, check_deployment, known_context
from dh_grader.lti.registrations import LtiError, LtiRole, Registration, unusable
from dh_grader.store import tables

# --- Read the requests of platforms for links to exercises (LtiDeepLinkingRequest)


LINKING: Final = "https://purl.imsglobal.org/spec/lti-dl/claim/"
LINK: Final = "ltiResourceLink"
# The platform grades files of students with what the tutor chooses, instead of opening a link.
FILES: Final = "ltiAssetProcessor"
_NOTICES: Final = f"{LTI}platformnotificationservice"
# The longest text that is sent back to the platform.
_LONGEST_DATA: Final = 16_000
_LONGEST_ADDRESS: Final = 2000


def begin_linking(
    connection: Connection, message: LaunchMessage, secret: Secret, now: datetime
) -> LinkingTicket:
    """Return a ticket with which a tutor may send links to the platform. Raises LtiError.

    No course and no link is recorded yet, because the tutor may cancel.
    """
    if not settle(connection, secret, now):
        raise LtiError("no-secret")
    asked = _asked(message)
    if message.role is not LtiRole.TUTOR:
        raise LtiError("not-a-tutor")
    check_deployment(connection, message, now)
    mine = tables.registrations.c.id == message.registration.id
    connection.execute(update(tables.registrations).where(mine).values(launched_at=now))
    context = known_context(connection, message)
    return LinkingTicket(
        registration=message.registration.id,
        deployment=message.deployment,
        course="" if context is None else context.course,
        **asked,
    )


def _asked(message: LaunchMessage) -> Mapping[str, Any]:
    name = f"{LINKING}deep_linking_settings"
    settings = message.claims.get(name)
    if settings is None:
        raise LtiError("no-linking-settings")
    if not isinstance(settings, dict):
        raise LtiError("bad-claim", claim=name)
    known = message.registration
    address = settings.get("deep_link_return_url")
    if not isinstance(address, str) or not 0 < len(address) <= _LONGEST_ADDRESS:
        raise LtiError("no-return-address")
    if unusable(address, local=known.is_development):
        raise LtiError("no-return-address")
    if not known.is_own(address):
        raise LtiError("foreign-return-address", address=address)
    kinds = settings.get("accept_types")
    if not isinstance(kinds, list) or not {LINK, FILES} & {str(each) for each in kinds}:
        raise LtiError("no-links-accepted")
    for_files = LINK not in kinds
    data = settings.get("data")
    if data is not None and not (isinstance(data, str) and len(data) <= _LONGEST_DATA):
        raise LtiError("bad-claim", claim=f"{name}.data")
    return {
        "return_url": address,
        "data": data,
        # Without a word of the platform, one link is sure to be accepted, and so are its points.
        "takes_several": settings.get("accept_multiple") is True,
        "takes_line_items": settings.get("accept_lineitem") is not False,
        "notices_url": _notices_url(message) if for_files else "",
    }


def _notices_url(message: LaunchMessage) -> str:
    service = message.claims.get(_NOTICES)
    url = service.get("platform_notification_service_url") if isinstance(service, dict) else None
    if not isinstance(url, str) or not 0 < len(url) <= _LONGEST_ADDRESS:
        raise LtiError("no-notices")
    if reason := unusable(url, local=message.registration.is_development):
        raise LtiError("bad-address", address=url, reason=reason)
    return url


# --- The response to a deep linking message: links, signed with our key


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
    """Return the signed response that gives the platform links to exercises, perhaps none.

    ``locale`` is the language of reports on files. Raises LtiError.
    """
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
