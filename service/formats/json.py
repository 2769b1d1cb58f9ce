"""A report as JSON."""

import json
from collections.abc import Sequence
from typing import Final

from pydantic import TypeAdapter
from rich.console import Console

from service.grading import Report

_REPORT: Final = TypeAdapter(Report)


def rendered(report: Report, *, indent: int | None = None) -> bytes:
    """The report as UTF-8 JSON; fields that say nothing (None) are left out."""
    return _REPORT.dump_json(report, exclude_none=True, indent=indent)


def page(results: Sequence[tuple[str, Report | str]], _: Console) -> bytes:
    """The report of one file, nothing where it has none; of several files a list."""
    if len(results) == 1:
        result = results[0][1]
        return rendered(result, indent=2) + b"\n" if isinstance(result, Report) else b""
    return b"[\n" + b",\n".join(_entry(*each) for each in results) + b"\n]\n"


def _entry(file: str, result: Report | str) -> bytes:
    name = json.dumps(file).encode()
    if isinstance(result, Report):
        return b'{"file": %b, "report": %b}' % (name, rendered(result))
    return b'{"file": %b, "error": %b}' % (name, json.dumps(result).encode())
