"""The names that learning platforms give to what they download, and the student in them.

Moodle writes ``Ada Lovelace_1234_assignsubmission_file_`` as the name of a folder, or before the
name of a file; Canvas writes ``lovelaceada_LATE_1234_56789_`` before the name of a file.
"""

import re
from dataclasses import dataclass
from typing import Final

_MOODLE: Final = re.compile(r"(?P<student>.+?)_(?P<id>\d+)_assignsubmission_[a-z]+_(?P<file>.*)")
_CANVAS: Final = re.compile(r"(?P<student>[^_]+)_(?:LATE_)?(?P<id>\d{2,})_\d{3,}_(?P<file>.+)")


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
    elif found := _CANVAS.fullmatch(name):
        learner = found["id"]
    else:
        return None
    return PlatformName(f"{found['student']}_{found['id']}", learner, found["file"])
