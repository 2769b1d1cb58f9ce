"""Split a script in MATLAB or Python into statements and calls."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final

from service.grids.cutting.grid import Grid, GridError
from service.grids.cutting.limits import GRID_LIMITS
from service.grids.cutting.pairs import CLOSES, split, strict_pairs
from service.grids.cutting.source_text import SourceText, joined
from service.grids.scripts.program_text import without_remarks
from service.grids.scripts.session import without_prompts
from service.regex import regex
from service.translations import say

_ENDS: Final = ";,\n\r\x85\u2028\u2029"
# Lines that begin or end a block comment: %{ and %} in MATLAB, triple quotes in Python.
_BLOCK: Final = regex(r"[ \t]*(%\{|%\}|\"\"\"|''')?")
_CALL: Final = regex(r"(?:[A-Za-z_]\w{0,60}\.){0,4}([A-Za-z_]\w{0,60})[ \t]*\(")
_SHOWN: Final = 40
# Blanks other than those of ASCII and the ends of lines: web pages have them in programs.
_BLANK: Final = regex(r"[^\S\x00-\x20\x85\u2028\u2029]")


@dataclass(frozen=True, slots=True)
class RobotTable:
    """The DH table of a robot, and the convention that the script names: standard or modified.

    With ``has_headers``, the first row contains headers. Otherwise the columns are a, α, d, θ.
    """

    grid: Grid
    convention: str | None = None
    has_headers: bool = False


def statements(source: SourceText) -> list[SourceText]:
    """Return the statements of a script in order, without comments.

    Raises GridError for unbalanced brackets, and for too many brackets.
    """
    # Brackets may span several lines.
    source = replace(source, text=_BLANK.sub(" ", source.text))
    plain = without_remarks(_without_blocks(without_prompts(source)))
    if sum(map(plain.text.count, CLOSES)) > GRID_LIMITS.separators:
        raise unread_script(
            say(
                "This script has more than {most:,} brackets. Paste only its links.",
                most=GRID_LIMITS.separators,
            ),
            source,
        )
    pieces = (piece.strip() for piece in split(plain, _ENDS))
    return [piece for piece in pieces if piece.text]


def _without_blocks(source: SourceText) -> SourceText:
    """Return the text without block comments."""
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
            rest = line.text.partition(found)[2]
            closer = "%}" if found == "%{" else found
            closer = "" if closer in rest else closer
        else:
            yield line
        yield line.cut(0, 0).spelled("\n")


def split_call(source: SourceText) -> tuple[str, SourceText] | None:
    """Return a function's name and the text of its arguments; None if the text is not one call.

    Raises GridError for unbalanced brackets.
    """
    # Module names before the function's name, as in ``rtb.RevoluteDH(…)``, are left out.
    call = _CALL.match(source.text)
    if call is None or strict_pairs(source)[call.end() - 1] != len(source.text):
        return None
    return call[1], source.cut(call.end(), len(source.text) - 1)


def arguments(inside: SourceText) -> list[SourceText]:
    """Return the arguments of a call, or the elements of a list."""
    pieces = (piece.strip() for piece in split(inside, ","))
    return [piece for piece in pieces if piece.text]


def unread_script(message: str, source: SourceText) -> GridError:
    """Return the error for a script whose DH table is not certain."""
    return GridError("unread_script", message, source.whole)


def excerpt(source: SourceText) -> str:
    """Return the beginning of a piece of a script, to quote it in a message."""
    text = " ".join("".join(c if c.isprintable() else " " for c in source.text).split())
    return text if len(text) <= _SHOWN else text[: _SHOWN - 1] + "…"
