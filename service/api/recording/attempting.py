"""Grade and record one attempt at an exercise, perhaps in an assignment of a course."""

import hashlib
import json
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime
from functools import partial
from http import HTTPStatus
from typing import TYPE_CHECKING

from fastapi import Request, Response

from service.api.http.language import language_of
from service.api.http.problems import ProblemError, message_of, store_down
from service.api.http.told_answer import told_json
from service.api.monitor import Monitor
from service.api.turns import arrived_at, run_in_turns
from service.attempts.attempt import NewAttempt, RecordedAttempt, Standing
from service.attempts.errors import StoreDownError
from service.attempts.graded import AttemptGrading, AttemptReport
from service.attempts.outcome import Outcome
from service.attempts.policy import AttemptRefusedError, Ruling, points_after, ruling
from service.attempts.results.recorded_report import shown_report
from service.catalogue import Exercise, FeedbackLevel, least
from service.catalogue.attempts import AttemptsSpec
from service.contract.attempts import Attempt, AttemptRequest
from service.time_slices import working_time
from service.translations import Language, say

if TYPE_CHECKING:  # it loads the drivers of databases
    from service.attempts.store import AttemptStore


@dataclass(frozen=True, slots=True)
class AttemptTerms:
    """The rules for recording an attempt.

    ``feedback_at`` returns the feedback level of the n-th attempt. ``assignment`` is the row number
    of the assignment, or None.
    """

    rules: AttemptsSpec
    feedback_at: Callable[[int], FeedbackLevel]
    assignment: int | None = None


# When a request arrived, and how many attempts of the learner counted then.
Arrived = tuple[datetime, Standing]


@dataclass(frozen=True, slots=True)
class Recorder:
    """Records attempts in the database. ``ceiling`` is the highest feedback level of reports."""

    store: "AttemptStore"
    ceiling: FeedbackLevel
    monitor: Monitor | None

    async def answer(
        self,
        request: Request,
        exercise: Exercise,
        body: AttemptRequest,
        terms: AttemptTerms,
        owner: str,
        idempotency_key: str | None,
        arrived: Arrived | None = None,
    ) -> Response:
        """Grade and record answers; return a response with the attempt and its report.

        Raises ProblemError.
        """
        # Without ``arrived``, the time of arrival and the earlier attempts are looked up.
        now, before = arrived or (arrived_at(request), None)
        attempting = _Attempting(exercise, body, terms, self, owner, idempotency_key, now)
        try:
            recorded = await attempting.recorded(request, before)
        except StoreDownError as error:
            detail = say(
                "The database did not confirm the attempt. Send it again, with the same "
                "Idempotency-Key."
            )
            raise store_down(detail) from error
        except AttemptRefusedError as error:
            raise ProblemError(
                HTTPStatus.FORBIDDEN, message_of(error), error.name, say("The attempt is not taken")
            ) from error
        language = language_of(request)
        return told_json(_answer(recorded, language), language, HTTPStatus.CREATED)


class _Attempting:
    def __init__(
        self,
        exercise: Exercise,
        body: AttemptRequest,
        terms: AttemptTerms,
        recorder: Recorder,
        owner: str,
        idempotency_key: str | None,
        now: datetime,
    ) -> None:
        self._exercise = exercise
        self._body = body
        self._terms = terms
        self._recorder = recorder
        self._owner = owner
        self._key = idempotency_key
        self._grading = AttemptGrading(exercise, body)
        self._now = now
        answers = body.model_dump(mode="json", exclude={"learner"}, exclude_unset=True)
        self._submission = json.dumps(answers)
        self._answers_digest = _digest(body.answers)
        content = {"exercise": exercise.id, "learner": body.learner, **answers}
        if terms.assignment is not None:
            content["assignment"] = terms.assignment
        self._request_digest = _digest(content)

    async def recorded(self, request: Request, before: Standing | None) -> RecordedAttempt:
        store, assignment = self._recorder.store, self._terms.assignment
        standing = before or await store.standing(
            self._exercise.plain_id, self._body.learner, self._owner, self._key, assignment
        )
        while True:
            if standing.earlier is not None:
                return self._same(standing.earlier)
            most = self._most(self._ruling(standing))
            if not self._grading.has(most):
                await run_in_turns(request, partial(self._grade, most))
            written = await store.record(standing, self._after)
            if isinstance(written, RecordedAttempt):
                return written
            standing = written

    def _ruling(self, standing: Standing) -> Ruling:
        return ruling(self._terms.rules, standing.counted, self._now)

    def _most(self, taken: Ruling) -> FeedbackLevel:
        return least(self._terms.feedback_at(taken.ordinal), self._recorder.ceiling)

    def _grade(self, most: FeedbackLevel) -> None:
        began = working_time()
        report = self._grading.at(most).report
        monitor = self._recorder.monitor
        if monitor is not None:
            monitor.graded(report, working_time() - began)

    def _same(self, earlier: RecordedAttempt) -> RecordedAttempt:
        if earlier.request_digest != self._request_digest:
            raise ProblemError(
                HTTPStatus.UNPROCESSABLE_ENTITY,
                say(
                    "Another attempt was recorded under this Idempotency-Key. Take a new key for "
                    "each attempt."
                ),
                "idempotency-key-reused",
                say("The idempotency key belongs to another attempt"),
            )
        return earlier

    def _after(self, standing: Standing) -> tuple[NewAttempt, Outcome] | None:
        # Return None if the attempt is not allowed, is recorded already, or must be graded with
        # another feedback level first.
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
        return self._new(taken, graded, standing), graded.outcome

    def _new(self, taken: Ruling, graded: AttemptReport, before: Standing) -> NewAttempt:
        report, price = graded.report, before.hint_price
        return NewAttempt(
            exercise=self._exercise.plain_id,
            learner=self._body.learner,
            ordinal=before.last + 1 if report.gradable else None,
            at=self._now,
            is_late=taken.is_late,
            worth=taken.worth,
            submission=self._submission,
            answers_digest=self._answers_digest,
            report=graded.text,
            version=report.version,
            grader=report.grader,
            points=points_after(report.points, report.max_points, price, taken.worth),
            max_points=report.max_points,
            owner=self._owner,
            idempotency_key=self._key,
            request_digest=self._request_digest,
            assignment=self._terms.assignment,
            variant=self._exercise.seed or None,
            hint_price=price,
        )


def _answer(recorded: RecordedAttempt, language: Language) -> bytes:
    attempt = Attempt.model_validate(recorded, from_attributes=True)
    told = attempt.model_dump_json(exclude_none=True)
    report = shown_report(recorded.report, language)
    return f'{{"attempt":{told},"report":{report}}}'.encode()


def _digest(content: object) -> str:
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
