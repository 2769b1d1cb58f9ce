"""Report formats for people and programs: the table of all formats.

``terminal.py`` has the report for a terminal, ``documents.py`` files to read, and those that a
platform takes.
"""

from collections.abc import Mapping
from pkgutil import resolve_name
from typing import Final

from dh_grader.formats.graded import ReportFormat

# Where each format is. A format is imported when it is used: some need half a second.
_FORMATS: Final[Mapping[str, str]] = {
    "classroom50": "dh_grader.formats.documents:CLASSROOM50",
    "csv": "dh_grader.formats.documents:CSV",
    "github": "dh_grader.formats.documents:GITHUB",
    "gradebook": "dh_grader.formats.documents:GRADEBOOK",
    "gradescope": "dh_grader.formats.documents:GRADESCOPE",
    "html": "dh_grader.formats.documents:HTML",
    "json": "dh_grader.formats.documents:JSON",
    "jsonl": "dh_grader.formats.documents:JSONL",
    "junit": "dh_grader.formats.documents:JUNIT",
    "markdown": "dh_grader.formats.documents:MARKDOWN",
    "prairielearn": "dh_grader.formats.documents:PRAIRIELEARN",
    "text": "dh_grader.formats.terminal:TEXT",
}
FORMAT_NAMES: Final[tuple[str, ...]] = tuple(_FORMATS)


def report_format(name: str) -> ReportFormat:
    """Return the format of this name, one of ``FORMAT_NAMES``."""
    found: ReportFormat = resolve_name(_FORMATS[name])
    return found
