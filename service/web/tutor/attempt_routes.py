"""The routes of the pages of recorded attempts."""

# Scripts load the attempts themselves.

import re
from typing import Final

from fastapi import APIRouter, Request
from starlette.responses import Response

from service.api.http.language import language_of
from service.api.http.lookup import Catalogue, exercise_or_404, reachable_exercises
from service.api.permissions.access import require_reach
from service.regex import regex
from service.web.assets import Assets
from service.web.page_answer import page_answer
from service.web.page_headers import PRIVATE_HEADERS
from service.web.tutor.attempt_pages import (
    CoursePlace,
    attempt_page,
    attempts_page,
    nothing_recorded_page,
    statistics_page,
)
from service.web.tutor.tutor_routes import Tutoring

_NAME: Final = regex(r"[a-z0-9-]{1,64}", re.ASCII)


def attempt_routes(catalogue: Catalogue, assets: Assets, tutoring: Tutoring) -> APIRouter:
    """Return the routes of the pages of recorded attempts."""
    router = APIRouter(prefix="/tutor", include_in_schema=False)
    access = tutoring.access

    def answer(request: Request, shown: bytes, root: str) -> Response:
        if not tutoring.records:
            shown = nothing_recorded_page(assets, language_of(request), root)
        return page_answer(request, shown, PRIVATE_HEADERS)

    @router.get("/attempts")
    async def attempts(request: Request, exercise: str | None = None) -> Response:
        """Return the page with the list of attempts."""
        # If the caller's key is restricted to some exercises, the page lists one of these exercises
        # at a time.
        caller = access.caller(request)
        require_reach(caller, exercise or None)
        shown = reachable_exercises(catalogue, caller)
        drawn = attempts_page(
            shown,
            assets,
            language_of(request),
            _place(request),
            of_all=caller.exercises is None,
            forgets=caller.reaches_all,
        )
        return answer(request, drawn, "../")

    @router.get("/attempts/{attempt_id}")
    async def attempt(request: Request, attempt_id: str) -> Response:
        """Return the page of an attempt."""
        return answer(request, attempt_page(attempt_id, assets, language_of(request)), "../../")

    @router.get("/statistics/{exercise_id}")
    async def statistics(request: Request, exercise_id: str) -> Response:
        """Return the page with an exercise's statistics."""
        exercise = exercise_or_404(catalogue, exercise_id)
        drawn = statistics_page(exercise, assets, language_of(request), _place(request))
        return answer(request, drawn, "../../")

    return router


def _place(request: Request) -> CoursePlace:
    # Return the course and the assignment in the address of a page, if they are well formed.
    given = request.query_params
    course, assignment = given.get("course", ""), given.get("assignment", "")
    if not _NAME.fullmatch(course):
        return CoursePlace()
    return CoursePlace(course, assignment if _NAME.fullmatch(assignment) else "")
