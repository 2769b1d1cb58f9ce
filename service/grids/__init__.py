"""Pasted text -> a grid of cell texts that know where they were typed. Knows nothing of robots."""

from service.grids.grid import Grid, GridCell, GridError
from service.grids.limits import GRID_LIMITS, GridLimits
from service.grids.registry import FORMATS, read_grid

__all__ = ["FORMATS", "GRID_LIMITS", "Grid", "GridCell", "GridError", "GridLimits", "read_grid"]
