"""Read the headers of a pasted DH table: the parameter in a column, and its unit."""

import re
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final, NamedTuple

from service.expressions import AngleUnit, Kind
from service.grading.reading.tables.words import (
    ANGLE_UNITS,
    ASIDES,
    FILLERS,
    LETTERS,
    METRES,
    PLACES,
    TERMS,
    in_plain_words,
)
from service.regex import regex

LABEL: Final = "label"
ASIDE: Final = "aside"
# A number that is added to θ, or to the variable of the joint.
THETA_OFFSET: Final = "theta offset"
OFFSET: Final = "offset"
# The letter l, which heads the link lengths or the numbers of the links.
LENGTH_OR_LABEL: Final = "l"
QUANTITIES: Final[Mapping[str, Kind]] = {
    "a": "length", "alpha": "angle", "d": "length", "theta": "angle",
}  # fmt: skip

# The names of the columns in messages.
SHOWN: Final = {"a": "a", "alpha": "α", "d": "d", "theta": "θ"}

_LONGEST: Final = 60
# Characters that NFKC leaves alone, or replaces by wrong ones.
_SIGNS: Final = str.maketrans(
    {"⍺": "α", "∝": "α", "−": "-", "–": "-", "‐": "-", "‑": "-", "º": "°", "˚": "°"}
)
# An accent in LaTeX: \'e. And "n°", a number in French, Spanish and Italian.
_ACCENT: Final = regex(r"\\['`\"^~](?=[a-z{])")
_NUMERO: Final = regex(r"(?<![a-z])n\.?\s?°")
# The preposition in "n° d'articulation" and "numéro de l'axe" is not d.
_OF: Final = regex(r"(?<=no|ro)\s(?:de\s)?[dl]['’](?=[a-z]{3})")
_STYLE: Final = regex(
    r"\\(?:mathrm|mathbf|mathit|mathsf|text|textbf|textit|textrm|operatorname|boldsymbol|bm|rm|bf"
    r"|boldmath|bfseries|itshape|makecell|thead)(?![a-z])|\\[,;:! ]"
)
# A unit of the package siunitx: \si{\milli\metre}.
_SIUNITX: Final = regex(r"\\(?:si|unit)\s?\{([\\a-z ]{1,30})\}")
_CIRCLE: Final = regex(r"\^\s?\(?\s?\{?\s?(?:\\circ|∘|°|o)\s?\}?\)?(?![a-z])|\\degree|∘")
_MARKER: Final = regex(r"\^\s?\{?\s?\*\s?\}?")
_SHIFTED: Final = regex(r"(?<![a-z])([ijkn])\s?-\s?1(?!\d)|([a-z])([ijkn])\s?-\s?1(?!\d)")
_WORD: Final = regex(r"[a-z]+~?|#|[^\sa-z#]")
_GLUED: Final = regex(r"(a|r|d|q|th|alpha|theta)([ijkn]~?)")
_INDEX: Final = regex(r"[ijkn]~?")
# The axis of a parameter: d_z, a_x, but d_x is the length along x.
_ALONG: Final = regex(r"(?<![a-z])(?:(a|r|d)\s?x|(d)\s?z|(alpha)\s?x|(theta|φ|phi)\s?z)(?![a-z])")
# The number of a row after the name of a parameter: θ_1, a_{2}, d(3); but not a_{i-1}.
_NUMBER: Final = regex(r"(?<=[^\W\d]|[_({])([0-9]{1,2})[)}\s*]*$")
_IGNORED: Final = frozenset(".,:;()[]{}|'\"/?_")
_DIGITS_OR_OPERATORS: Final = regex(r"[0-9+\-*/=^]")

_UNIT_NAMES: Final = "|".join(sorted((*ANGLE_UNITS, *METRES), key=len, reverse=True))
_BRACKETED_UNIT: Final = regex(rf"[(\[]\s{{0,4}}(?:(?:in|en)\s)?({_UNIT_NAMES})\s{{0,4}}[)\]]")
# "in" or "en" before a unit is a preposition, not inches.
_TRAILING_UNIT: Final = regex(
    rf"(?:[\s,;:/_]|(?<=[^a-z]))(?:(?:in|en)\s)?({_UNIT_NAMES})\s{{0,4}}$|(°)\s{{0,4}}$"
)


