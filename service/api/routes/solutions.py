"""The route that shows model solutions to tutors."""

from functools import partial
from http import HTTPStatus
from typing import Final

from fastapi import APIRouter, Response
from pydantic import TypeAdapter

from service.api.document.openapi import MAY_NEED_KEY, answers
from service.api.http.lookup import Catalogue, ExerciseId, exercise_or_404
from service.api.http.memoized import MemoizedResults
from service.catalogue import Exercise
from service.solutions import ModelSolution, solve

_SOLUTION: Final = TypeAdapter(ModelSolution)


class SolvedExercises:
    """The solutions of exercises, memoized."""

    def __init__(self) -> None:
        self._memoized = MemoizedResults()

    async def answer(self, exercise: Exercise) -> Response:
        """Return the model solution of an exercise as JSON."""
        key = (exercise.id, exercise.version)
        content = await self._memoized.of(key, partial(_solved, exercise))
        return Response(content, 200, {"Cache-Control": "no-store"}, "application/json")


def _solved(exercise: Exercise) -> bytes:
    return _SOLUTION.dump_json(solve(exercise), exclude_none=True)


def routes(catalogue: Catalogue) -> APIRouter:
    """Return the route that shows model solutions."""
    router = APIRouter(prefix="/v1/exercises", tags=["solutions"])
    solutions = SolvedExercises()

    @router.get(
        "/{exercise_id}/solution",
        operation_id="getSolution",
        summary="Show the model solution",
        response_description="The model solution.",
        responses=answers(
            ModelSolution, "solution-response", HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND
        ),
        openapi_extra=MAY_NEED_KEY,
    )
    async def show_solution(exercise_id: ExerciseId) -> Response:
        """Show the right answer to each part, each link transform and the pose, for tutors."""
        return await solutions.answer(exercise_or_404(catalogue, exercise_id))

    return router
