"""The routes of LTI: launches, joining, notices, forms of tutors, and the list of platforms.

The service has them only if it has a database and a secret. The pages are in ``lti_pages.py``, and
what messages of platforms mean is in ``dh_grader.lti``.
"""

import logging
from collections.abc import Awaitable, Callable, Mapping, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from http import HTTPStatus
from typing import Annotated, Any, Final, NamedTuple
from urllib.parse import parse_qs, urlencode

from fastapi import APIRouter, Path, Request
from pydantic import BaseModel, Field, ValidationError
from sqlalchemy import Connection, Row, select
from starlette.responses import HTMLResponse, JSONResponse, RedirectResponse, Response

from dh_grader.access import Caller, Scope, Secret
from dh_grader.api.http import (
    LANGUAGE_FIELD,
    NO_STORE,
    Catalogue,
    ProblemError,
    current_request,
    language_of,
    message_of,
    read_body,
)
from dh_grader.api.permissions import is_same_origin
from dh_grader.api.recording import read, write
from dh_grader.contract.courses import CourseName, NewAssignment
from dh_grader.courses import CourseError, roll
from dh_grader.formats.documents import STYLE
from dh_grader.lti.deep_linking import NewLink, signed_response
from dh_grader.lti.fetching import (
    PlatformKeys,
    SigningKey,
    ensure_key,
    own_key_list,
    published_keys,
    signing_key,
)
from dh_grader.lti.grade_services import ScoreError
from dh_grader.lti.handed_files import missing_counts, notice_in, parties_of, queue_files
from dh_grader.lti.joining import (
    CheckLine,
    Invitation,
    accept,
    check_registration,
    claim,
    invitation_of,
    last_refusal,
    register_at,
    release,
)
from dh_grader.lti.launch import (
    REPORT,
    Landing,
    LaunchMessage,
    LinkingTicket,
    Login,
    LtiTicket,
    NewLogin,
    assign,
    begin_login,
    digest,
    key_id_of,
    login_fields,
    login_of,
    message_in,
    new_assignment_id,
    pseudonym,
    ticket_in,
)
from dh_grader.lti.registrations import (
    LtiError,
    LtiRole,
    Registration,
    RegistrationError,
    all_registrations,
    deployments_of,
    find_registration,
    note_refusal,
    origin_of,
    registration,
    unusable,
)
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.tables import contexts, resource_links
from dh_grader.translations import ENGLISH, Language, say
from dh_grader.web.lti_pages import (
    Choice,
    Landings,
    NotYetError,
    Offer,
    binding_page,
    choosing_page,
    frame_headers,
    links_of,
    login_page,
    lti_page,
    offer_of,
    picked_in,
    picker_page,
    refused_page,
    return_page,
    tutor_page,
)
from dh_grader.web.pages import (
    FORM_HEADERS,
    SESSION,
    Assets,
    form_fields,
    page,
    page_answer,
    set_session_cookie,
)
from dh_grader.web.tutor import Tutoring

# --- Launches, by which a learning platform opens the service for its users


_log = logging.getLogger(__name__)

_LOGIN: Final = "/login"
_LAUNCH: Final = "/launch"
_LAUNCH_FIELDS: Final = 30
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
        fields = await form_fields(request, _LAUNCH_FIELDS)
        language = language_of(request)
        return await launching.answered(lambda: login(fields, language), language)

    @router.post(_LAUNCH)
    async def launch(request: Request) -> Response:
        """Check the platform's message, and return the page that the message opens."""
        fields = await form_fields(request, _LAUNCH_FIELDS)

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

    def __init__(self, assets: Assets, tutoring: Tutoring, platform_keys: PlatformKeys) -> None:
        self._assets, self._store = assets, tutoring.store
        self._platform_keys = platform_keys

    async def begin(self, given: Mapping[str, str]) -> NewLogin:
        """Store a new login and return it. Raises LtiError."""
        fields = login_fields(given)
        known = await read(
            self._store, lambda it: find_registration(it, fields["iss"], fields.get("client_id"))
        )
        now = datetime.now(UTC)
        return await write(self._store, lambda it: begin_login(it, known, fields, now))

    async def login_of(self, fields: Mapping[str, str]) -> tuple[Registration, Login]:
        """Return the registration and the login that a message belongs to. Raises LtiError."""
        now = datetime.now(UTC)
        begun = await read(self._store, lambda it: login_of(it, fields.get("state", ""), now))
        known = await read(self._store, lambda it: _known(it, begun.registration))
        if "error" in fields:
            raise LtiError("platform-error", error=fields["error"])
        return known, begun

    async def message(self, token: str, known: Registration, begun: Login) -> LaunchMessage:
        """Return the message in a signed token. Note why it is refused, and raise LtiError."""
        now = datetime.now(UTC)
        try:
            key = await self._platform_keys.key(known, key_id_of(token))
            return message_in(token, key, known, begun, now)
        except LtiError as error:
            name = error.name
            await write(self._store, lambda it: note_refusal(it, known.id, name, now))
            raise

    def ask_to_bind(
        self, request: Request, fields: Mapping[str, str], known: Registration, begun: Login
    ) -> Response:
        """Return a page for a browser that has not sent the cookie of its login.

        Raises LtiError if no page can help: if the page already has its own window and the platform
        offers no storage.
        """
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
        try:
            return await work()
        except LtiError as error:
            return await self._refused(error, language)

    async def _refused(self, error: LtiError, language: Language) -> Response:
        """Return an error page for the student, with the reference number of the log line."""
        context = current_request()
        reference = "" if context is None else context.id
        _log.warning("LTI: refused (%s), reference %s: %s", error.name, reference, error)
        known = await read(self._store, all_registrations)
        origins = [origin for each in known for origin in each.frame_origins]
        content = refused_page(self._assets, language, error.advice, reference, error.name)
        status = _STATUSES.get(error.name, HTTPStatus.FORBIDDEN)
        return HTMLResponse(content, status, headers=frame_headers(language, origins))


