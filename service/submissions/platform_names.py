"""The names that learning platforms give to what they download, and the student in them.

Moodle (``mod/assign/classes/downloader.php``, earlier ``mod/assign/locallib.php``) writes
``Ada Byron_1234_assignsubmission_file`` as the name of a folder, with another ``_`` in older
versions, or before the name of a file. Canvas (``lib/content_zipper.rb``) writes
``byronada_LATE_1234_56789_`` before the name of a file; a text that was typed there is
``byronada_1234_text.html``, an address ``byronada_1234_link.html``, and where students are
anonymous ``anon_x7Gh2`` stands for the name and the number.
"""

import re
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Final

_MOODLE: Final = re.compile(
    r"(?P<student>.+?)_(?P<id>\d+)_assignsubmission_[a-z]+(?:_(?P<file>.*))?"
)
# Canvas leaves letters, digits and _ of a name; marks of many scripts are letters there.
_CANVAS: Final = re.compile(
    r"(?:(?P<student>[^\s.,()-]+?)_)??(?:LATE_)?(?P<id>\d{2,}|anon_[A-Za-z0-9]+)"
    r"_(?:\d{3,}_(?P<file>.+)|(?P<entry>(?:text|link)(?:-\d+)?\.html))"
)
# A second download of one file, or a second hand-in: ``table-1.csv``, ``table (1).csv``.
_COPY: Final = re.compile(r"(?:-\d+| ?\(\d+\))$")


@dataclass(frozen=True, slots=True)
class PlatformName:
    """A name in its pieces.

    ``student`` is unique; ``learner`` is the one that the platform's gradebook has; ``file`` is the
    student's own name of the file, empty for a folder.
    """

    student: str
    learner: str
    file: str


def platform_name(name: str) -> PlatformName | None:
    """The pieces of a name that a platform has given; None for any other."""
    if found := _MOODLE.fullmatch(name):
        # Moodle's grading worksheet has this in the column "Identifier".
        learner = f"Participant {found['id']}"
        return PlatformName(f"{found['student']}_{found['id']}", learner, found["file"] or "")
    found = _CANVAS.fullmatch(name)
    if found is None or (found["student"] is None) == found["id"].isdigit():
        return None
    student = "_".join(filter(None, (found["student"], found["id"])))
    return PlatformName(student, found["id"], found["file"] or found["entry"])


def without_copy_number(stem: str) -> str:
    """The name that a file had before it was a copy: ``table`` of ``table (1)``."""
    return _COPY.sub("", stem)


def student_and_part(name: str, parts: Collection[str]) -> tuple[str, str] | None:
    """The student and the part in ``STUDENT.PART.csv``, where PART is one of ``parts``.

    The name of a student may have dots, that of a part has none.
    """
    student, _, part = PurePosixPath(name).stem.rpartition(".")
    part = without_copy_number(part).lower()
    return (student, part) if student and part in parts else None
