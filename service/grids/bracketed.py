"""Matrices in brackets: MATLAB's, and lists of lists from Python, NumPy, SymPy and JSON."""

from typing import Final

from service.expressions.errors import Note
from service.grids import lists, matlab
from service.grids.grid import Grid, GridError, GridFormat, grid
from service.grids.program_text import begins_as_matrix, text_around, unwrap
from service.grids.source_text import SourceText

# Functions of MATLAB, or of both, and no function at all.
_OF_MATLAB: Final = frozenset({"", "sym", "simplify"})


def _parse(source: SourceText) -> Grid:
    written = unwrap(source)
    notes: tuple[Note, ...] = ()
    if len(written.groups) == 1:
        [content] = written.groups
        lines = lists.lines_of(content)
        if lines is not None:
            rows = lists.rows(lines)
        elif written.maker not in _OF_MATLAB and ";" not in content.text:
            rows = lists.flat(content, written)
        else:
            rows, notes = matlab.rows(content)
    else:
        # print() of MATLAB's symbolic matrices: each row in brackets of its own.
        for group in written.groups:
            if any(letter in ";\n" for letter in group.text):
                raise text_around(written.groups[1])
        rows = lists.rows(list(written.groups))
    _refuse_objects(rows)
    unquoted = [[lists.unquoted(cell.strip()) for cell in row] for row in rows]
    return grid("brackets", unquoted, source.whole, notes)


def _refuse_objects(rows: list[list[SourceText]]) -> None:
    for row in rows:
        for cell in row:
            inner = cell.strip()
            if inner.text.startswith(("{", '"', "'")) and ":" in inner.text:
                raise GridError(
                    "named_values",
                    "Values with names (JSON objects, dictionaries) are not read from pasted "
                    "text; paste a list of rows, or a table with a header line.",
                    inner.whole,
                )


FORMAT: Final = GridFormat("brackets", begins_as_matrix, _parse)
