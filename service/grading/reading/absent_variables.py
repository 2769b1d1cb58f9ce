"""Names of joint variables that a robot does not have, such as theta0.

A cell with such a name is wrong, but not unreadable.
"""

# Students write them if they count the joints from 0, or revolute and prismatic joints separately.
# theta3 is absent if joint 3 slides.

from collections.abc import Iterator
from functools import lru_cache
from typing import Final

from service.expressions import Symbol, Vocabulary

_LETTERS: Final = "thetad"
# Larger than every joint number, so that no shorthand (such as c1) means an absent variable.
_FIRST_ABSENT_JOINT: Final = 1000


@lru_cache(maxsize=256)
def with_absent_variables(vocabulary: Vocabulary) -> Vocabulary:
    """Add the usual joint variables that the robot does not have to the vocabulary."""
    # They are counted from 0.
    # Names such as ``d2`` are added only if some joint slides; otherwise they are unknown lengths.
    if not vocabulary.joints:
        return vocabulary
    indices = range(vocabulary.joints[-1] + 1)
    absent = [symbol for index in indices for symbol in _absent(index, vocabulary)]
    return Vocabulary([*vocabulary.symbols, *absent], decimal_comma=vocabulary.decimal_comma)


def _absent(index: int, vocabulary: Vocabulary) -> Iterator[Symbol]:
    known = vocabulary.by_name
    others = [name for name in (f"th{index}", f"q{index}") if name not in known]
    if f"theta{index}" not in known:
        joint = _FIRST_ABSENT_JOINT + 2 * index
        yield Symbol(f"theta{index}", "angle", tuple(others), joint=joint)
    if vocabulary.sliding and f"d{index}" not in known:
        yield Symbol(f"d{index}", "length", joint=_FIRST_ABSENT_JOINT + 2 * index + 1)


def joint_counted(name: str) -> int:
    """Return the joint number in the name of an absent joint variable: 3 for theta3."""
    return int(name.lstrip(_LETTERS))
