"""A report as JSON."""

from typing import Final

from pydantic import TypeAdapter

from service.grading import Report

_REPORT: Final = TypeAdapter(Report)


def rendered(report: Report, *, indent: int | None = None) -> bytes:
    """The report as UTF-8 JSON; fields that say nothing (None) are left out."""
    return _REPORT.dump_json(report, exclude_none=True, indent=indent)
