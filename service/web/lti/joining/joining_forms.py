"""The routes by which a learning platform registers itself here (dynamic registration)."""

# The platform opens the link that an admin has pasted.

from collections.abc import Mapping
from datetime import UTC, datetime
from http import HTTPStatus
from typing import Any, Final

from fastapi import APIRouter, Request
from sqlalchemy import Connection
from starlette.responses import Response

from service.api.courses.asking import read, write
from service.api.http.language import language_of
from service.api.http.problems import message_of
from service.api.permissions.access import is_same_origin
from service.lti.joining.dynamic_registration import register_at
from service.lti.joining.invitations import Invitation, accept, claim, invitation_of, release
from service.lti.own_keys import ensure_key
from service.lti.registrations import Registration, RegistrationError, origin_of, unusable
from service.translations import say
from service.web.lti.landing import Landings
from service.web.lti.lti_pages import frame_headers, lti_page
from service.web.page_answer import page_answer
from service.web.sign_in import form_fields

# Stands for platforms that are not registered yet, in no registration's id.
_JOINING: Final = ""
_FIELDS: Final = ("invitation", "openid_configuration", "registration_token")


def joining_forms(landings: Landings) -> APIRouter:
    """Return the routes by which a learning platform registers itself here."""
    router = APIRouter(prefix="/lti")
    store = landings.store

    def answered(request: Request, fields: dict[str, str], known: bool, **values: Any) -> Response:
        scripts = ["close_registration.js"] if values.get("made") else []
        shown = {"made": None, "message": "", "invitation": None, **values}
        shown |= {"fields": fields, "language": language_of(request)}
        content = lti_page("register.html", landings.assets, scripts, **shown)
        configuration = fields["openid_configuration"]
        may_frame = known and not unusable(configuration, local=True)
        headers = frame_headers(
            language_of(request), [origin_of(configuration)] if may_frame else []
        )
        status = HTTPStatus.FORBIDDEN if values.get("message") else HTTPStatus.OK
        return page_answer(request, content, headers, status)

    @router.get("/register")
    async def ask(request: Request) -> Response:
        """Return the page that asks the platform's admin to continue."""
        # Nothing is fetched yet.
        fields = {name: request.query_params.get(name, "") for name in _FIELDS}
        now = datetime.now(UTC)
        try:
            found = await read(store, lambda it: invitation_of(it, fields["invitation"], now))
        except RegistrationError as error:
            return answered(request, fields, False, message=message_of(error))
        if not fields["openid_configuration"]:
            message = say(
                "Paste this link into your platform, where it asks for the address of a dynamic "
                "registration. The platform then opens this page with an address of its own."
            )
            return answered(request, fields, True, message=message)
        return answered(request, fields, True, invitation=found)

    @router.post("/register")
    async def register(request: Request) -> Response:
        """Register the platform, and return a page with the result."""
        given = await form_fields(request)
        fields = {name: given.get(name, "") for name in _FIELDS}
        if not is_same_origin(request):
            return answered(
                request, fields, False, message=say("The page of another site has sent the form.")
            )
        now = datetime.now(UTC)
        try:
            found = await write(store, lambda it: claim(it, fields["invitation"], now))
        except RegistrationError as error:
            return answered(request, fields, False, message=message_of(error))
        try:
            made = await _registered(landings, found, fields)
        except RegistrationError as error:
            return answered(request, fields, True, message=message_of(error), invitation=found)
        return answered(request, fields, True, invitation=found, made=made)

    return router


async def _registered(
    landings: Landings, invitation: Invitation, fields: Mapping[str, str]
) -> Registration:
    # Return the new registration of an invited platform. Raises RegistrationError.
    # After an error, the invitation is valid as before.
    def joined(connection: Connection) -> Registration:
        now = datetime.now(UTC)
        ensure_key(connection, landings.secret, now)
        return accept(connection, invitation, values, now)

    try:
        values = await landings.platforms.run(
            _JOINING,
            lambda: register_at(
                invitation, fields["openid_configuration"], fields["registration_token"]
            ),
        )
        return await write(landings.store, joined)
    except BaseException:
        await write(landings.store, lambda it: release(it, invitation))
        raise
