"""Tags and entities of HTML in a cell of Markdown: ``&theta;<sub>1</sub>`` is ``θ_{1}``."""

import re
from html import unescape
from typing import Final

from service.grids.cutting.source_text import SourceText, joined
from service.regex import regex

_MARKUP: Final = regex(
    r"<(?P<tag>su[bp])>(?P<inner>[^<>|]{1,20})</(?P=tag)>"
    r"|&(?:#\d{1,6}|#x[0-9a-f]{1,5}|[a-z]{1,12});",
    re.IGNORECASE,
)
_DEGREES: Final = frozenset({"o", "0", "°", "º"})


def without_tags(cell: SourceText) -> SourceText:
    """Return the cell with its tags and entities replaced by plain characters."""
    if "<" not in cell.text and "&" not in cell.text:
        return cell
    pieces, start = [], 0
    for found in _MARKUP.finditer(cell.text):
        whole = cell.cut(*found.span())
        pieces += [cell.cut(start, found.start()), whole.spelled(_plain(found))]
        start = found.end()
    return joined([*pieces, cell.cut(start, len(cell.text))], cell.at)


def _plain(found: re.Match[str]) -> str:
    if not found["tag"]:
        return unescape(found[0])
    inner = unescape(found["inner"]).strip()
    if found["tag"].lower() == "sub":
        return f"_{{{inner}}}"
    if inner in _DEGREES:
        return "°"
    return inner if inner == "*" else f"^({inner})"
