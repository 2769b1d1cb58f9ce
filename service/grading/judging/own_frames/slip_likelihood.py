"""Which of several slips is the likelier one, where each of them alone explains a wrong table.

On parallel axes, and around sliding joints, one slip can often be mended in another cell than the
one that it was made in. What speaks for a mend then: that the right value is a simple one, and that
the slip is of a kind that students make: a sign, a value forgotten, a quarter turn, something added
that does not belong there, a joint variable missing or misplaced.
"""

import numpy as np

from service.grading.comparison import difference
from service.grading.formula_text import multiples
from service.grading.part import Grading
from service.grading.samples import HALF
from service.kinematics.transforms import Numbers

# Far below a wrong cell, and so that a slip of no kind weighs less than a frame that was moved.
TERM = 0.002
NO_KNOWN_SLIP = 0.010
SAME = 1e-6

# How many terms a constant counts for that is no sum of letters and a number.
UNRELATED = 4


def unlikelihood(written: Numbers | None, right: Numbers, angle: bool, grading: Grading) -> float:
    """What speaks against a slip that wrote one constant ``(SAMPLES,)`` for another; 0 is least.

    ``written`` is None where the cell moved otherwise than it should, or could not be read: there
    the joint variable is what was mistaken.
    """
    meant = _terms(right, angle, grading)
    simple = TERM * _count(meant)
    if written is None or _is_turn(written, right, angle):
        return simple
    found = _terms(written, angle, grading)
    if found == {} or _count(found) > _count(meant):
        return simple
    if found is not None and meant is not None and _sizes(found) == _sizes(meant):
        return simple
    return simple + NO_KNOWN_SLIP


def _is_turn(written: Numbers, right: Numbers, angle: bool) -> bool:
    """Whether an angle is off by a quarter turn or by half of one, or has the wrong sign."""
    if not angle:
        return False
    turns = [written - right + turn for turn in (np.pi / 2, np.pi, -np.pi / 2)]
    off = np.abs(difference(np.array([*turns, written + right]), np.zeros(1), angle)).max(axis=-1)
    return bool(off.min() < SAME)


# Letters with their multiples, a number under "".
_Terms = dict[str, float]


def _terms(constant: Numbers, angle: bool, grading: Grading) -> _Terms | None:
    """The sum that a student would write; quarter turns are left out. None where it is no such."""
    found = multiples(constant[:HALF], angle, grading.exercise, grading.samples)
    if found is None:
        return None
    letters, number = found
    if angle:
        number -= np.pi / 2 * round(number / (np.pi / 2))
    rest = {"": float(number)} if abs(number) > SAME else {}
    return {letter: float(share) for share, letter in letters} | rest


def _count(terms: _Terms | None) -> float:
    """How many terms a sum has; a letter counts as often as it is taken."""
    if terms is None:
        return UNRELATED
    return sum(abs(share) if letter else 1.0 for letter, share in terms.items())


def _sizes(terms: _Terms) -> dict[str, float]:
    """The terms without their signs."""
    return {letter: round(abs(share), 6) for letter, share in terms.items()}
