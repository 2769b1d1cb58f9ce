"""The page on which tutors sign in with their key, and the routes to sign in and out."""

import re
from datetime import UTC, datetime, timedelta
from http import HTTPStatus
from typing import Final
from urllib.parse import parse_qs, quote, unquote

from fastapi import APIRouter, Request
from starlette.responses import RedirectResponse, Response

from service.access.caller import Scope
from service.access.keys import CredentialError, Keys, KeysBusyError, KeysUnreachableError
from service.api.http.language import language_of
from service.api.http.problems import store_down
from service.api.permissions.access import (
    PLAIN_COOKIE,
    SECURE_COOKIE,
    Access,
    is_same_origin,
)
from service.api.permissions.access_problems import access_problem
from service.regex import regex
from service.translations import say
from service.web.assets import Assets
from service.web.page_answer import page_answer
from service.web.page_headers import FORM_HEADERS
from service.web.pages import page

# A session ends after one working day; using it does not make it longer.
SESSION: Final = timedelta(hours=10)
HOME: Final = "/tutor"
# Paths of tutors' pages, as browsers send them.
_OURS: Final = regex(r"/tutor(?:[/?][A-Za-z0-9/?._~%&=+:@!$'()*,;-]*)?", re.ASCII)
_LONGEST: Final = 2000
_MOST_FIELDS: Final = 10


def sign_in_routes(assets: Assets, access: Access) -> APIRouter:
    """Return the routes to sign in and out."""
    router = APIRouter(prefix="/tutor", include_in_schema=False)

    def form(request: Request, following: str, message: str = "") -> Response:
        content = page(
            "web/templates/sign_in.html",
            assets,
            "../",
            ["page.js"],
            styles=["tutor.css", "records.css"],
            language=language_of(request),
            following=following,
            message=message,
        )
        status = HTTPStatus.FORBIDDEN if message else HTTPStatus.OK
        return page_answer(request, content, FORM_HEADERS, status)

    @router.get("/sign-in")
    async def ask(request: Request, following: str = HOME) -> Response:
        """Return the form on which a tutor enters a key."""
        return form(request, own_path(following))

    @router.post("/sign-in")
    async def begin(request: Request) -> Response:
        """Start a session, and open the page that the tutor wanted."""
        fields = await form_fields(request)
        following = own_path(fields.get("following", ""))
        if access.keys is None or not await access.keys.are_needed():
            return _see(following)
        if not is_same_origin(request):
            message = say("The form was sent by a page of another site. Send it again.")
            return form(request, following, message)
        until = datetime.now(UTC) + SESSION
        try:
            session = await _session(access.keys, fields.get("key", "").strip(), until)
        except CredentialError as error:
            return form(request, following, error.args[0] if error.args else str(error))
        answer = _see(following)
        set_session_cookie(answer, request, session)
        return answer

    @router.post("/sign-out")
    async def end(request: Request) -> Response:
        """End the tutor's session in this browser."""
        answer = _see(f"{HOME}/sign-in")
        if is_same_origin(request):
            set_session_cookie(answer, request, "")
        return answer

    return router


def sign_in_address(path: str, query: str) -> str:
    """Return the relative address of the sign-in form that leads back to a page."""
    wanted = f"{path}?{query}" if query else path
    return f"tutor/sign-in?following={quote(own_path(wanted), safe='')}"


def own_path(path: str) -> str:
    """Return the path if it leads to a tutor's page, otherwise the path of the home page."""
    is_ours = len(path) <= _LONGEST and _OURS.fullmatch(path) and ".." not in unquote(path)
    return path if is_ours else HOME


async def _session(keys: Keys, key: str, until: datetime) -> str:
    """Return a session token for the holder of a key. Raises CredentialError, ProblemError."""
    if not key:
        raise CredentialError(say("Enter a key."))
    try:
        caller = await keys.caller(key)
    except KeysUnreachableError as error:
        raise store_down(say("The key cannot be checked: the database does not answer.")) from error
    except KeysBusyError as error:
        raise access_problem("busy") from error
    if Scope.TUTOR not in caller.scopes or caller.learner is not None:
        raise CredentialError(say("This key is not a tutor's: it has not the scope tutor."))
    return keys.session(caller, until)


async def form_fields(request: Request, most: int = _MOST_FIELDS) -> dict[str, str]:
    """Return the fields of a form."""
    body = (await request.body()).decode(errors="replace")
    try:
        return {name: each[0] for name, each in parse_qs(body, max_num_fields=most).items()}
    except ValueError:
        return {}


def _see(path: str) -> Response:
    # Relative to /tutor/…, so that it works below the prefix of a proxy.
    headers = {"Cache-Control": "no-store"}
    return RedirectResponse(f"..{path}", HTTPStatus.SEE_OTHER, headers)


def set_session_cookie(answer: Response, request: Request, session: str) -> None:
    """Set the session cookie; without a session, remove the session cookies."""
    # The ``Origin`` header of the browser shows whether the browser uses HTTPS. A service behind a
    # proxy may not know that otherwise.
    origin = request.headers.get("origin", "")
    is_secure = origin.startswith("https:") or request.url.scheme == "https"
    age = int(SESSION.total_seconds()) if session else 0
    for name in (SECURE_COOKIE, PLAIN_COOKIE):
        if not session or (name == SECURE_COOKIE) is is_secure:
            secure = name == SECURE_COOKIE
            answer.set_cookie(name, session, age, secure=secure, httponly=True, samesite="lax")
