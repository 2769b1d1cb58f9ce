"""Report formats for people and programs.

``documents/`` and ``platforms/`` have one file for each format, ``shared/`` helpers of several.
"""

from collections.abc import Mapping
from pkgutil import resolve_name
from typing import Final

from service.formats.shared.report_format import ReportFormat

# Where each format is. A format is imported when it is used: some need half a second.
_FORMATS: Final[Mapping[str, str]] = {
    "classroom50": "service.formats.platforms.classroom50:CLASSROOM50",
    "csv": "service.formats.documents.csv:CSV",
    "github": "service.formats.platforms.github:GITHUB",
    "gradebook": "service.formats.documents.gradebook:GRADEBOOK",
    "gradescope": "service.formats.platforms.gradescope:GRADESCOPE",
    "html": "service.formats.documents.html:HTML",
    "json": "service.formats.documents.json:JSON",
    "jsonl": "service.formats.documents.jsonl:JSONL",
    "junit": "service.formats.platforms.junit:JUNIT",
    "markdown": "service.formats.documents.markdown:MARKDOWN",
    "prairielearn": "service.formats.platforms.prairielearn:PRAIRIELEARN",
    "text": "service.formats.documents.text:TEXT",
}
FORMAT_NAMES: Final[tuple[str, ...]] = tuple(_FORMATS)


def report_format(name: str) -> ReportFormat:
    """Return the format of this name, one of ``FORMAT_NAMES``."""
    found: ReportFormat = resolve_name(_FORMATS[name])
    return found
