r"""The star that marks a joint variable, as tables print it, and the star that multiplies it."""

import re
from typing import Final

from service.expressions.characters.unicode import CLOSE, OPEN

# Behind a marked joint variable, an angle is subtracted as often as added: θ1*-π/2, θ1*-90°,
# θ1*-\frac{\pi}{2}.
_ANGLE_SUBTRACTED: Final = (
    rf"\s*-[\s({{{OPEN}]*(?:pi\b|π|[0-9.]+\s*\*?\s*(?:pi\b|π)|[0-9.]+\s*(?:°|deg)|"
    rf"[0-9{{}}/ ]+{CLOSE}\s*\*?\s*(?:pi\b|π))|\s*-\s*[0-9]{{2,}}\s*$"
)
_MARKER: Final = re.compile(rf"\s*(?:\+|\)|,|$)|\s+-\s|{_ANGLE_SUBTRACTED}")
_SPACED_MARKER: Final = re.compile(r"\s*(?:\+|\)|,|$)")
# These are read as stars, but mark nothing.
_DOTS: Final = frozenset({"·", "⋅", "×", r"\cdot", r"\times"})


def is_marker(text: str, start: int, end: int, typed: str) -> bool:
    """Whether the * at text[start:end], right behind a joint variable, marks it.

    ``typed`` is the star as typed: a dot multiplies, whatever follows.
    """
    if typed in _DOTS:
        return False
    pattern = _SPACED_MARKER if text[start - 1].isspace() else _MARKER
    return pattern.match(text, end) is not None
