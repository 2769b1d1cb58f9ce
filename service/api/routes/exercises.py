"""The routes that list and describe exercises, without their correct answers."""

from http import HTTPStatus
from typing import Any

from fastapi import APIRouter, Request, Response

from service.api.courses.own_variant import OwnVariants, of_assignment
from service.api.document.openapi import refusals
from service.api.http.language import language_of
from service.api.http.lookup import Catalogue, ExerciseId, exercise_or_404
from service.api.http.told_answer import in_languages, language_headers
from service.catalogue import FeedbackLevel, in_language, least
from service.contract.exercises import ExerciseList, ExerciseView
from service.grading.kinds.find_slip import shown_shape
from service.typeset.statement import statement_html


def routes(catalogue: Catalogue, feedback: FeedbackLevel, own: OwnVariants) -> APIRouter:
    """Return the routes that list and describe exercises.

    ``feedback`` is the highest feedback level of reports.
    """
    router = APIRouter(prefix="/v1/exercises", tags=["exercises"])

    # The models take the public fields from the attributes of the exercises.
    @router.get(
        "",
        operation_id="listExercises",
        summary="List the exercises",
        response_model=ExerciseList,
        response_description="The catalogue.",
        **in_languages({}),
    )
    async def list_exercises(request: Request, response: Response) -> dict[str, Any]:
        """List all exercises, by level, then by their place within it."""
        language = language_of(request)
        response.headers.update(language_headers(language))
        return {"exercises": [in_language(each, language) for each in catalogue.values()]}

    @router.get(
        "/{exercise_id}",
        operation_id="getExercise",
        summary="Show an exercise",
        response_model=ExerciseView,
        response_description="The exercise.",
        response_model_exclude_none=True,
        **in_languages(
            of_assignment({"responses": refusals(HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND)})
        ),
    )
    async def show_exercise(
        exercise_id: ExerciseId, request: Request, response: Response
    ) -> dict[str, Any]:
        """Show an exercise: its statement, its symbols, and what each part asks for."""
        language = language_of(request)
        response.headers.update(language_headers(language))
        exercise = await own.of(request, exercise_or_404(catalogue, exercise_id))
        exercise = in_language(exercise, language)
        fields = {name: getattr(exercise, name, None) for name in ExerciseView.model_fields}
        parts = [
            {
                **dict(part),
                "prompt_html": statement_html(part.prompt, exercise.symbols),
                "shape": shown_shape(part, exercise),
            }
            for part in exercise.parts
        ]
        return {
            **fields,
            "statement_html": statement_html(exercise.statement, exercise.symbols),
            "figure": exercise.reference is not None,
            "feedback": least(exercise.feedback, feedback),
            "symbols": exercise.variables,
            "parts": parts,
        }

    return router
