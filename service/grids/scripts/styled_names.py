r"""Remove the style of names before values: ``- **T** =``, ``\boxed{T = …}``, ``T matrix``."""

import re
from typing import Final

from service.grids.cutting.source_text import SourceText, joined
from service.regex import regex

_NAME: Final = r"\\?[^\W\d]\w{0,11}(?:\{\w{1,6}\})?"
# A bullet or bold type before a name and its sign; elsewhere "-" and "*" may belong to a value.
_STYLED: Final = regex(
    rf"^[ \t]*(?:[-*•‣◦][ \t]{{1,4}})?(?P<bold>\*\*|__)?(?P<name>{_NAME})[ \t]{{0,4}}"
    r"(?P<closed>(?P=bold))?[ \t]{0,4}(?P<sign>[=:])(?!=)(?P<open>(?P=bold))?"
    r"(?P<value>[^\n]*)",
    re.MULTILINE,
)
_BEGINS_VALUE: Final = regex(r"[*_\s]{0,8}(?:[\[(\\$]|\w{1,8}\.\w{1,8}\(|\Z)")
_BULLET: Final = regex(r"[ \t]*[-*•‣◦][ \t]")
_BOXED: Final = regex(
    r"^[ \t]*(?P<dollars>\${0,2})[ \t]*\\boxed[ \t]*\{(?P<inner>[^\n]*)\}[ \t]*(?P=dollars)[ \t]*$",
    re.MULTILINE,
)
# A matrix may begin on the line below its heading.
_MATRIX: Final = regex(
    r"^[ \t]*(?:(?:the|homogeneous|transformation|rotation)[ \t]){0,3}"
    r"(?:(?P<before>[A-Z]_?\w{0,5})[ \t]matrix|matrix[ \t](?P<after>[A-Z]_?\w{0,5}))"
    r"[ \t]*(?:\r?\n)?[ \t]*(?=\[|\\begin\{[bpv]?matrix\}|(?:\w{1,8}\.)?(?:array|[mM]atrix)\()",
    re.MULTILINE | re.IGNORECASE,
)


def without_styles(source: SourceText) -> SourceText:
    """Return the text with plain names: ``- **T** = [`` and ``T matrix [`` become ``T = [``."""
    return _named_matrices(_unstyled(_unboxed(source)))


def _unboxed(source: SourceText) -> SourceText:
    if "\\boxed" not in source.text:
        return source
    pieces, start = [], 0
    for box in _BOXED.finditer(source.text):
        inner = box["inner"]
        if "=" in inner and _is_balanced(inner):
            pieces += [source.cut(start, box.start()), source.cut(*box.span("inner"))]
            start = box.end()
    return joined([*pieces, source.cut(start, len(source.text))], source.at)


def _is_balanced(text: str) -> bool:
    depth = 0
    for letter in text:
        depth += (letter == "{") - (letter == "}")
        if depth < 0:
            return False
    return depth == 0


def _unstyled(source: SourceText) -> SourceText:
    pieces, start = [], 0
    for found in _STYLED.finditer(source.text):
        value = found.span("value")
        if found["sign"] == ":" and not _BEGINS_VALUE.match(found["value"]):
            # A sentence after its heading.
            continue
        if found["bold"]:
            if found["closed"] is None and found["open"] is None:
                # The whole line is bold.
                stripped = found["value"].rstrip()
                if not stripped.endswith(found["bold"]):
                    continue
                value = value[0], value[0] + len(stripped) - len(found["bold"])
        elif not _BULLET.match(found[0]):
            continue
        pieces += [source.cut(start, found.start()), source.cut(*found.span("name"))]
        pieces += [source.cut(*found.span("sign")), source.cut(*value)]
        start = found.end()
    return joined([*pieces, source.cut(start, len(source.text))], source.at) if pieces else source


def _named_matrices(source: SourceText) -> SourceText:
    pieces, start = [], 0
    for found in _MATRIX.finditer(source.text):
        name = source.cut(*found.span("before" if found["before"] else "after"))
        pieces += [source.cut(start, found.start()), name, name.spelled(" = ")]
        start = found.end()
    return joined([*pieces, source.cut(start, len(source.text))], source.at) if pieces else source
