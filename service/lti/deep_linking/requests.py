"""Read the requests of platforms for links to exercises (LtiDeepLinkingRequest)."""

from collections.abc import Mapping
from datetime import datetime
from typing import Any, Final

from sqlalchemy import Connection, update

from service.access.key_table import settle
from service.access.keys import Secret
from service.attempts.storage import lti_tables as tables
from service.lti.linking import check_deployment, known_context
from service.lti.messages import LTI, LaunchMessage
from service.lti.problems import LtiError
from service.lti.registrations import unusable
from service.lti.roles import LtiRole
from service.lti.tickets import LinkingTicket

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
    """Return a ticket with which a tutor may send links to the platform. Raises LtiError."""
    # No course and no link is recorded yet, because the tutor may cancel.
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
