"""The route that reads a course's roster, the platform's list of its members (LTI)."""

from datetime import UTC, datetime
from http import HTTPStatus

from fastapi import APIRouter, Request
from starlette.responses import Response

from service.api.courses.asking import CourseId, course_problem, read, write
from service.api.http.language import language_of
from service.api.http.problems import message_of
from service.courses.errors import CourseError
from service.translations import say, told
from service.web.assets import Assets
from service.web.courses.course_pages import roster_page
from service.web.page_answer import page_answer
from service.web.page_headers import FORM_HEADERS
from service.web.sign_in import form_fields
from service.web.tutor.tutor_routes import Tutoring


def roster_routes(assets: Assets, tutoring: Tutoring) -> APIRouter:
    """Return the route that reads a roster (a platform's list of members)."""
    router = APIRouter(prefix="/tutor/courses")
    access, store = tutoring.access, tutoring.store

    @router.post("/{course_id}/roster")
    async def roster(request: Request, course_id: CourseId) -> Response:
        """Read the platform's list of members, and return the page with the changes."""
        from service.courses import roll
        from service.lti.roster.enrolment import (
            RosterError,
            ask_for_roster,
            enrol_members,
            read_roster,
        )

        shows_names = "names" in await form_fields(request)
        secret = None if access.keys is None else access.keys.secret
        if secret is None:
            message = say("Rosters need a secret: set DH_GRADER_SECRET.")
            raise course_problem(CourseError("unusable", message))
        known, now, language = secret, datetime.now(UTC), language_of(request)
        course = await read(store, lambda it: roll.course(it, course_id))
        try:
            asked = await write(store, lambda it: ask_for_roster(it, course_id, known, now))
        except RosterError as error:
            raise course_problem(CourseError("unusable", message_of(error))) from error
        try:
            members = await tutoring.platforms.run(
                asked.registration.id, lambda: read_roster(asked)
            )
        except RosterError as error:
            content = roster_page(
                course, None, told(message_of(error), language.translation), assets, language
            )
            return page_answer(request, content, FORM_HEADERS, HTTPStatus.BAD_GATEWAY)
        change = await write(
            store, lambda it: enrol_members(it, asked, members, known, shows_names=shows_names)
        )
        content = roster_page(course, change, "", assets, language)
        return page_answer(request, content, FORM_HEADERS)

    return router
