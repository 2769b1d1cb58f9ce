"""The route that shows model solutions to tutors."""

import asyncio
from collections import OrderedDict
from http import HTTPStatus
from typing import Any, Final

from fastapi import APIRouter, Response
from pydantic import BaseModel, Field

from service.api.lookup import Catalogue, exercise_or_404
from service.api.openapi import answer, refusals
from service.api.problems import ProblemError
from service.catalogue import Exercise

# A course has a few dozen exercises; one solution takes some ten kilobytes.
KEPT: Final = 128


class Shown(BaseModel):
    """A matrix as a textbook prints it."""

    text: str
    latex: str


class LinkSolution(Shown):
    """The link transform of one row of the robot's table."""

    label: str


class PartAnswer(Shown):
    """The right answer to one part."""

    part: str
    kind: str
    title: str
    answer: Any = Field(description="The same as it is posted; `text` may be posted as well.")


class ModelSolution(BaseModel):
    """What is right in each part of an exercise, and how one comes to it."""

    exercise: str
    version: str
    notation: dict[str, str] = Field(
        description="What each shorthand stands for: c12 for cos(theta1 + theta2)."
    )
    parts: list[PartAnswer]
    links: list[LinkSolution] = Field(
        description="The link transforms of the robot's own table; none where it has no table."
    )
    pose: Shown | None = Field(None, description="From the base frame to the tool frame.")


class Solutions:
    """Model solutions as JSON, worked out one at a time in a thread, and kept."""

    def __init__(self) -> None:
        self._kept: OrderedDict[tuple[str, str], str] = OrderedDict()
        self._working = asyncio.Lock()

    async def of(self, exercise: Exercise) -> str:
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


def _solved(exercise: Exercise) -> str:
    # Only here: SymPy takes half a second to import, and no student's answer needs it.
    from service.solutions import solve

    solution = solve(exercise)
    pose = solution.pose
    return ModelSolution(
        exercise=solution.exercise,
        version=solution.version,
        notation=dict(solution.notation),
        parts=[
            PartAnswer(
                part=each.part,
                kind=each.kind,
                title=each.title,
                answer=each.shown.answer,
                text=each.shown.text,
                latex=each.shown.latex,
            )
            for each in solution.parts
        ],
        links=[
            LinkSolution(label=label, text=shown.text, latex=shown.latex)
            for label, shown in solution.links.items()
        ],
        pose=Shown(text=pose.text, latex=pose.latex) if pose else None,
    ).model_dump_json(exclude_none=True)


def routes(catalogue: Catalogue, *, shown: bool) -> APIRouter:
    """The route that shows model solutions, or says how to have them shown."""
    router = APIRouter(prefix="/v1/exercises", tags=["solutions"])
    solutions = Solutions()

    @router.get(
        "/{exercise_id}/solution",
        responses={
            200: answer(ModelSolution, "solution-response"),
            **refusals(HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND),
        },
    )
    async def show_solution(exercise_id: str) -> Response:
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
        return Response(
            content, media_type="application/json", headers={"Cache-Control": "no-store"}
        )

    return router
