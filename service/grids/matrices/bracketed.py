"""Matrices in brackets: MATLAB's, and lists of lists from Python, NumPy, SymPy and JSON."""

from typing import Final

from service.expressions.errors import Note
from service.grids.cutting.grid import Grid, GridError, GridFormat, grid
from service.grids.cutting.pairs import outside, pairs
from service.grids.cutting.source_text import SourceText
from service.grids.matrices import lists, matlab
from service.grids.scripts.program_text import begins_as_matrix, text_around, unwrap
from service.translations import say

# Functions of MATLAB that may enclose a matrix; "" if there is none.
_MATLAB_FUNCTIONS: Final = frozenset({"", "sym", "simplify"})


def _lines(source: SourceText) -> list[SourceText]:
    """Return the texts in round brackets if each line is one row in them: ``(l1, 0, 0, q1)``."""
    lines = [line for each in source.lines() if (line := each.strip(" \t,;")).text]
    inner = [line.cut(1, len(line.text) - 1) for line in lines]
    for line, row in zip(lines, inner, strict=True):
        if line.text[0] != "(" or pairs(line.text).get(0) != len(line.text):
            return []
        if not any(True for _ in outside(row.text, ",")):
            return []
    return inner if len(inner) > 1 else []


def _matches(text: str) -> bool:
    return begins_as_matrix(text) or bool(_lines(SourceText.of(text)))


def _parse(source: SourceText) -> Grid:
    if in_brackets := _lines(source):
        return grid("brackets", lists.rows(in_brackets), source.whole)
    matrix = unwrap(source)
    notes: tuple[Note, ...] = ()
    if len(matrix.groups) == 1:
        [content] = matrix.groups
        lines = lists.lines_of(content)
        if lines is not None:
            rows = lists.rows(lines)
        elif matrix.maker not in _MATLAB_FUNCTIONS and ";" not in content.text:
            rows = lists.flat(content, matrix)
        else:
            rows, notes = matlab.rows(content)
    else:
        # MATLAB prints each row of a symbolic matrix in brackets.
        for group in matrix.groups:
            if any(letter in ";\n" for letter in group.text):
                raise text_around(matrix.groups[1])
        rows = lists.rows(list(matrix.groups))
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
                    say(
                        "Values with names (JSON objects, dictionaries) are not read from pasted "
                        "text; paste a list of rows, or a table with a header line."
                    ),
                    inner.whole,
                )


FORMAT: Final = GridFormat(_matches, _parse)
