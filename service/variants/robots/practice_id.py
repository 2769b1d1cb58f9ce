"""The ids of generated robots: ``practice-2-modified~k3f9``."""

from dataclasses import dataclass, replace
from typing import Final

from service.kinematics.dh import Convention
from service.regex import regex
from service.variants.robots.level import LEVELS

_DIGITS: Final = "0123456789abcdefghijklmnopqrstuvwxyz"
_LONGEST: Final = 8
_ID: Final = regex(
    rf"practice-(\d)-({'|'.join(Convention)})~(0|[1-9a-z][0-9a-z]{{0,{_LONGEST - 1}}})"
)
# Every seed below is a robot's number.
ALL_NUMBERS: Final = 36**_LONGEST


@dataclass(frozen=True, slots=True)
class PracticeId:
    """The id of a generated robot: a level, a convention and a number."""

    # Both conventions have the same robots.

    level: int
    convention: Convention
    number: int

    @property
    def seed(self) -> str:
        """The number of the robot in base 36 (digits 0 to 9 and a to z)."""
        digits, left = "", self.number
        while left or not digits:
            left, digit = divmod(left, len(_DIGITS))
            digits = _DIGITS[digit] + digits
        return digits

    @property
    def exercise(self) -> str:
        """The id without the number of the robot."""
        return f"practice-{self.level}-{self.convention.value}"

    def __str__(self) -> str:
        return f"{self.exercise}~{self.seed}"

    def following(self, steps: int = 1) -> "PracticeId":
        """Return the id of the robot whose number is greater by ``steps``."""
        # After the last robot comes the first.
        return replace(self, number=(self.number + steps) % ALL_NUMBERS)


def practice_id(text: str) -> PracticeId | None:
    """Return the parts of a robot's id; None if the text is not the id of a robot.

    >>> practice_id("practice-2-modified~1a")
    PracticeId(level=2, convention=<Convention.MODIFIED: 'modified'>, number=46)
    """
    found = _ID.fullmatch(text)
    if found is None or int(found[1]) not in LEVELS:
        return None
    return PracticeId(int(found[1]), Convention(found[2]), int(found[3], len(_DIGITS)))
