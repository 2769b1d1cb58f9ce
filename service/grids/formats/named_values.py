"""Rows whose values have names: ``Link 1: a = l1, alpha = 90°, d = 0, theta = q1``.

The values may also be below each other, as in YAML, or arguments: ``DH('a', l1, 'alpha', 0, …)``.
"""

import re
from itertools import islice
from typing import Final, NamedTuple

from service.grids.cutting.grid import Grid, GridFormat, grid
from service.grids.cutting.limits import GRID_LIMITS
from service.grids.cutting.pairs import pairs
from service.grids.cutting.source_text import SourceText
from service.grids.matrices.lists import unquoted
from service.grids.scripts.titles import UNIT

_COLUMNS: Final = ("a", "alpha", "d", "theta")
_LETTERS: Final = {"α": "alpha", "alfa": "alpha", "θ": "theta", "ϑ": "theta", "th": "theta"}
_NAME: Final = re.compile(
    r"(?<![\w\\^\"'.])(?<![\w^]\{)(?P<quote>['\"]?)\\?(?:var)?(?P<name>alpha|alfa|α|theta|th|θ|ϑ|a|d)"
    r"_?\{?(?P<number>[\d₀-₉]{0,2}|[ijᵢ])\}?(?P=quote)[ \t]{0,20}(?P<sign>[=:,])(?!=)"
)
# Marks that only style a text.
_STYLE: Final = re.compile(r"\\[()]|\*\*|[`$]")
# Signs of a list, of another name, or of an unclosed string.
_NOT_ONE: Final = re.compile(r"[=:'\"]|\A[\[{]|\A\Z")
# A word within a row that may be a value.
_LETTER: Final = re.compile(r"(?<!\w)\w{1,2}(?!\w)")
_STOP: Final = frozenset(",;\n\r|)]}")
_PADDING: Final = re.compile(r"[\s,;.:=→|()\[\]{}<>#*•·–—_-]+")
# Words before a name, or the label of a row: "Link 1", "2. Joint 2 (revolute)", "T1 = DH(".
_LABEL: Final = re.compile(
    r"(?:\d{1,2} (?=\D*\d))?(?:[^\W\d_]{1,20} ){0,3}(?:[^\W\d_]{0,20}(?P<number>\d{1,2}) )?"
    r"(?:[^\W\d_]{1,20} ){0,3}"
)
_SUBSCRIPTS: Final = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")


class _Item(NamedTuple):
    """A value with a name, such as ``a_1 = 0.4``."""

    name: str
    number: str
    label: str
    value: SourceText


def _items(source: SourceText) -> list[_Item]:
    text = _STYLE.sub(lambda mark: " " * len(mark[0]), source.text)
    source = SourceText(text, source.starts, source.ends, source.at)
    first = islice(_NAME.finditer(text), len(_COLUMNS) * GRID_LIMITS.rows + 1)
    names = [name for name in first if name["sign"] != "," or name["quote"]]
    following = [*(name.start() for name in names), len(text)][1:]
    found: list[_Item] = []
    ends, at = pairs(text), 0
    for name, end in zip(names, following, strict=True):
        gap = _PADDING.sub(" ", f"{text[at : name.start()]} ").lstrip()
        label = None if UNIT.search(gap) else _LABEL.fullmatch(gap)
        at = name.end()
        while at < end and text[at] not in _STOP:
            at = ends.get(at, at + 1)
        value = unquoted(source.cut(name.end(), at).strip())
        is_within = len(found) % len(_COLUMNS) > 0
        if label is None or _NOT_ONE.search(value.text) or (is_within and _LETTER.search(gap)):
            return []
        letter = _LETTERS.get(name["name"], name["name"])
        number = name["number"].translate(_SUBSCRIPTS)
        found.append(_Item(letter, number, label["number"] or "", value))
    return [] if _PADDING.sub("", text[at:]) else found


def _rows(source: SourceText) -> list[list[SourceText]]:
    items, size, nothing = _items(source), len(_COLUMNS), source.cut(0, 0)
    rows, numbers = [[nothing.spelled("i"), *map(nothing.spelled, _COLUMNS)]], []
    for group in (items[i : i + size] for i in range(0, len(items), size)):
        named = {item.name: item for item in group}
        if sorted(named) != sorted(_COLUMNS) or any(item.label for item in group[1:]):
            return []
        numbers.append(_number([named[column].number for column in _COLUMNS], group[0].label))
        label = group[0].value.cut(0, 0).spelled(numbers[-1] or "")
        rows.append([label, *(named[column].value for column in _COLUMNS)])
    is_numbered = all(numbers) and len(set(numbers)) == len(numbers)
    return rows if numbers and (is_numbered or set(numbers) == {""}) else []


def _number(indices: list[str], label: str) -> str | None:
    # Return the number of a row, "" if it has none; None if its label and indices disagree.
    # In the modified convention, the indices of a and alpha are one less.
    if not all(map(str.isdigit, indices)):
        return None if any(map(str.isdigit, indices)) else label
    a, alpha, d, theta = map(int, indices)
    is_row = a == alpha and d == theta and d - a in {0, 1} and label in {"", str(d)}
    return str(d) if is_row else None


def _parse(source: SourceText) -> Grid:
    return grid("names", _rows(source), source.whole)


FORMAT: Final = GridFormat(lambda text: bool(_rows(SourceText.of(text))), _parse)
