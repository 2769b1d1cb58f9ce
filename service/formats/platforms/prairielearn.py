"""The ``results.json`` of a PrairieLearn external grader.

Source: https://prairielearn.readthedocs.io/en/latest/externalGrading/, "Grading results". An
unreadable submission is reported as not gradable, so it costs no attempt.
"""

from typing import Any, Final

from service.formats.shared.graded import GradedSubmission
from service.formats.shared.json_document import json_document
from service.formats.shared.part_results import PartResult, part_results
from service.formats.shared.plain_text import percent, points_in_words
from service.formats.shared.report_format import ReportFormat, Setting, single
from service.regex import regex
from service.translations.sentence import Translation


def _document(submission: GradedSubmission, setting: Setting) -> bytes:
    results = part_results(submission, setting.language)
    content = (
        _graded(submission, results, setting.language.translation)
        if submission.is_gradable
        else _not_gradable(results)
    )
    return json_document(content)


def _graded(
    submission: GradedSubmission, results: list[PartResult], translation: Translation | None
) -> dict[str, Any]:
    total = points_in_words(submission.points, submission.max_points, translation)
    return {
        "gradable": True,
        "score": submission.score,
        "message": f"{total}, {percent(submission.score)}",
        "tests": [_test(each) for each in results],
    }


def _test(result: PartResult) -> dict[str, Any]:
    return {
        "name": result.name,
        "points": result.points,
        "max_points": result.max_points,
        "message": "\n".join(result.lines()),
    }


def _not_gradable(results: list[PartResult]) -> dict[str, Any]:
    lines = (
        line if each.report is None else f"{each.name}: {line}"
        for each in results
        for line in each.message_lines()
    )
    return {"gradable": False, "score": 0.0, "format_errors": list(dict.fromkeys(lines))}


_MARK: Final = regex(
    rb'\{\s*"gradable": (?:true|false),\s*"score": [\d.]+,\s*"(?:message|format_errors|tests)": '
)

PRAIRIELEARN: Final = ReportFormat(single(_document), _MARK, is_single=True, for_students=True)