def _known(connection: Connection, registration_id: str) -> Registration:
    try:
        return registration(connection, registration_id)
    except RegistrationError as error:
        raise LtiError("no-longer-registered") from error


def is_bound(
    request: Request, fields: Mapping[str, str], known: Registration, begun: Login
) -> bool:
    """True if this browser has begun the login; False if it has not sent its secret yet.

    Raises LtiError if the secret is not from this browser.
    """
    # The browser sends its secret in a cookie, or in a form with the value from the platform's
    # storage. The form is accepted only from our own page, because an attacker could begin a login
    # and let another browser post the form.
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


def cookie_name(known: Registration, state: str) -> str:
    """Return the name of the cookie of a login; several may be under way at once."""
    prefix = "__Host-" if known.address.startswith("https:") else ""
    return f"{prefix}dh-grader-lti-{digest(state)[:12]}"


def set_cookie(answer: Response, begun: NewLogin) -> None:
    """Set the cookie with the secret of a login."""
    name = cookie_name(begun.registration, begun.state)
    answer.set_cookie(name, begun.browser, _AGE, secure=True, httponly=True, samesite="none")


# --- Dynamic registration: a learning platform registers itself here
#
# The platform opens the link that an admin has pasted.


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
        """Return the page that asks the platform's admin to continue; fetch nothing yet."""
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
    # Return the new registration of an invited platform. Raises RegistrationError; the invitation
    # is then valid as before.
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


# --- The forms on a tutor's first page: choose the exercises of a link, and open the course
#
# A page in a frame has no cookie, so each form contains a signed ticket.
#
# The forms are accepted from our own pages only. The course opens in a window of its own, in which
# our cookie is not a third-party cookie.


# The fields of a form with all exercises.
_FORM_FIELDS: Final = 1000

Answered = Callable[[Callable[[], Awaitable[Response]], Language], Awaitable[Response]]


