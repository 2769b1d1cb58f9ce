"""Equations whose left side is a name or empty: x = l1 c1, T(1,4) := l1 c1, = cos(q1).

Only the right side is read. The left side is replaced by blanks, so that the positions of the other
characters do not change.
"""

import re
from typing import Final, NamedTuple

from service.expressions.characters import greek
from service.expressions.errors import Note, Span
from service.expressions.parsing.lexing.words import split
from service.expressions.vocabulary.symbols import Vocabulary
from service.regex import regex
from service.translations import say

_STYLE: Final = r"\\(?:mathrm|mathbf|mathit|mathsf|text|boldsymbol|bm|vec)\s*"
_LETTERS: Final = rf"(?:\\?[A-Za-z]{{1,12}}[0-9]{{0,3}}|[{greek.CLASS}][0-9]{{0,3}})"
_SCRIPT: Final = r"[_^]\s*(?:\{[^{}=]{0,24}\}|\\?[A-Za-z0-9*]{1,12})"
_LEFT: Final = regex(
    rf"""
    (?: \$ | \s | \\[(\[,;:!] | \\q?quad(?![A-Za-z]) | \\begin\{{[a-z]+\*?\}} ){{0,8}}
    (?P<side>
      (?P<left>
        (?: (?:let|const|var|double|float|auto) \s++ )?
        (?: \{{\s*+\}}\s*+ )?
        (?: {_SCRIPT}\s*+ ){{0,2}}
        (?P<name> {_STYLE}\{{\s*{_LETTERS}\s*\}} | {_STYLE}[A-Za-z] | {_LETTERS} )?
        (?: \s*+{_SCRIPT} | [₀-₉]+ | ['’′*] | \.[A-Za-z]{{1,8}} ){{0,3}}
        (?P<brackets> (?: \s*+[(\[{{]\s*+[\w\s,:\\]{{1,32}}[)\]}}] ){{0,2}} )
      )
      \s*+ &? \s*+ (?: :?==? | ≔ | \\coloneqq(?![A-Za-z]) )
    )
    """,
    re.VERBOSE,
)
_EQUALS: Final = regex(r"=|≔|\\coloneqq(?![A-Za-z])|≈|≡|\\(?:approx|equiv)(?![A-Za-z])|[<>≤≥]")
_WORD: Final = regex(r"[A-Za-z]+[0-9]*")
# A name in brackets, which may be a factor of a product. The time, as in q1(t), is not a factor.
_OF_NAMES: Final = regex(r"[(\[{]\s*+(?!t\s*+\))[^0-9\s]")


class LeftSide(NamedTuple):
    """The name before an equals sign. ``span`` is the position of the name and the sign."""

    name: str
    span: Span


def left_side(source: str, vocabulary: Vocabulary) -> LeftSide | None:
    """Return the name before the equals sign of an equation; None for any other text."""
    if "=" not in source and "≔" not in source and r"\coloneqq" not in source:
        return None
    found = _LEFT.match(source)
    if found is None or _EQUALS.search(source, found.end()):
        return None
    if not source[found.end() :].strip(" $") or not _is_name(found, vocabulary):
        return None
    return LeftSide(" ".join(found["left"].split()), found.span("side"))


def right_side(source: str, vocabulary: Vocabulary) -> tuple[str, Note | None]:
    """Replace a name and its equals sign by blanks.

    Return the new text and a note on the change.
    """
    left = left_side(source, vocabulary)
    if left is None:
        return source, None
    start, end = left.span
    message = say("Only the right side of the equation was read.")
    return f"{source[:start]}{' ' * (end - start)}{source[end:]}", Note(
        "equation", message, left.span
    )


def _is_name(found: re.Match[str], vocabulary: Vocabulary) -> bool:
    """True if the left side is a name, not a function (cos) or a product (l1 (c1 + c2))."""
    words = _WORD.findall(found["name"] or "")
    pieces = split(words[-1], vocabulary) if words else None
    if pieces is None:
        return True
    return pieces[0].kind != "function" and not _OF_NAMES.search(found["brackets"])
