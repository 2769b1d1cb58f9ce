"""A new exercise file to start from."""

import re
from pathlib import Path
from typing import Final

_TEMPLATE: Final = Path(__file__).with_name("template.toml")
_ID: Final = re.compile(r"[a-z][a-z0-9]*(?:[-_][a-z0-9]+)*")
_LONGEST: Final = 60


class UnusableIdError(ValueError):
    """A text that cannot be the id of an exercise."""

    def __init__(self, exercise_id: str) -> None:
        super().__init__(
            f"{exercise_id[:_LONGEST]!r} cannot be an exercise's id: write small letters and "
            f"digits, with - or _ between them, such as elbow-arm"
        )


def template(exercise_id: str) -> str:
    """The text of a new exercise file, with comments; it passes every check as it is.

    Raises UnusableIdError: the id becomes the file's name and a part of web addresses.
    """
    if not _ID.fullmatch(exercise_id) or len(exercise_id) > _LONGEST:
        raise UnusableIdError(exercise_id)
    title = exercise_id.replace("-", " ").replace("_", " ").capitalize()
    return _TEMPLATE.read_text(encoding="utf-8").replace("TITLE", title, 1)
