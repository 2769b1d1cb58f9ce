"""Numbers with a decimal comma, for exercises that allow it: 1,5 is 1.5.

A semicolon separates arguments: atan2(1,5; 2).
"""

from typing import Final

from service.regex import regex

# A number with one comma. In 1,2,3 and in 1.5,2 a comma separates values.
_NUMBER: Final = regex(r"(?<![0-9A-Za-z_.])(?<![0-9],)([0-9]+),([0-9]+)(?![0-9]|[.,][0-9])")
# A semicolon between the arguments of a function.
_BETWEEN_ARGUMENTS: Final = regex(r";(?=[^();]*(?:\([^()]*\)[^();]*)*\))")


def with_points(text: str) -> str:
    """Replace each decimal comma by a point: 1,5 becomes 1.5. All other characters stay."""
    return _NUMBER.sub(r"\1.\2", text) if "," in text else text


def with_points_and_commas(text: str) -> str:
    """Replace decimal commas by points, and semicolons between arguments by commas."""
    text = with_points(text)
    return _BETWEEN_ARGUMENTS.sub(",", text) if ";" in text else text
