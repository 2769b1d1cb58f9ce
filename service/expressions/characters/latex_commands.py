"""LaTeX commands and their plain spellings."""

import re
from typing import Final

from service.expressions.characters import greek
from service.expressions.characters.unicode import MARKER

FUNCTIONS: Final = {
    **{name: name for name in ("sin", "cos", "tan", "exp", "atan", "asin", "acos", "tg", "abs")},
    **{name: name for name in ("arcsin", "arccos", "arctan", "arctg", "sind", "cosd", "tand")},
}
PLAIN: Final = {
    **greek.LETTERS,
    "vartheta": "θ", "varphi": "φ", "varepsilon": "ε", "varrho": "ρ", "varsigma": "σ",
    "cdot": "*", "times": "*", "ast": "*", "bullet": "*", "div": "/", "ell": "l",
    "degree": "°", "degrees": "°", "textdegree": "°", "circ": "°", "deg": " deg ", "rad": " rad ",
    "lbrace": "{", "rbrace": "}", "lbrack": "[", "rbrack": "]",
    "vert": "|", "lvert": "|", "rvert": "|", "mid": "|", "star": MARKER,
}  # fmt: skip
FRACTIONS: Final = frozenset({"frac", "tfrac", "dfrac", "cfrac"})
# Commands that only style their argument.
STYLES: Final = frozenset({
    "mathrm", "mathit", "mathbf", "mathsf", "mathtt", "mathnormal", "boldsymbol", "bm",
    "text", "textrm", "textit", "textnormal", "mbox", "operatorname", "mathop", "mathord",
})  # fmt: skip
# Commands that mean nothing by themselves.
SPACES: Final = frozenset({
    "quad", "qquad", "thinspace", "medspace", "thickspace", "enspace", "enskip", "displaystyle",
    "textstyle", "scriptstyle", "limits", "nolimits", "left", "right", "big", "Big", "bigg", "Bigg",
    "bigl", "Bigl", "biggl", "Biggl", "bigr", "Bigr", "biggr", "Biggr", "bigm", "middle", "rm",
})  # fmt: skip
BLANK_SYMBOLS: Final = frozenset(",;:!> /()[]")

COMMAND: Final = re.compile(r"\\(?:([A-Za-z]+)\*?|(.))", re.DOTALL)
RAISED_CIRCLE: Final = re.compile(
    r"\^\s*(?:\\(?:circ|degree)(?![A-Za-z])|\{\s*\\(?:circ|degree)\s*\}|[°∘◦]|\{\s*[°∘◦]\s*\})"
)
_STAR: Final = r"(?:[*∗⋆]|\\(?:ast|star)(?![A-Za-z]))"
RAISED_STAR: Final = re.compile(rf"\^\s*(?:{_STAR}(?!\*)|\{{\s*{_STAR}\s*\}})|⋆")


def known_prefix(name: str) -> str | None:
    """The longest known command that ``name`` begins with: cosq -> cos."""
    for end in range(len(name) - 1, 1, -1):
        if name[:end] in FUNCTIONS or name[:end] in PLAIN:
            return name[:end]
    return None
