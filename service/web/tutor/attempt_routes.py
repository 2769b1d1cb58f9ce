"""The routes of the pages of recorded attempts; scripts load the attempts themselves."""

from fastapi import APIRouter, Request
from starlette.responses import HTMLResponse, Response

from service.api.http.lookup import Catalogue, exercise_or_404, reachable_exercises
from service.api.permissions.access import require_reach
from service.web.assets import Assets
from service.web.page_headers import PRIVATE_HEADERS
from service.web.tutor.attempt_pages import (
    attempt_page,
    attempts_page,
    nothing_recorded_page,
    statistics_page,
)
from service.web.tutor.tutor_routes import Tutoring


def attempt_routes(catalogue: Catalogue, assets: Assets, tutoring: Tutoring) -> APIRouter:
    """Return the routes of the pages of recorded attempts."""
    router = APIRouter(prefix="/tutor", include_in_schema=False)
    access = tutoring.access

    def answer(shown: bytes, root: str) -> Response:
        content = shown if tutoring.records else nothing_recorded_page(assets, root)
        return HTMLResponse(content, headers=PRIVATE_HEADERS)

    @router.get("/attempts")
    async def attempts(request: Request, exercise: str | None = None) -> Response:
        """Answer with the list of attempts. A restricted key sees one exercise at a time."""
        caller = access.caller(request)
        require_reach(caller, exercise or None)
        shown = reachable_exercises(catalogue, caller)
        return answer(attempts_page(shown, assets, of_all=caller.exercises is None), "../")

    @router.get("/attempts/{attempt_id}")
    async def attempt(attempt_id: str) -> Response:
        """Answer with the page of an attempt."""
        return answer(attempt_page(attempt_id, assets), "../../")

    @router.get("/statistics/{exercise_id}")
    async def statistics(exercise_id: str) -> Response:
        """Answer with the page of an exercise's statistics and regrade."""
        exercise = exercise_or_404(catalogue, exercise_id)
        return answer(statistics_page(exercise, assets), "../../")

    return router
