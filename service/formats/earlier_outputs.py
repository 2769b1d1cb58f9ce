"""Recognise what this program has written, and the worksheets of platforms, by their contents.

Tutors keep reports and worksheets in the folder of the submissions, so these files come back as
entries of the class. And an output may replace only an earlier output.
"""

import zipfile
from collections.abc import Sequence
from pathlib import Path, PurePosixPath
from typing import Final

from service.formats import FORMAT_NAMES, report_format
from service.formats.class_page import FEEDBACK, INDEX
from service.formats.worksheets import is_worksheet
from service.submissions.handed_in import MAX_START, ClassEntry
from service.submissions.office_files import UNREADABLE_ARCHIVE

# The file that lists what a run has written into a folder.
WRITTEN: Final = ".dh-grader-written"
_PAGE: Final = ".html"
_OVERVIEW: Final = b'content="DH Grader class overview"'
# The endings of the files that platforms call a worksheet or a gradebook.
_WORKSHEETS: Final = frozenset({".csv", ".tsv", ".txt", ".xls"})


def is_output(entry: ClassEntry) -> bool:
    """True if an entry of a class is an output or a worksheet, and no submission."""
    if start := entry.start(""):
        ending = PurePosixPath(entry.name).suffix.lower()
        if is_document(start) or (ending in _WORKSHEETS and is_worksheet(start)):
            return True
        if not start.startswith(b"PK"):
            return False
    names = entry.inside()
    return _is_written(names, entry) or _holds_pages(names, entry)


def _is_written(names: Sequence[str], entry: ClassEntry) -> bool:
    # A run may also have written a file into the folder of a student.
    if WRITTEN not in names:
        return False
    lines = entry.start(WRITTEN).decode(errors="replace").splitlines()
    return {name.partition("/")[0] for name in names} <= {
        WRITTEN,
        *(line.partition("/")[0] for line in lines),
    }


def _holds_pages(names: Sequence[str], entry: ClassEntry) -> bool:
    # A class page, feedback for Moodle, or only pages of students.
    if INDEX in names and _OVERVIEW in entry.start(INDEX)[:_HEAD]:
        return True
    if is_feedback(names):
        return True
    pages = [name for name in names if name.endswith(_PAGE)]
    return bool(pages) and pages == list(names) and is_document(entry.start(pages[0]))


_HEAD: Final = 1_000


def is_feedback(names: Sequence[str]) -> bool:
    """True if these are the names in a zip file of feedback for Moodle."""
    return bool(names) and all(name.endswith(f"/{FEEDBACK}") for name in names)


def is_document(start: bytes) -> bool:
    """True if a document of one of the report formats begins like this."""
    return any(report_format(name).mark.match(start) for name in FORMAT_NAMES)


def is_earlier_output(file: Path) -> bool:
    """True if the file is empty, or a document that this program has written. Raises OSError."""
    with file.open("rb") as opened:
        start = opened.read(MAX_START)
    if not start.strip() or is_document(start):
        return True
    try:
        with zipfile.ZipFile(file) as archive:
            return is_feedback(archive.namelist())
    except UNREADABLE_ARCHIVE:
        return False
