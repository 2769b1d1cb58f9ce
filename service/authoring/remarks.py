"""The remarks on an exercise file that can be read."""

from dataclasses import dataclass
from enum import StrEnum
from functools import partial


class Level(StrEnum):
    """A failure must be mended; a warning is worth a look."""

    FAILED = "failed"
    WARNING = "warning"


@dataclass(frozen=True, slots=True)
class Remark:
    """One remark on a field of the file; empty where it is about the whole."""

    level: Level
    field: str
    text: str


failed = partial(Remark, Level.FAILED)
warning = partial(Remark, Level.WARNING)
