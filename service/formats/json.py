"""Reports as JSON."""

import json
from collections.abc import Sequence
from typing import Final

from pydantic import TypeAdapter
from rich.console import Console

from service.formats import GradedFile
from service.grading import Report

_REPORT: Final = TypeAdapter(Report)


def rendered(report: Report, *, indent: int | None = None) -> bytes:
    """The report as UTF-8 JSON; fields that say nothing (None) are left out."""
    return _REPORT.dump_json(report, exclude_none=True, indent=indent)


def document(graded: Sequence[GradedFile], _: Console) -> bytes:
    """The report alone for one file, if it has one; else a list with one entry for each file."""
    if len(graded) == 1:
        report = graded[0].report
        return b"" if report is None else rendered(report, indent=2) + b"\n"
    return b"[\n" + b",\n".join(map(_entry, graded)) + b"\n]\n"


def _entry(result: GradedFile) -> bytes:
    file = json.dumps(str(result.file)).encode()
    if result.report is None:
        return b'{"file": %b, "error": %b}' % (file, json.dumps(result.error).encode())
    return b'{"file": %b, "report": %b}' % (file, rendered(result.report))
