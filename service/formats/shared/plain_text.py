"""Untrusted texts, and numbers, as short text that is safe to print."""

from collections.abc import Iterable, Iterator
from typing import Final

from service.regex import regex
from service.translations import say, told
from service.translations.sentence import Translation

# Builds read commands in the output of programs: GitHub `::` at the start of a line and `##[`
# anywhere, Azure `##vso[`, TeamCity `##teamcity[`. No formula has these signs twice in a row.
_COMMAND: Final = regex(r"(?<=([:#]))(?=\1)")
# Spaces at which no line breaks, as French has them before a colon. Python calls them unprintable.
_UNBROKEN: Final = "\u00a0\u202f"


def visible(text: str) -> str:
    """Return the text in one line, without invisible characters."""
    if not text.isprintable():
        text = "".join(
            c if c.isprintable() or c in _UNBROKEN else "\N{REPLACEMENT CHARACTER}" for c in text
        )
    return _COMMAND.sub(" ", text)


def code_pieces(text: str) -> list[tuple[str, bool]]:
    """Divide a text at its backticks; each piece has True if it is code."""
    pieces = visible(text).split("`")
    if len(pieces) % 2 == 0:
        # With an odd number of backticks, nothing is code.
        return [(visible(text), False)]
    return [(piece, bool(i % 2)) for i, piece in enumerate(pieces) if piece]


def shortened(text: str, most: int) -> str:
    """Return the text, cut to at most ``most`` characters."""
    return text if len(text) <= most else f"{text[: most - 1]}…"


def first_lines(
    lines: Iterable[str], most: int, translation: Translation | None = None
) -> Iterator[str]:
    """Yield the first ``most`` lines, then a line with the number of omitted lines."""
    left = 0
    for i, line in enumerate(lines):
        if i < most:
            yield line
        else:
            left += 1
    if left:
        yield told(say("… and {count} more", count=left), translation)


def points_in_words(earned: float, most: float, translation: Translation | None = None) -> str:
    """Return points with their unit, such as ``1.5 / 2 points``."""
    return told(say("{points} points", points=points(earned, most)), translation)


def points(earned: float, most: float) -> str:
    """Return points such as ``1.5 / 2``. The points are never rounded up to the maximum."""
    shown = number(earned)
    if earned < most and shown == number(most):
        shown = number(int(earned * 100) / 100)
    return f"{shown} / {number(most)}"


def percent(score: float) -> str:
    """Return a score, 0..1, in per cent, such as ``87.5 %``, rounded down."""
    return f"{int(score * 1000 + 1e-6) / 10:g} %"


def whole_percent(share: float) -> str:
    """Return a fraction, 0..1, in whole per cent. Only 1 is ``100 %``."""
    return f"{min(int(share * 100 + 0.5), 99) if share < 1 else 100} %"


def whole_score(score: float) -> str:
    """Return a score, 0..1, in whole per cent, such as ``87 %``, rounded down."""
    return f"{int(score * 100 + 1e-6)} %"


def number(value: float) -> str:
    """Return a number with at most two decimals."""
    return f"{value:.2f}".rstrip("0").rstrip(".")
