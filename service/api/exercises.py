"""The routes that list and describe exercises: everything but the answers."""

from http import HTTPStatus
from typing import Any

from fastapi import APIRouter
from pydantic import BaseModel, Field

from service.api.lookup import Catalogue, ExerciseId, exercise_or_404
from service.api.openapi import refusals
from service.api.statement import statement_html
from service.catalogue import FeedbackLevel, least
from service.catalogue.fields import Marking
from service.catalogue.parts import AnyShape
from service.expressions import Kind


class PartSummary(BaseModel):
    """A part in the list of exercises."""

    id: str
    kind: str = Field(description="The kind of answer that it asks for.")
    points: float


class ExerciseSummary(BaseModel):
    """An exercise in the list."""

    id: str
    title: str
    source: str
    structure: str | None = Field(
        description="The joints in order: R turns, P slides. Null where there is no robot."
    )
    parts: list[PartSummary]


class ExerciseList(BaseModel):
    """The catalogue."""

    exercises: list[ExerciseSummary]


class SymbolView(BaseModel):
    """A letter that may stand in an answer."""

    name: str
    kind: Kind
    unit: str
    description: str
    joint: int | None = Field(None, description="The joint whose variable this is.")


class PartView(BaseModel):
    """A part as a student sees it before answering."""

    id: str
    title: str
    prompt: str
    kind: str = Field(description="The kind of answer that it asks for.")
    points: float
    marking: Marking = Field(description="How the cells of an answer share its points.")
    follows: str | None = Field(
        None,
        description="The earlier part that this one follows from; left out where there is none.",
    )
    shape: AnyShape


class ExerciseView(BaseModel):
    """An exercise as a student sees it before answering."""

    id: str
    version: str
    title: str
    source: str
    structure: str | None = Field(None, description="Left out where there is no robot.")
    statement: str = Field(description="Markdown, with LaTeX between dollars.")
    statement_html: str = Field(
        description="The same as HTML and MathML, without scripts, styles and pictures."
    )
    figure: bool = Field(description="Whether it has a robot that `figure.svg` draws.")
    feedback: FeedbackLevel = Field(
        description="The most that a report on it tells: `full`, `hints`, `verdicts` or `score`."
    )
    symbols: list[SymbolView]
    parts: list[PartView]


def routes(catalogue: Catalogue, feedback: FeedbackLevel) -> APIRouter:
    """The routes that show the catalogue; ``feedback`` is the most that any report tells."""
    router = APIRouter(prefix="/v1/exercises", tags=["exercises"])

    # The models pick from the exercises, by attribute, the fields that are public.
    @router.get(
        "",
        operation_id="listExercises",
        summary="List the exercises",
        response_model=ExerciseList,
        response_description="The catalogue.",
    )
    async def list_exercises() -> dict[str, Any]:
        """List all exercises, in the order of their files' names."""
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
        parts = [{**dict(part), "shape": part.shape(exercise.reference)} for part in exercise.parts]
        return {
            **fields,
            "statement_html": statement_html(exercise.statement),
            "figure": exercise.reference is not None,
            "feedback": least(exercise.feedback, feedback),
            "symbols": exercise.variables,
            "parts": parts,
        }

    return router
