"""Grading an answer for its author's sake."""

from collections.abc import Mapping

from service.catalogue import Exercise
from service.expressions import AngleUnit
from service.grading import FeedbackLevel, PartReport, Submission, grade
from service.grading.report import messages_of


def graded(
    exercise: Exercise, answers: Mapping[str, object], angle_unit: AngleUnit = "radians"
) -> dict[str, PartReport]:
    """The report on each part, by its id."""
    submission = Submission(answers, angle_unit, FeedbackLevel.FULL)
    return {part.part: part for part in grade(exercise, submission).parts}


def in_words(report: PartReport) -> str:
    """Verdict, points and the first message of a part, for a remark."""
    # A message on a single cell tells more than one on the whole part.
    message = next((f": {each.message}" for each, _ in reversed([*messages_of(report)])), "")
    return f"{report.verdict.value}, {report.points:g} of {report.max_points:g} points{message}"
