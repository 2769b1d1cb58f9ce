"""Write formulas in the notations that docs/expressions.md promises."""

# A spelling says how names, products, powers, functions and constant angles are written. A writer
# adds the brackets that are needed, and sometimes more.

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from random import Random
from typing import Final

from tests.attack.formulas import (
    JOINTS,
    Call,
    Name,
    Number,
    Power,
    Product,
    Quotient,
    Ratio,
    Sum,
    Tree,
    Turn,
)

_SUBSCRIPTS: Final = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
_SUPERSCRIPTS: Final = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_HALVES: Final = {(1, 2): "½", (1, 4): "¼", (3, 4): "¾", (1, 3): "⅓", (2, 3): "⅔", (1, 5): "⅕"}
_DIGITS: Final = frozenset("0123456789.½¼¾⅓⅔⅕")
_GREEK: Final = {"theta": "θ", "alpha": "α", "beta": "β"}

# The precedence of a text's outermost operation; an atom needs no brackets.
SUM, PRODUCT, POWER, ATOM = range(4)
# A text and its precedence.
Written = tuple[str, int]


@dataclass(frozen=True)
class Spelling:
    """One way of writing formulas."""

    # A field with several variants lets the writer draw one.
    names: Callable[[Random, str, str], str]
    times: tuple[str, ...] = ("*",)
    divided: str = "/"
    power: str = "^"
    pi: tuple[str, ...] = ("pi",)
    turns: tuple[str, ...] = ("pi",)
    functions: Mapping[str, tuple[str, ...]] | None = None
    opening: tuple[str, ...] = ("(",)
    blanks: tuple[str, ...] = ("",)
    bare: float = 0.0
    shorthand: float = 0.0
    powered_function: float = 0.0
    redundant: float = 0.0
    latex: bool = False
    degrees: bool = False
    minus: str = "-"
    around: tuple[str, ...] = ("{}",)
    others: "tuple[Spelling, ...]" = ()


_CLOSING: Final = {"(": ")", "[": "]", "{": "}", r"\left(": r"\right)", r"\left[": r"\right]",
                   r"\bigl(": r"\bigr)"}  # fmt: skip


# --- names: the stem and the index of q1, alpha2, l_base


def _stems(random: Random, name: str) -> tuple[str, str]:
    if name == "l_base":
        return "l", "base"
    stem, index = name[:-1], name[-1]
    if not index.isdigit():
        return name, ""
    if name == "q3":
        return random.choice(("d", "q")), index
    return (random.choice(("q", "theta")) if name in JOINTS else stem), index


def _ascii(random: Random, stem: str, index: str) -> str:
    if index == "base":
        return "l_base"
    return f"{stem}{random.choice(('', '', '_'))}{index}" if index else stem


def _greek(random: Random, stem: str, index: str) -> str:
    letter = _GREEK.get(stem, stem)
    if index == "base":
        return "l_base"
    forms = (index, f"_{index}", index.translate(_SUBSCRIPTS), f"_{{{index}}}")
    return letter + (random.choice(forms) if index else "")


def _latex_name(random: Random, stem: str, index: str) -> str:
    letter = f"\\{stem}" if stem in _GREEK else stem
    if index == "base":
        return random.choice(("l_{base}", r"l_{\mathrm{base}}", r"l_{\text{base}}"))
    return letter + (
        random.choice((f"_{index}", f"_{{{index}}}", f"_{{{index}}}")) if index else ""
    )


def _wolfram(_: Random, stem: str, index: str) -> str:
    if index == "base":
        return "l_base"
    return f"Subscript[{_GREEK.get(stem, stem)}, {index}]" if index else _GREEK.get(stem, stem)


