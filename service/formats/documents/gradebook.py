"""Grades for the gradebook of a course: a line for each learner, with the headings of Moodle.

Moodle, Canvas and others import such a file and ask which column is which.
"""

from collections.abc import Iterable, Iterator
from typing import Final

from service.formats.shared import spreadsheet
from service.formats.shared.graded import GradedSubmission
from service.formats.shared.part_results import PartResult, part_results
from service.formats.shared.plain_text import points
from service.formats.shared.report_format import ReportFormat, Setting


def _pieces(submissions: Iterable[GradedSubmission], _: Setting) -> Iterator[bytes]:
    yield spreadsheet.line(spreadsheet.GRADEBOOK_HEAD)
    for submission in submissions:
        yield spreadsheet.line(_cells(submission))


def _cells(submission: GradedSubmission) -> list[str | float | None]:
    """No grade where nothing was graded: an import leaves the one that is there."""
    parts = (f"{each.name}: {_earned(each)}" for each in part_results(submission))
    return [
        submission.learner,
        submission.points if submission.is_graded else None,
        submission.max_points,
        "; ".join(parts),
    ]


def _earned(result: PartResult) -> str:
    return points(result.points, result.max_points) if result.report else result.file.problem


FORMAT: Final = ReportFormat(_pieces)
