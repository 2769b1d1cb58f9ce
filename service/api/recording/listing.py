"""Routes for tutors and for learners with a token: read recorded attempts."""

import json
from dataclasses import replace
from datetime import UTC, datetime
from http import HTTPStatus
from typing import TYPE_CHECKING, Annotated, Any, Final

from fastapi import APIRouter, Query, Request, Response
from pydantic import AfterValidator, AwareDatetime, BeforeValidator, StringConstraints

from service.access.caller import Caller
from service.api.document.openapi import MAY_NEED_KEY, refusals
from service.api.http.language import language_of
from service.api.http.lookup import AttemptId, Catalogue, ExerciseId, exercise_or_404
from service.api.http.problems import invalid
from service.api.http.told_answer import in_languages, told_json
from service.api.permissions.access import Access
from service.api.permissions.access_problems import access_problem
from service.api.recording.store import NO_STORE, ask, private, unknown_attempt
from service.attempts.attempt import MOST_ON_A_PAGE, AttemptFilter, ListedAttempt
from service.attempts.errors import BadCursorError
from service.attempts.results.recorded_report import shown_report
from service.contract.attempts import (
    AttemptDetail,
    AttemptList,
    AttemptOverride,
    AttemptSummary,
    Learner,
)
from service.contract.courses import CourseName
from service.contract.statistics import ExerciseStatistics
from service.regex import regex
from service.translations import Language, say

if TYPE_CHECKING:  # they load the drivers of databases
    from sqlalchemy import Row

    from service.attempts.results.listing import AttemptHistory
    from service.attempts.store import AttemptStore


def _in_utc(moment: datetime) -> datetime:
    try:
        return moment.astimezone(UTC)
    except OverflowError as error:
        raise ValueError(say("This is no moment of the calendar in UTC.")) from error


def _written_out(moment: object) -> object:
    # A number would be read as seconds since 1970.
    if isinstance(moment, str) and _DATE.match(moment) is None:
        raise ValueError(say("This must be a date with a time, such as 2026-10-01T08:00:00Z."))
    return moment


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

_REFUSED: Final = refusals(
    HTTPStatus.FORBIDDEN,
    HTTPStatus.NOT_FOUND,
    HTTPStatus.UNPROCESSABLE_ENTITY,
    HTTPStatus.SERVICE_UNAVAILABLE,
)


def routes(catalogue: Catalogue, store: "AttemptStore | None", access: Access) -> APIRouter:
    """Return the routes that read attempts: tutors read all attempts, learners only their own."""
    router = APIRouter(prefix="/v1", tags=["attempts"])

    @router.get(
        "/attempts",
        operation_id="listAttempts",
        summary="List recorded attempts",
        response_model=AttemptList,
        response_description="A page of attempts.",
        responses=_REFUSED,
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
        **in_languages({"responses": _REFUSED, "openapi_extra": MAY_NEED_KEY}),
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
        **in_languages({"responses": _REFUSED, "openapi_extra": MAY_NEED_KEY}),
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
