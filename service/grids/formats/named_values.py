"""Rows whose values have names: ``Link 1: a = l1, alpha = 90°, d = 0, theta = q1``.

The values may also be below each other, as in YAML, or arguments: ``DH('a', l1, 'alpha', 0, …)``.
"""

import re
from dataclasses import replace
from itertools import islice, pairwise
from typing import Final, NamedTuple

from service.grids.cutting.grid import Grid, GridFormat, grid
from service.grids.cutting.limits import GRID_LIMITS
from service.grids.cutting.once import once
from service.grids.cutting.pairs import outside, pairs
from service.grids.cutting.source_text import SourceText, joined
from service.grids.matrices.lists import unquoted
from service.grids.scripts.titles import UNIT
from service.regex import regex

_COLUMNS: Final = ("a", "alpha", "d", "theta")
_LETTERS: Final = {"α": "alpha", "alfa": "alpha", "θ": "theta", "ϑ": "theta", "th": "theta"}
_NAME: Final = regex(
    # What the name begins with comes first, because most characters of a text begin none.
    r"(?=['\"\\vaαtθϑd])(?<![\w\\^\"'.])(?<![\w^]\{)(?P<quote>['\"]?)\\?(?:var)?(?P<name>alpha|alfa|α|theta|th|θ|ϑ|a|d)"
    r"_?\{?(?P<number>[\d₀-₉]{0,2}|[ijᵢ])\}?(?P=quote)[ \t]{0,20}(?P<sign>[=:,])(?!=)"
)
# Marks that only style a text.
_STYLE: Final = regex(r"\\[()]|\*\*|[`$]")
# Signs of a list, of another name, or of an unclosed string.
_NOT_ONE: Final = regex(r"[=:'\"]|\A[\[{]|\A\Z")
# A word within a row that may be a value.
_LETTER: Final = regex(r"(?<!\w)\w{1,2}(?!\w)")
_STOP: Final = frozenset(",;\n\r|)]}")
_PADDING: Final = regex(r"[\s,;.:=→|()\[\]{}<>#*•·–—_-]+")
# Words before a name, or the label of a row: "Link 1", "2. Joint 2 (revolute)", "T1 = DH(".
_LABEL: Final = regex(
    r"(?:\d{1,2} (?=\D*\d))?(?:[^\W\d_]{1,20} ){0,3}(?:[^\W\d_]{0,20}(?P<number>\d{1,2}) )?"
    r"(?:[^\W\d_]{1,20} ){0,3}"
)
# A word between two values, and words before the next name: "0 and angle theta = q1".
_AND: Final = regex(
    r"(?:\A|\s)(?:and|und|y|et|with|mit|con|avec)(?:\s[^\W\d_]{3,20}){0,2}\s*\Z", re.IGNORECASE
)
# Words that change the parameter after them: "minus theta = q1".
_CHANGED: Final = regex(
    r"(?<!\w)(?:minus|plus|negative|half|twice|double|not|cos|sin|tan|menos|moins|nicht|halb|doppelt)"
    r"\s*\Z",
    re.IGNORECASE,
)
# Names before their values: (a, α, d, θ) = (l1, 0, 0, θ1).
_ONE: Final = r"\s{0,4}\\?(?:alpha|alfa|α|theta|th|θ|ϑ|a|d)_?\{?(?:[\d₀-₉]{0,2}|[ijᵢ])\}?\s{0,4}"
_GROUP: Final = regex(
    rf"[(\[](?P<names>{_ONE}(?:,{_ONE}){{3}})[)\]]\s{{0,4}}[=:]\s{{0,4}}(?=[(\[])"
)
_AFTER: Final = regex(r"[ \t]*(?:[,;.\r\n]|\Z)")
_COMMA: Final = regex(",")
_ORDINALS: Final = tuple(
    regex(rf"(?<!\w)(?:{words})\w{{0,4}}", re.IGNORECASE)
    for words in (
        "first|erst|primer|premi", "second|zweit|segund|deuxi", "third|dritt|tercer|troisi",
        "fourth|viert|cuart|quatri", "fifth|fünft|quint|cinqui", "sixth|sechst|sext|sixi",
    )
)  # fmt: skip
_SUBSCRIPTS: Final = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")


class _Item(NamedTuple):
    """A value with a name, such as ``a_1 = 0.4``."""

    name: str
    number: str
    label: str
    value: SourceText


def _spread(source: SourceText) -> SourceText:
    """Return the text with each name before its value, if groups of names are before values."""
    text, pieces, start = source.text, [], 0
    ends = pairs(text)
    for group in _GROUP.finditer(text):
        opened, end = group.end(), ends.get(group.end(), 0)
        inside = source.cut(opened + 1, end - 1)
        commas = [*outside(inside.text, ",")]
        names = source.cut(*group.span("names")).split(_COMMA)
        values = [inside.cut(a + 1, b) for a, b in pairwise([-1, *commas, len(inside.text)])]
        is_whole = start <= opened < end and _AFTER.match(text, end)
        if not is_whole or len(values) != len(names):
            return source
        pieces.append(source.cut(start, group.start()))
        for name, value in zip(names, values, strict=True):
            pieces += [name, name.spelled("="), value, name.spelled(",")]
        start = end
    return joined([*pieces, source.cut(start, len(text))], source.at)


def _items(source: SourceText) -> list[_Item]:
    text = _STYLE.sub(lambda mark: " " * len(mark[0]), source.text)
    source = _spread(replace(source, text=text))
    text = source.text
    first = islice(_NAME.finditer(text), len(_COLUMNS) * GRID_LIMITS.rows + 1)
    names = [name for name in first if name["sign"] != "," or name["quote"]]
    following = [*(name.start() for name in names), len(text)][1:]
    found: list[_Item] = []
    ends, at = pairs(text), 0
    for name, end in zip(names, following, strict=True):
        gap = _PADDING.sub(" ", f"{text[at : name.start()]} ").lstrip()
        gap = _AND.sub("", gap) if found else gap
        for i, ordinal in enumerate(_ORDINALS, 1):
            gap = ordinal.sub(str(i), gap)
        label = None if UNIT.search(gap) else _LABEL.fullmatch(gap)
        at = name.end()
        while at < end and text[at] not in _STOP:
            at = ends.get(at, at + 1)
        written = text[name.end() : at].rstrip(" \t.")
        if at == end < len(text):
            written = _AND.sub("", written)
        value = unquoted(source.cut(name.end(), name.end() + len(written)).strip())
        is_within = len(found) % len(_COLUMNS) > 0
        if _CHANGED.search(text, max(0, name.start() - 20), name.start()):
            return []
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


@once
def _matches(text: str) -> bool:
    return bool(_rows(SourceText.of(text)))


FORMAT: Final = GridFormat(_matches, _parse)
