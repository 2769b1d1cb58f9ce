"""Joint variables that a robot does not have: theta3 where joint 3 slides, theta0.

A student who counts the joints from 0, or the turning joints by themselves, writes them in a table.
They are names with one meaning, and wrong; not a text that cannot be read.
"""

from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import Final

from service.expressions import Expression, Symbol, Vocabulary
from service.grading.numerics.samples import Samples

_LETTERS: Final = "thetad"
# No joint has such an index, so that no shorthand names an absent variable.
_BEYOND: Final = 1000


@lru_cache(maxsize=256)
def with_absent_variables(vocabulary: Vocabulary) -> Vocabulary:
    """The vocabulary with the usual names of joints from 0 on, as far as they mean nothing in it.

    ``d2`` is such a name only where some joint slides: elsewhere it is an unknown length.
    """
    if not vocabulary.joints:
        return vocabulary
    indices = range(vocabulary.joints[-1] + 1)
    absent = [symbol for index in indices for symbol in _absent(index, vocabulary)]
    return Vocabulary([*vocabulary.symbols, *absent])


def _absent(index: int, vocabulary: Vocabulary) -> Iterator[Symbol]:
    known = vocabulary.by_name
    others = [name for name in (f"th{index}", f"q{index}") if name not in known]
    if f"theta{index}" not in known:
        joint = _BEYOND + 2 * index
        yield Symbol(f"theta{index}", "angle", tuple(others), joint=joint)
    if vocabulary.sliding and f"d{index}" not in known:
        yield Symbol(f"d{index}", "length", joint=_BEYOND + 2 * index + 1)


def joint_counted(name: str) -> int:
    """The number of the joint that the canonical name of such a variable counts, from 0 on."""
    return int(name.lstrip(_LETTERS))


def absent_names(expressions: Iterable[Expression | None], samples: Samples) -> set[str]:
    """The canonical names of the variables in the expressions that the robot does not have."""
    used: set[str] = set().union(*(each.symbols for each in expressions if each is not None))
    return used.difference(samples.values)
