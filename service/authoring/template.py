"""A new exercise file to start from."""

from pathlib import Path
from typing import Final

from service.catalogue import ID_ADVICE, is_exercise_id

_TEMPLATE: Final = Path(__file__).with_name("template.toml")
_SHOWN: Final = 60


class UnusableIdError(ValueError):
    """A text that cannot be the id of an exercise."""

    def __init__(self, exercise_id: str) -> None:
        super().__init__(f"{exercise_id[:_SHOWN]!r} cannot be an exercise's id: {ID_ADVICE}")


def template(exercise_id: str, like: Path | None = None) -> str:
    """The text of a new exercise file, with comments; it passes every check as it is.

    It is that of the file ``like``, where one is named. Raises UnusableIdError: the id becomes the
    file's name and a part of web addresses.
    """
    if not is_exercise_id(exercise_id):
        raise UnusableIdError(exercise_id)
    if like is not None:
        return like.read_text(encoding="utf-8")
    title = exercise_id.replace("-", " ").replace("_", " ").capitalize()
    return _TEMPLATE.read_text(encoding="utf-8").replace("TITLE", title, 1)
