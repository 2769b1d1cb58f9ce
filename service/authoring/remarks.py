"""Remarks on a readable exercise file."""

from dataclasses import dataclass
from enum import StrEnum
from functools import partial


class Level(StrEnum):
    """The level of a remark: a failure must be fixed, a warning should be checked."""

    FAILED = "failed"
    WARNING = "warning"


@dataclass(frozen=True, slots=True)
class Remark:
    """A remark on a field of the file; ``field`` is empty if it is about the whole file."""

    level: Level
    field: str
    text: str


failed = partial(Remark, Level.FAILED)
warning = partial(Remark, Level.WARNING)
