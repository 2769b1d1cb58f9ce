"""Read a pasted table or matrix as a grid of cells.

This package knows nothing about robots. The package imports only spans, errors and function names
from ``service.expressions``.
"""

from service.grids.cutting.grid import Grid, GridCell, GridError
from service.grids.cutting.limits import GRID_LIMITS, GridLimits
from service.grids.cutting.source_text import SourceText
from service.grids.registry import FORMATS, FULL_WIDTH, read_grid, read_robot
from service.grids.scripts.given_values import ASSIGNMENT, without_tuples
from service.grids.scripts.script import RobotTable
from service.grids.several import NamedGrid, read_grids

__all__ = [
    "ASSIGNMENT",
    "FORMATS",
    "FULL_WIDTH",
    "GRID_LIMITS",
    "Grid",
    "GridCell",
    "GridError",
    "GridLimits",
    "NamedGrid",
    "RobotTable",
    "SourceText",
    "read_grid",
    "read_grids",
    "read_robot",
    "without_tuples",
]
