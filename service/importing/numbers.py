"""Write numbers into statements and tables of exercise files."""

import math


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
