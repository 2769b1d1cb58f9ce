"""Labels for names of symbols: θ with index 1 for theta1, and the room that a label needs."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final
from xml.sax.saxutils import escape

from service.expressions.characters.greek import LETTERS
from service.expressions.printing.symbol_names import stem_and_index
from service.regex import regex

# The font size in pixels; the size of an index as a share of it, and how much it is lowered.
SIZE: Final = 17.0
_INDEX: Final = 0.78
_DROP: Final = 0.24

# Widths of italic letters in serif fonts, as shares of the font size; other characters are widest.
_WIDTHS: Final = {
    **dict.fromkeys("ijlt1,. ", 0.34),
    **dict.fromkeys("{}", 0.5),
    **dict.fromkeys("acdeghknopqrsuvxyzbfθφψαβγδω023456789", 0.56),
    **dict.fromkeys("+−=", 0.72),
}
_WIDEST: Final = 0.86
# Signs, numbers and names of frames are upright.
_UPRIGHT: Final = regex(r"[ +,]*|[0-9.]+|\{.*")


@dataclass(frozen=True, slots=True)
class Label:
    """A text of pairs (stem, index). The index of a sign is empty: ``(("θ", "1"), ("+", ""))``."""

    runs: tuple[tuple[str, str], ...]

    @property
    def size(self) -> float:
        """The font size in pixels. Numbers, which are long, are as small as an index."""
        return SIZE * (_INDEX if self.runs[0][0][0].isdigit() else 1.0)

    @property
    def text(self) -> str:
        """The plain text, such as θ1 + d2."""
        return "".join(stem + index for stem, index in self.runs)

    @property
    def width(self) -> float:
        """An estimate of the label's width in pixels, rather too large than too small."""
        return self.size * sum(_width(stem) + _INDEX * _width(index) for stem, index in self.runs)

    def svg(self, x: float, y: float, kind: str) -> str:
        """Return the SVG text centred at the point (x, y), with the class ``kind``."""
        parts, lowered = [], False
        for stem, index in self.runs:
            back = f' dy="{-_DROP * SIZE:.1f}"' if lowered else ""
            style = ' class="sign"' if _UPRIGHT.fullmatch(stem) else ""
            parts.append(f"<tspan{style}{back}>{escape(stem)}</tspan>")
            lowered = bool(index)
            if index:
                parts.append(
                    f'<tspan class="index" dy="{_DROP * SIZE:.1f}">{escape(index)}</tspan>'
                )
        middle = y + 0.3 * self.size
        kind += " number" if self.size < SIZE else ""
        return f'<text class="{kind}" x="{x:.1f}" y="{middle:.1f}">{"".join(parts)}</text>'


def name_label(name: str) -> Label:
    """Return the label of one symbol."""
    return Label((_run(name),))


def frame_label(labels: Sequence[str]) -> Label:
    """Return the label of frames at one place: {3}, {4}."""
    return Label(((", ".join(f"{{{label}}}" for label in labels), ""),))


def sum_label(names: Sequence[str]) -> Label:
    """Return the label of a sum of symbols."""
    return _joined(map(_run, names), " + ")


def list_label(names: Sequence[str]) -> Label:
    """Return the label of several names for one thing, separated by commas."""
    return _joined(map(_run, names), ", ")


def _joined(runs: Iterable[tuple[str, str]], sign: str) -> Label:
    found: list[tuple[str, str]] = []
    for run in runs:
        found += [(sign, ""), run] if found else [run]
    return Label(tuple(found))


def _run(name: str) -> tuple[str, str]:
    if name[0].isdigit():
        return name, ""
    stem, index = stem_and_index(name)
    return LETTERS.get(stem, stem), index


def _width(text: str) -> float:
    return sum(_WIDTHS.get(character, _WIDEST) for character in text)
