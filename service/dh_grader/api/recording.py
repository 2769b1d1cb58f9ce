"""The routes that record attempts, and those that list, export and change recorded attempts.

The last section is for all routes with a database: they ask it with ``ask``, ``read`` and
``write``. Which attempt counts is decided in ``dh_grader.store``.
"""

import hashlib
import json
from collections.abc import AsyncIterator, Awaitable, Callable, Collection
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime
from functools import partial
from http import HTTPStatus
from typing import IO, TYPE_CHECKING, Annotated, Any, Final, TypeVar

from fastapi import APIRouter, Header, Path, Query, Request, Response
from pydantic import AfterValidator, AwareDatetime, BeforeValidator, StringConstraints
from starlette.background import BackgroundTask
from starlette.requests import ClientDisconnect
from starlette.responses import StreamingResponse

from dh_grader.access import Caller
from dh_grader.api.document import MAY_NEED_KEY, posting, refusals
from dh_grader.api.http import (
    NO_STORE,
    AttemptId,
    BoundedWork,
    Catalogue,
    ExerciseId,
    Monitor,
    ProblemError,
    arrived_at,
    exercise_or_404,
    give_way,
    in_languages,
    invalid,
    language_of,
    message_of,
    private,
    read_body,
    require_parts,
    run_in_turns,
    store_down,
    told_json,
)
from dh_grader.api.permissions import Access, access_problem
from dh_grader.catalogue import Exercise, FeedbackLevel, is_exercise_id, least
from dh_grader.catalogue.schema_fields import AttemptsSpec
from dh_grader.contract import (
    Attempt,
    AttemptChange,
    AttemptDetail,
    AttemptList,
    AttemptOverride,
    AttemptRequest,
    AttemptResponse,
    AttemptSummary,
    ExerciseStatistics,
    ForgetRequest,
    ForgottenData,
    Learner,
    OverrideRequest,
    RegradeAnswer,
    RegradeRequest,
)
from dh_grader.contract.courses import CourseName
from dh_grader.courses import CourseError, CourseFault
from dh_grader.regex import regex
from dh_grader.slices import working_time
from dh_grader.store import (
    MOST_ON_A_PAGE,
    AttemptFilter,
    AttemptGrading,
    AttemptRefusedError,
    AttemptReport,
    BadCursorError,
    GradesFormat,
    ListedAttempt,
    NewAttempt,
    Outcome,
    RecordedAttempt,
    Ruling,
    Standing,
    StoreDownError,
    UnknownAttemptError,
    UnusablePointsError,
    points_after,
    ruling,
    shown_report,
)
from dh_grader.translations import Language, paragraph, say, told

if TYPE_CHECKING:
    from sqlalchemy import Connection, Row

    from dh_grader.store.attempt_store import AttemptStore
    from dh_grader.store.regrades import RegradedAttempt, Regrading
    from dh_grader.store.results import AttemptHistory


# --- The route that records attempts


IDEMPOTENCY_KEY: Final = Header(
    alias="Idempotency-Key",
    min_length=1,
    max_length=255,
    description="Any text that you choose for this attempt. If the request is sent again with the "
    "same key, the answer is the same, and nothing is recorded twice.",
)


