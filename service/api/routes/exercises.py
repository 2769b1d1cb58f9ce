"""The routes that list and describe exercises, without the answers."""

from http import HTTPStatus
from typing import Any

from fastapi import APIRouter

from service.api.document.openapi import refusals
from service.api.http.lookup import Catalogue, ExerciseId, exercise_or_404
from service.catalogue import FeedbackLevel, least
from service.contract.exercises import ExerciseList, ExerciseView
from service.typeset.statement import statement_html


def routes(catalogue: Catalogue, feedback: FeedbackLevel) -> APIRouter:
    """Return the routes of the catalogue; ``feedback`` is the highest level of any report."""
    router = APIRouter(prefix="/v1/exercises", tags=["exercises"])

    # The models take the public fields from the attributes of the exercises.
    @router.get(
        "",
        operation_id="listExercises",
        summary="List the exercises",
        response_model=ExerciseList,
        response_description="The catalogue.",
    )
    async def list_exercises() -> dict[str, Any]:
        """List all exercises, by level, then by their place within it."""
        return {"exercises": list(catalogue.values())}

    @router.get(
        "/{exercise_id}",
        operation_id="getExercise",
        summary="Show an exercise",
        response_model=ExerciseView,
        response_description="The exercise.",
        responses=refusals(HTTPStatus.NOT_FOUND),
        response_model_exclude_none=True,
    )
    async def show_exercise(exercise_id: ExerciseId) -> dict[str, Any]:
        """Show an exercise: its statement, its symbols, and what each part asks for."""
        exercise = exercise_or_404(catalogue, exercise_id)
        fields = {name: getattr(exercise, name, None) for name in ExerciseView.model_fields}
        parts = [
            {
                **dict(part),
                "prompt_html": statement_html(part.prompt, exercise.symbols),
                "shape": part.shape(exercise.reference),
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