_LATEX_FUNCTIONS: Final = {
    "sin": (r"\sin",), "cos": (r"\cos",), "tan": (r"\tan",),
    "asin": (r"\arcsin", r"\operatorname{asin}"), "acos": (r"\arccos", r"\operatorname{acos}"),
    "atan": (r"\arctan", r"\operatorname{atan}"),
    "atan2": (r"\operatorname{atan2}", r"\mathrm{atan2}"), "exp": (r"\exp",),
}  # fmt: skip
_NUMPY: Final = {
    "asin": ("np.arcsin", "math.asin", "asin"), "acos": ("np.arccos", "math.acos"),
    "atan": ("np.arctan", "math.atan"), "atan2": ("np.arctan2", "math.atan2"),
    "abs": ("abs", "np.abs", "math.fabs"),
    **{name: (f"np.{name}", f"math.{name}", name) for name in ("sin", "cos", "tan", "sqrt", "exp")},
}  # fmt: skip
_WOLFRAM: Final = {
    "sin": ("Sin",), "cos": ("Cos",), "tan": ("Tan",), "asin": ("ArcSin",), "acos": ("ArcCos",),
    "atan": ("ArcTan",), "sqrt": ("Sqrt",), "abs": ("Abs",), "exp": ("Exp",),
}  # fmt: skip
_ARC: Final = {"asin": ("arcsin",), "acos": ("arccos",), "atan": ("arctan",),
               "atan2": ("arctan2",)}  # fmt: skip

PLAIN: Final = Spelling(_ascii, blanks=("", " "))
_LATEX: Final = Spelling(
    _latex_name, times=(r" \cdot ", r" \, ", " ", r"\times "), divided="frac", power="^{}",
    pi=(r"\pi",), turns=("pi", r"^\circ", r"^{\circ}"), functions=_LATEX_FUNCTIONS,
    opening=("(", r"\left(", r"\left[", "["), blanks=("", " "), latex=True,
    around=("{}", "${}$", r"\({}\)", "{}", r"\displaystyle {}"),
)  # fmt: skip
SPELLINGS: Final[dict[str, Spelling]] = {
    "plain": PLAIN,
    "blanks": replace(PLAIN, blanks=("", " ", "  ", "\t", " ", "\n", "\u00a0", "\u2009")),
    "brackets": replace(PLAIN, redundant=0.4, opening=("(", "[", "{")),
    "Python": Spelling(
        _ascii, power="**", pi=("np.pi", "math.pi", "pi"), turns=("pi", "deg2rad"),
        functions=_NUMPY, blanks=("", " "),
    ),
    "MATLAB": Spelling(
        _ascii, times=("*", ".*"), divided="./", power=".^", turns=("pi", "deg2rad"),
        blanks=("", " "), around=("{}", "{};", "x = {}"),
    ),
    "Mathematica": Spelling(
        _wolfram, times=("*", " "), pi=("Pi", "π"), functions=_WOLFRAM, blanks=("", " "),
        turns=("pi", " Degree"),
    ),
    "Unicode": Spelling(
        _greek, times=("·", "×", "⋅", " "), power="²", pi=("π",), turns=("pi", "°"),
        blanks=("", " "), minus="−", powered_function=0.5,
    ),
    "Greek": Spelling(_greek, pi=("π",), turns=("pi", "°", " deg"), blanks=("", " ")),
    "implicit": Spelling(_ascii, times=("", " "), turns=("pi", "deg"), blanks=("", " ")),
    "bare functions": Spelling(_greek, times=("*", " "), pi=("π", "pi"), bare=0.9,
                               blanks=("", " "), powered_function=0.8),
    "shorthand": Spelling(_ascii, times=("*", " ", ""), shorthand=1.0, blanks=("", " "),
                          turns=("pi", "deg")),
    "shorthand, Greek": Spelling(_greek, times=("*", " ", "·"), shorthand=0.8, power="²",
                                 pi=("π",), blanks=("", " ")),
    "degrees": Spelling(_ascii, turns=("deg", "°", " degrees", "bare"), blanks=("", " ")),
    "form in degrees": Spelling(_ascii, turns=("deg", "°", "bare", "bare"), degrees=True,
                                blanks=("", " ")),
    "LaTeX": _LATEX,
    "LaTeX, bare": replace(_LATEX, bare=0.9, powered_function=0.9),
    "LaTeX, shorthand": replace(_LATEX, shorthand=0.9),
    "LaTeX, mixed": replace(_LATEX, bare=0.3, shorthand=0.3, powered_function=0.4, redundant=0.2,
                            divided="/", names=_greek),
    "arc": replace(PLAIN, functions=_ARC, redundant=0.1),
    "named": replace(PLAIN, around=("x = {}", "p_x = {}", "T = {}", "px={}")),
}  # fmt: skip
SPELLINGS["mixed"] = replace(
    PLAIN,
    others=tuple(
        replace(SPELLINGS[name], bare=0.0, around=("{}",))
        for name in ("plain", "Python", "Unicode", "Greek", "shorthand", "LaTeX", "LaTeX, mixed")
    ),
)
# Spellings that are not used in grids: their texts contain separators of cells.
OPEN: Final = frozenset({
    "blanks", "named", "MATLAB", "Mathematica", "mixed", "form in degrees"
})  # fmt: skip


