"""The forms on a tutor's first page: choose the exercises of a link, and open the course.

A page in a frame has no cookie, so each form contains a signed ticket.
"""

# The forms are accepted from our own pages only. The course opens in a window of its own, in which
# our cookie is not a third-party cookie.

from collections.abc import Awaitable, Callable, Mapping
from dataclasses import replace
from datetime import UTC, datetime
from http import HTTPStatus
from typing import Any, Final
from urllib.parse import parse_qs, urlencode

from fastapi import APIRouter, Request
from pydantic import ValidationError
from sqlalchemy import Connection, Row, select
from starlette.responses import HTMLResponse, RedirectResponse, Response

from service.access.caller import Caller, Scope
from service.api.courses.asking import read, write
from service.api.http.language import LANGUAGE_FIELD, language_of
from service.api.http.problems import message_of
from service.api.permissions.access import is_same_origin
from service.attempts.storage.lti_tables import contexts, resource_links
from service.contract.courses import NewAssignment
from service.courses import roll
from service.courses.errors import CourseError
from service.lti.linking import Landing, assign, new_assignment_id
from service.lti.problems import LtiError
from service.lti.registrations import registration
from service.lti.roles import LtiRole
from service.lti.tickets import LtiTicket, ticket_in
from service.translations import Language, say
from service.web.lti.landing import Landings
from service.web.lti.lti_pages import Choice, choosing_page, frame_headers, tutor_page
from service.web.page_headers import NO_STORE
from service.web.sign_in import SESSION, form_fields, set_session_cookie

_MOST_FIELDS: Final = 1000

Answered = Callable[[Callable[[], Awaitable[Response]], Language], Awaitable[Response]]


def tutor_forms(landings: Landings, answered: Answered) -> APIRouter:
    """Return the routes of the forms on a tutor's first page."""
    # ``answered`` makes an error page from an LtiError.
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
                    raise _NotYetError("")
                new = _new_assignment(choice, link.number)
                known_ones = landings.catalogue
                made = await write(store, lambda it: _assigned(it, link.number, new, known_ones))
            except _NotYetError as error:
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


def _course_address(course: str, learner: str, language: Language) -> str:
    """Return the address of the page of a course, or of one of its learners."""
    query = {"learner": learner} if learner else {}
    page = "/learner" if learner else ""
    return f"../tutor/courses/{course}{page}?{urlencode({**query, LANGUAGE_FIELD: language.code})}"


class _NotYetError(Exception):
    """The values of a form cannot be used; the form is shown again, with this message."""


def _rows(connection: Connection, ticket: LtiTicket) -> tuple[Row[Any], Row[Any]]:
    # Return the database rows of the course and the resource link that a ticket names.
    # Raises LtiError.
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


def form_lists(body: bytes) -> Mapping[str, list[str]]:
    """Return all values of each field of a form, by field name."""
    try:
        return parse_qs(body.decode(errors="replace"), max_num_fields=_MOST_FIELDS)
    except ValueError:
        return {}


def _choice(fields: Mapping[str, list[str]]) -> Choice:
    chosen = {
        name: fields.get(f"points:{name}", [""])[0].strip()[:20]
        for name in fields.get("exercise", [])
    }
    title, search = (fields.get(name, [""])[0].strip()[:200] for name in ("title", "search"))
    return Choice(title, search, chosen, variants=fields.get("variants") == ["yes"])


def _new_assignment(choice: Choice, link: int) -> NewAssignment:
    if not choice.chosen:
        raise _NotYetError(say("Choose at least one exercise."))
    if not choice.title:
        raise _NotYetError(say("Enter a title."))
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
        raise _NotYetError(say("Points are numbers above 0, at most 10000.")) from error


def _assigned(connection: Connection, link: int, new: NewAssignment, catalogue: Any) -> Any:
    try:
        return assign(connection, link, new, catalogue)
    except CourseError as error:
        raise _NotYetError(message_of(error)) from error
