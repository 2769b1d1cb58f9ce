"""The ``results.json`` of a Gradescope autograder: a test for each part, with its rows.

Source: https://gradescope-autograders.readthedocs.io/en/latest/specs/, "Output format".
"""

from collections.abc import Iterator
from typing import Any, Final

from service.formats.shared.graded import GradedSubmission
from service.formats.shared.json_document import json_document
from service.formats.shared.markdown_text import part_details
from service.formats.shared.messages import total_points
from service.formats.shared.part_results import PartResult, part_results
from service.formats.shared.plain_text import visible
from service.formats.shared.report_format import ReportFormat, Setting, single
from service.regex import regex
from service.translations import paragraph, say, told
from service.translations.sentence import Translation


def _document(submission: GradedSubmission, setting: Setting) -> bytes:
    content = {
        "score": submission.points,
        "output": "\n\n".join(
            [_total(submission, setting.language.translation), *_tasks(submission)]
        ),
        "output_format": "text",
        "test_name_format": "text",
        "test_output_format": "md",
        "visibility": setting.visibility.value,
        "stdout_visibility": "hidden",
        "tests": [_test(each) for each in part_results(submission, setting.language)],
    }
    return json_document(content)


def _total(submission: GradedSubmission, translation: Translation | None) -> str:
    if not submission.is_graded:
        problems = "; ".join(submission.problems)
        nothing = say("Nothing could be graded: {problems}", problems=problems)
        return visible(told(nothing, translation))
    return told(paragraph(total_points(submission), _unread(submission)), translation)


def _tasks(submission: GradedSubmission) -> Iterator[str]:
    for file in submission.files:
        yield from map(visible, file.exercise.task)


def _unread(submission: GradedSubmission) -> str:
    if submission.is_gradable:
        return ""
    if submission.is_answered:
        return say("Nothing in this submission could be read.")
    return say("Nothing is answered.")


def _test(result: PartResult) -> dict[str, Any]:
    return {
        "name": result.name,
        "score": result.points,
        "max_score": result.max_points,
        "status": "passed" if result.passed else "failed",
        "output": part_details(result),
    }


_MARK: Final = regex(
    rb'\{\s*"score": [\d.]+,\s*"output": ".{0,60000}",'
    rb'\s*"output_format": "text",\s*"test_name_format": "text",'
)

GRADESCOPE: Final = ReportFormat(single(_document), _MARK, is_single=True, for_students=True)
