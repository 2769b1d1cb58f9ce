"""The web pages of the service, and the exercise that other sites embed.

It puts the routes of the other files together, and has those of the pages for everybody.
"""

from http import HTTPStatus
from typing import Final

from fastapi import APIRouter, Request
from starlette.responses import RedirectResponse, Response

from dh_grader.api.application import WebPages
from dh_grader.api.http import (
    Catalogue,
    ChunkedResponse,
    ProblemError,
    exercise_or_404,
    keep_language,
    language_of,
)
from dh_grader.api.permissions import Access
from dh_grader.catalogue import exercise_after
from dh_grader.variants.robots import CatalogueWithPractice
from dh_grader.web.courses import course_routes
from dh_grader.web.pages import (
    REFERENCE_HEADERS,
    Asset,
    Assets,
    catalogue_page,
    exercise_page,
    help_routes,
    learner_page,
    load_assets,
    page_answer,
    play_page,
    practice_page,
    problem_page,
    reference_page,
    sign_in_routes,
    ten_minutes_page,
)
from dh_grader.web.tutor import Tutoring, attempt_routes, tutor_routes

__all__ = ["Tutoring", "web_routes"]


# --- The routes of the pages and of their static files


# Any site may load the element; DH_GRADER_CORS_ORIGINS limits what it may request then.
_FILE_HEADERS: Final = {
    "Access-Control-Allow-Origin": "*",
    "Cross-Origin-Resource-Policy": "cross-origin",
}
_FOR_EVER: Final = "public, max-age=31536000, immutable"
_ENTRY: Final = "embed.js"


def web_routes(catalogue: Catalogue, tutoring: Tutoring | None = None) -> WebPages:
    """Return all pages of the service, with static files, ``/embed.js`` and problem pages.

    Without ``tutoring``, nobody sees the pages of tutors.
    """
    router = APIRouter(include_in_schema=False)
    assets = load_assets()
    # Robots are found, but not listed.
    practised = CatalogueWithPractice(catalogue)
    files = assets.by_name
    tutoring = tutoring or Tutoring(Access())
    router.include_router(_practice_routes(assets, tutoring.access))
    router.include_router(help_routes(assets, tutoring.access))
    router.include_router(sign_in_routes(assets, tutoring.access))
    router.include_router(tutor_routes(practised, assets, tutoring))
    router.include_router(attempt_routes(catalogue, assets, tutoring))
    router.include_router(course_routes(catalogue, assets, tutoring))
    router.include_router(_lti_routes(catalogue, assets, tutoring))

    @router.get("/")
    async def home(request: Request, exercise: str | None = None) -> Response:
        """Return the catalogue page, or redirect to the exercise that the query names."""
        if exercise is not None:
            known = exercise_or_404(practised, exercise)
            answer = RedirectResponse(f"exercises/{known.id}", HTTPStatus.SEE_OTHER)
            keep_language(request, answer)
            return answer
        tutor = tutoring.access.shows_solutions(request)
        shown = catalogue_page(catalogue, assets, language_of(request), tutor=tutor)
        return page_answer(request, shown)

    @router.get("/exercises/{exercise_id}")
    async def exercise(request: Request, exercise_id: str) -> Response:
        """Return the page of an exercise; statement and figure need no scripts."""
        found = exercise_or_404(practised, exercise_id)
        tutor = tutoring.access.shows_solutions(request)
        following = exercise_after(exercise_id, catalogue.values())
        shown = exercise_page(found, following, assets, language_of(request), tutor=tutor)
        return page_answer(request, shown)

    @router.get("/play")
    async def play(request: Request) -> Response:
        """Return the page of free play; the tables in it stay in the browser."""
        tutor = tutoring.access.shows_solutions(request)
        shown = play_page(assets, language_of(request), tutor=tutor)
        return page_answer(request, shown)

    @router.get("/learn")
    async def learn(request: Request) -> Response:
        """Return the page that personal links open."""
        # The page is the same for all learners: its script reads the key in the link.
        return page_answer(request, learner_page(assets, language_of(request)))

    @router.get("/docs")
    async def reference(request: Request) -> Response:
        """Return the reference of the HTTP interface."""
        tutor = tutoring.access.shows_solutions(request)
        shown = reference_page(assets, language_of(request), tutor=tutor)
        return page_answer(request, shown, REFERENCE_HEADERS)

    @router.get(f"/{_ENTRY}")
    async def embed() -> Response:
        """Return the script that other sites include to embed an exercise."""
        # It loads the other scripts. Only this script has a name that never changes.
        content = assets.by_plain_name[_ENTRY].content.replace(b'"./', b'"./static/')
        return _file(assets.by_plain_name[_ENTRY], content, "no-cache")

    @router.get("/static/{name}")
    async def static(name: str) -> Response:
        """Return a script, style or picture."""
        if name not in files:
            raise ProblemError(HTTPStatus.NOT_FOUND, "The page has no such file.")
        return _file(files[name], files[name].content, _FOR_EVER)

    return WebPages(router, problem_page(assets), tutoring.close, tutoring.drafts)


def _lti_routes(catalogue: Catalogue, assets: Assets, tutoring: Tutoring) -> APIRouter:
    if tutoring.store is None:
        return APIRouter()
    # It loads the database drivers.
    from dh_grader.web.lti_routes import lti_routes

    return lti_routes(catalogue, assets, tutoring)


def _practice_routes(assets: Assets, access: Access) -> APIRouter:
    router = APIRouter()

    @router.get("/practice")
    async def practice(request: Request) -> Response:
        """Return the page for practice; the fragment of the address names the robot."""
        tutor = access.shows_solutions(request)
        shown = practice_page(assets, language_of(request), tutor=tutor)
        return page_answer(request, shown)

    @router.get("/learn-dh")
    async def learn_dh(request: Request) -> Response:
        """Return the page "DH in ten minutes"; a learner's progress stays in the browser."""
        tutor = access.shows_solutions(request)
        shown = ten_minutes_page(assets, language_of(request), tutor=tutor)
        return page_answer(request, shown)

    return router


def _file(asset: Asset, content: bytes, caching: str) -> Response:
    headers = {**_FILE_HEADERS, "Cache-Control": caching}
    return ChunkedResponse(content, headers=headers, media_type=asset.media_type)
