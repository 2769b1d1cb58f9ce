"""Annotations of GitHub Actions: one for each part that lost points, and one for the total.

Source: https://docs.github.com/en/actions/reference/workflow-commands-for-github-actions, and the
code with which the runner parses them, ``src/Runner.Common/ActionCommand.cs`` of
https://github.com/actions/runner. The runner shows only ten errors of a step, so all messages on a
part share one annotation.
"""

from collections.abc import Iterable, Iterator
from typing import Final

from service.formats.shared.graded import GradedSubmission
from service.formats.shared.messages import NOT_GRADED, NOT_PASSED, PASSED, total_points
from service.formats.shared.part_results import PartResult, part_results
from service.formats.shared.plain_text import percent, visible
from service.formats.shared.report_format import ReportFormat, Setting
from service.regex import regex
from service.translations import paragraph, say, told
from service.translations.sentence import Translation

# Percent comes first, because all replacements contain it.
_IN_DATA: Final = (("%", "%25"), ("\r", "%0D"), ("\n", "%0A"))
_IN_PROPERTIES: Final = (*_IN_DATA, (":", "%3A"), (",", "%2C"))


def _pieces(submissions: Iterable[GradedSubmission], setting: Setting) -> Iterator[bytes]:
    for submission in submissions:
        for result in part_results(submission, setting.language):
            if not result.passed:
                yield _part(result)
        yield _total(submission, setting.language.translation)


def _part(result: PartResult) -> bytes:
    title = f"{result.name}: {result.points_in_words}"
    level = "warning" if result.points else "error"
    return _command(level, result.file.file, title, "\n".join(result.lines() or [title]))


def _total(submission: GradedSubmission, translation: Translation | None) -> bytes:
    file = submission.files[0].file if len(submission.files) == 1 else ""
    needed = say("{share} is needed to pass.", share=percent(submission.pass_mark))
    if not submission.is_graded:
        return _command("error", file, told(NOT_GRADED, translation), told(needed, translation))
    total = told(paragraph(total_points(submission), needed), translation)
    if submission.passed:
        return _command("notice", file, told(PASSED, translation), total)
    return _command("error", file, told(NOT_PASSED, translation), total)


def _command(level: str, file: str, title: str, message: str) -> bytes:
    properties = {"file": visible(file), "title": title}
    written = ",".join(
        f"{name}={_escaped(value, _IN_PROPERTIES)}" for name, value in properties.items() if value
    )
    return f"::{level} {written}::{_escaped(message, _IN_DATA)}\n".encode()


def _escaped(text: str, replacements: tuple[tuple[str, str], ...]) -> str:
    for sign, replacement in replacements:
        text = text.replace(sign, replacement)
    return text


_MARK: Final = regex(rb"::(?:notice|warning|error) (?:file|title)=")

GITHUB: Final = ReportFormat(_pieces, _MARK, is_stream=True, for_students=True)
