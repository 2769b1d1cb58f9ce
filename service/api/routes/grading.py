"""The routes that grade submissions."""

import logging
from functools import partial
from http import HTTPStatus

from fastapi import APIRouter, Request, Response

from service.access.caller import Caller
from service.api.courses.own_variant import OwnVariants, of_assignment
from service.api.courses.practice import PracticeGate
from service.api.document.openapi import posting
from service.api.http.bodies import read_body, validated
from service.api.http.language import language_of
from service.api.http.lookup import Catalogue, ExerciseId, Location, exercise_or_404, require_parts
from service.api.http.problems import ProblemError, failed
from service.api.http.told_answer import in_languages, told_json
from service.api.monitor import Monitor
from service.api.permissions.access import Access, require_reach
from service.api.permissions.authentication import count_submissions
from service.api.turns import give_way, run_in_turns
from service.catalogue import Exercise, FeedbackLevel, least
from service.contract.grading import GradeManyResponse
from service.formats.documents.json import rendered
from service.formats.told_report import report_in
from service.grading import Report, grade
from service.submissions.body import ExerciseSubmission, GradeManyRequest, GradeRequest
from service.time_slices import working_time
from service.translations import Language

_log = logging.getLogger(__name__)


def routes(
    catalogue: Catalogue,
    feedback: FeedbackLevel,
    access: Access,
    monitor: Monitor | None,
    practice: PracticeGate,
    own: OwnVariants,
) -> APIRouter:
    """Return the routes that grade; ``feedback`` is the highest feedback level of reports."""
    router = APIRouter(prefix="/v1", tags=["grading"])

    # Gradings run on the event loop: each is a millisecond of pure Python, which threads cannot
    # run in parallel, and changing threads would take another tenth of that.
    @router.post(
        "/exercises/{exercise_id}/grade",
        operation_id="grade",
        summary="Grade a submission",
        response_description="The report.",
        **in_languages(of_assignment(posting(GradeRequest, Report, "grade", HTTPStatus.NOT_FOUND))),
    )
    async def grade_one(exercise_id: ExerciseId, request: Request) -> Response:
        """Grade answers, row by row and cell by cell. Nothing is recorded.

        The answer is a report, whatever a student wrote: an entry that cannot be read is
        `unreadable`, with the reason, and everything else is graded. The same answers
        always get the same report, in the language of the reader. It says no more than the
        exercise and the service allow; `feedback` may ask for less.
        """
        exercise = await own.of(request, exercise_or_404(catalogue, exercise_id))
        await practice.check(access.caller(request), exercise.plain_id)
        body = await read_body(GradeRequest, request)
        language = language_of(request)
        report = await run_in_turns(request, lambda: _report(exercise, body, (), language))
        return told_json(report, language)

    @router.post(
        "/grade",
        operation_id="gradeMany",
        summary="Grade many submissions",
        response_description="A result for each submission, in their order.",
        **in_languages(posting(GradeManyRequest, GradeManyResponse, "grade-many")),
    )
    async def grade_many(request: Request) -> Response:
        """Grade submissions to any exercises, each as if it were alone. Nothing is recorded.

        Each submission counts as a request towards the limits of the service. If they do not allow
        all submissions now, the answer is 429, and nothing is graded.

        The results have the order of the submissions. If a submission cannot be graded
        because its exercise or one of its parts does not exist, its result is a problem;
        the others are graded.
        """
        caller, language = access.caller(request), language_of(request)
        body = await read_body(GradeManyRequest, request)
        await count_submissions(request, len(body.submissions))
        results = []
        for i, submission in enumerate(body.submissions):
            if i:
                await give_way(request)
            graded = partial(_result, submission, i, request.url.path, caller, language)
            refused = await practice.refusal(caller, _named(submission))
            results.append(
                _problem(refused, request.url.path, i, language)
                if refused
                else await run_in_turns(request, graded)
            )
        content = b'{"results":[%b]}' % b",".join(results)
        return told_json(content, language)

    def _result(value: object, i: int, path: str, caller: Caller, language: Language) -> bytes:
        at = ("submissions", i)
        try:
            submission = validated(ExerciseSubmission, value, at)
            require_reach(caller, submission.exercise)
            exercise = exercise_or_404(catalogue, submission.exercise)
            return b'{"report":%b}' % _report(exercise, submission, at, language)
        except ProblemError as error:
            problem = error
        except Exception:  # noqa: BLE001 -- the other submissions are graded all the same
            _log.exception("submission %d of a request could not be graded", i)
            problem = failed()
        return _problem(problem, path, i, language)

    def _report(exercise: Exercise, body: GradeRequest, at: Location, language: Language) -> bytes:
        require_parts(exercise, ((part, (*at, "answers", part)) for part in body.answers))
        submission = body.submission(least(exercise.feedback, feedback))
        began = working_time()
        report = grade(exercise, submission)
        if monitor is not None:
            monitor.graded(report, working_time() - began)
        return rendered(report_in(report, language))

    return router


def _named(submission: object) -> str:
    exercise = submission.get("exercise") if isinstance(submission, dict) else None
    return exercise.partition("~")[0] if isinstance(exercise, str) else ""


def _problem(problem: ProblemError, path: str, i: int, language: Language) -> bytes:
    content = problem.content(f"{path}#/submissions/{i}", language=language)
    return b'{"problem":%b}' % content
