"""The stack of open brackets while a text is read."""

from typing import Final

from service.expressions.characters.unicode import CLOSE, OPEN
from service.expressions.errors import Span, UnreadableError
from service.expressions.limits import LIMITS
from service.regex import regex

PARTNERS: Final = {"(": ")", "[": "]", "{": "}", "|": "|", OPEN: CLOSE}
_ROUND: Final = regex("[()]")
# The token index of redundant braces around round brackets, which have no token.
WRAPPING: Final = -1


class Brackets:
    """A stack of opening brackets, each with its position in the text as typed."""

    __slots__ = ("opened",)

    def __init__(self) -> None:
        self.opened: list[tuple[str, Span, int]] = []

    def open(self, bracket: str, span: Span, token: int) -> None:
        """Add an opening bracket, which is the token at index ``token``.

        Raises UnreadableError if the bracket is nested too deep.
        """
        if len(self.opened) >= LIMITS.depth:
            raise UnreadableError("beyond", span, limit="depth")
        self.opened.append((bracket, span, token))

    def close(self, bracket: str, span: Span) -> int | None:
        """Close the innermost bracket; return its token's index, or None if no bracket is open.

        Raises UnreadableError if ``bracket`` does not fit the innermost bracket.
        """
        if not self.opened:
            return None
        opener, place, token = self.opened.pop()
        if PARTNERS[opener] != bracket:
            raise UnreadableError("mismatch", span, opener=place, wanted=PARTNERS[opener])
        return token

    def in_bars(self) -> bool:
        """True if the innermost bracket is a bar, as in |x|."""
        return bool(self.opened) and self.opened[-1][0] == "|"


def partners(text: str) -> dict[int, int]:
    """Map the position of each opening round bracket to that of its closing bracket, if any."""
    found: dict[int, int] = {}
    opened: list[int] = []
    for match in _ROUND.finditer(text):
        if match.group() == "(":
            opened.append(match.start())
        elif opened:
            found[opened.pop()] = match.start()
    return found
