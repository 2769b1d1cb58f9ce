r"""Matrices drawn over several lines: SymPy's and Octave's ⎡…⎤, Maxima's [ … ], MATLAB's / … \.

A row is one line, followed by an empty line of the drawing. A matrix whose cells take several lines
(powers, fractions) is refused.
"""

import re
from itertools import pairwise
from typing import Final

from service.grids.cutting.grid import Grid, GridError, GridFormat, grid
from service.grids.cutting.pairs import outside
from service.grids.cutting.source_text import SourceText
from service.grids.scripts.program_text import TAIL, after_names
from service.regex import regex
from service.translations import say

_PIECES: Final = frozenset("⎡⎢⎣⎤⎥⎦⎛⎜⎝⎞⎟⎠⎧⎨⎩⎫⎬⎭")
_LEFT: Final = "⎡⎢⎣⎛⎜⎝[/|\\"
_RIGHT: Final = "⎤⎥⎦⎞⎟⎠]\\|/"
# An empty line of the drawing: [    ].
_SPACER: Final = regex(r"^[ \t]*\[[ \t]+\][ \t]*\r?$", re.MULTILINE)
_SLASHES: Final = regex(r"^[ \t]*/[^\n]*\\[ \t]*\r?\n[ \t]*\|", re.MULTILINE)
_GAP: Final = regex(r"[ \t]{2,}")


def _matches(text: str) -> bool:
    if not _PIECES.isdisjoint(text):
        return True
    return _SPACER.search(text) is not None or _SLASHES.search(text) is not None


def _parse(source: SourceText) -> Grid:
    drawing = source.cut(after_names(source.text), len(source.text)).strip(TAIL)
    lines = [line for line in map(SourceText.strip, drawing.lines()) if line.text]
    rows: list[SourceText | None] = []
    for line in lines:
        inner = line.cut(1, len(line.text) - 1).strip()
        if line.text[0] not in _LEFT or line.text[-1] not in _RIGHT or len(line.text) < 2:
            raise _refusal(line)
        if not _PIECES.isdisjoint(inner.text):
            raise _refusal(line)
        rows.append(inner if inner.text else None)
    for above, row in pairwise(rows):
        if above and row:
            raise _refusal(row)
    cells = [_cells(row) for row in rows if row]
    if len(set(map(len, cells))) > 1:
        raise _refusal(lines[0])
    return grid("drawn matrix", cells, source.whole)


def _cells(row: SourceText) -> list[SourceText]:
    """Split a row at commas, or at two or more blanks if it has no comma."""
    commas = [*outside(row.text, ",")]
    if not commas:
        return row.split(_GAP)
    return [row.cut(a + 1, b) for a, b in pairwise([-1, *commas, len(row.text)])]


def _refusal(line: SourceText) -> GridError:
    return GridError(
        "drawn_matrix",
        say(
            "This drawn matrix cannot be read safely. Paste it as one line of text or as "
            "LaTeX, as print(T) or latex(T) in SymPy give it."
        ),
        line.whole,
    )


FORMAT: Final = GridFormat(_matches, _parse)