class Writer:
    """Writes formulas in one notation, and chooses at random between its variants."""

    def __init__(self, spelling: Spelling, random: Random) -> None:
        self._s = spelling
        self._random = random

    def write(self, tree: Tree) -> str:
        """Return the formula as text."""
        return self._random.choice(self._s.around).format(self._text(tree, SUM))

    def _blank(self) -> str:
        return self._random.choice(self._s.blanks)

    def _text(self, tree: Tree, least: int, *, angle: bool = False) -> str:
        if self._s.others and self._random.random() < 0.4:
            other = replace(self._random.choice(self._s.others), others=self._s.others)
            return Writer(other, self._random)._text(tree, least, angle=angle)
        text, strength = self._written(tree, angle=angle)
        if strength < least or self._random.random() < self._s.redundant:
            return self._bracketed(text)
        return text

    def _bracketed(self, text: str) -> str:
        opening = self._random.choice(self._s.opening)
        if opening not in {"(", r"\left("} and text.isdigit():
            # In q_1 [2], the bracket would be read as an index.
            opening = "("
        return f"{opening}{self._blank()}{text}{self._blank()}{_CLOSING[opening]}"

    def _written(self, tree: Tree, *, angle: bool = False) -> Written:
        match tree:
            case Number(text):
                return text, ATOM
            case Ratio(top, bottom):
                return self._ratio(top, bottom)
            case Turn(degrees):
                return self._turn(degrees, angle=angle)
            case Name(name):
                return self._s.names(self._random, *_stems(self._random, name)), ATOM
            case Sum(terms):
                return self._sum(terms, angle=angle), SUM
            case Product(factors):
                return self._product(factors), PRODUCT
            case Quotient(top, bottom):
                return self._quotient(top, bottom)
            case Power(base, exponent):
                return self._power(base, exponent)
            case Call(function, arguments):
                return self._call(function, arguments)

    def _ratio(self, top: int, bottom: int) -> Written:
        if self._s.power == "²" and (top, bottom) in _HALVES and self._random.random() < 0.5:
            return _HALVES[top, bottom], PRODUCT
        if self._s.divided == "frac":
            short = rf"\frac{top}{bottom}" if self._random.random() < 0.3 else ""
            return short or rf"\{self._random.choice('dt ').strip()}frac{{{top}}}{{{bottom}}}", ATOM
        return f"{top}{self._s.divided}{bottom}", PRODUCT

    def _turn(self, degrees: int, *, angle: bool) -> Written:
        unit = self._random.choice(self._s.turns)
        if unit == "bare":
            if self._s.degrees and angle:
                return str(degrees), PRODUCT
            unit = "deg"
        if unit == "deg2rad":
            return f"deg2rad({degrees})", ATOM
        if unit != "pi":
            return f"{degrees}{unit}", PRODUCT
        pi = self._random.choice(self._s.pi)
        top, bottom = degrees // 45, 4
        if degrees % 45:
            top, bottom = degrees // 30, 6
        while top % 2 == bottom % 2 == 0:
            top, bottom = top // 2, bottom // 2
        if top % 3 == bottom % 3 == 0:
            top, bottom = top // 3, bottom // 3
        times = "*" if not self._s.latex else self._random.choice((r"\cdot ", " ", ""))
        over = pi if top == 1 else f"{top}{times}{pi}"
        if bottom == 1:
            return over, ATOM if top == 1 else PRODUCT
        if self._s.divided == "frac":
            return rf"\frac{{{over}}}{{{bottom}}}", ATOM
        return f"{over}{self._s.divided}{bottom}", PRODUCT

    def _sum(self, terms: tuple[tuple[int, Tree], ...], *, angle: bool) -> str:
        text = ""
        for at, (sign, term) in enumerate(terms):
            written = self._text(term, PRODUCT, angle=angle)
            if at:
                blank = self._blank()
                text += f"{blank}{'+' if sign > 0 else self._s.minus}{blank}{written}"
            else:
                text = f"{self._s.minus if sign < 0 else ''}{written}"
        return text

    def _product(self, factors: tuple[Tree, ...]) -> str:
        marked = not set(self._s.times) & {"", " ", r" \, "}
        ordered = factors if marked else sorted(factors, key=_place_in_product)
        text = ""
        for at, each in enumerate(ordered):
            # A quotient needs no brackets as the first factor.
            is_quotient = isinstance(each, Quotient | Ratio | Product | Turn)
            least = ATOM if (is_quotient and at) or not marked else POWER
            if at == 0 and isinstance(each, Ratio) and self._random.random() < 0.5:
                least = PRODUCT
            written = self._text(each, least)
            if at == 0:
                text = written
                continue
            times = self._random.choice(self._s.times)
            if times == "" and not _may_touch(text, written):
                times = " "
            if times.strip() == "" or times == r" \, ":
                # Two adjacent numbers are not read as a product, nor is a mixed number.
                is_mixed = isinstance(ordered[at - 1], Number) and "frac" in written[:6]
                if written[0] in _DIGITS or is_mixed or _is_bare(text, self._s):
                    times = "*" if not self._s.latex else r" \cdot "
            if times.strip() and not times.startswith(" "):
                blank = self._blank()
                times = f"{blank}{times}{blank}"
            text += times + written
        return text

    def _quotient(self, top: Tree, bottom: Tree) -> Written:
        if self._s.divided == "frac":
            return rf"\frac{{{self._text(top, SUM)}}}{{{self._text(bottom, SUM)}}}", ATOM
        # A product without signs needs no brackets before a slash: a b/c is a (b/c).
        over = self._text(top, ATOM if isinstance(top, Quotient | Ratio | Turn) else POWER)
        if isinstance(top, Product) and self._random.random() < 0.5:
            over = self._text(top, PRODUCT)
        if _is_bare(over, self._s):
            over = self._bracketed(over)
        blank = self._blank()
        return f"{over}{blank}{self._s.divided}{blank}{self._text(bottom, ATOM)}", PRODUCT

    def _raised(self, exponent: int) -> str:
        if self._s.power == "²":
            return str(exponent).translate(_SUPERSCRIPTS)
        if self._s.power == "^{}":
            short = 0 <= exponent < 10 and self._random.random() < 0.5
            return f"^{exponent}" if short else f"^{{{exponent}}}"
        return f"{self._s.power}{exponent}" if exponent > 0 else f"{self._s.power}({exponent})"

    def _power(self, base: Tree, exponent: int) -> Written:
        if isinstance(base, Call) and exponent > 0 and base.function in ("sin", "cos", "tan"):
            short = self._shorthand(base)
            if short and self._random.random() < self._s.shorthand:
                return short + self._raised(exponent), POWER
            if self._random.random() < self._s.powered_function:
                return self._call(base.function, base.arguments, self._raised(exponent))
        if isinstance(base, Call):
            # cos(q1)^2 needs no further brackets; bars and roots have an end of their own.
            bare = replace(self._s, bare=0.0)
            text = Writer(bare, self._random)._text(base, ATOM)
        else:
            text = self._text(base, ATOM)
        return text + self._raised(exponent), POWER

    def _shorthand(self, call: Call) -> str:
        if call.function not in ("sin", "cos"):
            return ""
        [of] = call.arguments
        terms = of.terms if isinstance(of, Sum) else ((1, of),)
        names = [term.name for sign, term in terms if sign > 0 and isinstance(term, Name)]
        if len(names) != len(terms) or not set(names) <= set(JOINTS):
            return ""
        letter = call.function[0]
        digits = "".join(name[-1] for name in names)
        if self._s.latex:
            stem = self._random.choice((letter, letter, rf"\mathrm{{{letter}}}"))
            if len(digits) == 1 and self._random.random() < 0.3:
                return _cosine_of_theta(self._random, letter, digits)
            return stem + (f"_{digits}" if len(digits) == 1 else f"_{{{digits}}}")
        forms = [letter + digits, f"{letter}_{{{digits}}}"]
        if "θ" in self._s.names(self._random, "theta", "1") and len(digits) == 1:
            forms.append(f"{letter}θ{digits}")
        return self._random.choice(forms)

    def _call(self, function: str, arguments: tuple[Tree, ...], raised: str = "") -> Written:
        short = self._shorthand(Call(function, arguments))
        if short and not raised and self._random.random() < self._s.shorthand:
            return short, ATOM
        table = self._s.functions or {}
        if function == "sqrt" and self._s.latex:
            return rf"\sqrt{{{self._text(arguments[0], SUM)}}}", ATOM
        if function == "sqrt" and self._s.power == "²":
            return f"√{self._bracketed(self._text(arguments[0], SUM))}", ATOM
        if function == "abs" and self._s.latex:
            return rf"\left|{self._text(arguments[0], SUM)}\right|", ATOM
        if function == "atan2" and self._s.names is _wolfram:
            y, x = (self._text(each, SUM) for each in arguments)
            return f"ArcTan[{x}, {y}]", ATOM
        name = self._random.choice(table.get(function, (function,))) + raised
        trigonometric = function in ("sin", "cos", "tan")
        if trigonometric and self._random.random() < self._s.bare:
            inside = self._bare_argument(arguments[0])
            if inside:
                gap = "" if self._s.latex and inside.startswith("\\") else " "
                return f"{name}{gap}{inside}", PRODUCT
        opening = "[" if self._s.names is _wolfram else self._random.choice(self._s.opening)
        if opening == "{":
            opening = "("
        inner = f",{self._blank()}".join(
            self._text(each, SUM, angle=trigonometric) for each in arguments
        )
        return f"{name}{opening}{self._blank()}{inner}{_CLOSING[opening]}", ATOM

    def _bare_argument(self, of: Tree) -> str:
        if isinstance(of, Name):
            return self._text(of, ATOM)
        match of:
            case Product((Number(text), Name() as name)) if text.isdigit():
                return f"{text}{self._text(name, ATOM)}"
        return ""


def _cosine_of_theta(random: Random, letter: str, digits: str) -> str:
    return random.choice((rf"{letter}\theta_{digits}", rf"{letter}_{{\theta_{digits}}}"))


def _place_in_product(each: Tree) -> int:
    for place, kinds in enumerate(((Number,), (Ratio, Turn), (Name,), (Power,))):
        if isinstance(each, kinds):
            return place
    return 6 if isinstance(each, Call) else 5


def _may_touch(left: str, right: str) -> bool:
    if right[0] in "([" or left[-1] in ")]":
        return True
    return right[0].isalpha() and (left[-1].isdigit()) and right[0] not in "eE"


def _is_bare(text: str, spelling: Spelling) -> bool:
    return bool(spelling.bare) and text[-1] not in ")]}"
