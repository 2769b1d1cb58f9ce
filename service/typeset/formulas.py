"""Formulas and matrices in MathML, made from plain text."""

from collections.abc import Iterator
from html import escape
from typing import Final

from service.expressions import Expression, ExpressionError, Symbol, Vocabulary, read
from service.expressions.printing.mathml import row
from service.expressions.printing.text import to_text
from service.expressions.tree import Binary, Node
from service.expressions.vocabulary.functions import RESERVED
from service.grids import GridError, read_grid
from service.regex import regex
from service.typeset.names import typeset

# In characters of plain text; with more, a formula is too wide for a phone.
_LONGEST_TERM: Final = 36
# A matrix with more entries is shown as text.
_MOST_ENTRIES: Final = 64
# The e of 1e-3 is no name.
_NAME: Final = regex(r"(?:(?<![0-9.])|(?![eE][-+]?[0-9]))[A-Za-z][A-Za-z0-9]*(?:_[A-Za-z0-9]+)*")


def formula(text: str) -> str:
    """Return a formula as HTML with MathML, or as text if it is unreadable."""
    # Every word may be a name. Browsers do not break a formula into lines. So each term of a sum
    # becomes a separate formula, and a long term becomes text.
    try:
        tree = _read(text).tree
    except (ExpressionError, ValueError):
        return escape(text)
    return " ".join(reversed(list(_terms(tree))))


def _terms(tree: Node) -> Iterator[str]:
    """Yield the terms of a sum with their signs, the last term first."""
    while isinstance(tree, Binary) and tree.operator in "+-":
        sign = "−" if tree.operator == "-" else "+"
        last = tree.right
        if to_text(last)[0] == "-" or (isinstance(last, Binary) and last.operator in "+-"):
            # It needs brackets, which the printer sets.
            break
        yield _term(last, sign)
        tree = tree.left
    yield _term(tree)


def _term(tree: Node, sign: str = "") -> str:
    text = to_text(tree)
    if len(text) > _LONGEST_TERM:
        return f"{sign} {typeset(text.replace('*', ' ⋅ '), _names(text))}".lstrip()
    before = f'<mo form="infix">{sign}</mo>' if sign else ""
    return f"<math>{before}{row(tree)}</math>"


def matrix(text: str, name: str = "") -> str | None:
    """Return a matrix in brackets as HTML with MathML, or None if the text is not a matrix.

    Each line of the text is a row, with commas between the entries. ``name`` is shown before the
    matrix.
    """
    # Other forms of a pasted matrix are read, too.
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
    # Read a formula in which every word that is no function, unit or constant is a name.
    # Raises ExpressionError, or ValueError if two names differ only in their underscores.
    symbols = [Symbol(name, "number") for name in sorted(_names(text))]
    return read(text, Vocabulary(symbols), repairs=False)


def _names(text: str) -> set[str]:
    return set(_NAME.findall(text)) - RESERVED
