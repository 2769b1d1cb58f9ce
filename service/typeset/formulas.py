"""Formulas and matrices of formulas in MathML, from text that the program reads itself."""

import re
from html import escape
from typing import Final

from service.expressions import Expression, ExpressionError, Symbol, Vocabulary, read
from service.expressions.printing.mathml import row
from service.expressions.vocabulary.functions import RESERVED
from service.grids import GridError, read_grid
from service.typeset.names import typeset

# A matrix with more entries is shown as text.
_MOST_ENTRIES: Final = 64
# The e of 1e-3 is no name.
_NAME: Final = re.compile(
    r"(?:(?<![0-9.])|(?![eE][-+]?[0-9]))[A-Za-z][A-Za-z0-9]*(?:_[A-Za-z0-9]+)*"
)


def formula(text: str) -> str:
    """Return a formula in any names as HTML with MathML, or as text if it is unreadable."""
    try:
        return f"<math>{row(_read(text).tree)}</math>"
    except (ExpressionError, ValueError):
        return escape(text)


def matrix(text: str, name: str = "") -> str | None:
    """Return a matrix in brackets as HTML with MathML, or None if the text is none.

    A line is a row, with commas between the entries; other forms of a pasted matrix are read, too.
    ``name`` is what the matrix equals.
    """
    try:
        rows = [[row(_read(cell.text).tree) for cell in line] for line in read_grid(text).rows]
    except (ExpressionError, GridError, ValueError):
        return None
    if sum(map(len, rows)) > _MOST_ENTRIES or len(set(map(len, rows))) != 1:
        return None
    lines = "".join(f"<mtr>{''.join(map('<mtd>{}</mtd>'.format, each))}</mtr>" for each in rows)
    before = f"{typeset(name, {name})} = " if name else ""
    brackets = f'<mrow><mo>[</mo><mtable class="matrix">{lines}</mtable><mo>]</mo></mrow>'
    return f'<div class="display">{before}<math>{brackets}</math></div>\n'


def _read(text: str) -> Expression:
    """Read a formula in which every word that is no function, unit or constant is a name.

    Raises ExpressionError, or ValueError if two names differ only in their underscores.
    """
    found = sorted(set(_NAME.findall(text)) - RESERVED)
    return read(text, Vocabulary([Symbol(name, "number") for name in found]), repairs=False)
