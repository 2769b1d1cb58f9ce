"""Find the likeliest of several mistakes that each explain a wrong table.

A mistake is likely if the correct value is simple, or if students often make it.
"""

# On parallel axes, and around prismatic joints, a mistake can often be repaired in several cells.
# Students often make a wrong sign, a forgotten value, a quarter turn, an extra term, a missing or
# misplaced joint variable.

import numpy as np

from service.grading.formula_text import multiples
from service.grading.numerics.comparison import difference
from service.grading.numerics.samples import HALF
from service.grading.numerics.tolerances import SAME_TERM
from service.grading.part import Grading
from service.kinematics.transforms import Numbers

# All these costs are far below that of a wrong cell; an unknown slip costs less than a moved frame.
TERM = 0.002
UNKNOWN_SLIP = 0.010

# The number of terms of a constant that is not a sum of letters and a number.
UNRELATED = 4


def slip_penalty(written: Numbers | None, right: Numbers, angle: bool, grading: Grading) -> float:
    """Return how unlikely it is to write one constant for another; at least 0.

    ``written`` is None if the cell is unreadable or depends wrongly on the joints.
    """
    # Then the mistake is in the joint variable.
    right_terms = _terms(right, angle, grading)
    penalty = TERM * _count(right_terms)
    if written is None or _is_turn(written, right, angle):
        return penalty
    terms = _terms(written, angle, grading)
    if terms == {} or _count(terms) > _count(right_terms):
        return penalty
    if terms is not None and right_terms is not None and _sizes(terms) == _sizes(right_terms):
        return penalty
    return penalty + UNKNOWN_SLIP


def _is_turn(written: Numbers, right: Numbers, angle: bool) -> bool:
    if not angle:
        return False
    turns = [written - right + turn for turn in (np.pi / 2, np.pi, -np.pi / 2)]
    error = np.abs(difference(np.array([*turns, written + right]), np.zeros(1), angle))
    return bool(error.max(axis=-1).min() < SAME_TERM)


# The multiple of each letter; the number has the key "".
_Terms = dict[str, float]


def _terms(constant: Numbers, angle: bool, grading: Grading) -> _Terms | None:
    # A sum of letters and a number; quarter turns are left out.
    found = multiples(constant[:HALF], angle, grading.exercise, grading.samples)
    if found is None:
        return None
    letters, number = found
    if angle:
        number -= np.pi / 2 * round(number / (np.pi / 2))
    rest = {"": float(number)} if abs(number) > SAME_TERM else {}
    return {letter: float(share) for share, letter in letters} | rest


def _count(terms: _Terms | None) -> float:
    # 2*l1 counts as two terms.
    if terms is None:
        return UNRELATED
    return sum(abs(share) if letter else 1.0 for letter, share in terms.items())


def _sizes(terms: _Terms) -> dict[str, float]:
    return {letter: round(abs(share), 6) for letter, share in terms.items()}
