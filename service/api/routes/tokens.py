"""The route that makes tokens for learners."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from http import HTTPStatus

from fastapi import APIRouter, Request, Response

from service.api.document.openapi import posting
from service.api.http.bodies import read_body
from service.api.http.lookup import Catalogue, require_exercises
from service.api.permissions.access import Access, require_reach
from service.contract.tutoring import TokenRequest, TokenResponse


def routes(catalogue: Catalogue, access: Access) -> APIRouter:
    """Return the route that makes tokens for learners."""
    router = APIRouter(prefix="/v1", tags=["tokens"])

    @router.post(
        "/tokens",
        operation_id="createToken",
        summary="Make a token for a learner",
        response_description="The token.",
        status_code=HTTPStatus.CREATED,
        **posting(
            TokenRequest,
            TokenResponse,
            "token",
            HTTPStatus.NOT_FOUND,
            success=HTTPStatus.CREATED,
        ),
    )
    async def create_token(request: Request) -> Response:
        """Make a token. A learner's browser grades, records and reads its own attempts with it.

        A page with a token calls the service without showing the key. The token has no
        right that its key does not have, and expires no later than the key. The service
        does not store it.
        """
        caller = access.caller(request)
        body = await read_body(TokenRequest, request)
        exercises = caller.exercises
        if body.exercises is not None:
            require_exercises(catalogue, body.exercises, "exercises")
            for exercise in body.exercises:
                require_reach(caller, exercise)
            exercises = frozenset(body.exercises)
        # A token has no fractions of seconds.
        now = datetime.now(UTC).replace(microsecond=0)
        expires_at = now + timedelta(minutes=body.minutes)
        learner = replace(caller, learner=body.learner, exercises=exercises)
        token = access.token(learner, expires_at)
        answer = TokenResponse(token=token, learner=body.learner, expires_at=expires_at)
        return Response(
            answer.model_dump_json(),
            HTTPStatus.CREATED,
            {"Cache-Control": "no-store"},
            "application/json",
        )

    return router
