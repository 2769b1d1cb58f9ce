r"""Names of a script for symbols with other names: ``t1 = symbols('theta1')``.

The symbols are those of the exercise, so each name is replaced by its symbol wherever it stands.
Declarations without another name, such as ``q1, q2 = symbols('q1 q2')``, are left to the readers.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from service.grids.cutting.grid import GridError
from service.grids.cutting.source_text import SourceText, joined
from service.regex import regex
from service.translations import say

_NAME: Final = r"[A-Za-z_θα]\w{0,30}"
_DECLARES: Final = regex(
    rf"(?:^|(?<=;))[ \t]{{0,40}}(?:>>>?[ \t]?|In ?\[\d{{1,4}}\]: ?)?"
    rf"(?P<statement>\(?(?P<names>{_NAME}(?:[ \t]{{0,4}},[ \t]{{0,4}}{_NAME}){{0,23}})"
    r"[ \t]{0,4},?\)?[ \t]{0,8}=[ \t]{0,8}"
    r"(?:\w{1,20}\.){0,2}(?P<function>(?:dynamic)?symbols|Symbol|var|sym)"
    r"\([ \t]{0,4}[rRuU]?(?P<quote>['\"])(?P<symbols>[^'\"\n]{1,300})(?P=quote)"
    r"(?P<options>[^()\n]{0,100})\)[ \t]{0,40})(?=[;\r\n#%]|\Z)",
    re.MULTILINE,
)
# One of these is in the name of each function.
_FUNCTIONS: Final = ("ym", "var")
# A name in a formula, perhaps with an index. Names of arguments, and names in strings and comments,
# are no symbols.
_USE: Final = regex(
    r"(?<![\w)\]}'])'[^'\n]*'|\"[^\"\n]*\"|[#%][^\n]*"
    rf"|(?<![\w.\\])(?P<name>{_NAME})(?!\w)(?!\s{{0,4}}=(?!=))(?P<index>\[\s?\d{{1,2}}\s?\])?"
)
# A numbered list of symbols in SymPy: q1:4 is q1, q2, q3, and q:3 is q0, q1, q2.
_RANGE: Final = regex(r"(?P<stem>[^\W\d]\w*?)(?P<first>\d{0,2}):(?P<end>\d{1,2})")
_SYMBOL: Final = regex(r"\\{0,2}[^\W\d]\w{0,30}(?:\{\w{1,6}\})?")
_SIZE: Final = regex(r"\s*,\s*[\[\d]")
_MOST: Final = 60


def with_own_symbols(source: SourceText) -> SourceText:
    """Return a script with its symbols instead of other names for them.

    Raises GridError if it is not certain which symbol a name means.
    """
    if not any(word in source.text for word in _FUNCTIONS):
        return source
    declared = [each for each in _DECLARES.finditer(source.text) if _is_other(each)][:_MOST]
    if not declared:
        return source
    meant: dict[str, str] = {}
    for each in declared:
        for name, symbol in _meanings(source, each):
            if meant.setdefault(name, symbol) != symbol:
                raise _uncertain(source, each)
    pieces, start = [], 0
    for each in declared:
        pieces += [source.cut(start, each.start("statement"))]
        start = each.end("statement")
    pieces.append(source.cut(start, len(source.text)))
    return joined([named for piece in pieces for named in _renamed(piece, meant)], source.at)


def _is_other(declaration: re.Match[str]) -> bool:
    # True if a name has another symbol than itself.
    # In MATLAB, sym('q', [1 3]) is the vector of q1, q2, q3.
    is_vector = _SIZE.match(declaration["options"]) is not None
    return not is_vector and _names(declaration) != _symbols(declaration)


def _names(declaration: re.Match[str]) -> list[str]:
    return [name.strip() for name in declaration["names"].split(",")]


def _symbols(declaration: re.Match[str]) -> list[str]:
    written = declaration["symbols"]
    if declaration["function"] in {"Symbol", "sym"}:
        return [written.strip()]
    words = re.split(r"[\s,]+", written.strip(" ,"))
    return [symbol for word in words for symbol in _numbered(word)]


def _numbered(word: str) -> list[str]:
    numbers = _RANGE.fullmatch(word.replace("(", "").replace(")", ""))
    if numbers is None:
        return [word]
    first = int(numbers["first"] or 0)
    return [f"{numbers['stem']}{i}" for i in range(first, int(numbers["end"]))]


def _meanings(source: SourceText, declaration: re.Match[str]) -> Iterator[tuple[str, str]]:
    names, symbols = _names(declaration), _symbols(declaration)
    if not all(map(_SYMBOL.fullmatch, symbols)):
        raise _uncertain(source, declaration)
    symbols = [symbol.replace("\\\\", "\\") for symbol in symbols]
    if len(names) == 1 and len(symbols) > 1:
        # The name of a tuple, whose indices count from 0.
        yield from ((f"{names[0]}[{i}]", symbol) for i, symbol in enumerate(symbols))
    elif len(names) == len(symbols):
        yield from zip(names, symbols, strict=True)
    else:
        raise _uncertain(source, declaration)


def _renamed(piece: SourceText, meant: Mapping[str, str]) -> Sequence[SourceText]:
    found, start = [], 0
    for use in _USE.finditer(piece.text):
        name = use["name"] or ""
        index = "".join((use["index"] or "").split())
        symbol = meant.get(name + index)
        end = use.end()
        if symbol is None and name in meant:
            symbol, end = meant[name], use.end("name")
        if symbol is not None:
            found += [piece.cut(start, use.start()), piece.cut(use.start(), end).spelled(symbol)]
            start = end
    return [*found, piece.cut(start, len(piece.text))]


def _uncertain(source: SourceText, declaration: re.Match[str]) -> GridError:
    line = source.cut(*declaration.span("statement")).strip()
    message = say(
        "`{line}` gives symbols other names in a way that is not followed here. Write the symbols "
        "of the exercise into the table or matrix itself.",
        line=line.text[:60],
    )
    return GridError("given_value", message, line.whole)