def tutor_forms(landings: Landings, answered: Answered) -> APIRouter:
    """Return these routes; ``answered`` makes an error page from an LtiError."""
    router = APIRouter(prefix="/lti")
    store, keys = landings.store, landings.keys

    async def asked(request: Request, text: str) -> LtiTicket:
        """Return the signed ticket in one of our forms. Raises LtiError."""
        if not is_same_origin(request):
            raise LtiError("binding-from-elsewhere")
        return ticket_in(text, LtiTicket, landings.secret)

    @router.post("/assignment")
    async def choose(request: Request) -> Response:
        """Search for exercises, or make an assignment of the chosen exercises."""
        fields = form_lists(await request.body())
        text = fields.get("ticket", [""])[0]
        language = language_of(request, fields.get("locale", [""])[0])

        async def chosen() -> Response:
            ticket = await asked(request, text)
            context, link = await read(store, lambda it: _rows(it, ticket))
            known = await read(store, lambda it: registration(it, ticket.registration))
            course = await read(store, lambda it: roll.course(it, context.course))
            choice = _choice(fields)
            try:
                if fields.get("action") != ["save"]:
                    raise NotYetError("")
                new = _new_assignment(choice, link.number)
                known_ones = landings.catalogue
                made = await write(store, lambda it: _assigned(it, link.number, new, known_ones))
            except NotYetError as error:
                shown = replace(choice, message=message_of(error))
                content = choosing_page(
                    shown, course.title, text, landings.catalogue, landings.assets, language
                )
            else:
                landing = Landing(
                    LtiRole.TUTOR,
                    course_title=course.title,
                    link_title=made.title,
                    assignment=made,
                )
                content = tutor_page(landing, text, landings.catalogue, landings.assets, language)
            return HTMLResponse(content, headers=frame_headers(language, known.frame_origins))

        return await answered(chosen, language)

    @router.post("/session")
    async def session(request: Request) -> Response:
        """Start a tutor's session, and open the course."""
        fields = await form_fields(request)
        language = language_of(request, fields.get("locale", ""))

        async def begun() -> Response:
            ticket = await asked(request, fields.get("ticket", ""))
            context, _ = await read(store, lambda it: _rows(it, ticket))
            caller = Caller(frozenset({Scope.TUTOR}), key_id=context.key, course=context.course)
            address = _course_address(context.course, ticket.learner, language)
            answer = RedirectResponse(address, HTTPStatus.SEE_OTHER, NO_STORE)
            text = keys.session(caller, datetime.now(UTC) + SESSION)
            set_session_cookie(answer, request, text)
            return answer

        return await answered(begun, language)

    return router


def form_lists(body: bytes) -> Mapping[str, list[str]]:
    """Return all values of each field of a form, by field name."""
    try:
        return parse_qs(body.decode(errors="replace"), max_num_fields=_FORM_FIELDS)
    except ValueError:
        return {}


def _course_address(course: str, learner: str, language: Language) -> str:
    """Return the address of the page of a course, or of one of its learners."""
    query = {"learner": learner} if learner else {}
    page = "/learner" if learner else ""
    return f"../tutor/courses/{course}{page}?{urlencode({**query, LANGUAGE_FIELD: language.code})}"


def _rows(connection: Connection, ticket: LtiTicket) -> tuple[Row[Any], Row[Any]]:
    # Return the database rows of the course and the resource link that a ticket names. Raises
    # LtiError.
    of_context = (contexts.c.number == ticket.context) & (
        contexts.c.registration == ticket.registration
    )
    of_link = (resource_links.c.number == ticket.link) & (
        resource_links.c.context == ticket.context
    )
    context = connection.execute(select(contexts).where(of_context)).one_or_none()
    link = connection.execute(select(resource_links).where(of_link)).one_or_none()
    if context is None or link is None:
        raise LtiError("no-longer-registered")
    return context, link


def _choice(fields: Mapping[str, list[str]]) -> Choice:
    chosen = {
        name: fields.get(f"points:{name}", [""])[0].strip()[:20]
        for name in fields.get("exercise", [])
    }
    title, search = (fields.get(name, [""])[0].strip()[:200] for name in ("title", "search"))
    return Choice(title, search, chosen, variants=fields.get("variants") == ["yes"])


def _new_assignment(choice: Choice, link: int) -> NewAssignment:
    if not choice.chosen:
        raise NotYetError(say("Choose at least one exercise."))
    if not choice.title:
        raise NotYetError(say("Enter a title."))
    listed = [{"exercise": each, "points": points} for each, points in choice.chosen.items()]
    fields = {
        "id": new_assignment_id(link),
        "title": choice.title,
        "exercises": listed,
        "variants": choice.variants,
    }
    try:
        return NewAssignment.model_validate(fields)
    except ValidationError as error:
        raise NotYetError(say("Points are numbers above 0, at most 10000.")) from error


def _assigned(connection: Connection, link: int, new: NewAssignment, catalogue: Any) -> Any:
    try:
        return assign(connection, link, new, catalogue)
    except CourseError as error:
        raise NotYetError(message_of(error)) from error


# --- Deep linking: the form on which a tutor searches for exercises, and makes links to them


# Platforms may want to see who sends the answer: our origin, and nothing more.
_REFERRER: Final = {"Referrer-Policy": "strict-origin"}


def picker_forms(landings: Landings, answered: Answered) -> APIRouter:
    """Return this route; ``answered`` makes an error page from an LtiError."""
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
        """Search for exercises, or return to the platform: with the chosen links, or with none."""
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
    return offer_of(connection, ticket, _known(connection, ticket.registration))


# --- Notices of platforms, signed, that a student has handed in a file
#
# They come without a login and without a browser.


_MOST_NOTICES: Final = 50


