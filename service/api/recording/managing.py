"""Routes for tutors: export and change recorded attempts."""

from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import suppress
from dataclasses import asdict
from functools import partial
from http import HTTPStatus
from typing import IO, TYPE_CHECKING, Annotated, Any, Final

from fastapi import APIRouter, Query, Request, Response
from starlette.background import BackgroundTask
from starlette.requests import ClientDisconnect
from starlette.responses import StreamingResponse

from service.access.caller import Caller
from service.api.document.openapi import MAY_NEED_KEY, posting, refusals
from service.api.http.bodies import read_body
from service.api.http.bounded_work import BoundedWork
from service.api.http.language import language_of
from service.api.http.lookup import AttemptId, Catalogue, ExerciseId, exercise_or_404
from service.api.http.problems import ProblemError, invalid, message_of
from service.api.http.told_answer import in_languages, told_json
from service.api.permissions.access import Access
from service.api.recording.listing import (
    AssignmentFilter,
    CourseFilter,
    Name,
    Since,
    Until,
    course_of,
    may_reach,
)
from service.api.recording.store import NO_STORE, ask, private, unknown_attempt
from service.api.turns import give_way
from service.attempts.attempt import AttemptFilter, GradesFormat
from service.attempts.errors import (
    BadCursorError,
    UnknownAttemptError,
    UnusablePointsError,
)
from service.catalogue import Exercise, FeedbackLevel, is_exercise_id
from service.contract.attempts import AttemptSummary, Learner
from service.contract.tutoring import (
    AttemptChange,
    ForgetRequest,
    ForgottenData,
    OverrideRequest,
    RegradeAnswer,
    RegradeRequest,
)
from service.translations import Language, paragraph, say, told

if TYPE_CHECKING:  # they load the drivers of databases
    from service.attempts.regrades.outdated import RegradedAttempt, Regrading
    from service.attempts.store import AttemptStore

# Bytes of an export that are sent at once.
_PIECE: Final = 64 * 1024
_REFUSED: Final = (HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND, HTTPStatus.SERVICE_UNAVAILABLE)
_KINDS: Final = {GradesFormat.JSONL: ("jsonl", "application/jsonl")}
_CSV: Final = ("csv", "text/csv")
_EXPORTED: Final[dict[int | str, dict[str, Any]]] = {
    200: {"content": {kind: {"schema": {"type": "string"}} for _, kind in (_CSV, *_KINDS.values())}}
}


def routes(
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
        responses={**_EXPORTED, **refusals(*_REFUSED, HTTPStatus.UNPROCESSABLE_ENTITY)},
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
        from service.attempts.results.grades import counting_rules

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
        **posting(OverrideRequest, AttemptSummary, "override", *_REFUSED),
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
        **posting(ForgetRequest, ForgottenData, "forget", *_REFUSED),
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
            posting(RegradeRequest, RegradeAnswer, "regrade", *_REFUSED, HTTPStatus.CONFLICT)
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
        from service.attempts.regrades.steps import apply_step, preview_step

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
        from service.authoring import failures

        if self._checked is None or self._checked[0] is not exercise:
            self._checked = (exercise, failures(exercise))
        return self._checked[1]

    def _of(self, exercise: Exercise, course: str | None) -> "Regrading":
        from service.attempts.regrades.outdated import Regrading

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
