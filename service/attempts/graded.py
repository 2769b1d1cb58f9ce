"""Grade an attempt: the report for the learner, and the outcome for statistics."""

from dataclasses import dataclass, replace

from service.attempts.outcome import Outcome, outcome_of
from service.attempts.results.recorded_report import recorded_report
from service.catalogue import Exercise, FeedbackLevel
from service.grading import GradedAnswers, Report, graded_answers
from service.submissions.body import GradeRequest


@dataclass(frozen=True, slots=True)
class AttemptReport:
    """A report, its JSON, and its outcome (verdicts and message codes) for statistics."""

    report: Report
    text: str
    outcome: Outcome


class AttemptGrading:
    """Grades the answers of one request, and makes reports at different feedback levels."""

    def __init__(self, exercise: Exercise, body: GradeRequest) -> None:
        self._exercise = exercise
        self._body = body
        self._graded: dict[FeedbackLevel, GradedAnswers] = {}
        self._reports: dict[FeedbackLevel, AttemptReport] = {}

    def has(self, most: FeedbackLevel) -> bool:
        """True if ``at(most)`` can return the report without grading again."""
        return _grading_level(self._level(most)) in self._graded

    def at(self, most: FeedbackLevel) -> AttemptReport:
        """Return the report at the requested feedback level, or at ``most`` if that is lower."""
        level = self._level(most)
        if level not in self._reports:
            self._reports[level] = self._report(most, level)
        return self._reports[level]

    def _report(self, most: FeedbackLevel, level: FeedbackLevel) -> AttemptReport:
        # The outcome needs rows, which the report at level ``score`` does not have.
        enough = _grading_level(level)
        if enough not in self._graded:
            submission = replace(self._body.submission(most), feedback=enough)
            self._graded[enough] = graded_answers(self._exercise, submission)
        graded = self._graded[enough]
        report = graded.report(enough)
        outcome = outcome_of(report)
        shown = report if level is enough else graded.report(level)
        return AttemptReport(shown, recorded_report(shown), outcome)

    def _level(self, most: FeedbackLevel) -> FeedbackLevel:
        return self._body.submission(most).feedback


def _grading_level(level: FeedbackLevel) -> FeedbackLevel:
    return FeedbackLevel.FULL if level is FeedbackLevel.FULL else FeedbackLevel.HINTS
