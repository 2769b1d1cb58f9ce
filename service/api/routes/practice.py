"""The route that gives students generated robots to practise with."""

from functools import partial
from http import HTTPStatus
from typing import Annotated

from fastapi import APIRouter, Query, Request

from service.api.document.openapi import MAY_NEED_KEY, refusals
from service.api.http.lookup import Catalogue
from service.api.http.problems import invalid
from service.api.turns import give_way, run_in_turns
from service.contract.exercises import PracticeRobot
from service.kinematics.dh import Convention
from service.translations import say
from service.variants.robots.dealing import (
    asks_enough,
    candidates,
    difficulty_of,
    has_situation,
)
from service.variants.robots.difficulty import Situation
from service.variants.robots.practice_id import practice_id

_LEVEL = Query(ge=1, le=4, description="From 1, robots with two or three joints, to 4.")
_CONVENTION = Query(description="The DH convention of the table.")
_AFTER = Query(
    max_length=60,
    description="The id of the last robot. Robots that are dealt after one another are not alike.",
)
_FAVOUR = Query(description="A situation that the robot should have.")


def routes(catalogue: Catalogue) -> APIRouter:
    """Return the route that chooses a generated robot.

    ``catalogue`` contains all generated robots as exercises.
    """
    router = APIRouter(prefix="/v1/practice", tags=["exercises"])

    @router.get(
        "/next",
        operation_id="getNextRobot",
        summary="Deal a generated robot",
        response_model=PracticeRobot,
        response_description="The robot.",
        responses=refusals(HTTPStatus.UNPROCESSABLE_ENTITY),
        openapi_extra=MAY_NEED_KEY,
    )
    async def deal(
        request: Request,
        level: Annotated[int, _LEVEL] = 1,
        convention: Annotated[Convention, _CONVENTION] = Convention.STANDARD,
        after: Annotated[str | None, _AFTER] = None,
        favour: Annotated[Situation | None, _FAVOUR] = None,
    ) -> PracticeRobot:
        """Deal a robot to practise with: any one, or the next one after another.

        An id always means the same robot. Robots are not recorded and not in the list of
        exercises; show, draw and grade them by their ids.
        """
        last = None if after is None else practice_id(after)
        if after is not None and last is None:
            message = say("This is not the id of a practice robot.")
            detail = {"type": "unknown", "loc": ("after",), "msg": message}
            raise invalid([detail])
        chosen = None
        for chosen in candidates(level, convention, last):
            # A look takes a millisecond and a grading more, so others work in between.
            await give_way(request)
            if favour is not None and not has_situation(chosen, favour):
                continue
            if await run_in_turns(request, partial(asks_enough, catalogue[str(chosen)])):
                break
        assert chosen is not None
        return PracticeRobot(
            id=str(chosen), level=level, convention=convention, difficulty=difficulty_of(chosen)
        )

    return router
