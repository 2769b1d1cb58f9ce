"""An attempt graded: the report that its learner gets, and the outcome that is counted."""

from service.attempts.outcome import Outcome, outcome_of
from service.catalogue import Exercise, FeedbackLevel, least
from service.grading import Report, grade
from service.submissions.body import GradeRequest


def graded_attempt(
    exercise: Exercise, body: GradeRequest, ordinal: int, ceiling: FeedbackLevel
) -> tuple[Report, Outcome]:
    """The report at the level of this attempt, and the outcome, which needs more than bare marks.

    ``ceiling`` is the most that the service tells.
    """
    most = least(exercise.feedback_at(ordinal), ceiling)
    report = grade(exercise, body.submission(most))
    if report.feedback in (FeedbackLevel.FULL, FeedbackLevel.HINTS):
        return report, outcome_of(report)
    with_codes = body.model_copy(update={"feedback": None})
    return report, outcome_of(grade(exercise, with_codes.submission(FeedbackLevel.HINTS)))
