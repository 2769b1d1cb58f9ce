"""An attempt graded: the report that its learner gets, and the outcome that is counted."""

from service.attempts.outcome import Outcome, outcome_of
from service.catalogue import Exercise, FeedbackLevel
from service.grading import Report, grade
from service.submissions.body import GradeRequest


def graded_attempt(
    exercise: Exercise, body: GradeRequest, most: FeedbackLevel
) -> tuple[Report, Outcome]:
    """The report at a level, and the outcome, which needs more than bare marks."""
    report = grade(exercise, body.submission(most))
    if report.feedback in (FeedbackLevel.FULL, FeedbackLevel.HINTS):
        return report, outcome_of(report)
    with_codes = body.model_copy(update={"feedback": None})
    return report, outcome_of(grade(exercise, with_codes.submission(FeedbackLevel.HINTS)))
