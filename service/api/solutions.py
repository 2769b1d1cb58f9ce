"""The route that shows model solutions to tutors."""

import asyncio
from collections import OrderedDict
from http import HTTPStatus
from typing import Final

from fastapi import APIRouter, Response
from pydantic import TypeAdapter

from service.api.lookup import Catalogue, ExerciseId, exercise_or_404
from service.api.openapi import answers
from service.api.problems import ProblemError
from service.catalogue import Exercise
from service.solutions import ModelSolution, solve

# A course has a few dozen exercises; one solution takes some ten kilobytes.
KEPT: Final = 128
_SOLUTION: Final = TypeAdapter(ModelSolution)


class Solutions:
    """Model solutions as JSON, worked out one at a time in a thread, and kept."""

    def __init__(self) -> None:
        self._kept: OrderedDict[tuple[str, str], bytes] = OrderedDict()
        self._working = asyncio.Lock()

    async def of(self, exercise: Exercise) -> bytes:
        """The solution of this version of the exercise."""
        key = (exercise.id, exercise.version)
        if key not in self._kept:
            async with self._working:
                if key not in self._kept:
                    self._kept[key] = await asyncio.to_thread(_solved, exercise)
                    while len(self._kept) > KEPT:
                        self._kept.popitem(last=False)
        self._kept.move_to_end(key)
        return self._kept[key]


def _solved(exercise: Exercise) -> bytes:
    return _SOLUTION.dump_json(solve(exercise), exclude_none=True)


def routes(catalogue: Catalogue, *, shown: bool) -> APIRouter:
    """The route that shows model solutions, or says how to have them shown."""
    router = APIRouter(prefix="/v1/exercises", tags=["solutions"])
    solutions = Solutions()

    @router.get(
        "/{exercise_id}/solution",
        operation_id="getSolution",
        summary="Show the model solution",
        response_description="The model solution.",
        responses=answers(
            ModelSolution, "solution-response", HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND
        ),
    )
    async def show_solution(exercise_id: ExerciseId) -> Response:
        """Show the right answer to each part, each link transform and the pose, for tutors."""
        if not shown:
            raise ProblemError(
                HTTPStatus.FORBIDDEN,
                "Model solutions are for tutors, and this service does not show them. To have them "
                "shown to whoever can reach it, start it with DH_GRADER_SOLUTIONS=true; on the "
                "machine itself, use dh-grader exercises show ID --solution.",
                "solutions-off",
                "Model solutions are not shown here",
            )
        content = await solutions.of(exercise_or_404(catalogue, exercise_id))
        return Response(content, 200, {"Cache-Control": "no-store"}, "application/json")

    return router
