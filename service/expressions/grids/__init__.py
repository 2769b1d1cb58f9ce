"""Pasted text -> a grid of cell texts that know where they were typed. Knows nothing of robots."""

from service.expressions.grids.grid import Cell, Grid, GridError
from service.expressions.grids.limits import GRID_LIMITS, GridLimits
from service.expressions.grids.registry import FORMATS, read_grid

__all__ = ["FORMATS", "GRID_LIMITS", "Cell", "Grid", "GridError", "GridLimits", "read_grid"]
