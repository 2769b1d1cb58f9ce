"""LaTeX commands and their plain spellings."""

import re
from typing import Final

from service.expressions.characters import greek
from service.expressions.characters.unicode import MARKER
from service.regex import regex

FUNCTIONS: Final = {
    **{name: name for name in ("sin", "cos", "tan", "exp", "atan", "asin", "acos", "tg", "abs")},
    **{name: name for name in ("arcsin", "arccos", "arctan", "arctg", "sind", "cosd", "tand")},
    **{name: name for name in ("sec", "csc", "cosec", "cot", "cotg", "ctg", "sen", "arcsen")},
    # These are refused by their names, which is clearer than an unknown command.
    **{name: name for name in ("log", "ln", "lg", "sinh", "cosh", "tanh", "coth", "max", "min")},
    **{name: name for name in ("det", "gcd", "sgn", "arsinh", "arcosh")},
}
PLAIN: Final = {
    **greek.LETTERS,
    **{f"up{name}": letter for name, letter in greek.LETTERS.items() if name.islower()},
    **{f"var{name}": letter for name, letter in greek.LETTERS.items() if name[0].isupper()},
    "vartheta": "θ", "varphi": "φ", "varepsilon": "ε", "varrho": "ρ", "varsigma": "σ",
    "cdot": "*", "times": "*", "ast": "*", "bullet": "*", "div": "/", "ell": "l",
    "ldotp": "*", "cdotp": "*", "slash": "/",
    "degree": "°", "degrees": "°", "textdegree": "°", "circ": "°", "deg": " deg ", "rad": " rad ",
    "lbrace": "{", "rbrace": "}", "lbrack": "[", "rbrack": "]",
    "vert": "|", "lvert": "|", "rvert": "|", "mid": "|", "star": MARKER,
}  # fmt: skip
FRACTIONS: Final = frozenset({"frac", "tfrac", "dfrac", "cfrac", "nicefrac", "sfrac", "flatfrac"})
# Numbers and units in the package siunitx.
QUANTITIES: Final = frozenset({"SI", "qty", "si", "unit", "num"})
UNITS: Final = frozenset({"si", "unit"})
ANGLE_UNITS: Final = {
    **dict.fromkeys(("degree", "deg", "°", "degrees", "arcdegree"), "°"),
    **dict.fromkeys(("radian", "rad"), " rad "),
}
# Commands that only style their argument.
STYLES: Final = frozenset({
    "mathrm", "mathit", "mathbf", "mathsf", "mathtt", "mathnormal", "boldsymbol", "bm",
    "text", "textrm", "textit", "textnormal", "mbox", "operatorname", "mathop", "mathord",
})  # fmt: skip
# Commands that mean nothing by themselves.
SPACES: Final = frozenset({
    "quad", "qquad", "thinspace", "medspace", "thickspace", "enspace", "enskip", "displaystyle",
    "textstyle", "scriptstyle", "limits", "nolimits", "left", "right", "big", "Big", "bigg", "Bigg",
    "bigl", "Bigl", "biggl", "Biggl", "bigr", "Bigr", "biggr", "Biggr", "bigm", "middle",
    "mleft", "mright", "relax", "nonumber", "notag", "strut", "allowbreak",
})  # fmt: skip
# Commands that style the rest of their group: {\it q}.
SWITCHES: Final = frozenset({
    "rm", "it", "bf", "sf", "tt", "sl", "em", "cal", "mit", "normalfont", "upshape", "bfseries",
})  # fmt: skip
# Commands that are skipped together with their argument.
IGNORED: Final = frozenset({"hspace", "vspace", "phantom", "hphantom", "vphantom", "label"})
BLANK_SYMBOLS: Final = frozenset(",;:!> /()[]")

COMMAND: Final = regex(r"\\(?:([A-Za-z]+)\*?|(.))", re.DOTALL)
# Environments around one formula.
ENVIRONMENT: Final = regex(
    r"\s*\{\s*(?:equation|displaymath|math|align|aligned|gather|gathered|split|multline)\*?\s*\}"
)
# The product sign of SymPy's latex(..., mul_symbol="ldot").
DOT_BETWEEN_SPACES: Final = regex(r"\\,\s*\.\s*\\,")
# A letter as Mathematica writes it in plain text: \[Theta].
NAMED_LETTER: Final = regex(r"\\\[(Capital|Curly)?([A-Z][a-z]+)\]")
_BRACE: Final = regex(r"\\.|[{}]", re.DOTALL)
RAISED_CIRCLE: Final = regex(
    r"\^\s*(?:\\(?:circ|degree)(?![A-Za-z])|\{\s*\\(?:circ|degree)\s*\}|[°∘◦]|\{\s*[°∘◦]\s*\})"
)
_STAR: Final = r"(?:[*∗⋆]|\\(?:ast|star)(?![A-Za-z]))"
RAISED_STAR: Final = regex(rf"\^\s*(?:{_STAR}(?!\*)|\{{\s*{_STAR}\s*\}})|⋆")


def known_prefix(name: str) -> str | None:
    """Return the longest known command at the beginning of ``name`` (cos in cosq), or None."""
    for end in range(len(name) - 1, 1, -1):
        if name[:end] in FUNCTIONS or name[:end] in PLAIN:
            return name[:end]
    return None


def brace_partners(source: str) -> dict[int, int]:
    """Map the position of each opening brace to the position of its closing brace.

    Braces without a partner are left out.
    """
    partners: dict[int, int] = {}
    opened: list[int] = []
    for match in _BRACE.finditer(source):
        if match.group() == "{":
            opened.append(match.start())
        elif match.group() == "}" and opened:
            partners[opened.pop()] = match.start()
    return partners
