"""The route that records attempts."""

from collections.abc import Awaitable, Callable, Collection
from http import HTTPStatus
from typing import TYPE_CHECKING, Annotated, Final

from fastapi import APIRouter, Header, Request, Response

from service.access.caller import Caller
from service.api.document.openapi import posting
from service.api.http.bodies import read_body
from service.api.http.lookup import Catalogue, ExerciseId, exercise_or_404, require_parts
from service.api.http.problems import ProblemError
from service.api.http.told_answer import in_languages
from service.api.monitor import Monitor
from service.api.permissions.access import Access
from service.api.permissions.access_problems import access_problem
from service.api.recording.attempting import AttemptTerms, Recorder
from service.catalogue import FeedbackLevel
from service.contract.attempts import AttemptRequest, AttemptResponse
from service.translations import say

if TYPE_CHECKING:  # it loads the drivers of databases
    from service.attempts.store import AttemptStore

IDEMPOTENCY_KEY: Final = Header(
    alias="Idempotency-Key",
    min_length=1,
    max_length=255,
    description="Any text that you choose for this attempt. If the request is sent again with the "
    "same key, the answer is the same, and nothing is recorded twice.",
)


def routes(
    catalogue: Catalogue,
    feedback: FeedbackLevel,
    store: "AttemptStore | None",
    access: Access,
    practice: Callable[[Caller, str], Awaitable[None]],
    monitor: Monitor | None = None,
    origins: Collection[str] = (),
) -> APIRouter:
    """Return the route that records attempts; ``feedback`` is the highest feedback level."""
    router = APIRouter(prefix="/v1", tags=["attempts"])

    @router.post(
        "/exercises/{exercise_id}/attempts",
        operation_id="recordAttempt",
        summary="Grade a submission and record it",
        response_description="The recorded attempt and its report.",
        status_code=HTTPStatus.CREATED,
        **in_languages(
            posting(
                AttemptRequest,
                AttemptResponse,
                "attempt",
                HTTPStatus.FORBIDDEN,
                HTTPStatus.NOT_FOUND,
                HTTPStatus.SERVICE_UNAVAILABLE,
                success=HTTPStatus.CREATED,
            )
        ),
    )
    async def record_attempt(
        exercise_id: ExerciseId,
        request: Request,
        idempotency_key: Annotated[str | None, IDEMPOTENCY_KEY] = None,
    ) -> Response:
        """Grade answers and record them with their report, once for each idempotency key.

        The exercise says how attempts are counted and limited; an attempt in which nothing
        could be read does not count. An attempt that is answered with 201 is not lost,
        whatever happens to the service.
        """
        access.require_allowed_origin(request, origins)
        if store is None:
            raise not_recorded()
        exercise = exercise_or_404(catalogue, exercise_id)
        caller = access.caller(request)
        await practice(caller, exercise.plain_id)
        body = await read_body(AttemptRequest, request)
        if caller.learner not in (None, body.learner):
            raise access_problem("other-learner")
        require_parts(exercise, ((part, ("answers", part)) for part in body.answers))
        terms = AttemptTerms(exercise.attempts, exercise.feedback_at)
        recorder = Recorder(store, feedback, monitor)
        return await recorder.answer(request, exercise, body, terms, caller.owner, idempotency_key)

    return router


def not_recorded() -> ProblemError:
    """Return the error for a service without a database."""
    return ProblemError(
        HTTPStatus.NOT_FOUND,
        say("No attempts are recorded here: the service has no database."),
        "attempts-not-recorded",
        say("Attempts are not recorded here"),
    )
