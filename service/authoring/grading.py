"""Grading an answer for its author's sake."""

from collections.abc import Iterator, Mapping

from service.catalogue import Exercise
from service.grading import Feedback, FeedbackLevel, PartReport, Submission, grade
from service.grading.reading.entry import AngleUnit


def graded(
    exercise: Exercise, answers: Mapping[str, object], angle_unit: AngleUnit = "radians"
) -> dict[str, PartReport]:
    """The report on each part, by its id."""
    submission = Submission(answers, angle_unit, FeedbackLevel.FULL)
    return {part.part: part for part in grade(exercise, submission).parts}


def messages(report: PartReport) -> Iterator[Feedback]:
    """All messages on a part: on itself, its rows and their cells."""
    yield from report.feedback
    for row in report.rows:
        yield from row.feedback
        for cell in row.cells:
            yield from cell.feedback


def in_words(report: PartReport) -> str:
    """Verdict, points and the first message of a part, for a remark."""
    # A message on a single cell says more than one on the whole.
    message = next((f": {each.message}" for each in reversed(list(messages(report)))), "")
    return f"{report.verdict.value}, {report.points:g} of {report.max_points:g} points{message}"
