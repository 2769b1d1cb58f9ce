"""The template of a new exercise file."""

from pathlib import Path
from typing import Final

from service.catalogue import ID_ADVICE, is_exercise_id
from service.translations import say

_TEMPLATE: Final = Path(__file__).with_name("template.toml")
_SHOWN: Final = 60


class UnusableIdError(ValueError):
    """The text cannot be the id of an exercise."""

    def __init__(self, exercise_id: str) -> None:
        super().__init__(
            say(
                "{id!r} cannot be an exercise's id: {advice}",
                id=exercise_id[:_SHOWN],
                advice=ID_ADVICE,
            )
        )


def template(exercise_id: str, like: Path | None = None) -> str:
    """Return the text of a new exercise file, or a copy of the file ``like``.

    Raises UnusableIdError.
    """
    if not is_exercise_id(exercise_id):
        raise UnusableIdError(exercise_id)
    if like is not None:
        return like.read_text(encoding="utf-8")
    title = exercise_id.replace("-", " ").replace("_", " ").capitalize()
    return _TEMPLATE.read_text(encoding="utf-8").replace("TITLE", title, 1)
