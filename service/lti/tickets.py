"""Tickets: short-lived signed texts in a tutor's page, which prove what the launch has allowed.

A page in a frame has no cookie; its forms send the ticket instead.
"""

import hmac
import time
from datetime import datetime, timedelta
from typing import Final, Literal, TypeVar

import jwt
from pydantic import BaseModel, ConfigDict, ValidationError

from service.access.keys import Secret
from service.lti.problems import LtiError

LIFETIME: Final = timedelta(hours=1)
_ALGORITHM: Final = "HS256"
_JWS: Final = jwt.PyJWS()


class FormTicket(BaseModel):
    """The common fields of all tickets (signed texts in the forms of a page)."""

    # Each kind of ticket has its own ``iss``, so kinds cannot be confused.

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

    ``data`` is sent back unchanged.
    """

    # ``course`` is "" until somebody launches the course. ``notices_url`` is "" unless the
    # exercises are for files that students hand in at the platform.

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
    until = int((now + LIFETIME).timestamp())
    return jwt.encode(ticket.model_dump() | {"exp": until}, _key(secret), _ALGORITHM)


def ticket_in(text: str, kind: type[_T], secret: Secret) -> _T:
    """Return the ticket of this kind from its signed text. Raises LtiError."""
    try:
        ticket = kind.model_validate_json(_JWS.decode(text, _key(secret), [_ALGORITHM]))
    except (jwt.InvalidTokenError, ValidationError) as error:
        raise LtiError("ticket-expired") from error
    if ticket.exp <= time.time():
        raise LtiError("ticket-expired")
    return ticket


def _key(secret: Secret) -> bytes:
    return hmac.digest(secret.lti_secret, b"tickets", "sha256")
