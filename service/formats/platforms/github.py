"""Annotations of GitHub Actions: one for each part that lost points, and one for the total.

Source: https://docs.github.com/en/actions/reference/workflow-commands-for-github-actions, and the
code with which the runner parses them, ``src/Runner.Common/ActionCommand.cs`` of
https://github.com/actions/runner. The runner shows only ten errors of a step, so all messages on a
part share one annotation.
"""

from collections.abc import Iterable, Iterator
from typing import Final

from service.formats.shared.graded import GradedSubmission
from service.formats.shared.part_results import PartResult, part_results
from service.formats.shared.plain_text import percent, points, visible
from service.formats.shared.report_format import ReportFormat, Setting

# Percent comes first, because all replacements contain it.
_IN_DATA: Final = (("%", "%25"), ("\r", "%0D"), ("\n", "%0A"))
_IN_PROPERTIES: Final = (*_IN_DATA, (":", "%3A"), (",", "%2C"))


def _pieces(submissions: Iterable[GradedSubmission], _: Setting) -> Iterator[bytes]:
    for submission in submissions:
        for result in part_results(submission):
            if not result.passed:
                yield _part(result)
        yield _total(submission)


def _part(result: PartResult) -> bytes:
    title = f"{result.name}: {points(result.points, result.max_points)} points"
    level = "warning" if result.points else "error"
    return _command(level, result.file.file, title, "\n".join(result.lines() or [title]))


def _total(submission: GradedSubmission) -> bytes:
    file = submission.files[0].file if len(submission.files) == 1 else ""
    needed = f"{percent(submission.pass_mark)} is needed to pass."
    if not submission.is_graded:
        return _command("error", file, "Not graded", needed)
    total = f"{points(submission.points, submission.max_points)} points"
    told = f"{total}, {percent(submission.score)}. {needed}"
    if submission.passed:
        return _command("notice", file, "Passed", told)
    return _command("error", file, "Not passed", told)


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


FORMAT: Final = ReportFormat(_pieces, is_stream=True, for_students=True)
