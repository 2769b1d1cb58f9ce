"""Undo the rounding in robot files and tables: 1.5708 becomes π/2."""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from dh_grader.kinematics import Numbers
from dh_grader.translations import Sentence, say

# Numbers are snapped before any common normal is computed: two axes that should be parallel and are
# 0.000004 rad apart have a common normal kilometres away.


STEP: Final = math.radians(15)
NEAR: Final = 1e-4
_FEWEST_DECIMALS: Final = 2
_LENGTH_DECIMALS: Final = 5
# Smaller changes are errors of floating-point numbers, not of a file.
_LEAST_SNAP: Final = 1e-12


def snapped_angle(value: float, decimals: int = 0) -> float:
    """Return an angle in radians; a rounded multiple of 15° becomes exact.

    ``decimals`` is the number of decimals with which the angle was written in radians, or 0.

    >>> snapped_angle(1.57, 2) == math.pi / 2, snapped_angle(0.7847, 4)
    (True, 0.7847)
    """
    return _multiple(value) if is_multiple(value, decimals) else value


def is_multiple(value: float, decimals: int = 0) -> bool:
    """True if an angle in radians is a multiple of 15°, exact or rounded."""
    # A number is a rounded multiple if it is within 1e-4 of the multiple. A number with two or more
    # decimals is also a rounded multiple if it equals the multiple, rounded to the same number of
    # decimals.
    multiple = _multiple(value)
    rounded = round(multiple, decimals) if decimals >= _FEWEST_DECIMALS else multiple
    return abs(value - multiple) <= NEAR or abs(value - rounded) < _LEAST_SNAP


def _multiple(value: float) -> float:
    return round(value / STEP) * STEP


def decimals_of(text: str) -> int:
    """Return the number of decimals of a written number; 0 for a number such as 1e-3."""
    return len(text.partition(".")[2]) if "e" not in text.lower() else 0


def snapped_length(value: float) -> float:
    """Return a length in metres, rounded to 0.01 mm."""
    return round(value, _LENGTH_DECIMALS)


def snapped_direction(direction: Numbers) -> Numbers:
    """Return a unit vector in which entries near 0 are exactly 0."""
    kept = np.where(np.abs(direction) <= NEAR, 0.0, direction)
    return np.asarray(kept / np.linalg.norm(kept))


class Snaps:
    """The numbers that were changed, one by one, as remarks for the author."""

    def __init__(self) -> None:
        self.remarks: list[Sentence] = []

    def angle(self, place: str, value: float, written: str = "") -> float:
        """Return the snapped angle. ``written`` is its text in radians, if it was written so."""
        snapped = snapped_angle(value, decimals_of(written))
        self._note(place, value - snapped, written or angle_text(value), angle_text(snapped))
        return snapped

    def length(self, place: str, written: str) -> float:
        """Return the snapped length."""
        value = float(written)
        snapped = snapped_length(value)
        self._note(place, value - snapped, written, exact_text(snapped))
        return snapped

    def direction(self, place: str, direction: Numbers) -> Numbers:
        """Return the snapped direction."""
        snapped = snapped_direction(direction)
        change = float(np.abs(snapped - direction).max())
        self._note(place, change, _vector(direction), _vector(snapped))
        return snapped

    def _note(self, place: str, change: float, written: str, value: str) -> None:
        if abs(change) > _LEAST_SNAP and written != value:
            self.remarks.append(
                say("{place}: {written} became {value}.", place=place, written=written, value=value)
            )


def _vector(numbers: Sequence[float] | Numbers) -> str:
    return f"({', '.join(map(exact_text, numbers))})"


# Write numbers into statements and tables of exercise files.


def number_text(value: float) -> str:
    """Return a number with at most six decimals, for a statement.

    >>> number_text(-0.4250000001), number_text(-1e-12)
    ('-0.425', '0')
    """
    return _text(value, 6)


def exact_text(value: float) -> str:
    """Return a number with at most twelve decimals, for a table.

    >>> exact_text(0.12345678), exact_text(131.2 * 0.001)
    ('0.12345678', '0.1312')
    """
    return _text(value, 12)


def _text(value: float, decimals: int) -> str:
    text = f"{value:.{decimals}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def angle_text(angle: float) -> str:
    """Return an angle in degrees, for a table.

    >>> angle_text(math.pi / 2), angle_text(-1e-15)
    ('90deg', '0')
    """
    # The rounding error is less than 1e-12 rad.
    text = _text(math.degrees(angle), 10)
    return text if text == "0" else f"{text}deg"
