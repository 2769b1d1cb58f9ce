"""The routes that show model solutions: to tutors, and to students with full marks."""

from functools import partial
from http import HTTPStatus
from typing import Final

from fastapi import APIRouter, Request, Response
from pydantic import TypeAdapter

from service.api.courses.own_variant import OwnVariants, of_assignment
from service.api.courses.practice import PracticeGate
from service.api.document.openapi import MAY_NEED_KEY, answers, posting
from service.api.http.bodies import read_body
from service.api.http.lookup import Catalogue, ExerciseId, exercise_or_404, require_parts
from service.api.http.memoized import MemoizedResults
from service.api.http.problems import ProblemError
from service.api.permissions.access import Access
from service.api.turns import run_in_turns
from service.catalogue import Exercise, FeedbackLevel
from service.catalogue.attempts import AttemptsSpec
from service.grading import is_all_right
from service.solutions import ModelSolution, solve
from service.submissions.body import GradeRequest
from service.translations import say

_SOLUTION: Final = TypeAdapter(ModelSolution)


class SolvedExercises:
    """The model solutions of exercises, memoized."""

    def __init__(self) -> None:
        self._memoized = MemoizedResults()

    async def answer(self, exercise: Exercise) -> Response:
        """Return the model solution of an exercise as JSON."""
        key = (exercise.id, exercise.version)
        content = await self._memoized.of(key, partial(_solved, exercise))
        return Response(content, 200, {"Cache-Control": "no-store"}, "application/json")


def _solved(exercise: Exercise) -> bytes:
    return _SOLUTION.dump_json(solve(exercise), exclude_none=True)


def routes(
    catalogue: Catalogue, access: Access, practice: PracticeGate, own: OwnVariants
) -> APIRouter:
    """Return the routes that show model solutions."""
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

    @router.post(
        "/{exercise_id}/solution",
        operation_id="getSolutionForRightAnswers",
        summary="Show the model solution for right answers",
        response_description="The model solution.",
        **of_assignment(
            posting(GradeRequest, ModelSolution, None, HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND)
        ),
    )
    async def show_solution_for_right_answers(
        exercise_id: ExerciseId, request: Request
    ) -> Response:
        """Show the model solution to a student whose answers have full marks in all parts.

        An exercise that counts has none: its assignment says when its solution is shown.
        """
        exercise = await own.of(request, exercise_or_404(catalogue, exercise_id))
        await practice.check_solution(access.caller(request), exercise.plain_id)
        if exercise.attempts != AttemptsSpec():
            raise _not_shown()
        body = await read_body(GradeRequest, request)
        require_parts(exercise, ((part, ("answers", part)) for part in body.answers))
        submission = body.submission(FeedbackLevel.SCORE)
        if not await run_in_turns(request, partial(is_all_right, exercise, submission)):
            raise _not_shown()
        return await solutions.answer(exercise)

    return router


def _not_shown() -> ProblemError:
    return ProblemError(
        HTTPStatus.FORBIDDEN,
        say("The solution is shown after full marks, and not for exercises that count."),
        "solution-not-shown",
        say("The solution is not shown"),
    )