def new_attempts_routes(
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


# --- Grade and record one attempt at an exercise, perhaps in an assignment of a course


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


# --- For tutors and for learners with a token: read recorded attempts


def _written_out(moment: object) -> object:
    # A number would be read as seconds since 1970.
    if isinstance(moment, str) and _DATE.match(moment) is None:
        raise ValueError(say("This must be a date with a time, such as 2026-10-01T08:00:00Z."))
    return moment


def _in_utc(moment: datetime) -> datetime:
    try:
        return moment.astimezone(UTC)
    except OverflowError as error:
        raise ValueError(say("This is no moment of the calendar in UTC.")) from error


_DATE: Final = regex(r"\d{4}-\d\d-\d\d[Tt ]")
Moment = Annotated[AwareDatetime, BeforeValidator(_written_out), AfterValidator(_in_utc)]
Since = Annotated[
    Moment | None,
    Query(description="Attempts from this moment on; with its time zone: 2026-10-01T08:00:00Z."),
]
Until = Annotated[Moment | None, Query(description="Attempts before this moment.")]
CourseFilter = Annotated[CourseName | None, Query(description="The id of a course.")]
AssignmentFilter = Annotated[
    CourseName | None, Query(description="The id of an assignment of the course.")
]
Name = Annotated[str, StringConstraints(max_length=100, pattern=r"^[^\x00-\x1f\x7f]+$")]

_LISTING_REFUSED: Final = refusals(
    HTTPStatus.FORBIDDEN,
    HTTPStatus.NOT_FOUND,
    HTTPStatus.UNPROCESSABLE_ENTITY,
    HTTPStatus.SERVICE_UNAVAILABLE,
)


def listing_routes(catalogue: Catalogue, store: "AttemptStore | None", access: Access) -> APIRouter:
    """Return the routes that read attempts: tutors read all attempts, learners only their own."""
    router = APIRouter(prefix="/v1", tags=["attempts"])

    @router.get(
        "/attempts",
        operation_id="listAttempts",
        summary="List recorded attempts",
        response_model=AttemptList,
        response_description="A page of attempts.",
        responses=_LISTING_REFUSED,
        openapi_extra=MAY_NEED_KEY,
    )
    async def list_attempts(
        request: Request,
        exercise: Annotated[Name | None, Query(description="The id of an exercise.")] = None,
        learner: Annotated[Learner | None, Query(description="The learner.")] = None,
        since: Since = None,
        until: Until = None,
        counted: Annotated[
            bool | None,
            Query(description="Only attempts that count (true), or that do not count (false)."),
        ] = None,
        cursor: Annotated[
            str | None, Query(max_length=40, description="The `next` of the previous page.")
        ] = None,
        course: CourseFilter = None,
        assignment: AssignmentFilter = None,
        limit: Annotated[
            int, Query(ge=1, le=MOST_ON_A_PAGE, description="The most attempts on a page.")
        ] = 50,
    ) -> Response:
        """List recorded attempts, the newest first, without answers and reports.

        Tutors see all attempts. A learner with a token sees the learner's own.
        """
        caller = access.caller(request)
        course = course_of(caller, course)
        if exercise is not None and caller.learner is not None:
            exercise = exercise.partition("~")[0]
        wanted = AttemptFilter(
            exercise, _readable(caller, learner), since, until, counted, course, assignment
        )
        try:
            shown, following = await ask(store, lambda it: it.page(wanted, cursor, limit))
        except BadCursorError as error:
            message = say("This is no cursor of a page.")
            detail = {"type": "cursor", "loc": ("cursor",), "msg": message}
            raise invalid([detail]) from error
        attempts = [_summary(each, caller) for each in shown]
        return private(AttemptList(attempts=attempts, next=following))

    @router.get(
        "/attempts/{attempt_id}",
        operation_id="getAttempt",
        summary="Show a recorded attempt",
        response_model=AttemptDetail,
        response_description="The attempt with its answers and reports.",
        **in_languages({"responses": _LISTING_REFUSED, "openapi_extra": MAY_NEED_KEY}),
    )
    async def show_attempt(request: Request, attempt_id: AttemptId) -> Response:
        """Show a recorded attempt with its answers and its report, in the reader's language.

        Tutors also see earlier reports and overrides.
        """
        caller = access.caller(request)
        found = await ask(store, lambda it: it.history(attempt_id))
        if found is None or not _may_read(caller, found):
            raise unknown_attempt()
        language = language_of(request)
        content = json.dumps(_detail(found, caller, language))
        return told_json(content, language, headers=NO_STORE)

    @router.get(
        "/exercises/{exercise_id}/statistics",
        operation_id="getStatistics",
        summary="Show the statistics of an exercise",
        response_model=ExerciseStatistics,
        response_description="The counts of recorded attempts.",
        **in_languages({"responses": _LISTING_REFUSED, "openapi_extra": MAY_NEED_KEY}),
    )
    async def show_statistics(
        request: Request,
        exercise_id: ExerciseId,
        since: Since = None,
        until: Until = None,
        course: CourseFilter = None,
        assignment: AssignmentFilter = None,
    ) -> Response:
        """Count recorded attempts for tutors: right answers in each place, and common mistakes."""
        exercise = exercise_or_404(catalogue, exercise_id)
        wanted = AttemptFilter(
            exercise=exercise.id,
            since=since,
            until=until,
            course=course_of(access.caller(request), course),
            assignment=assignment,
        )
        figures = await ask(store, lambda it: it.statistics(wanted))
        language = language_of(request)
        content = figures.model_dump_json(exclude_none=True, context=language.translation)
        return told_json(content, language, headers=NO_STORE)

    return router


def course_of(caller: Caller, course: str | None) -> str | None:
    """Return the course whose attempts the caller asks for, or None. Raises ProblemError."""
    if caller.course is not None and course not in (None, caller.course):
        raise access_problem("other-course")
    return caller.course or course


def may_reach(caller: Caller, found: "AttemptHistory | None") -> bool:
    """True if the attempt exists and the caller may see it."""
    return (
        found is not None
        and caller.reaches(found.attempt.exercise)
        and caller.course in (None, found.course)
    )


def _readable(caller: Caller, learner: str | None) -> str | None:
    if caller.learner is not None and learner not in (None, caller.learner):
        raise access_problem("other-learner")
    return caller.learner or learner


def _may_read(caller: Caller, found: "AttemptHistory") -> bool:
    return may_reach(caller, found) and caller.learner in (None, found.attempt.learner)


def _summary(attempt: ListedAttempt, caller: Caller) -> AttemptSummary:
    seen = attempt if caller.learner is None else replace(attempt, variant=None)
    return AttemptSummary.model_validate(seen, from_attributes=True)


def _detail(found: "AttemptHistory", caller: Caller, language: Language) -> dict[str, Any]:
    # Overrides and replaced reports are only for tutors.
    is_tutor = caller.learner is None
    attempt = _summary(found.attempt, caller)
    return {
        "attempt": attempt.model_dump(mode="json", exclude_none=True),
        "submission": json.loads(found.submission),
        "report": json.loads(shown_report(found.report, language)),
        "overrides": [
            AttemptOverride.model_validate(row, from_attributes=True).model_dump(
                mode="json", exclude_none=True
            )
            for row in found.overrides
            if is_tutor
        ],
        "earlier_reports": [_earlier(row, language) for row in found.earlier if is_tutor],
        "hints": [each.model_dump(mode="json", exclude_none=True) for each in found.hints],
    }


def _earlier(row: "Row[Any]", language: Language) -> dict[str, Any]:
    named = ("version", "grader", "points", "max_points")
    return {
        "replaced_at": row.replaced_at.isoformat(),
        **{name: getattr(row, name) for name in named},
        "report": json.loads(shown_report(row.report, language)),
    }


# --- For tutors: export and change recorded attempts


# Bytes of an export that are sent at once.
_PIECE: Final = 64 * 1024
_MANAGING_REFUSED: Final = (
    HTTPStatus.FORBIDDEN,
    HTTPStatus.NOT_FOUND,
    HTTPStatus.SERVICE_UNAVAILABLE,
)
_KINDS: Final = {GradesFormat.JSONL: ("jsonl", "application/jsonl")}
_CSV: Final = ("csv", "text/csv")
_EXPORTED: Final[dict[int | str, dict[str, Any]]] = {
    200: {"content": {kind: {"schema": {"type": "string"}} for _, kind in (_CSV, *_KINDS.values())}}
}


def managing_routes(
    catalogue: Catalogue, feedback: FeedbackLevel, store: "AttemptStore | None", access: Access
) -> APIRouter:
    """Return the routes that export and change attempts.

    ``feedback`` is the highest feedback level of new reports.
    """
    router = APIRouter(prefix="/v1", tags=["attempts"])
    regrades = _Regrades(feedback)

    @router.get(
        "/attempts/export",
        operation_id="exportAttempts",
        summary="Export recorded attempts",
        response_class=Response,
        response_description="The file: lines of CSV, or of JSON.",
        responses={**_EXPORTED, **refusals(*_MANAGING_REFUSED, HTTPStatus.UNPROCESSABLE_ENTITY)},
        openapi_extra=MAY_NEED_KEY,
    )
    async def export_attempts(
        request: Request,
        exercise: Annotated[Name | None, Query(description="The id of an exercise.")] = None,
        learner: Annotated[Learner | None, Query(description="The learner.")] = None,
        since: Since = None,
        until: Until = None,
        course: CourseFilter = None,
        assignment: AssignmentFilter = None,
        form: Annotated[
            GradesFormat,
            Query(
                alias="format",
                description="`csv` and `jsonl` have every attempt. `canvas` and `moodle` are for a "
                "gradebook: of one exercise, the attempt of each learner that counts.",
            ),
        ] = GradesFormat.CSV,
    ) -> Response:
        """Export recorded attempts for tutors, by exercise, learner and moment.

        If only one attempt of a learner counts, it is chosen among the exported ones.
        """
        if form.is_gradebook and exercise is None:
            message = say("{format} has one column for one exercise; name it.", format=form.value)
            raise invalid([{"type": "missing_exercise", "loc": ("exercise",), "msg": message}])
        # Imported here, because it loads the drivers of databases.
        from dh_grader.store.results import counting_rules

        course = course_of(access.caller(request), course)
        wanted = AttemptFilter(
            exercise, learner, since, until, course=course, assignment=assignment
        )
        rules = counting_rules(catalogue)
        turn = partial(give_way, request)
        file = await ask(store, lambda it: it.export(wanted, form, exercise or "", rules, turn))
        ending, kind = _KINDS.get(form, _CSV)
        headers = {
            **NO_STORE,
            "Content-Disposition": f'attachment; filename="{_stem(form, exercise)}.{ending}"',
        }
        pieces = _pieces(file, turn)
        return StreamingResponse(pieces, 200, headers, kind, BackgroundTask(file.close))

    @router.post(
        "/attempts/{attempt_id}/override",
        operation_id="overrideAttempt",
        summary="Give an attempt other points",
        response_description="The attempt with its new points.",
        **posting(OverrideRequest, AttemptSummary, "override", *_MANAGING_REFUSED),
    )
    async def override_attempt(request: Request, attempt_id: AttemptId) -> Response:
        """Give an attempt other points than its report does, with a reason; for tutors.

        The service keeps the author, the reason and the moment, also of points that are
        withdrawn later.
        """
        caller = access.caller(request)
        body = await read_body(OverrideRequest, request)
        found = await ask(store, lambda it: it.history(attempt_id))
        if not may_reach(caller, found):
            raise unknown_attempt()
        author = _author(caller, body.author)
        try:
            changed = await ask(
                store, lambda it: it.override(attempt_id, body.points, body.reason, author)
            )
        except UnknownAttemptError as error:
            raise unknown_attempt() from error
        except UnusablePointsError as error:
            raise invalid(
                [{"type": "points", "loc": ("points",), "msg": message_of(error)}]
            ) from error
        return private(AttemptSummary.model_validate(changed, from_attributes=True))

    @router.post(
        "/learners/forget",
        operation_id="forgetLearner",
        summary="Delete everything that is recorded of a learner",
        response_description="How much is, or was, recorded of the learner.",
        **posting(ForgetRequest, ForgottenData, "forget", *_MANAGING_REFUSED),
    )
    async def forget_learner(request: Request) -> Response:
        """Delete everything that is recorded of a learner for ever; for tutors of all exercises.

        Without `apply` nothing is deleted, and the answer says how much it would be. With
        SQLite, deleted data remain in a file beside the database as long as another program
        reads it: see `erased`.
        """
        body = await read_body(ForgetRequest, request)
        erased = None
        if body.apply:
            data, erased = await ask(store, lambda it: it.forget(body.learner))
        else:
            data = await ask(store, lambda it: it.data_of(body.learner))
        return private(
            ForgottenData(learner=body.learner, deleted=body.apply, erased=erased, **asdict(data))
        )

    @router.post(
        "/exercises/{exercise_id}/regrade",
        operation_id="regradeAttempts",
        summary="Regrade some attempts at a corrected exercise",
        response_description="The results of this step, and the cursor of the next one.",
        **in_languages(
            posting(
                RegradeRequest, RegradeAnswer, "regrade", *_MANAGING_REFUSED, HTTPStatus.CONFLICT
            )
        ),
    )
    async def regrade_attempts(
        request: Request, exercise_id: ExerciseId, course: CourseFilter = None
    ) -> Response:
        """Regrade attempts that another version of exercise or program has graded; for tutors.

        With `course`, and with a key of a course, only attempts in this course are regraded.

        One request works for about a second. Repeat it with `next` as the cursor until the
        answer has no `next`. Without `apply` nothing is written, and the answers say which
        results would change and why. With `apply` the new reports are written, and the old
        ones are kept. All variants of the exercise are regraded, each by its own answer; an
        attempt at a variant that has other values now stays. An interrupted regrade continues
        with a request without a cursor. If the exercise fails its check, the first answer has
        `failures`, and `apply` needs `force`.
        """
        exercise = exercise_or_404(catalogue, exercise_id.partition("~")[0])
        course = course_of(access.caller(request), course)
        body = await read_body(RegradeRequest, request)
        language = language_of(request)
        step = partial(regrades.step, exercise, course, body, language)
        answer = await ask(store, lambda it: regrades.work.do(partial(step, it)))
        return told_json(answer.model_dump_json(exclude_none=True), language, headers=NO_STORE)

    return router


class _Regrades:
    def __init__(self, ceiling: FeedbackLevel) -> None:
        self._ceiling = ceiling
        self.work = BoundedWork()
        # The regrade of the last step, which has memoized the reports on equal answers.
        self._last: tuple[Exercise, str | None, Regrading] | None = None
        # The exercise that was checked last.
        self._checked: tuple[Exercise, list[str]] | None = None

    def step(
        self,
        exercise: Exercise,
        course: str | None,
        body: RegradeRequest,
        language: Language,
        store: "AttemptStore",
    ) -> RegradeAnswer:
        # Imported here, because it loads the drivers of databases.
        from dh_grader.store.regrades import apply_step, preview_step

        failures = self._failures(exercise) if body.cursor is None else []
        if failures and body.apply and not body.force:
            raise ProblemError(
                HTTPStatus.CONFLICT,
                say(
                    "The exercise fails its check: {failures} Correct its file first.",
                    failures=paragraph(*failures),
                ),
                "exercise-fails",
                say("The exercise fails its check"),
            )
        step = apply_step if body.apply else preview_step
        try:
            done = step(store.engine, self._of(exercise, course), body.cursor)
        except BadCursorError as error:
            message = say("This is no cursor of a step.")
            detail = {"type": "cursor", "loc": ("cursor",), "msg": message}
            raise invalid([detail]) from error
        if done.following is None:
            # The memoized reports are not needed any more.
            self._last = None
        changed = (each for each in done.regraded if each.is_changed)
        return RegradeAnswer(
            applied=body.apply,
            regraded=len(done.regraded),
            left=done.left,
            changes=[_change(each, language) for each in changed],
            failures=[told(each, language.translation) for each in failures] or None,
            next=done.following,
        )

    def _failures(self, exercise: Exercise) -> list[str]:
        from dh_grader.authoring import failures

        if self._checked is None or self._checked[0] is not exercise:
            self._checked = (exercise, failures(exercise))
        return self._checked[1]

    def _of(self, exercise: Exercise, course: str | None) -> "Regrading":
        from dh_grader.store.regrades import Regrading

        if self._last is None or self._last[0] is not exercise or self._last[1] != course:
            self._last = (exercise, course, Regrading(exercise, self._ceiling, course))
        return self._last[2]


def _change(changed: "RegradedAttempt", language: Language) -> AttemptChange:
    reasons = [told(each, language.translation) for each in changed.reasons]
    made = AttemptChange.model_validate(changed, from_attributes=True)
    return made.model_copy(update={"reasons": reasons})


async def _pieces(file: IO[bytes], give_way: Callable[[], Awaitable[None]]) -> AsyncIterator[bytes]:
    # A client may want the pieces compressed. A client that has gone needs no more of them.
    with suppress(ClientDisconnect):
        while piece := file.read(_PIECE):
            yield piece
            await give_way()


def _stem(form: GradesFormat, exercise: str | None) -> str:
    kind = form.value if form.is_gradebook else "attempts"
    return f"{kind}-{exercise}" if exercise and is_exercise_id(exercise) else kind


def _author(caller: Caller, given: str | None) -> str:
    by = f"key {caller.key_id}" if caller.key_id else "at the machine"
    return f"{given} ({by})" if given else by


# --- How routes ask the database: what is read and written, and errors as HTTP responses

R = TypeVar("R")

CourseId = Annotated[CourseName, Path(description="The id of a course.")]
AssignmentId = Annotated[CourseName, Path(description="The id of an assignment.")]

_TITLES: Final[dict[CourseFault, tuple[HTTPStatus, str]]] = {
    "unknown-course": (HTTPStatus.NOT_FOUND, say("There is no such course")),
    "unknown-assignment": (HTTPStatus.NOT_FOUND, say("There is no such assignment")),
    "unknown-learner": (HTTPStatus.NOT_FOUND, say("The course has no such learner")),
    "not-assigned": (HTTPStatus.NOT_FOUND, say("The exercise is not part of the assignment")),
    "has-attempts": (HTTPStatus.CONFLICT, say("Attempts are recorded there")),
    "already-there": (HTTPStatus.CONFLICT, say("There is one with this id already")),
    "unusable": (HTTPStatus.UNPROCESSABLE_ENTITY, say("The request cannot be used")),
}
_ASKING_REFUSED: Final = (
    HTTPStatus.FORBIDDEN,
    HTTPStatus.NOT_FOUND,
    HTTPStatus.SERVICE_UNAVAILABLE,
)


async def ask(
    store: "AttemptStore | None", question: Callable[["AttemptStore"], Awaitable[R]]
) -> R:
    """Call ``question`` with the store of attempts; return the result.

    Raises ProblemError if the database is missing or does not respond.
    """
    if store is None:
        raise not_recorded()
    try:
        return await question(store)
    except StoreDownError as error:
        detail = say("The database does not answer.")
        raise store_down(detail) from error


async def read(store: "AttemptStore | None", work: "Callable[[Connection], R]") -> R:
    """Call ``work`` to read from the database, and return the result.

    Raises ProblemError.
    """
    return await _done(store, work, writes=False)


async def write(store: "AttemptStore | None", work: "Callable[[Connection], R]") -> R:
    """Call ``work`` in a transaction of the database, and return the result.

    Raises ProblemError.
    """
    return await _done(store, work, writes=True)


async def _done(
    store: "AttemptStore | None", work: "Callable[[Connection], R]", *, writes: bool
) -> R:
    try:
        return await ask(store, lambda it: it.write(work) if writes else it.read(work))
    except CourseError as error:
        raise course_problem(error) from error


def reading(model: type) -> dict[str, Any]:
    """Return FastAPI's arguments for a route that reads data of a course."""
    refused = refusals(*_ASKING_REFUSED, HTTPStatus.UNPROCESSABLE_ENTITY)
    return {"response_model": model, "responses": refused, "openapi_extra": MAY_NEED_KEY}


def changing(
    body: type, model: type, *further: HTTPStatus, success: HTTPStatus = HTTPStatus.OK
) -> dict[str, Any]:
    """Return FastAPI's arguments for a route that changes data of a course.

    ``further`` are additional error statuses of the route.
    """
    options = posting(body, model, None, *_ASKING_REFUSED, *further, success=success)
    return {"status_code": success, **options}


def not_recorded() -> ProblemError:
    """Return the error for a service without a database."""
    return ProblemError(
        HTTPStatus.NOT_FOUND,
        say("No attempts are recorded here: the service has no database."),
        "attempts-not-recorded",
        say("Attempts are not recorded here"),
    )


def unknown_attempt() -> ProblemError:
    """Return the error for an attempt that is unknown or that the caller may not see."""
    return ProblemError(
        HTTPStatus.NOT_FOUND,
        say("No attempt with this id is recorded here."),
        "unknown-attempt",
        say("There is no such attempt"),
    )


def course_problem(error: CourseError) -> ProblemError:
    """Convert a CourseError to an HTTP error."""
    status, title = _TITLES[error.name]
    return ProblemError(status, message_of(error), error.name, title)


def service_address(request: Request) -> str:
    """Return the address with which links to this service begin, without a trailing slash."""
    # Without the setting, the header Host decides, which the caller's own browser sends.
    public_url: str | None = request.app.state.public_url
    return public_url or str(request.base_url).rstrip("/")
