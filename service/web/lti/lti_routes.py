"""The routes of LTI, by which a learning platform opens the service for its users.

The service has these routes only if it has a database and a secret.
"""

import logging
from collections.abc import Awaitable, Callable, Mapping
from datetime import UTC, datetime
from http import HTTPStatus
from typing import TYPE_CHECKING, Final
from urllib.parse import urlencode

from fastapi import APIRouter, Request
from starlette.responses import HTMLResponse, JSONResponse, RedirectResponse, Response

from service.api.courses.asking import read, write
from service.api.http.language import language_of
from service.api.http.lookup import Catalogue
from service.api.http.request_context import current_request
from service.api.permissions.access import is_same_origin
from service.translations import ENGLISH, Language
from service.web.assets import Assets
from service.web.lti.lti_pages import binding_page, frame_headers, login_page, refused_page
from service.web.page_headers import NO_STORE
from service.web.sign_in import form_fields
from service.web.tutor.tutor_routes import Tutoring

if TYPE_CHECKING:  # they load the drivers of databases
    from service.lti.logins import Login, NewLogin
    from service.lti.messages import LaunchMessage
    from service.lti.platform_keys import PlatformKeys
    from service.lti.problems import LtiError
    from service.lti.registrations import Registration

_log = logging.getLogger(__name__)

_LOGIN: Final = "/login"
_LAUNCH: Final = "/launch"
_MOST_FIELDS: Final = 30
# The lifetime of the cookie of a login (seconds).
_AGE: Final = 600
_STATUSES: Final = {
    "keys-unreachable": HTTPStatus.SERVICE_UNAVAILABLE,
    "no-secret": HTTPStatus.SERVICE_UNAVAILABLE,
}


def lti_routes(catalogue: Catalogue, assets: Assets, tutoring: Tutoring) -> APIRouter:
    """Return the routes of LTI; none without a database and a secret."""
    router = APIRouter(prefix="/lti", include_in_schema=False)
    keys = tutoring.access.keys
    if tutoring.store is None or keys is None or keys.secret is None:
        return router
    # Imported only here, because they import the database drivers.
    from service.formats.documents.html import STYLE
    from service.lti.messages import REPORT
    from service.lti.platform_keys import PlatformKeys
    from service.web.lti.deep_linking.picker_forms import picker_forms
    from service.web.lti.handed_files.notice_routes import notice_routes
    from service.web.lti.joining.joining_forms import joining_forms
    from service.web.lti.landing import Landings
    from service.web.lti.platforms import platform_routes
    from service.web.lti.tutor_forms import tutor_forms

    landings = Landings(
        catalogue,
        assets,
        tutoring.store,
        keys,
        keys.secret,
        tutoring.platforms,
        tutoring.feedback,
    )
    platform_keys = PlatformKeys(tutoring.platforms)
    launching = _Launching(assets, tutoring, platform_keys)

    async def login(fields: Mapping[str, str], language: Language) -> Response:
        begun = await launching.begin(fields)
        answer: Response
        if "lti_storage_target" in begun.fields:
            name = cookie_name(begun.registration, begun.state)
            content = login_page(begun, name, assets, language)
            headers = frame_headers(language, begun.registration.frame_origins)
            answer = HTMLResponse(content, headers=headers)
        else:
            answer = RedirectResponse(begun.address, HTTPStatus.FOUND, NO_STORE)
        set_cookie(answer, begun)
        return answer

    @router.get(_LOGIN)
    async def login_by_get(request: Request) -> Response:
        """Begin a login; the platform sends the user here first."""
        language = language_of(request)
        return await launching.answered(
            lambda: login(dict(request.query_params), language), language
        )

    @router.post(_LOGIN)
    async def login_by_post(request: Request) -> Response:
        """Begin a login with the fields of a form."""
        fields = await form_fields(request, _MOST_FIELDS)
        language = language_of(request)
        return await launching.answered(lambda: login(fields, language), language)

    @router.post(_LAUNCH)
    async def launch(request: Request) -> Response:
        """Check the platform's message, and return the page that the message opens."""
        fields = await form_fields(request, _MOST_FIELDS)

        async def launched() -> Response:
            known, begun = await launching.login_of(fields)
            if not is_bound(request, fields, known, begun):
                return launching.ask_to_bind(request, fields, known, begun)
            message = await launching.message(fields.get("id_token", ""), known, begun)
            language = language_of(request, message.locale)
            content = await landings.page(message, begun, language)
            style = STYLE.hash if message.kind == REPORT else ""
            return HTMLResponse(
                content, headers=frame_headers(language, known.frame_origins, style=style)
            )

        return await launching.answered(launched, language_of(request))

    @router.get("/jwks.json")
    async def own_keys() -> Response:
        """Return our public keys."""
        from service.lti.own_keys import published_keys

        found = await read(tutoring.store, published_keys)
        return JSONResponse(found, headers={"Cache-Control": "public, max-age=3600"})

    both = APIRouter(include_in_schema=False)
    both.include_router(router)
    both.include_router(tutor_forms(landings, launching.answered))
    both.include_router(picker_forms(landings, launching.answered))
    both.include_router(joining_forms(landings))
    both.include_router(platform_routes(landings))
    both.include_router(notice_routes(tutoring.store, keys.secret, platform_keys))
    return both


