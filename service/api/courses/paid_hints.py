"""The route for hints on recorded attempts.

A hint has several steps. The service records each step that a learner takes. A step may have a
price, which reduces the points of later attempts.
"""

from collections.abc import Collection
from functools import partial
from http import HTTPStatus
from typing import TYPE_CHECKING, Any

from fastapi import APIRouter, Request, Response

from service.access.caller import Caller
from service.api.courses.asking import read, write
from service.api.document.openapi import posting
from service.api.http.bodies import read_body
from service.api.http.language import language_of
from service.api.http.lookup import AttemptId, Catalogue, exercise_or_404
from service.api.http.problems import ProblemError, message_of
from service.api.http.told_answer import in_languages, told_json
from service.api.permissions.access import Access
from service.api.recording.new_attempts import not_recorded
from service.api.recording.store import NO_STORE, unknown_attempt
from service.api.routes.hints import hint_for
from service.api.turns import arrived_at, run_in_turns
from service.attempts.policy import AttemptRefusedError, ruling
from service.catalogue import Exercise, FeedbackLevel, least
from service.catalogue.attempts import AttemptsSpec
from service.contract.attempts import AttemptHintRequest
from service.contract.grading import Hint, HintRequest
from service.submissions.body import GradeRequest
from service.translations import say

if TYPE_CHECKING:  # they load the drivers of databases
    from sqlalchemy import Connection, Row

    from service.attempts.store import AttemptStore


def routes(
    catalogue: Catalogue,
    feedback: FeedbackLevel,
    store: "AttemptStore | None",
    access: Access,
    origins: Collection[str] = (),
) -> APIRouter:
    """Return the route for hints; ``feedback`` is the highest feedback level of reports."""
    router = APIRouter(prefix="/v1", tags=["attempts"])

    @router.post(
        "/attempts/{attempt_id}/hints",
        operation_id="takeHint",
        summary="Take a hint for a message of a recorded report",
        response_description="One step of the hint.",
        **in_languages(
            posting(
                AttemptHintRequest,
                Hint,
                None,
                HTTPStatus.FORBIDDEN,
                HTTPStatus.NOT_FOUND,
                HTTPStatus.SERVICE_UNAVAILABLE,
            )
        ),
    )
    async def take_hint(request: Request, attempt_id: AttemptId) -> Response:
        """Return a step of the hint for a message of this attempt, and record that it was taken.

        Its price reduces the points of the learner's later attempts at the exercise. The same step
        costs nothing again. Before the next step, the learner hands in another answer.
        """
        from service.attempts.hints import HintStepOf, attempt_with_course, hint_refusal, take
        from service.attempts.regrades.outdated import attempted_exercise

        access.require_allowed_origin(request, origins)
        if store is None:
            raise not_recorded()
        body = await read_body(AttemptHintRequest, request)
        row = await read(store, lambda it: attempt_with_course(it, attempt_id))
        if row is None or not _may_use(access.caller(request), row):
            raise unknown_attempt()
        named = exercise_or_404(catalogue, row.exercise)
        rules, prices, counted = await read(store, partial(_terms, row, named))
        now = arrived_at(request)
        try:
            ruling(rules, counted, now)
        except AttemptRefusedError as error:
            raise _refused(error.name, message_of(error)) from error
        exercise = attempted_exercise(named, row)
        if prices is None or exercise is None:
            raise _refused("no-hints", say("Recorded attempts at this exercise have no hints."))
        wanted = HintStepOf(body.part, body.code, body.row or "", body.cell or "", body.step)
        refused = await read(store, lambda it: hint_refusal(it, row, wanted))
        if refused is not None:
            raise _refused(refused.name, message_of(refused))
        hint = await run_in_turns(request, partial(_hint, exercise, row, body, feedback))
        refused = await write(store, lambda it: take(it, attempt_id, wanted, prices, now))
        if refused is not None:
            raise _refused(refused.name, message_of(refused))
        language = language_of(request)
        content = hint.model_dump_json(exclude_none=True, context=language.translation)
        return told_json(content, language, headers=NO_STORE)

    return router


def _may_use(caller: Caller, row: "Row[Any]") -> bool:
    return (
        caller.reaches(row.exercise)
        and caller.course in (None, row.course)
        and caller.learner in (None, row.learner)
    )


def _terms(
    row: "Row[Any]", exercise: Exercise, connection: "Connection"
) -> tuple[AttemptsSpec, list[float] | None, int]:
    from service.attempts.recording import standing
    from service.courses.terms import terms_of

    counted = standing(connection, row.exercise, row.learner, "", None, row.assignment).counted
    if row.assignment is None:
        return exercise.attempts, exercise.attempts.hint_prices, counted
    terms = terms_of(connection, row.course, row.in_assignment, row.learner)
    return terms.rules, terms.hint_prices(exercise), counted


def _hint(
    exercise: Exercise, row: "Row[Any]", body: AttemptHintRequest, most: FeedbackLevel
) -> Hint:
    from json import loads

    submission = GradeRequest.model_validate_json(row.submission)
    asked = HintRequest.model_construct(
        **{name: getattr(submission, name) for name in GradeRequest.model_fields},
        **body.model_dump(),
    )
    # The report may have said less than the exercise allows.
    told = FeedbackLevel(loads(row.report)["feedback"])
    return hint_for(exercise, asked, least(most, told))


def _refused(name: str, detail: str) -> ProblemError:
    return ProblemError(HTTPStatus.FORBIDDEN, detail, name, say("The hint is not given"))
