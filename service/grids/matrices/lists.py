"""Lists of lists from Python, NumPy (also printed arrays), SymPy's Matrix([[…]]), and JSON."""

from typing import Final

from service.grids.cutting.blanks import split_blanks
from service.grids.cutting.grid import GridError, too_many_rows
from service.grids.cutting.limits import GRID_LIMITS
from service.grids.cutting.pairs import CLOSES, split, strict_pairs
from service.grids.cutting.source_text import SourceText, joined
from service.grids.scripts.program_text import WrittenMatrix
from service.regex import regex
from service.translations import say

_BETWEEN: Final = " \t\r\n,;"
# A character in UTF-16, of one or two units, or an escaped punctuation mark.
_ESCAPE: Final = regex(
    r"\\(?:(u[dD][89abAB][0-9A-Fa-f]{2}\\u[dD][c-fC-F][0-9A-Fa-f]{2}|u[0-9A-Fa-f]{4})|([\\\"'/]))"
)
_COLUMN_MAKERS: Final = frozenset({"Matrix", "ImmutableMatrix", "MutableDenseMatrix"})


def lines_of(content: SourceText) -> list[SourceText] | None:
    """Return the text in each inner bracket of a list of lists; None for any other text.

    Raises GridError for unbalanced brackets, and for too many brackets.
    """
    ends = strict_pairs(content)
    text = content.text
    lines: list[SourceText] = []
    i = 0
    while i < len(text):
        if text[i] in CLOSES:
            line = content.cut(i + 1, ends[i] - 1)
            # (a + b), (c + d) are values in round brackets; (a, b), (c, d) are rows.
            if text[i] == "(" and len(split(line, ",")) == 1:
                return None
            if len(lines) > GRID_LIMITS.rows:
                raise too_many_rows(content.whole)
            lines.append(line)
            i = ends[i]
        elif text[i] in _BETWEEN:
            i += 1
        else:
            return None
    return lines or None


def rows(lines: list[SourceText]) -> list[list[SourceText]]:
    """Split each line into values at commas, or at blanks if it has no comma.

    Raises GridError for a list of matrices.
    """
    found = []
    for line in lines:
        if line.text.lstrip()[:1] in {"[", "{"} and lines_of(line):
            message = say("This is a list of matrices or tables; paste one of them.")
            raise GridError("nested_too_deep", message, line.whole)
        found.append(_values(line))
    return found


def flat(content: SourceText, matrix: WrittenMatrix) -> list[list[SourceText]]:
    """Return the rows of a matrix made from a flat list, as by SymPy's ``Matrix(2, 2, […])``.

    Raises GridError if the number of values does not fit the shape.
    """
    # Without a shape, SymPy makes a column and NumPy a row.
    values = _values(content)
    if matrix.shape is None:
        return [[value] for value in values] if matrix.maker in _COLUMN_MAKERS else [values]
    height, width = matrix.shape
    if height * width != len(values):
        count = height * width
        message = say(
            "A {rows} × {columns} matrix has {number} values; yours has {found}.",
            rows=height,
            columns=width,
            number=count,
            found=len(values),
        )
        raise GridError("wrong_count", message, content.whole)
    return [values[i * width : (i + 1) * width] for i in range(height)]


def _values(line: SourceText) -> list[SourceText]:
    pieces = split(line, ",")
    if len(pieces) == 1:
        # NumPy prints its arrays with blanks.
        return list(split_blanks(line).elements)
    if not pieces[-1].text.strip():
        pieces.pop()
    return pieces


def unquoted(cell: SourceText) -> SourceText:
    """Return the cell without the quotation marks of a string, and with its escapes decoded."""
    # An escape that may begin a LaTeX command is not decoded: "\theta" stays \theta, though a
    # program would read a tab in it.
    quote = cell.text[:1]
    if quote not in {"'", '"'} or len(cell.text) < 2 or not cell.text.endswith(quote):
        return cell
    inner = cell.cut(1, len(cell.text) - 1)
    pieces: list[SourceText] = []
    start = 0
    for escape in _ESCAPE.finditer(inner.text):
        pieces.append(inner.cut(start, escape.start()))
        letter = _character(escape[1]) if escape[1] else escape[2]
        pieces.append(inner.cut(escape.start(), escape.end()).spelled(letter))
        start = escape.end()
    return joined([*pieces, inner.cut(start, len(inner.text))], inner.whole[0])


def _character(units: str) -> str:
    return bytes.fromhex(units.replace("\\", "").replace("u", "")).decode("utf-16-be", "replace")
