"""Let a server grade submissions."""

# This module loads httpx, so import the module late.

from collections.abc import Collection
from dataclasses import replace
from http import HTTPStatus
from typing import Final

from service.cli.language import spoken
from service.cli.remote.journal import Journal, digest
from service.client import GraderClient, GraderClientError, RequestRefusedError
from service.formats.shared.graded import GradedSubmission
from service.grading import Report, Submission
from service.grading.report import rounded_points
from service.local_grading import GradingTerms, graded, unknown_part
from service.submissions.assignment import AssignedExercise
from service.submissions.body import GradeRequest
from service.submissions.handed_in import HandedIn
from service.submissions.lookup import UnknownExerciseError
from service.submissions.outline import ExerciseOutline, PartOutline
from service.translations import say

# The statuses that concern the key or the connection; other client errors concern the answers.
_CONCERNING_ALL: Final = {HTTPStatus.UNAUTHORIZED, HTTPStatus.FORBIDDEN, HTTPStatus.REQUEST_TIMEOUT}


def exercise_of(server: GraderClient, exercise_id: str) -> ExerciseOutline:
    """Return an exercise of the server. Raises UnknownExerciseError or GraderClientError."""
    try:
        told = server.exercise(exercise_id)
    except RequestRefusedError as error:
        if error.code != "unknown-exercise":
            raise
        known = tuple(each.id for each in server.exercises())
        raise UnknownExerciseError(exercise_id, known) from error
    parts = tuple(PartOutline(part.id, part.title, part.points) for part in told.parts)
    return ExerciseOutline(told.id, told.version, told.title, told.source, told.feedback, parts)


class RemoteGrading:
    """Lets a server grade submissions, unless the journal already has their reports.

    ``ungraded`` has the names of the submissions that the server could not grade, and ``reason``
    says why.
    """

    # Several threads may use one object. The journal keeps the reports for each ``key`` apart,
    # because the feedback of a server may depend on the key.

    def __init__(
        self, server: GraderClient, key: str | None, terms: GradingTerms, journal: Journal
    ) -> None:
        self._server = server
        self._key = key
        self._terms = terms
        self._journal = journal
        self._has_ended = False
        self.reason = ""
        self.ungraded: set[str] = set()

    def graded(self, handed: HandedIn) -> GradedSubmission:
        """Grade a submission; return a report or an error message for each exercise."""

        def report_on(
            body: GradeRequest, assigned: AssignedExercise, terms: GradingTerms
        ) -> tuple[Report | None, str]:
            if problem := unknown_part(body, assigned):
                return None, problem
            try:
                return self._report(assigned, terms.submission(body, assigned)), ""
            except GraderClientError as error:
                if _concerns_these(error):
                    refused = say("is refused by the server: {reason}", reason=error.args[0])
                    return None, spoken(refused)
                self.reason = self.reason or error.args[0]
                self.ungraded.add(handed.name)
                return None, spoken(say("is not graded: {reason}", reason=error.args[0]))

        return graded(handed, self._terms, report_on)

    def _report(self, assigned: AssignedExercise, submission: Submission) -> Report:
        exercise = assigned.exercise
        parts = tuple(part.id for part in exercise.parts)
        terms = (submission.angle_unit, submission.feedback, submission.echo)
        asked = (self._server.server, self._key, exercise.id, exercise.version)
        of = digest((*asked, parts, terms, submission.answers))
        if (known := self._journal.report(of)) is not None:
            return known
        if self._has_ended:
            raise GraderClientError(self.reason)
        try:
            report = self._server.grade(
                exercise.id,
                submission.answers,
                angle_unit=submission.angle_unit,
                feedback=submission.feedback,
                echo=submission.echo,
            )
        except GraderClientError as error:
            if _concerns_all(error):
                self._has_ended = True
            raise
        report = restricted(report, parts)
        self._journal.add(of, report)
        return report


def restricted(report: Report, parts: Collection[str]) -> Report:
    """Return the report, limited to these parts of the exercise."""
    kept = tuple(part for part in report.parts if part.part in parts)
    points = rounded_points(sum(part.points for part in kept))
    max_points = rounded_points(sum(part.max_points for part in kept))
    score = round(points / max_points, 6)
    return replace(report, parts=kept, points=points, max_points=max_points, score=score)


def _concerns_all(error: GraderClientError) -> bool:
    # True if other submissions would cause the same error.
    if isinstance(error, RequestRefusedError):
        return error.status in _CONCERNING_ALL or error.is_temporary
    return True


def _concerns_these(error: GraderClientError) -> bool:
    # True if the server refuses these answers, so that sending them again is useless.
    is_refusal = isinstance(error, RequestRefusedError) and 400 <= error.status < 500
    return is_refusal and not _concerns_all(error)
