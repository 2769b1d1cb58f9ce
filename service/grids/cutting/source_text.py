"""A piece of text that knows where each of its characters was typed."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Final

from service.expressions.errors import Span
from service.regex import regex

_LINE_END: Final = regex("\r\n|[\r\n\x85\u2028\u2029]")


@dataclass(frozen=True, slots=True)
class SourceText:
    """A piece of text, and the position [start, end) of each character in the typed text.

    ``at`` is the position of an empty piece. ``typed`` is the whole typed text.
    """

    text: str
    starts: Sequence[int]
    ends: Sequence[int]
    at: int = 0
    typed: str = ""

    @staticmethod
    def of(source: str) -> "SourceText":
        """Return the whole ``source`` as a piece."""
        return SourceText(source, range(len(source)), range(1, len(source) + 1), typed=source)

    def cut(self, start: int, end: int) -> "SourceText":
        """Return the characters [start, end) as a piece."""
        if start == 0 and end == len(self.text):
            return self
        return SourceText(
            self.text[start:end],
            self.starts[start:end],
            self.ends[start:end],
            self.span(start)[0],
            self.typed,
        )

    def span(self, start: int = 0, end: int | None = None) -> Span:
        """Return where the characters [start, end) are in the typed text."""
        length = len(self.text)
        start = min(max(start, 0), length)
        stop = start if end is None else min(max(end, start), length)
        if start < stop:
            return self.starts[start], self.ends[stop - 1]
        if start < length:
            return self.starts[start], self.starts[start]
        at = self.ends[-1] if length else self.at
        return at, at

    @property
    def whole(self) -> Span:
        """The position of the piece in the typed text."""
        return self.span(0, len(self.text))

    @property
    def line_number(self) -> int:
        """The number of the line of the typed text in which the piece begins, as editors count."""
        return line_number(self.typed, self.whole[0])

    def strip(self, letters: str | None = None) -> "SourceText":
        """Return the piece without blanks (or ``letters``) at either end."""
        left = len(self.text) - len(self.text.lstrip(letters))
        return self.cut(left, max(left, len(self.text.rstrip(letters))))

    def lines(self) -> list["SourceText"]:
        """Return the lines without their line ends."""
        return self.split(_LINE_END)

    def split(self, separator: re.Pattern[str]) -> list["SourceText"]:
        """Return the pieces before, between and after all matches of ``separator``."""
        pieces, start = [], 0
        for match in separator.finditer(self.text):
            pieces.append(self.cut(start, match.start()))
            start = match.end()
        return [*pieces, self.cut(start, len(self.text))]

    def spelled(self, text: str) -> "SourceText":
        """Return a copy of the piece with this ``text``, at the same position."""
        # Each of its characters has the place of this whole piece.
        start, end = self.whole
        return SourceText(text, (start,) * len(text), (end,) * len(text), start, self.typed)


def line_number(typed: str, place: int) -> int:
    """Return the number of the line with the character ``place``. The first line is 1."""
    return 1 + sum(1 for _ in _LINE_END.finditer(typed, 0, place))


def joined(pieces: Iterable[SourceText], at: int) -> SourceText:
    """Join the pieces into one. ``at`` is the position of an empty result."""
    kept = [piece for piece in pieces if piece.text]
    if len(kept) == 1:
        return kept[0]
    return SourceText(
        "".join(piece.text for piece in kept),
        [*chain.from_iterable(piece.starts for piece in kept)],
        [*chain.from_iterable(piece.ends for piece in kept)],
        at,
        kept[0].typed if kept else "",
    )
