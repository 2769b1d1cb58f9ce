"""The limits on the size of a pasted text."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class GridLimits:
    """Limits for one pasted text."""

    # ``rows`` allows twelve rows and a header, ``matrices`` the halves of twelve screw axes.
    # ``separators`` bounds the number of commas, bars, tabs, line ends and the like in the text,
    # including those between empty cells of a spreadsheet. The length of a cell is bounded by the
    # reader of expressions.

    characters: int = 26 * 1024
    rows: int = 13
    columns: int = 12
    matrices: int = 24
    separators: int = 1024


GRID_LIMITS = GridLimits()
