"""The route that records attempts."""

import hashlib
import json
from collections.abc import Collection
from datetime import UTC, datetime
from functools import partial
from http import HTTPStatus
from typing import TYPE_CHECKING, Annotated

from fastapi import APIRouter, Header, Request, Response

from service.api.document.openapi import posting
from service.api.http.bodies import read_body
from service.api.http.lookup import Catalogue, ExerciseId, exercise_or_404, require_parts
from service.api.http.problems import ProblemError, store_down
from service.api.monitor import Monitor
from service.api.permissions.access import Access
from service.api.permissions.access_problems import access_problem
from service.api.turns import run_in_turns
from service.attempts.attempt import NewAttempt, RecordedAttempt, Standing
from service.attempts.errors import StoreDownError
from service.attempts.graded import AttemptGrading, AttemptReport
from service.attempts.outcome import Outcome
from service.attempts.policy import AttemptRefusedError, Ruling, ruling
from service.catalogue import Exercise, FeedbackLevel, least
from service.contract.attempts import Attempt, AttemptRequest, AttemptResponse
from service.time_slices import working_time

if TYPE_CHECKING:  # it loads the drivers of databases
    from service.attempts.store import AttemptStore

IdempotencyKey = Annotated[
    str | None,
    Header(
        alias="Idempotency-Key",
        min_length=1,
        max_length=255,
        description="Any text that you choose for this attempt. If the request is sent again with "
        "the same key, the answer is the same, and nothing is recorded twice.",
    ),
]


def routes(
    catalogue: Catalogue,
    feedback: FeedbackLevel,
    store: "AttemptStore | None",
    access: Access,
    monitor: Monitor | None = None,
    origins: Collection[str] = (),
) -> APIRouter:
    """Return the route that records; reports have at most the level ``feedback``.

    Pages of the service and of ``origins`` may record.
    """
    router = APIRouter(prefix="/v1", tags=["attempts"])

    @router.post(
        "/exercises/{exercise_id}/attempts",
        operation_id="recordAttempt",
        summary="Grade a submission and record it",
        response_description="The recorded attempt and its report.",
        status_code=HTTPStatus.CREATED,
        **posting(
            AttemptRequest,
            AttemptResponse,
            "attempt",
            HTTPStatus.FORBIDDEN,
            HTTPStatus.NOT_FOUND,
            HTTPStatus.SERVICE_UNAVAILABLE,
            success=HTTPStatus.CREATED,
        ),
    )
    async def record_attempt(
        exercise_id: ExerciseId, request: Request, idempotency_key: IdempotencyKey = None
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
        body = await read_body(AttemptRequest, request)
        caller = access.caller(request)
        if caller.learner not in (None, body.learner):
            raise access_problem("other-learner")
        require_parts(exercise, ((part, ("answers", part)) for part in body.answers))
        attempting = _Attempting(
            exercise, body, feedback, store, caller.owner, idempotency_key, monitor
        )
        try:
            recorded = await attempting.recorded(request)
        except StoreDownError as error:
            detail = (
                "The database did not confirm the attempt. Send it again, with the same "
                "Idempotency-Key."
            )
            raise store_down(detail) from error
        except AttemptRefusedError as error:
            raise ProblemError(
                HTTPStatus.FORBIDDEN, str(error), error.name, "The attempt is not taken"
            ) from error
        return Response(_answer(recorded), HTTPStatus.CREATED, media_type="application/json")

    return router


def not_recorded() -> ProblemError:
    """Return the problem of a service without a database."""
    return ProblemError(
        HTTPStatus.NOT_FOUND,
        "No attempts are recorded here: the service has no database.",
        "attempts-not-recorded",
        "Attempts are not recorded here",
    )


class _Attempting:
    """One request to record an attempt."""

    def __init__(
        self,
        exercise: Exercise,
        body: AttemptRequest,
        ceiling: FeedbackLevel,
        store: "AttemptStore",
        owner: str,
        idempotency_key: str | None,
        monitor: Monitor | None,
    ) -> None:
        self._exercise = exercise
        self._body = body
        self._ceiling = ceiling
        self._store = store
        self._owner = owner
        self._key = idempotency_key
        self._monitor = monitor
        self._grading = AttemptGrading(exercise, body)
        self._now = datetime.now(UTC)
        answers = body.model_dump(mode="json", exclude={"learner"}, exclude_unset=True)
        self._submission = json.dumps(answers)
        self._answers_digest = _digest(body.answers)
        content = {"exercise": exercise.id, "learner": body.learner, **answers}
        self._request_digest = _digest(content)

    async def recorded(self, request: Request) -> RecordedAttempt:
        """Grade and record it. Raises StoreDownError, AttemptRefusedError, ProblemError."""
        standing = await self._store.standing(
            self._exercise.id, self._body.learner, self._owner, self._key
        )
        while True:
            if standing.earlier is not None:
                return self._same(standing.earlier)
            most = self._most(self._ruling(standing))
            if not self._grading.has(most):
                await run_in_turns(request, partial(self._grade, most))
            written = await self._store.record(standing, self._after)
            if isinstance(written, RecordedAttempt):
                return written
            standing = written

    def _ruling(self, standing: Standing) -> Ruling:
        return ruling(self._exercise.attempts, standing.counted, self._now)

    def _most(self, taken: Ruling) -> FeedbackLevel:
        """Return the highest feedback level for the learner at this attempt."""
        return least(self._exercise.feedback_at(taken.ordinal), self._ceiling)

    def _grade(self, most: FeedbackLevel) -> None:
        began = working_time()
        report = self._grading.at(most).report
        if self._monitor is not None:
            self._monitor.graded(report, working_time() - began)

    def _same(self, earlier: RecordedAttempt) -> RecordedAttempt:
        if earlier.request_digest != self._request_digest:
            raise ProblemError(
                HTTPStatus.UNPROCESSABLE_ENTITY,
                "Another attempt was recorded under this Idempotency-Key. Take a new key for each "
                "attempt.",
                "idempotency-key-reused",
                "The idempotency key belongs to another attempt",
            )
        return earlier

    def _after(self, standing: Standing) -> tuple[NewAttempt, Outcome] | None:
        """Return the attempt to record; None if it is not allowed or must be graded first."""
        if standing.earlier is not None:
            return None
        try:
            taken = self._ruling(standing)
        except AttemptRefusedError:
            return None
        most = self._most(taken)
        if not self._grading.has(most):
            return None
        graded = self._grading.at(most)
        return self._new(taken, graded), graded.outcome

    def _new(self, taken: Ruling, graded: AttemptReport) -> NewAttempt:
        report = graded.report
        return NewAttempt(
            exercise=self._exercise.id,
            learner=self._body.learner,
            ordinal=taken.ordinal if report.gradable else None,
            at=self._now,
            is_late=taken.is_late,
            worth=taken.worth,
            submission=self._submission,
            answers_digest=self._answers_digest,
            report=graded.text,
            version=report.version,
            grader=report.grader,
            points=round(report.points * taken.worth, 6),
            max_points=report.max_points,
            owner=self._owner,
            idempotency_key=self._key,
            request_digest=self._request_digest,
        )


def _answer(recorded: RecordedAttempt) -> bytes:
    """Return the attempt and its report as JSON; the report is the recorded text, byte by byte."""
    attempt = Attempt.model_validate(recorded, from_attributes=True)
    told = attempt.model_dump_json(exclude_none=True)
    return f'{{"attempt":{told},"report":{recorded.report}}}'.encode()


def _digest(content: object) -> str:
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