@dataclass(frozen=True, slots=True)
class Header:
    """The meaning of a header.

    ``column`` is a, alpha, d, theta, "label", or "aside" for a column that is ignored; it is
    "theta offset" for a number that is added to θ, and "l" for the letter l. ``shifted`` is true
    for an index such as in a_{i-1}. ``is_word`` is true for the word "offset", which means d, or
    beside a column d a number that is added to the variable of the joint.
    """

    # ``unit`` is in small letters.
    column: str
    unit: str = ""
    shifted: bool = False
    is_word: bool = field(default=False, compare=False)

    @property
    def angle_unit(self) -> AngleUnit | None:
        """The unit of angles in the header, or None."""
        return ANGLE_UNITS.get(self.unit)

    @property
    def metres(self) -> float | None:
        """The unit of length in the header, in metres, or None: 0.001 for mm."""
        return METRES.get(self.unit)


class NamedParameter(NamedTuple):
    """The column of a parameter, and the number of its row if its name has one."""

    column: str
    row: int | None


def named_parameter(name: str) -> NamedParameter | None:
    r"""Return the DH parameter with a name such as a, \alpha_1, θ₁, d_{i}; None for other names."""
    plain = unicodedata.normalize("NFKC", name[: _LONGEST + 1])
    number = _NUMBER.search(plain)
    header = read_header(plain[: number.start()] if number else plain)
    if header is None or header.column not in QUANTITIES or header.unit:
        return None
    return NamedParameter(header.column, int(number[1]) if number else None)


def read_header(text: str) -> Header | None:
    r"""Return the header in a cell; None if the cell is not a header.

    Examples: ``a``, ``a_{i-1}``, ``α_i (deg)``, ``link length [mm]``, ``$\theta_i$``, ``#``.
    """
    if len(text) > _LONGEST:
        return None
    plain, unit = _plain(text)
    if ASIDES.fullmatch(plain):
        return Header(ASIDE)
    plain = _ALONG.sub(_without_axis, plain)
    found: set[str] = set()
    terms: set[str] = set()
    indices: list[str] = []
    places = False
    for word in _WORD.findall(plain):
        if glued := _GLUED.fullmatch(word):
            found.add(LETTERS[glued[1]])
            indices.append(glued[2])
        elif word in LETTERS:
            found.add(LETTERS[word])
        elif word in TERMS:
            terms.add(TERMS[word])
        elif _INDEX.fullmatch(word):
            indices.append(word)
        elif word in PLACES:
            places = True
        elif word not in FILLERS and word not in _IGNORED:
            return None
    return _decided(found, terms, unit, indices, places=places)


def _decided(
    found: set[str], terms: set[str], unit: str, indices: list[str], *, places: bool
) -> Header | None:
    if found == {"theta"} and terms == {"d"}:
        return Header(THETA_OFFSET, unit)
    if terms == {"a"}:
        # The letter of "link length l".
        found = found - {LENGTH_OR_LABEL}
    if "alpha" in found | terms:
        # "angle" in "twist angle" does not mean θ.
        terms = terms - {"theta"}
    if len(found | terms) == 1:
        [column] = found | terms
        shifted = any(index.endswith("~") for index in indices)
        return Header(column, unit, shifted, is_word="d" in terms - found)
    if not found and not terms and (places or indices) and not unit:
        return Header(LABEL)
    return None


def _without_axis(named: re.Match[str]) -> str:
    across, along, twist, turn = named.groups()
    return "a" if across else along or twist or turn


def is_wordy(text: str) -> bool:
    """True if a cell might be a header: a word or a name, but not a number or formula."""
    plain, _ = _plain(text[:_LONGEST])
    return bool(plain.strip()) and _DIGITS_OR_OPERATORS.search(plain) is None


def _plain(text: str) -> tuple[str, str]:
    # ``~`` replaces -1.
    plain = unicodedata.normalize("NFKC", text.translate(_SIGNS)).translate(_SIGNS)
    plain = _OF.sub(" ", _NUMERO.sub("no", _ACCENT.sub("", in_plain_words(plain))))
    plain = _SIUNITX.sub(lambda unit: unit[1].replace("\\", "").replace(" ", ""), plain)
    plain = _CIRCLE.sub("°", _MARKER.sub(" ", _STYLE.sub(" ", plain)))
    plain = plain.replace("α", " alpha ").replace("θ", " theta ")
    for mark in "\\$`*":
        plain = plain.replace(mark, " ")
    plain = plain.replace("{", "").replace("}", "")
    unit = ""
    if found := _BRACKETED_UNIT.search(plain):
        plain, unit = plain[: found.start()] + " " + plain[found.end() :], found[1]
    else:
        plain = plain.replace("_", " ")
        if trailing := _TRAILING_UNIT.search(plain.rstrip()):
            plain, unit = plain[: trailing.start()], trailing[1] or trailing[2]
    plain = " ".join(plain.replace("_", " ").split())
    return _SHIFTED.sub(lambda match: "".join(filter(None, match.groups())) + "~", plain), unit
