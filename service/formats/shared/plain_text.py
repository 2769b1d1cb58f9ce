"""Texts and numbers as they are printed, whoever wrote them."""

import re
from collections.abc import Iterable, Iterator
from typing import Final

# A build reads commands in what a program prints: GitHub lines that begin with `::` and `##[`
# anywhere, Azure `##vso[`, TeamCity `##teamcity[`. No formula has these signs twice in a row.
_COMMAND: Final = re.compile(r"(?<=([:#]))(?=\1)")


def visible(text: str) -> str:
    """The text in one line without control and invisible characters, or commands to a build."""
    if not text.isprintable():
        text = "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text)
    return _COMMAND.sub(" ", text)


def code_pieces(text: str) -> list[tuple[str, bool]]:
    """The visible text in pieces, and whether each is code: what stands between two backticks.

    A text whose backticks do not pair has no code.
    """
    pieces = visible(text).split("`")
    if len(pieces) % 2 == 0:
        return [(visible(text), False)]
    return [(piece, bool(i % 2)) for i, piece in enumerate(pieces) if piece]


def shortened(text: str, most: int) -> str:
    """The text, cut to ``most`` characters."""
    return text if len(text) <= most else f"{text[: most - 1]}…"


def first_lines(lines: Iterable[str], most: int) -> Iterator[str]:
    """The first lines, and how many more there are."""
    left = 0
    for i, line in enumerate(lines):
        if i < most:
            yield line
        else:
            left += 1
    if left:
        yield f"… and {left} more"


def points(earned: float, most: float) -> str:
    """Points out of the most there are: ``1.5 / 2``, never rounded up to the most."""
    shown = number(earned)
    if earned < most and shown == number(most):
        shown = number(int(earned * 100) / 100)
    return f"{shown} / {number(most)}"


def percent(score: float) -> str:
    """A score, 0..1, in per cent: ``87.5 %``, not rounded up to a mark that was not reached."""
    return f"{int(score * 1000 + 1e-6) / 10:g} %"


def whole_percent(share: float) -> str:
    """A share, 0..1, in whole per cent: ``67 %`` of two thirds, ``100 %`` of all alone."""
    return f"{min(int(share * 100 + 0.5), 99) if share < 1 else 100} %"


def whole_score(score: float) -> str:
    """A score, 0..1, in whole per cent: ``87 %``, not rounded up to a mark not reached."""
    return f"{int(score * 100 + 1e-6)} %"


def number(value: float) -> str:
    """A number with two decimals at most."""
    return f"{value:.2f}".rstrip("0").rstrip(".")
