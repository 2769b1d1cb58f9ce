"""Reports as a JSON list with one entry for each file."""

import json
from collections.abc import Iterable, Iterator
from typing import Final

from pydantic import TypeAdapter

from service.formats.shared.graded import GradedFile, GradedSubmission
from service.formats.shared.json_document import printable
from service.formats.shared.report_format import ReportFormat, Setting
from service.grading import Report
from service.regex import regex

_REPORT: Final = TypeAdapter(Report)


def rendered(report: Report, *, indent: int | None = None) -> bytes:
    """Return the report as UTF-8 JSON without the fields that are None."""
    return _REPORT.dump_json(report, exclude_none=True, indent=indent)


def read_report(content: bytes) -> Report:
    """Parse a report from the JSON that ``rendered`` made. Raises pydantic.ValidationError."""
    return _REPORT.validate_json(content)


def entries(submissions: Iterable[GradedSubmission]) -> Iterator[bytes]:
    """Yield a line of JSON for each file, with its report, its error, or both."""
    for submission in submissions:
        for file in submission.files:
            yield printable(_entry(submission, file))


def _entry(submission: GradedSubmission, file: GradedFile) -> bytes:
    head: dict[str, str | bool] = {
        "submission": _encodable(submission.name),
        "file": _encodable(file.file),
        "exercise": file.exercise.id,
        "passed": submission.passed,
    }
    if file.problem:
        head["error"] = _encodable(file.problem)
    if file.report is None:
        return json.dumps(head).encode()
    return json.dumps(head).encode()[:-1] + b', "report": %b}' % rendered(file.report)


def _encodable(text: str) -> str:
    # Names of files may have bytes that are not UTF-8.
    return text.encode("utf-8", "replace").decode()


def _pieces(submissions: Iterable[GradedSubmission], _: Setting) -> Iterator[bytes]:
    opening = b"[\n"
    for entry in entries(submissions):
        yield opening + entry
        opening = b",\n"
    yield b"[]\n" if opening == b"[\n" else b"\n]\n"


JSON: Final = ReportFormat(_pieces, regex(rb'\[\n\{"submission": "'))
