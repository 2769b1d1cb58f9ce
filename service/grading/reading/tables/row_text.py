"""Split the text of one DH row into its cells; recognize answers such as "none"."""

import re
from collections.abc import Mapping
from itertools import accumulate
from typing import Final, NamedTuple

from service.grading.reading.tables.column_headers import QUANTITIES, named_parameter

_LONGEST: Final = 2_000
# A name before = or a colon, with or without an index: a, \alpha_1, θ₁.
_NAMED: Final = re.compile(
    r"(?<![^\s,;({\[$|&])(\\?[A-Za-z\u0370-\u03ff⍺]+)(?:_?\{?[0-9]\}?|_\{?i\}?|[₀-₉])?\s{0,8}[=:]"
)
_BETWEEN: Final = re.compile(r"(?:[\s,;$|&]|\\[,;: ]|\\\\|\\quad|\\qquad|\band\b)+")
# The separators of rows in MATLAB, and of lines.
_ENDS: Final = re.compile(r"[;\n]")
# Four values separated by blanks only: a sign with blanks on both sides is an operator.
_FOUR_VALUES: Final = re.compile(
    r"\s*(?:[-+]?[^\s,;=+*/^-](?:[^\s,;=]*[^\s,;=+*/^-])?(?:[ \t]+|\s*$)){4}"
)
_BLANK: Final = re.compile(r"[ \t](?=[^ \t])")
_STYLE: Final = re.compile(r"\\(?:text|textrm|textit|mathrm|mathit|operatorname)\s?\{([^{}]*)\}")
_NONE: Final = re.compile(
    r"none|n/a|no (?:dh )?row|there is (?:none|no row)|does(?: not|n't) exist|\{none: ?true\}"
)


class NamedCell(NamedTuple):
    """The text of a cell, and the place in the whole text where it begins."""

    text: str
    start: int


def named_cells(text: str) -> Mapping[str, NamedCell] | None:
    """Return the cells of a text such as ``a=3, d=2, theta=90deg, alpha=0`` by column.

    The order is free. Separators are commas, semicolons, blanks or line ends; a colon may replace
    ``=``. Return None for any other text, and an empty mapping if a parameter is named twice.
    """
    if len(text) > _LONGEST:
        return None
    names = list(_NAMED.finditer(text))
    if not names or text[: names[0].start()].strip(" \t\n([{$"):
        return None
    cells: dict[str, NamedCell] = {}
    ends = [name.start() for name in names[1:]] + [len(text)]
    for name, end in zip(names, ends, strict=True):
        named = named_parameter(name[1])
        if named is None:
            return None
        if named.column in cells:
            return {}
        cells[named.column] = _trimmed(text, name.end(), end)
    return cells


def _trimmed(text: str, start: int, end: int) -> NamedCell:
    """Return the text between two places, without the separators around it."""
    while leading := _BETWEEN.match(text, start, end):
        start = leading.end()
    value = text[start:end]
    for trailing in _BETWEEN.finditer(value):
        if trailing.end() == len(value):
            value = value[: trailing.start()]
            break
    return NamedCell(value, start)


def in_one_line(text: str) -> str:
    """Return the text of a row with commas between its values and without outer round brackets.

    No character moves, so that spans stay valid.
    """
    if len(text) > _LONGEST:
        return text
    first, last = len(text) - len(text.lstrip()), len(text.rstrip())
    if _is_enclosed(text[first:last]):
        text = f"{text[:first]} {text[first + 1 : last - 1]} {text[last:]}"
    if "," not in text and len(_ENDS.findall(text.strip())) == len(QUANTITIES) - 1:
        return text[:first] + _ENDS.sub(",", text[first:last]) + text[last:]
    if _FOUR_VALUES.fullmatch(text):
        return text[:first] + _BLANK.sub(",", text[first:last]) + text[last:]
    return text


def _is_enclosed(text: str) -> bool:
    """True if the last character closes the first bracket."""
    if not (text.startswith("(") and text.endswith(")")):
        return False
    depths = accumulate({"(": 1, ")": -1}.get(sign, 0) for sign in text[:-1])
    return min(depths) > 0


def says_none(text: str) -> bool:
    r"""True if the text says that there is no row: none, n/a, \text{none}."""
    if len(text) > _LONGEST:
        return False
    plain = _STYLE.sub(r"\1", text)
    plain = "".join(sign for sign in plain if sign not in "$\"'“”").strip().rstrip(".!").lower()
    return _NONE.fullmatch(" ".join(plain.split())) is not None
