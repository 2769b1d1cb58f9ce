"""The statements of a script in MATLAB or Python, without comments and prompts."""

import re
from collections.abc import Iterator
from typing import Final

from service.grids.cutting.grid import GridError
from service.grids.cutting.limits import GRID_LIMITS
from service.grids.cutting.pairs import CLOSES, split, strict_pairs
from service.grids.cutting.source_text import SourceText, joined
from service.grids.scripts.program_text import without_remarks
from service.grids.scripts.session import without_prompts

_ENDS: Final = ";,\n\r\x85\u2028\u2029"
# Lines that begin and end a comment of several lines: MATLAB's %{ and %}, a text of Python.
_BLOCK: Final = re.compile(r"[ \t]*(%\{|%\}|\"\"\"|''')?")
_CALL: Final = re.compile(r"(?:[A-Za-z_]\w{0,60}\.){0,4}([A-Za-z_]\w{0,60})[ \t]*\(")
_SHOWN: Final = 40


def statements(source: SourceText) -> list[SourceText]:
    """The statements, in the order in which they stand; brackets may run over several lines.

    Raises GridError for unbalanced brackets, and more of them than the links of an arm have.
    """
    plain = without_remarks(_without_blocks(without_prompts(source)))
    if sum(map(plain.text.count, CLOSES)) > GRID_LIMITS.separators:
        raise unread_script(
            f"This script has more than {GRID_LIMITS.separators:,} brackets. Paste only its links.",
            source,
        )
    pieces = (piece.strip() for piece in split(plain, _ENDS))
    return [piece for piece in pieces if piece.text]


def _without_blocks(source: SourceText) -> SourceText:
    """The text without comments of several lines."""
    if not any(mark in source.text for mark in ("%{", '"""', "'''")):
        return source
    return joined(_outside_blocks(source), source.at)


def _outside_blocks(source: SourceText) -> Iterator[SourceText]:
    closer = ""
    for line in source.lines():
        mark = _BLOCK.match(line.text)
        found = (mark and mark[1]) or ""
        if closer:
            closer = "" if closer in line.text else closer
        elif found and found != "%}":
            behind = line.text.partition(found)[2]
            closer = "%}" if found == "%{" else found
            closer = "" if closer in behind else closer
        else:
            yield line
        yield line.cut(0, 0).spelled("\n")


def called(source: SourceText) -> tuple[str, SourceText] | None:
    """The name of a function and the text of its arguments, where the text is one call of it.

    Names in front of the function's are left out: ``rtb.RevoluteDH(…)``. Raises GridError for
    unbalanced brackets.
    """
    call = _CALL.match(source.text)
    if call is None or strict_pairs(source)[call.end() - 1] != len(source.text):
        return None
    return call[1], source.cut(call.end(), len(source.text) - 1)


def arguments(inside: SourceText) -> list[SourceText]:
    """The arguments of a call, or what stands in a list."""
    pieces = (piece.strip() for piece in split(inside, ","))
    return [piece for piece in pieces if piece.text]


def unread_script(message: str, source: SourceText) -> GridError:
    """The error for a script whose table is not certain."""
    return GridError("unread_script", message, source.whole)


def shown(source: SourceText) -> str:
    """The beginning of a piece of a script, so that it can be quoted in a message."""
    text = " ".join("".join(c if c.isprintable() else " " for c in source.text).split())
    return text if len(text) <= _SHOWN else text[: _SHOWN - 1] + "…"
