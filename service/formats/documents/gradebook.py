"""Grades for the gradebook of a course: one line for each learner, with Moodle's headings."""

import re
from collections.abc import Iterable, Iterator
from typing import Final

from service.formats.shared import spreadsheet
from service.formats.shared.graded import GradedSubmission
from service.formats.shared.part_results import PartResult, part_results
from service.formats.shared.plain_text import points
from service.formats.shared.report_format import ReportFormat, Setting
from service.regex import regex
from service.translations import Language, say, told


def _pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
    yield spreadsheet.line(spreadsheet.GRADEBOOK_HEAD)
    for submission in submissions:
        yield spreadsheet.line(_cells(submission, setting))


def _cells(submission: GradedSubmission, setting: Setting) -> list[str | float | None]:
    return [
        submission.learner,
        # On import, an empty grade keeps the old grade. What was not read does not count as 0.
        submission.points if submission.is_complete else None,
        submission.max_points,
        comment(submission, setting.language),
    ]


def comment(submission: GradedSubmission, language: Language) -> str:
    """Return the points of each part in one line."""
    results = part_results(submission, language)
    return "; ".join(f"{each.name}: {_earned(each, language)}" for each in results)


def _earned(result: PartResult, language: Language) -> str:
    if result.report is None:
        return result.file.problem
    if result.is_unread:
        return told(say("could not be read"), language.translation)
    return points(result.points, result.max_points)


_MARK: Final = regex(re.escape(",".join(spreadsheet.GRADEBOOK_HEAD)).encode() + b"\r?\n")

GRADEBOOK: Final = ReportFormat(_pieces, _MARK)
