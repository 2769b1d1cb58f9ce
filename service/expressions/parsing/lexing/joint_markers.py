"""The star after a joint variable: the marker that tables print, or a product.

Followed by nothing    θ1*, (d3*), atan2(q1*, k)    the marker
Followed by +          θ1* + 90°, d3*+l1            the marker: nobody writes a product like this
Followed by -          θ1* - 90°, θ1*-π/2           the marker, with a note
                       d3*-l1                       a product, with a note
Followed by other text q1*k                         a product

A raised star is always the marker.
"""

# A marked variable is the first factor of its term. If another factor precedes it (k*q1*+s1), a
# star before + or before a subtracted angle is ambiguous. If a blank precedes the star (q1 * + k),
# a star before + is ambiguous.

from typing import Final, Literal

from service.expressions.characters.unicode import CLOSE, OPEN
from service.regex import regex

# How a star was read; "noted" if the sign after it allows another reading.
Star = Literal["marker", "noted_marker", "product", "noted_product", "ambiguous"]

# An angle is subtracted from a marked joint variable as often as added: θ1*-π/2, θ1*-90°,
# θ1*-\frac{\pi}{2}.
_ANGLE_SUBTRACTED: Final = (
    rf"\s*-[\s({{{OPEN}]*(?:pi\b|π|[0-9.]+\s*+\*?+\s*+(?:pi\b|π)|[0-9.]+\s*(?:°|deg)|"
    rf"[0-9{{}}/ ]+{CLOSE}\s*+\*?+\s*+(?:pi\b|π))|\s*-\s*[0-9]{{2,}}\s*$"
)
_NOTHING: Final = regex(r"\s*(?:[)\]},]|$)")
_PLUS: Final = regex(r"\s*\+")
_MINUS: Final = regex(r"\s*-")
_SUBTRACTED: Final = regex(rf"\s+-\s|{_ANGLE_SUBTRACTED}")
# These are read as stars, but are never the marker.
_DOTS: Final = frozenset({"·", "⋅", "×", r"\cdot", r"\times"})


def read_star(text: str, start: int, end: int, typed: str, *, first: bool) -> Star:
    """Return how to read the * at text[start:end], which follows a joint variable.

    ``typed`` is the sign as typed. ``first`` is True if the variable is the first factor of its
    term.
    """
    # A dot always multiplies.
    if typed in _DOTS:
        return "product"
    spaced = text[start - 1].isspace()
    if _NOTHING.match(text, end):
        return "marker" if first else "product"
    if _PLUS.match(text, end):
        return "marker" if first and not spaced else "ambiguous"
    if spaced or not _MINUS.match(text, end):
        return "product"
    if _SUBTRACTED.match(text, end):
        return "noted_marker" if first else "ambiguous"
    return "noted_product"