class SignedNotice(BaseModel):
    """A signed notice from a learning platform."""

    jwt: str


class Notices(BaseModel):
    """The body of a request with several notices from a learning platform."""

    notices: Annotated[list[SignedNotice], Field(min_length=1, max_length=_MOST_NOTICES)]


def notice_routes(store: AttemptStore, secret: Secret, keys: PlatformKeys) -> APIRouter:
    """Return the route that accepts notices from learning platforms."""
    router = APIRouter(prefix="/lti")

    async def accept(token: str, refusals: dict[str, str]) -> None:
        # Queue the files of a notice. Raises LtiError. If the notice is of a registered platform,
        # store the name of an error in ``refusals``, at the id of the registration.
        key_id, now = key_id_of(token), datetime.now(UTC)
        parties = parties_of(token)
        known = await read(store, lambda it: find_registration(it, *parties))
        try:
            notice = notice_in(token, await keys.key(known, key_id), known, now)
            if notice is not None:
                learner = pseudonym(known.id, notice.user, secret)
                await write(store, lambda it: queue_files(it, known, notice, learner, now))
        except LtiError as error:
            refusals[known.id] = error.name
            raise

    @router.post("/notices")
    async def notices(request: Request) -> Response:
        """Accept the notices in a request, even if one of them is refused."""
        body = await read_body(Notices, request)
        refused: list[dict[str, str]] = []
        refusals: dict[str, str] = {}
        for each in body.notices:
            try:
                await accept(each.jwt, refusals)
            except LtiError as error:
                _log.warning("LTI: a notice was refused (%s): %s", error.name, error)
                refused.append({"error": error.name})
        # Anybody may send what is refused: one transaction for all of it.
        if refusals:
            await write(store, lambda it: _note(it, refusals))
        if refused:
            return JSONResponse({"errors": refused}, HTTPStatus.FORBIDDEN)
        return JSONResponse({})

    return router


def _note(connection: Connection, refusals: Mapping[str, str]) -> None:
    now = datetime.now(UTC)
    for registration_id, name in refusals.items():
        note_refusal(connection, registration_id, name, now)


# --- The page of the registered learning platforms, with a self-test for each platform
#
# It also shows their last launches and our keys.


# Registrations are named as courses are.
_RegistrationId = Annotated[CourseName, Path(description="The id of a registration.")]


class _Shown(NamedTuple):
    # A registered platform, with the data that the page shows about it.
    registration: Registration
    deployments: list[str]
    refusal: str
    missing_reports: int


def platform_routes(landings: Landings) -> APIRouter:
    """Return the routes of the page with the registered learning platforms."""
    router = APIRouter(prefix="/tutor/platforms")

    async def answer(
        request: Request, tested: str = "", lines: tuple[CheckLine, ...] = ()
    ) -> Response:
        found, keys = await read(landings.store, lambda it: (_shown(it), own_key_list(it)))
        root = "../../../" if tested else "../"
        content = page(
            "web/templates/lti/platforms.html",
            landings.assets,
            root,
            ["page.js"],
            styles=["tutor.css", "records.css"],
            language=language_of(request),
            tutor=True,
            platforms=found,
            keys=keys,
            now=datetime.now(UTC),
            tested=tested,
            lines=lines,
        )
        return page_answer(request, content, FORM_HEADERS)

    @router.get("")
    async def platforms(request: Request) -> Response:
        """Return the page with the registered learning platforms and our keys."""
        return await answer(request)

    @router.post("/{registration_id}/check")
    async def check(request: Request, registration_id: _RegistrationId) -> Response:
        """Test the registration of a platform, and return the page with the results."""
        secret, now = landings.secret, datetime.now(UTC)

        def known(connection: Connection) -> tuple[Registration, SigningKey]:
            found = registration(connection, registration_id)
            ensure_key(connection, secret, now)
            return found, signing_key(connection, secret, now)

        try:
            found, key = await write(landings.store, known)
        except RegistrationError as error:
            raise ProblemError(HTTPStatus.NOT_FOUND, message_of(error)) from error
        except LtiError as error:
            raise ProblemError(HTTPStatus.SERVICE_UNAVAILABLE, message_of(error)) from error
        lines = await landings.platforms.run(
            found.id, lambda: tuple(check_registration(found, key))
        )
        return await answer(request, found.id, lines)

    return router


def _shown(connection: Connection) -> list[_Shown]:
    missing = missing_counts(connection)
    return [
        _Shown(
            each,
            deployments_of(connection, each.id),
            last_refusal(each),
            missing.get(each.id, 0),
        )
        for each in all_registrations(connection)
    ]
