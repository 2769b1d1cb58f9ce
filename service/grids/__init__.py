"""Pasted text -> a grid of cells, each with its place in the text as pasted.

Knows nothing of robots, and of expressions only spans, errors and the names of functions.
"""

from service.grids.given_values import ASSIGNMENT
from service.grids.grid import Grid, GridCell, GridError
from service.grids.limits import GRID_LIMITS, GridLimits
from service.grids.registry import FORMATS, read_grid, read_robot
from service.grids.robot_table import RobotTable
from service.grids.several import NamedGrid, read_grids
from service.grids.source_text import SourceText

__all__ = [
    "ASSIGNMENT",
    "FORMATS",
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
]
