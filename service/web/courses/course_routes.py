"""The routes of the pages on which tutors manage their courses."""

from datetime import UTC, datetime
from http import HTTPStatus
from typing import TYPE_CHECKING, Annotated
from urllib.parse import parse_qs

from fastapi import APIRouter, Query, Request
from starlette.responses import Response

from service.api.courses.asking import (
    AssignmentId,
    CourseId,
    course_problem,
    read,
    service_address,
    write,
)
from service.api.http.bodies import validated
from service.api.http.language import language_of
from service.api.http.lookup import Catalogue
from service.contract.attempts import Learner
from service.contract.courses import LinksRequest
from service.contract.scores import SendAgainRequest
from service.courses.errors import links_need_a_secret, unknown_learner
from service.translations import Language
from service.web.assets import Assets
from service.web.courses.course_pages import (
    CourseState,
    assignment_page,
    course_page,
    courses_page,
    gradebook_page,
    learner_page,
)
from service.web.courses.roster_routes import roster_routes
from service.web.page_answer import page_answer
from service.web.page_headers import FORM_HEADERS, NO_STORE
from service.web.tutor.tutor_routes import Tutoring

if TYPE_CHECKING:  # it loads the drivers of databases
    from sqlalchemy import Connection


def course_routes(catalogue: Catalogue, assets: Assets, tutoring: Tutoring) -> APIRouter:
    """Return the routes of the pages on which tutors manage their courses."""
    router = APIRouter(include_in_schema=False)
    router.include_router(_set_up_routes(catalogue, assets, tutoring))
    router.include_router(_learner_routes(catalogue, assets, tutoring))
    router.include_router(roster_routes(assets, tutoring))
    return router


def _set_up_routes(catalogue: Catalogue, assets: Assets, tutoring: Tutoring) -> APIRouter:
    router = APIRouter(prefix="/tutor/courses")
    access, store = tutoring.access, tutoring.store

    @router.get("")
    async def courses(request: Request) -> Response:
        """Return the page with all courses that the tutor may see."""
        # A tutor of one course sees only this course.
        from service.courses import roll

        only = access.caller(request).course
        found = await read(store, lambda it: roll.all_courses(it, only))
        shown = courses_page(found, assets, language_of(request), creates=only is None)
        return _answer(request, shown)

    @router.get("/{course_id}")
    async def course(request: Request, course_id: CourseId) -> Response:
        """Return the page of a course."""
        language = language_of(request)
        state = await read(store, lambda it: _state(it, course_id, language))
        drawn = course_page(
            state,
            catalogue,
            assets,
            language,
            has_secret=access.keys is not None and access.keys.secret is not None,
            has_keys=bool(access.caller(request).key_id),
            deletes=access.caller(request).course is None,
        )
        return _answer(request, drawn)

    @router.get("/{course_id}/assignments/{assignment_id}")
    async def assignment(
        request: Request, course_id: CourseId, assignment_id: AssignmentId
    ) -> Response:
        """Return the page of an assignment."""
        from service.courses.assignments import assignment_of
        from service.courses.results.gradebook import gradebook, missing
        from service.lti.scores.overview import scores_of

        language = language_of(request)

        def drawn(connection: "Connection") -> bytes:
            return assignment_page(
                _state(connection, course_id, language),
                assignment_of(connection, course_id, assignment_id),
                missing(connection, course_id, assignment_id),
                gradebook(connection, course_id, assignment_id),
                scores_of(
                    connection, course_id, SendAgainRequest(assignment=assignment_id), language
                ),
                catalogue,
                assets,
                language,
            )

        return _answer(request, await read(store, drawn))

    return router


def _learner_routes(catalogue: Catalogue, assets: Assets, tutoring: Tutoring) -> APIRouter:
    router = APIRouter(prefix="/tutor/courses")
    access, store = tutoring.access, tutoring.store

    @router.get("/{course_id}/gradebook")
    async def book(request: Request, course_id: CourseId) -> Response:
        """Return the page of the gradebook."""
        from service.courses import roll

        found = await read(store, lambda it: roll.course(it, course_id))
        return _answer(request, gradebook_page(found, assets, language_of(request)))

    @router.get("/{course_id}/learner")
    async def learner(
        request: Request, course_id: CourseId, learner: Annotated[Learner, Query()]
    ) -> Response:
        """Return the page of a learner."""
        # The id is in the query, because it may have a slash.
        from service.courses.dealing import learner_variants
        from service.courses.learner_view import own_view
        from service.lti.handed_files.overview import missing_reports
        from service.lti.scores.overview import scores_of

        now, language = datetime.now(UTC), language_of(request)

        def drawn(connection: "Connection") -> bytes:
            view = own_view(connection, learner, course_id, catalogue, now, language)
            if not view.courses:
                raise unknown_learner(learner)
            [own] = view.courses
            variants = {
                each.id: learner_variants(connection, course_id, each.id, learner, catalogue)
                for each in own.assignments
            }
            wanted = SendAgainRequest(learner=learner)
            scores = scores_of(connection, course_id, wanted, language)
            reports = missing_reports(connection, course_id, language, learner)
            return learner_page(own, learner, variants, scores, reports, now, assets, language)

        return _answer(request, await read(store, drawn))

    @router.post("/{course_id}/links.csv")
    async def links(request: Request, course_id: CourseId) -> Response:
        """Return a CSV file with the links of all learners, or with a new link of one learner."""
        from service.courses.links import issue_links, written_links

        fields = parse_qs((await request.body()).decode(errors="replace"))
        one = fields.get("learner")
        secret = None if access.keys is None else access.keys.secret
        if secret is None:
            raise course_problem(links_need_a_secret())
        wanted = validated(LinksRequest, {"learners": one, "renew": one is not None})
        known = secret
        base, now = service_address(request), datetime.now(UTC)
        found = await write(store, lambda it: issue_links(it, course_id, wanted, known, base, now))
        attachment = f'attachment; filename="links-{course_id}.csv"'
        headers = {**NO_STORE, "Content-Disposition": attachment}
        content = b"".join(written_links(found))
        return Response(content, HTTPStatus.OK, headers, "text/csv; charset=utf-8")

    return router


def _answer(request: Request, content: bytes) -> Response:
    return page_answer(request, content, FORM_HEADERS)


def _state(connection: "Connection", course_id: str, language: Language) -> CourseState:
    """Return all data that the page of a course shows. Raises CourseError."""
    from service.courses import roll
    from service.courses.assignments import assignments_of
    from service.courses.results.gradebook import handed_in
    from service.lti.handed_files.overview import missing_reports
    from service.lti.roster.enrolment import roster_context

    roster = roster_context(connection, course_id)
    return CourseState(
        roll.course(connection, course_id),
        roll.learners(connection, course_id, datetime.now(UTC)),
        assignments_of(connection, course_id),
        handed_in(connection, course_id),
        roster,
        missing_reports(connection, course_id, language),
    )
