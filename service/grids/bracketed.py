"""Matrices in brackets: MATLAB's, and lists of lists from Python, NumPy, SymPy and JSON."""

from typing import Final

from service.expressions.errors import Note
from service.grids import lists, matlab
from service.grids.grid import Format, Grid, GridError, grid
from service.grids.program_text import looks_like_a_snippet, text_around, unwrap
from service.grids.source_text import Traced

# Functions of MATLAB, or of both, and no function at all.
_OF_MATLAB: Final = frozenset({"", "sym", "simplify"})


def _parse(source: Traced) -> Grid:
    snippet = unwrap(source)
    notes: tuple[Note, ...] = ()
    if len(snippet.groups) == 1:
        [content] = snippet.groups
        lines = lists.lines_of(content)
        if lines is not None:
            rows = lists.rows(lines)
        elif snippet.maker not in _OF_MATLAB and ";" not in content.text:
            rows = lists.flat(content, snippet)
        else:
            rows, notes = matlab.rows(content)
    else:
        # print() of MATLAB's symbolic matrices: each row in brackets of its own.
        for group in snippet.groups:
            if any(letter in ";\n" for letter in group.text):
                raise text_around(snippet.groups[1])
        rows = lists.rows(list(snippet.groups))
    _refuse_objects(rows)
    unquoted = [[lists.unquoted(cell.strip()) for cell in row] for row in rows]
    return grid("brackets", unquoted, source.whole, notes)


def _refuse_objects(rows: list[list[Traced]]) -> None:
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


FORMAT: Final = Format("brackets", looks_like_a_snippet, _parse)
