"""When two columns of numbers are the same answer.

Arrays are ``(..., samples)``; what is asked of them must hold at all samples.
"""

import math
from enum import IntEnum

import numpy as np
from numpy.typing import ArrayLike, NDArray

from service.grading.tolerances import EXACT_VALUE, ROUNDED_VALUE
from service.kinematics.tolerances import LARGEST_ANGLE, LARGEST_LENGTH
from service.kinematics.transforms import Numbers


class Match(IntEnum):
    """How an answer compares with what was expected."""

    DIFFERENT = 0
    UNDEFINED = 1
    ROUNDED = 2
    EXACT = 3


def difference(actual: Numbers, expected: Numbers, angle: ArrayLike = False) -> Numbers:
    """``actual − expected``; where ``angle`` (it broadcasts), turned into [−π, π] radians."""
    plain = actual - expected
    turns = np.where(angle, np.round(plain / (2 * np.pi)), 0.0)
    return plain - 2 * np.pi * turns


def matches(
    actual: Numbers,
    expected: Numbers,
    scale: ArrayLike,
    angle: ArrayLike = False,
    rounded: ArrayLike = True,
) -> NDArray[np.int_]:
    """The Match of each entry ``(...)``, from ``(..., samples)``.

    ``rounded`` says which entries may differ by what rounding to three figures does to a number of
    the entry's size, or of the largest size that the robot's own numbers have, if that is smaller:
    a student's own large offset must not widen what is let through.
    ``scale`` is the unit of the tolerance: 1 for angles and direction cosines, a typical length for
    lengths. It gives the tolerance an absolute floor, so that sin² + cos² − 1 is 0 every time; the
    floor is far too low for a wrong constant to hide beside a large entry.
    """
    with np.errstate(invalid="ignore", over="ignore"):
        error = np.abs(difference(actual, expected, angle)).max(axis=-1)
        size = np.sqrt(np.mean(expected * expected, axis=-1))
        largest = np.where(np.any(angle, axis=-1), LARGEST_ANGLE, LARGEST_LENGTH) * scale
        near = (error <= ROUNDED_VALUE * np.minimum(size, largest)) & rounded
        found = np.where(near, Match.ROUNDED, Match.DIFFERENT)
        found = np.where(error <= EXACT_VALUE * np.maximum(size, scale), Match.EXACT, found)
    return np.where(np.isfinite(actual).all(axis=-1), found, Match.UNDEFINED)


def same(actual: Numbers, expected: Numbers, scale: float = 1.0, angle: bool = False) -> bool:
    """Whether two single entries ``(samples,)`` are equal, or equal but for rounding.

    It asks the same as ``matches``, for a fifth of its cost.
    """
    error = actual - expected
    if angle:
        error -= 2 * np.pi * np.round(error / (2 * np.pi))
    size = math.sqrt(float(expected @ expected) / expected.size)
    largest = (LARGEST_ANGLE if angle else LARGEST_LENGTH) * scale
    tolerance = max(ROUNDED_VALUE * min(size, largest), EXACT_VALUE * max(size, scale))
    # NaN is not within any tolerance.
    return bool(np.abs(error).max() <= tolerance) and math.isfinite(size)
