"""The route that draws an exercise's mechanism."""

import base64
import hashlib
from functools import partial
from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Query, Request, Response

from service.api.courses.own_variant import OwnVariants, of_assignment
from service.api.document.openapi import refusals
from service.api.http.lookup import Catalogue, ExerciseId, exercise_or_404
from service.api.http.memoized import MemoizedResults
from service.api.http.problems import ProblemError
from service.catalogue import Exercise
from service.figures.drawing.style import Theme, style_sheet
from service.figures.figure import exercise_figure
from service.translations import say

_THEME = Query(
    description="`light`, `dark`, or `auto`, as the reader's system wants. Prints are always light."
)


_REFUSED = refusals(HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND, HTTPStatus.UNPROCESSABLE_ENTITY)


class SvgResponse(Response):
    """A response with a drawing in SVG."""

    media_type = "image/svg+xml"


def routes(catalogue: Catalogue, own: OwnVariants) -> APIRouter:
    """Return the route that draws figures."""
    router = APIRouter(prefix="/v1/exercises", tags=["exercises"])
    figures = MemoizedResults()

    @router.get(
        "/{exercise_id}/figure.svg",
        operation_id="getFigure",
        summary="Draw the mechanism",
        response_class=SvgResponse,
        response_description="The drawing.",
        **of_assignment({"responses": _REFUSED}),
    )
    async def draw_figure(
        exercise_id: ExerciseId, request: Request, theme: Annotated[Theme, _THEME] = Theme.AUTO
    ) -> Response:
        """Draw the robot of an exercise: joints, links, given frames, lengths, joint variables.

        The figure shows no frame that the student may choose, and no number that the statement
        does not name. The angles of all joints are 0, and sliding joints are extended. An exercise
        without a robot has no figure.
        """
        exercise = await own.of(request, exercise_or_404(catalogue, exercise_id))
        if exercise.reference is None:
            raise ProblemError(
                HTTPStatus.NOT_FOUND,
                say("The exercise {exercise} has no robot to draw.", exercise=exercise.id),
                "no-figure",
                say("The exercise has no figure"),
            )
        key = (exercise.id, exercise.version, exercise.title, exercise.view, theme)
        content = await figures.of(key, partial(_drawn, exercise, theme))
        return SvgResponse(content, headers=figure_headers(theme))

    return router


def _drawn(exercise: Exercise, theme: Theme) -> bytes:
    return exercise_figure(exercise, theme).encode()


def figure_headers(theme: Theme) -> dict[str, str]:
    """Return the HTTP headers of a figure; any page may show the figure."""
    digest = base64.b64encode(hashlib.sha256(style_sheet(theme).encode()).digest()).decode()
    policy = f"default-src 'none'; style-src 'sha256-{digest}'; frame-ancestors 'self'"
    return {
        "Content-Security-Policy": policy,
        "Cross-Origin-Resource-Policy": "cross-origin",
        "Cache-Control": "no-cache",
    }
