"""What one pasted text may cost, checked before the work that it bounds."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class GridLimits:
    """Bounds on one pasted text. ``rows`` are twelve and a header.

    ``separators`` counts commas, bars, tabs, line ends and the like wherever they stand: a
    spreadsheet's empty cells are pasted along with the others.

    How long a cell may be is for whoever reads it: one long cell costs only itself.
    """

    characters: int = 16 * 1024
    rows: int = 13
    columns: int = 12
    separators: int = 1024


GRID_LIMITS = GridLimits()
