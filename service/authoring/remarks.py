"""The remarks on an exercise file that can be read."""

from dataclasses import dataclass
from enum import StrEnum


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


def failed(field: str, text: str) -> Remark:
    """Something that must be mended."""
    return Remark(Level.FAILED, field, text)


def warning(field: str, text: str) -> Remark:
    """Something that is worth a look."""
    return Remark(Level.WARNING, field, text)
