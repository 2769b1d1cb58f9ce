"""Matrices drawn with pieces of brackets over several lines: refused, with advice."""

from typing import Final

from service.grids.grid import Grid, GridError, GridFormat
from service.grids.source_text import SourceText

_PIECES: Final = frozenset("⎡⎢⎣⎤⎥⎦⎛⎜⎝⎞⎟⎠⎧⎨⎩⎫⎬⎭")


def _matches(text: str) -> bool:
    return not _PIECES.isdisjoint(text)


def _parse(source: SourceText) -> Grid:
    at = next(i for i, letter in enumerate(source.text) if letter in _PIECES)
    raise GridError(
        "drawn_matrix",
        "This matrix is drawn with pieces of brackets, so powers and fractions stand on other "
        "lines and cannot be read safely. Paste print(T) or latex(T) instead of pprint(T).",
        source.span(at, at + 1),
    )


FORMAT: Final = GridFormat(_matches, _parse)
