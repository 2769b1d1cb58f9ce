"""Undo the rounding in robot files: 1.5708 becomes π/2."""

# Numbers are snapped before any common normal is computed: two axes that should be parallel and are
# 0.000004 rad apart have a common normal kilometres away.

import math
from typing import Final

import numpy as np

from service.kinematics.transforms import Numbers

STEP: Final = math.radians(15)
NEAR: Final = 1e-4
_FEWEST_DECIMALS: Final = 2
_LENGTH_DECIMALS: Final = 5


def snapped_angle(text: str) -> float:
    """Return an angle in radians; a rounded multiple of 15° becomes exact.

    >>> snapped_angle("1.57") == math.pi / 2, snapped_angle("1.6")
    (True, 1.6)
    """
    # A number is a rounded multiple if it is within 1e-4 of the multiple. A number with two or more
    # decimals is also a rounded multiple if it equals the multiple, rounded to the same number of
    # decimals.
    value = float(text)
    multiple = round(value / STEP) * STEP
    decimals = len(text.partition(".")[2]) if "e" not in text.lower() else 0
    rounded = decimals >= _FEWEST_DECIMALS and round(multiple, decimals) == value
    return multiple if rounded or abs(value - multiple) <= NEAR else value


def snapped_length(text: str) -> float:
    """Return a length in metres, rounded to 0.01 mm."""
    return round(float(text), _LENGTH_DECIMALS)


def snapped_direction(direction: Numbers) -> Numbers:
    """Return a unit vector in which entries near 0 are exactly 0."""
    kept = np.where(np.abs(direction) <= NEAR, 0.0, direction)
    return np.asarray(kept / np.linalg.norm(kept))
