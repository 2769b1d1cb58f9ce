"""Single characters: their plain spellings, and look-alikes of plain characters."""

import unicodedata
from typing import Final

from service.expressions.characters import greek
from service.expressions.errors import Cause
from service.regex import regex

# Brackets around a fraction with a bar, and the star that marks a joint variable. No student can
# type them: a typed character of Unicode's private area is refused.
OPEN: Final = "\ue000"
CLOSE: Final = "\ue001"
MARKER: Final = "\ue002"

_OPERATORS: Final = {
    **dict.fromkeys("×·⋅∙∗•⁎✕✖⨯⨉", "*"),
    **dict.fromkeys("÷∕⁄", "/"),
    **dict.fromkeys("−–—‐‑‒―˗﹣", "-"),
    **dict.fromkeys("º˚∘◦°", "°"),
    "√": "√",
    "﹢": "+",
    "﹙": "(",
    "﹚": ")",
    # The accent in 90 degrés.
    "é": "e",
    "ˆ": "^",
    "ℓ": "l",
    "度": "°",
    # Word's invisible brackets, and the invisible signs that MathML and Word put between a function
    # and its argument, and between factors. As blanks, they make sin⁡2⁢q the sine of 2q.
    "〖": "{",
    "〗": "}",
    "\u2061": " ",
    "\u2062": " ",
}
_SPELLINGS: Final = _OPERATORS | greek.VARIANTS
SUPERSCRIPTS: Final = dict(
    zip(
        "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻⁽⁾ᵃᵇᶜᵈᵉᶠᵍʰⁱʲᵏˡᵐⁿᵖʳˢᵗᵘᵛʷˣʸᶻ",
        "0123456789+-()abcdefghijklmnprstuvwxyz",
        strict=True,
    )
)
SUBSCRIPTS: Final = dict(
    zip("₀₁₂₃₄₅₆₇₈₉ₐₑₕᵢⱼₖₗₘₙₒₚᵣₛₜᵤᵥₓᵦᵧᵨᵩᵪ", "0123456789aehijklmnoprstuvxβγρφχ", strict=True)
)
LOOK_ALIKES: Final = dict(
    zip(
        "аеорсухіјѕԁԛӏһԝАВЕКМНОРСТХІЅЈΑΒΕΖΗΙΚΜΝΟΡΤΥΧοßɑ∝ɵѳӨөϴп∏ℼᴨ",
        "aeopcyxijsdqlhwABEKMHOPCTXISJABEZHIKMNOPTYXoβααθθθθθππππ",
        strict=True,
    )
)
# These characters are blank, but not invisible by their Unicode category.
_BLANKS: Final = frozenset("\u115f\u1160\u2800\u3164\uffa0")
_CAUSES: Final[dict[str, Cause]] = {
    **dict.fromkeys("±∓", "plus_minus"),
    **dict.fromkeys("′″‴’‘ʹ´`ᵀ⊤", "transpose"),
    **dict.fromkeys("∛∜", "cube_root"),
    **dict.fromkeys("∞", "not_finite"),
    **dict.fromkeys("ᵒ⁰", "raised_zero"),
    **dict.fromkeys(LOOK_ALIKES, "look_alike"),
}
_FRACTION: Final = regex("[0-9]⁄[0-9]+")


def is_invisible(letter: str) -> bool:
    """True if ``letter`` is a control character, a format character or a combining mark."""
    return letter in _BLANKS or unicodedata.category(letter) in {"Cf", "Cc", "Mn", "Me"}


def plain(letter: str) -> str | None:
    """Return the plain spelling of one character, or None if it has none."""
    if " " <= letter <= "~" or letter in greek.NAMES:
        return letter
    if letter in _SPELLINGS:
        return _SPELLINGS[letter]
    if letter.isspace():
        return " "
    if letter in _CAUSES or is_invisible(letter):
        return None
    return _compatible(letter)


def _compatible(letter: str) -> str | None:
    form = unicodedata.normalize("NFKC", letter)
    if _FRACTION.fullmatch(form):
        return f"{OPEN}{form.replace('⁄', '/')}{CLOSE}"
    form = greek.VARIANTS.get(form, form)
    is_styled = 0xFF01 <= ord(letter) <= 0xFF5E or 0x1D400 <= ord(letter) <= 0x1D7FF
    return form if is_styled and (" " <= form <= "~" or form in greek.NAMES) else None


def cause(letter: str) -> Cause:
    """Return the reason why a character without a plain spelling cannot be read."""
    return _CAUSES.get(letter) or ("invisible" if is_invisible(letter) else "character")
