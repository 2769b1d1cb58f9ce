"""The names of files that learning platforms export, and the students in these names.

Moodle (``mod/assign/classes/downloader.php``, earlier ``mod/assign/locallib.php``) names a folder
``Ada Byron_1234_assignsubmission_file``, in older versions with another ``_`` at the end, or puts
the same text before the name of a file. Canvas (``lib/content_zipper.rb``) puts
``byronada_LATE_1234_56789_`` before the name of a file. A text that a student typed in Canvas has
the name ``byronada_1234_text.html``, and a web address has the name ``byronada_1234_link.html``.
For anonymous students, ``anon_x7Gh2`` replaces the name and the number. Brightspace names a folder
``75842-1234567 - Ada Byron - Oct 3, 2026 405 PM``, or puts this text and `` - `` before the name of
a file. Blackboard names a file ``HW1_abyron_attempt_2026-10-03-16-05-33_table.csv``.
"""

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Final

from service.regex import regex

_MOODLE: Final = regex(r"(?P<student>.+?)_(?P<id>\d+)_assignsubmission_[a-z]+(?:_(?P<file>.*))?")
# Canvas removes all but letters, digits and _ from a name; it keeps marks of many scripts.
_CANVAS: Final = regex(
    r"(?:(?P<student>[^\s.,()-]+?)_)??(?:LATE_)?(?P<id>\d{2,}|anon_[A-Za-z0-9]+)"
    r"_(?:\d{3,}_(?P<file>.+)|(?P<entry>(?:text|link)(?:-\d+)?\.html))"
)
# The date has a year, and no `` - ``.
_DATE: Final = r"(?:(?! - ).)*\d{4}(?:(?! - ).)*"
_BRIGHTSPACE: Final = regex(rf"(?P<id>\d+-\d+) ?- ?(?P<student>.+?) ?- {_DATE}(?: - (?P<file>.+))?")
# The text that a student typed has the name of the attempt, without a name of a file.
_BLACKBOARD: Final = regex(
    r"(?P<student>.+_(?P<user>[^_]+))_attempt_\d{4}(?:-\d\d){5}(?:_(?P<file>.+)|(?P<text>\.txt))"
)
# No file system takes a longer name; a zip file does.
_LONGEST: Final = 255
# The name of Blackboard's receipt of an attempt, which holds what the student typed.
RECEIPT: Final = "attempt.txt"
# The number of a second download or a resubmission: ``table-1.csv``, ``table (1).csv``.
_COPY: Final = regex(r"(?:-\d+| ?\(\d+\))$")


@dataclass(frozen=True, slots=True)
class PlatformName:
    """A file name that a learning platform has given, divided into its parts."""

    # Unique.
    student: str
    # The student in the platform's gradebook.
    learner: str
    # The student's own name of the file; empty for a folder.
    file: str
    # The name of the person; empty if the submission is anonymous.
    person: str


def platform_name(name: str) -> PlatformName | None:
    """Split a name that a learning platform has given; return None for other names."""
    if len(name) > _LONGEST:
        return None
    if found := _MOODLE.fullmatch(name):
        # Moodle's grading worksheet has this in the column "Identifier".
        learner = f"Participant {found['id']}"
        student = found["student"]
        return PlatformName(f"{student}_{found['id']}", learner, found["file"] or "", student)
    if found := _BRIGHTSPACE.fullmatch(name):
        student = found["student"]
        return PlatformName(f"{student}_{found['id']}", student, found["file"] or "", student)
    if found := _BLACKBOARD.fullmatch(name):
        user = found["user"]
        return PlatformName(found["student"], user, found["file"] or RECEIPT, user)
    found = _CANVAS.fullmatch(name)
    if found is None or (found["student"] is None) == found["id"].isdigit():
        return None
    student = "_".join(filter(None, (found["student"], found["id"])))
    person = found["student"] or ""
    return PlatformName(student, found["id"], found["file"] or found["entry"], person)


def without_copy_number(stem: str) -> str:
    """Return the name without the number of a copy: ``table`` for ``table (1)``."""
    return _COPY.sub("", stem)


def student_and_part(name: str, parts: Collection[str]) -> tuple[str, str] | None:
    """Split ``STUDENT.PART.csv`` into student and part; return None unless PART is in ``parts``."""
    student, _, part = PurePosixPath(name).stem.rpartition(".")
    part = without_copy_number(part).lower()
    # The name of a student may contain dots; the name of a part does not.
    return (student, part) if student and part in parts else None
