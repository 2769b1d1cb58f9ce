"""MATLAB rows without brackets: each line ends with a semicolon."""

from typing import Final

from service.grids.cutting.grid import Grid, GridFormat, grid
from service.grids.cutting.source_text import SourceText
from service.grids.matrices import matlab


def _matches(text: str) -> bool:
    lines = [line.strip() for line in text.strip().splitlines() if line.strip()]
    inside = any(";" in line[:-1] for line in lines)
    return len(lines) > 1 and not inside and all(line.endswith(";") for line in lines[:-1])


def _parse(source: SourceText) -> Grid:
    rows, notes = matlab.rows(source)
    return grid("rows with semicolons", rows, source.whole, notes)


FORMAT: Final = GridFormat(_matches, _parse)
