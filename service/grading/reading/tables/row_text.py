"""The text of one DH row -> its cells, by name or in order; or that there is no row."""

import re
from collections.abc import Mapping
from itertools import accumulate
from typing import Final, NamedTuple

from service.grading.reading.tables.column_headers import QUANTITIES, named_parameter

_LONGEST: Final = 2_000
# A name in front of = or a colon, with an index or without: a, \alpha_1, θ₁.
_NAMED: Final = re.compile(
    r"(?<![^\s,;({\[$|&])(\\?[A-Za-z\u0370-\u03ff⍺]+)(?:_?\{?[0-9]\}?|_\{?i\}?|[₀-₉])?\s{0,8}[=:]"
)
_BETWEEN: Final = re.compile(r"(?:[\s,;$|&]|\\[,;: ]|\\\\|\\quad|\\qquad|\band\b)+")
# The ends of MATLAB's rows and of lines.
_ENDS: Final = re.compile(r"[;\n]")
# Four values with nothing but blanks between them: a sign with blanks around it has two sides.
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
    """The cells of ``a=3, d=2, theta=90deg, alpha=0`` by column, in whatever order.

    Between them may stand commas, semicolons, blanks or the ends of lines; colons do for ``=``.
    None where the text is anything else. Nothing is in it where a parameter is named twice.
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
    """The text between two places, without what parts it from its neighbours."""
    while leading := _BETWEEN.match(text, start, end):
        start = leading.end()
    value = text[start:end]
    for trailing in _BETWEEN.finditer(value):
        if trailing.end() == len(value):
            value = value[: trailing.start()]
            break
    return NamedCell(value, start)


def in_one_line(text: str) -> str:
    """The text of a row with commas between its values, and without round brackets around it.

    No character moves, so that places in the text stay what they are.
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
    """Whether the first bracket is closed by the last character."""
    if not (text.startswith("(") and text.endswith(")")):
        return False
    depths = accumulate({"(": 1, ")": -1}.get(sign, 0) for sign in text[:-1])
    return min(depths) > 0


def says_none(text: str) -> bool:
    r"""Whether the text says that there is no row: none, n/a, \text{none}."""
    if len(text) > _LONGEST:
        return False
    plain = _STYLE.sub(r"\1", text)
    plain = "".join(sign for sign in plain if sign not in "$\"'“”").strip().rstrip(".!").lower()
    return _NONE.fullmatch(" ".join(plain.split())) is not None