class _Launching:
    """Begins logins, and checks the messages with which platforms open the service."""

    def __init__(self, assets: Assets, tutoring: Tutoring, platform_keys: "PlatformKeys") -> None:
        self._assets, self._store = assets, tutoring.store
        self._platform_keys = platform_keys

    async def begin(self, given: Mapping[str, str]) -> "NewLogin":
        """Store a new login and return it. Raises LtiError."""
        from service.lti.logins import begin_login, login_fields
        from service.lti.registrations import find_registration

        fields = login_fields(given)
        known = await read(
            self._store, lambda it: find_registration(it, fields["iss"], fields.get("client_id"))
        )
        now = datetime.now(UTC)
        return await write(self._store, lambda it: begin_login(it, known, fields, now))

    async def login_of(self, fields: Mapping[str, str]) -> "tuple[Registration, Login]":
        """Return the registration and the login that a message belongs to. Raises LtiError."""
        from service.lti.logins import login_of
        from service.lti.problems import LtiError
        from service.lti.registrations import RegistrationError, registration

        now = datetime.now(UTC)
        begun = await read(self._store, lambda it: login_of(it, fields.get("state", ""), now))
        try:
            known = await read(self._store, lambda it: registration(it, begun.registration))
        except RegistrationError as error:
            raise LtiError("no-longer-registered") from error
        if "error" in fields:
            raise LtiError("platform-error", error=fields["error"])
        return known, begun

    async def message(self, token: str, known: "Registration", begun: "Login") -> "LaunchMessage":
        """Return the message in a signed token. Raises LtiError if the token is refused."""
        # The reason is noted before.
        from service.lti.messages import key_id_of, message_in
        from service.lti.problems import LtiError
        from service.lti.registrations import note_refusal

        now = datetime.now(UTC)
        try:
            key = await self._platform_keys.key(known, key_id_of(token))
            return message_in(token, key, known, begun, now)
        except LtiError as error:
            name = error.name
            await write(self._store, lambda it: note_refusal(it, known.id, name, now))
            raise

    def ask_to_bind(
        self, request: Request, fields: Mapping[str, str], known: "Registration", begun: "Login"
    ) -> Response:
        """Return a page for a browser that has not sent the cookie of its login.

        Raises LtiError if no page can help.
        """
        # That is, if the page already has its own window and the platform offers no storage.
        from service.lti.problems import LtiError

        is_window = request.headers.get("sec-fetch-dest") == "document"
        if is_window and begun.storage_target is None:
            raise LtiError("cookies-blocked")
        again = {name: each for name, each in begun.fields.items() if name != "lti_storage_target"}
        storage = None
        if begun.storage_target is not None:
            name = cookie_name(known, fields["state"])
            storage = (begun.storage_target, known.platform_origin, name)
        language = language_of(request)
        content = binding_page(
            self._assets,
            language,
            f"login?{urlencode(again)}",
            state=fields["state"],
            token=fields.get("id_token", ""),
            storage=storage,
        )
        return HTMLResponse(content, headers=frame_headers(language, known.frame_origins))

    async def answered(
        self, work: Callable[[], Awaitable[Response]], language: Language = ENGLISH
    ) -> Response:
        """Return the response of ``work``, or a page about an LtiError."""
        from service.lti.problems import LtiError

        try:
            return await work()
        except LtiError as error:
            return await self._refused(error, language)

    async def _refused(self, error: "LtiError", language: Language) -> Response:
        """Return an error page for the student, with the reference number of the log line."""
        from service.lti.registrations import all_registrations

        context = current_request()
        reference = "" if context is None else context.id
        _log.warning("LTI: refused (%s), reference %s: %s", error.name, reference, error)
        known = await read(self._store, all_registrations)
        origins = [origin for each in known for origin in each.frame_origins]
        content = refused_page(self._assets, language, error.advice, reference, error.name)
        status = _STATUSES.get(error.name, HTTPStatus.FORBIDDEN)
        return HTMLResponse(content, status, headers=frame_headers(language, origins))


def is_bound(
    request: Request, fields: Mapping[str, str], known: "Registration", begun: "Login"
) -> bool:
    """True if this browser has begun the login; False if it has not sent its secret yet.

    Raises LtiError if the secret is not from this browser.
    """
    # The browser sends its secret in a cookie, or in a form with the value from the platform's
    # storage. The form is accepted only from our own page, because an attacker could begin a login
    # and let another browser post the form.
    from service.lti.problems import LtiError

    cookie = request.cookies.get(cookie_name(known, fields["state"]))
    stored = fields.get("browser")
    if cookie is None and stored and not is_same_origin(request):
        raise LtiError("binding-from-elsewhere")
    secret = cookie or stored
    if not secret:
        return False
    if not begun.is_of_browser(secret):
        raise LtiError("other-browser")
    return True


def cookie_name(known: "Registration", state: str) -> str:
    """Return the name of the cookie of a login."""
    # Several logins may be under way at once.
    from service.lti.logins import digest

    prefix = "__Host-" if known.address.startswith("https:") else ""
    return f"{prefix}dh-grader-lti-{digest(state)[:12]}"


def set_cookie(answer: Response, begun: "NewLogin") -> None:
    """Set the cookie with the secret of a login."""
    name = cookie_name(begun.registration, begun.state)
    answer.set_cookie(name, begun.browser, _AGE, secure=True, httponly=True, samesite="none")
