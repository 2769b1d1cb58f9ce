"""Bounds on the cost of one pasted text, checked before the work that they bound."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class GridLimits:
    """Bounds on one pasted text. ``rows`` are twelve and a header.

    ``separators`` counts commas, bars, tabs, line ends and the like wherever they stand: a
    spreadsheet's empty cells are pasted along with the others.

    The reader of expressions bounds the length of a cell, for a long cell costs only itself.
    """

    characters: int = 26 * 1024
    rows: int = 13
    columns: int = 12
    separators: int = 1024


GRID_LIMITS = GridLimits()
