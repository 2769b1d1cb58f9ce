"""An attempt graded: the report that its learner gets, and the outcome that is counted."""

from dataclasses import dataclass, replace

from service.attempts.outcome import Outcome, outcome_of
from service.catalogue import Exercise, FeedbackLevel
from service.formats.documents.json import rendered
from service.grading import GradedAnswers, Report, graded_answers
from service.submissions.body import GradeRequest


@dataclass(frozen=True, slots=True)
class AttemptReport:
    """A report, as it is written, and what is counted of it."""

    report: Report
    text: str
    outcome: Outcome


class AttemptGrading:
    """The grading of one body: once for all levels below ``full``, and once for that."""

    def __init__(self, exercise: Exercise, body: GradeRequest) -> None:
        self._exercise = exercise
        self._body = body
        self._graded: dict[FeedbackLevel, GradedAnswers] = {}
        self._reports: dict[FeedbackLevel, AttemptReport] = {}

    def has(self, most: FeedbackLevel) -> bool:
        """Whether the report at this level needs no further grading."""
        return _graded_for(self._told(most)) in self._graded

    def at(self, most: FeedbackLevel) -> AttemptReport:
        """The report at a level, and the outcome, which needs more than bare marks."""
        level = self._told(most)
        if level not in self._reports:
            self._reports[level] = self._report(most, level)
        return self._reports[level]

    def _report(self, most: FeedbackLevel, level: FeedbackLevel) -> AttemptReport:
        enough = _graded_for(level)
        if enough not in self._graded:
            submission = replace(self._body.submission(most), feedback=enough)
            self._graded[enough] = graded_answers(self._exercise, submission)
        graded = self._graded[enough]
        report = graded.report(enough)
        outcome = outcome_of(report)
        told = report if level is enough else graded.report(level)
        return AttemptReport(told, rendered(told).decode(), outcome)

    def _told(self, most: FeedbackLevel) -> FeedbackLevel:
        return self._body.submission(most).feedback


def _graded_for(level: FeedbackLevel) -> FeedbackLevel:
    """The level at which one grades for this one, and for the outcome."""
    return FeedbackLevel.FULL if level is FeedbackLevel.FULL else FeedbackLevel.HINTS
