"""The routes of the pages for tutors, and the routes that these pages call."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from http import HTTPStatus
from pathlib import Path
from typing import TYPE_CHECKING

from fastapi import APIRouter, Request
from starlette.responses import Response

from service.api.http.bounded_work import BoundedWork
from service.api.http.chunked_response import ChunkedResponse
from service.api.http.language import language_of
from service.api.http.lookup import Catalogue, exercise_or_404, reachable_exercises
from service.api.http.memoized import MemoizedResults
from service.api.http.problems import ProblemError
from service.api.http.told_answer import language_headers
from service.api.permissions.access import Access
from service.catalogue import Exercise, FeedbackLevel, Robot
from service.catalogue.drafts import Drafts
from service.lti.platform_threads import PlatformThreads
from service.translations import say
from service.web.assets import Assets
from service.web.page_answer import page_answer
from service.web.page_headers import FORM_HEADERS, NO_STORE, PRIVATE_HEADERS
from service.web.tutor.checking import Checking
from service.web.tutor.class_routes import class_routes
from service.web.tutor.editor_routes import editor_routes
from service.web.tutor.exercise_folder import ExerciseFolder
from service.web.tutor.tutor_pages import misconceptions_page, solution_page, tutor_page

if TYPE_CHECKING:  # it loads the drivers of databases
    from service.attempts.store import AttemptStore


@dataclass(frozen=True, slots=True)
class Tutoring:
    """The settings of the pages for tutors.

    ``access`` decides who sees solutions. ``records`` is True if attempts are recorded, in
    ``store``. ``feedback`` is the highest feedback level for students.
    """

    # ``folders`` have the exercise files, and the editor saves in ``editor_dir``. ``checking``
    # checks the text in the editor. ``drafts`` has the exercises in the preview. ``platforms`` are
    # the threads that wait for learning platforms.

    access: Access
    folders: Sequence[Path] = field(default=())
    editor_dir: Path | None = None
    records: bool = False
    store: "AttemptStore | None" = None
    checking: Checking = field(default_factory=Checking)
    drafts: Drafts = field(default_factory=Drafts)
    feedback: FeedbackLevel = FeedbackLevel.FULL
    platforms: PlatformThreads = field(default_factory=PlatformThreads)

    def close(self) -> None:
        """End the processes and threads."""
        self.checking.close()
        self.platforms.close()


def tutor_routes(catalogue: Catalogue, assets: Assets, tutoring: Tutoring) -> APIRouter:
    """Return the routes of the pages for tutors."""
    # And the routes that these pages call.
    access = tutoring.access

    router = APIRouter(include_in_schema=False)
    work = BoundedWork()
    has_lti = tutoring.store is not None and access.keys is not None and bool(access.keys.secret)
    folder = ExerciseFolder(tutoring.folders, tutoring.editor_dir)
    for routes in (
        _solution_routes(catalogue, assets, access),
        editor_routes(catalogue, assets, folder, work, tutoring.checking, tutoring.drafts),
        class_routes(catalogue, assets, work),
    ):
        router.include_router(routes)

    @router.get("/tutor")
    async def home(request: Request) -> Response:
        """Return the home page of tutors."""
        # If the caller's key is restricted to some exercises, the page shows only these.
        caller = access.caller(request)
        shown = reachable_exercises(catalogue, caller)
        content = tutor_page(
            shown,
            assets,
            language_of(request),
            of_all=caller.reaches_all,
            has_courses=tutoring.records and caller.exercises is None,
            has_platforms=has_lti and caller.reaches_all,
            signed_in=access.is_signed_in(request),
        )
        return page_answer(request, content, FORM_HEADERS)

    return router


def _solution_routes(catalogue: Catalogue, assets: Assets, access: Access) -> APIRouter:
    router = APIRouter(prefix="/tutor")
    solutions, figures, named = MemoizedResults(), MemoizedResults(), MemoizedResults()

    @router.get("/solutions/{exercise_id}")
    async def solution(request: Request, exercise_id: str) -> Response:
        """Return the page with the correct answers to an exercise."""
        exercise = exercise_or_404(catalogue, exercise_id)
        of_all = access.caller(request).reaches_all
        language = language_of(request)
        key = (exercise.id, exercise.version, exercise.title, of_all, language.code)
        drawn = partial(solution_page, exercise, assets, language, of_all=of_all)
        content = await solutions.of(key, drawn)
        headers = {**PRIVATE_HEADERS, **language_headers(language)}
        return ChunkedResponse(content, headers=headers, media_type="text/html")

    @router.get("/misconceptions/{exercise_id}")
    async def misconceptions(request: Request, exercise_id: str) -> Response:
        """Return the page with the mistakes that the grader can name in an exercise."""
        exercise = exercise_or_404(catalogue, exercise_id)
        language = language_of(request)
        key = (exercise.id, exercise.version, exercise.title, language.code)
        drawn = partial(misconceptions_page, exercise, catalogue, assets, language)
        content = await named.of(key, drawn)
        headers = {**PRIVATE_HEADERS, **language_headers(language)}
        return ChunkedResponse(content, headers=headers, media_type="text/html")

    @router.get("/solutions/{exercise_id}/frames.svg")
    async def frames(exercise_id: str) -> Response:
        """Return a drawing of the robot with its frames."""
        # The frames are those of its correct table.
        exercise = exercise_or_404(catalogue, exercise_id)
        if not isinstance(exercise.reference, Robot):
            raise ProblemError(HTTPStatus.NOT_FOUND, say("The exercise has no frames to draw."))
        key = (exercise.id, exercise.version, exercise.title, exercise.view)
        content = await figures.of(key, partial(_frames, exercise))
        return Response(content, headers=NO_STORE, media_type="image/svg+xml")

    return router


def _frames(exercise: Exercise) -> bytes:
    from service.figures.figure import reference_figure

    return reference_figure(exercise).encode()
