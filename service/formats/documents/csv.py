"""Points as comma-separated values: a line for each submission, a column for each part."""

import re
from collections.abc import Iterable, Iterator
from typing import Final

from service.formats.shared import spreadsheet
from service.formats.shared.graded import GradedSubmission
from service.formats.shared.part_results import part_results
from service.formats.shared.report_format import ReportFormat, Setting
from service.grading import PartReport, Severity
from service.grading.report import messages_of
from service.regex import regex

_HEAD: Final = ("submission", "points", "max_points", "score", "passed", "problem", "messages")
# Messages that cost points or may name a slip. Notes and hints are not listed.
_COUNTED: Final = (Severity.ERROR, Severity.WARNING)


def _pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
    columns = [f"{each.id}.{part.id}" for each in setting.exercises for part in each.parts]
    yield spreadsheet.line([*_HEAD, *columns])
    for submission in submissions:
        yield spreadsheet.line(_cells(submission, setting))


def _cells(submission: GradedSubmission, setting: Setting) -> list[str | float | None]:
    is_complete = submission.is_complete
    results = part_results(submission, setting.language)
    # If something was not graded, the points are empty.
    return [
        submission.name,
        submission.points if is_complete else None,
        submission.max_points,
        _share(submission.score) if is_complete else None,
        "yes" if submission.passed else "no",
        "; ".join(submission.problems),
        " ".join(code for each in results if each.report for code in _codes(each.report)),
        *(None if each.is_unread else each.points for each in results),
    ]


def _share(score: float) -> str:
    # A share of 1 needs more decimals than points.
    return f"{score:.6f}".rstrip("0").rstrip(".")


def _codes(part: PartReport) -> list[str]:
    found = (message.code for message, _, _ in messages_of(part) if message.severity in _COUNTED)
    return [f"{part.part}.{code}" for code in dict.fromkeys(found)]


CSV: Final = ReportFormat(_pieces, regex(re.escape(",".join(_HEAD)).encode()))
