"""The route of the form on which a tutor searches for exercises, and makes links to them."""

import logging
from collections.abc import Sequence
from datetime import UTC, datetime
from typing import Final

from fastapi import APIRouter, Request
from sqlalchemy import Connection
from starlette.responses import HTMLResponse, Response

from service.api.courses.asking import read, write
from service.api.http.language import language_of
from service.api.http.problems import message_of
from service.api.permissions.access import is_same_origin
from service.lti.deep_linking.responses import NewLink, signed_response
from service.lti.problems import LtiError
from service.lti.registrations import Registration, RegistrationError, origin_of, registration
from service.lti.scores.score_problems import ScoreError
from service.lti.tickets import LinkingTicket, ticket_in
from service.translations import Language, say
from service.web.lti.deep_linking.offers import (
    NotYetError,
    Offer,
    links_of,
    offer_of,
    picked_in,
)
from service.web.lti.deep_linking.picker_pages import picker_page, return_page
from service.web.lti.landing import Landings
from service.web.lti.lti_pages import frame_headers
from service.web.lti.tutor_forms import Answered, form_lists

_log = logging.getLogger(__name__)

# Platforms may want to see who sends the answer: our origin, and nothing more.
_REFERRER: Final = {"Referrer-Policy": "strict-origin"}


def picker_forms(landings: Landings, answered: Answered) -> APIRouter:
    """Return the route of the form on which a tutor chooses exercises."""
    # ``answered`` makes an error page from an LtiError.
    router = APIRouter(prefix="/lti")
    store, secret = landings.store, landings.secret

    async def sent_back(
        ticket: LinkingTicket,
        known: Registration,
        links: Sequence[NewLink],
        language: Language,
    ) -> Response:
        now, locale = datetime.now(UTC), language.tag
        if ticket.notices_url and links:
            url = ticket.notices_url
            await landings.platforms.run(known.id, lambda: _ask_for_notices(landings, known, url))
        text = await write(
            store, lambda it: signed_response(it, ticket, known, links, secret, now, locale)
        )
        content = return_page(ticket.return_url, text, landings.assets, language)
        targets = (origin_of(ticket.return_url), *known.frame_origins)
        headers = {**frame_headers(language, known.frame_origins, *targets), **_REFERRER}
        return HTMLResponse(content, headers=headers)

    @router.post("/links")
    async def pick(request: Request) -> Response:
        """Search for exercises, send the chosen links to the platform, or cancel."""
        # A tutor who cancels also returns to the platform, but without links.
        fields = form_lists(await request.body())
        text = fields.get("ticket", [""])[0]
        language = language_of(request, fields.get("locale", [""])[0])

        async def picked() -> Response:
            if not is_same_origin(request):
                raise LtiError("binding-from-elsewhere")
            ticket = ticket_in(text, LinkingTicket, secret)
            offer = await read(store, lambda it: _offer(it, ticket))
            known, chosen = offer.registration, picked_in(fields)
            try:
                match fields.get("action", [""])[0]:
                    case "cancel":
                        return await sent_back(ticket, known, [], language)
                    case "add":
                        links = links_of(chosen, offer, landings.catalogue)
                        return await sent_back(ticket, known, links, language)
            except NotYetError as error:
                chosen = chosen.with_message(message_of(error))
            content = picker_page(
                offer, chosen, text, landings.catalogue, landings.assets, language
            )
            return HTMLResponse(content, headers=frame_headers(language, known.frame_origins))

        return await answered(picked, language)

    return router


def _ask_for_notices(landings: Landings, known: Registration, url: str) -> None:
    """Ask the platform to notify us of files that students hand in. Raises NotYetError."""
    try:
        landings.platform_files.ask_for_notices(known, url)
    except ScoreError as error:
        _log.warning("LTI: no notices of handed-in files (%s): %s", known.id, error)
        raise NotYetError(
            say(
                "Your platform does not let this service read files of students. Ask the "
                "administrator of the platform to allow that."
            )
        ) from error


def _offer(connection: Connection, ticket: LinkingTicket) -> Offer:
    try:
        known = registration(connection, ticket.registration)
    except RegistrationError as error:
        raise LtiError("no-longer-registered") from error
    return offer_of(connection, ticket, known)
