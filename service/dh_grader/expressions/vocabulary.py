"""The names that a formula may use (functions, units, symbols), and the tree that has them.

It knows every spelling of a whole name, but not how a text is split into names.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Final, Literal

from dh_grader.expressions import characters
from dh_grader.regex import regex
from dh_grader.translations import say

# --- The functions and units that an expression may use, and their spellings


PieceKind = Literal[
    "symbol", "pi", "constant", "function", "number", "unit", "shorthand", "invalid_shorthand"
]

ARITY: Final = {
    "sin": 1, "cos": 1, "tan": 1, "asin": 1, "acos": 1, "atan": 1, "atan2": 2, "sqrt": 1, "abs": 1,
    "exp": 1,
}  # fmt: skip
# MATLAB's functions of degrees: cosd(60) is cos(60deg), and acosd returns degrees.
OF_DEGREES: Final = {"sind": "sin", "cosd": "cos", "tand": "tan"}
IN_DEGREES: Final = {"asind": "asin", "acosd": "acos", "atand": "atan", "atan2d": "atan2"}
SPELLINGS: Final = {
    **{name: name for name in (*ARITY, *OF_DEGREES, *IN_DEGREES)},
    "arcsin": "asin", "arccos": "acos", "arctan": "atan", "arctan2": "atan2", "tg": "tan",
    "arctg": "atan", "deg2rad": "deg", "rad2deg": "rad2deg",
}  # fmt: skip
# A function's name in capitals, and as Mathematica spells it.
CAPITALS: Final = {
    variant: name
    for spelling, name in SPELLINGS.items()
    for variant in (spelling.upper(), spelling.capitalize())
} | {"ArcSin": "asin", "ArcCos": "acos", "ArcTan": "atan", "ArcTan2": "atan2", "ATan2": "atan2"}
TRIGONOMETRIC: Final = frozenset({"sin", "cos", "tan"})
INVERSE: Final = frozenset({"asin", "acos", "atan", "atan2"})

UNITS: Final[dict[str, Literal["deg", "rad"]]] = {
    "deg": "deg", "degree": "deg", "degrees": "deg", "rad": "rad", "radian": "rad",
    "radians": "rad",
}  # fmt: skip
# For a human reader and in Python, ``degrees(x)`` and ``radians(x)`` have opposite meanings, so
# only these two words may precede a bracket with any value.
UNIT_FUNCTIONS: Final = frozenset({"deg", "rad"})
# These may precede a number that is too large for radians.
FUNCTIONS_OF_DEGREES: Final = frozenset({"degrees", "radians"})

PI: Final = ("pi", "π")
PI_CAPITALS: Final = ("Pi", "PI")
# Modules that programs write before a function: np.cos, math.pi, Math.PI, std::cos.
MODULES: Final = frozenset({
    "np", "numpy", "math", "sp", "sympy", "sym", "jnp", "cmath", "mpmath", "mp", "scipy", "Math",
    "MathF", "std", "numbers", "torch", "tf", "casadi", "ca", "symengine",
})  # fmt: skip

# Functions that are built from other functions (see ``build_function`` in ``parser.py``), with
# their number of arguments; 0 for any number.
BUILT: Final = {
    "sec": 1, "csc": 1, "cot": 1, "pow": 2, "hypot": 2, "quotient": 2, "sum": 0, "product": 0,
    "value": 1,
}  # fmt: skip
# Constants of C: a root, or π over a number.
CONSTANTS: Final = {
    "M_PI_2": ("pi", 2), "M_PI_4": ("pi", 4), "M_SQRT2": ("sqrt", 2), "M_SQRT1_2": ("1/sqrt", 2),
}  # fmt: skip
# Words that are read only as a whole run, not as part of a longer one: cosf1 is cos(f1).
ALONE: Final[dict[str, tuple[PieceKind, str]]] = {
    **{
        spelling: ("function", name)
        for name, spellings in {
            "sec": ("sec", "Sec", "SEC"), "csc": ("csc", "Csc", "CSC", "cosec"),
            "cot": ("cot", "Cot", "COT", "cotan", "ctg", "cotg"),
            "sin": ("sen", "sinf", "SEN"), "cos": ("cosf",), "tan": ("tanf",),
            "asin": ("arcsen", "asen", "asinf"), "acos": ("acosf",), "atan": ("atanf",),
            "atan2": ("atan2f",), "sqrt": ("sqrtf",), "abs": ("fabs", "fabsf"),
            "pow": ("pow", "powf", "Power", "Pow", "POWER", "power"), "hypot": ("hypot",),
            "quotient": ("Rational", "Divide"), "sum": ("Plus", "Add"),
            "product": ("Times", "Mul"),
            "value": ("sym", "vpa", "simplify", "Simplify", "expand", "Expand", "float", "double"),
        }.items()
        for spelling in spellings
    },
    # In spreadsheets, these make radians of a number of degrees.
    **dict.fromkeys(("RADIANS", "BOGENMASS", "RADIANES", "RADIANTI"), ("function", "deg")),
    **dict.fromkeys(("Grad", "grados", "gradi", "graus", "degre", "degres"), ("unit", "deg")),
    **{name: ("constant", name) for name in CONSTANTS},
    "M_PI": ("pi", "pi"), "kPi": ("pi", "pi"), "Degree": ("unit", "deg"),
}  # fmt: skip
# Functions that no answer needs. They are refused by name, so that they are not read as products.
REFUSED: Final = frozenset({
    "log", "ln", "lg", "log10", "log2", "log1p", "expm1", "Log", "LN", "LOG",
    "sinh", "cosh", "tanh", "coth", "sech", "csch", "Sinh", "Cosh", "Tanh",
    *(f"{a}{name}" for a in ("a", "ar", "arc") for name in ("sinh", "cosh", "tanh", "coth")),
    *(f"{a}{name}" for a in ("a", "arc") for name in ("sec", "csc", "cot", "ctg", "cotg")),
    "max", "min", "Max", "Min", "MAX", "MIN", "floor", "Floor", "ceil", "ceiling", "round", "trunc",
    "fix", "sign", "Sign", "sgn", "SIGN", "signum", "mod", "Mod", "MOD", "rem", "fmod", "wrapToPi",
    "factorial", "diff", "int", "sum", "dot", "cross", "norm", "det", "gcd",
    "sinc", "cis", "versin", "haversin", "erf", "heaviside", "piecewise", "Piecewise", "unwrap",
})  # fmt: skip
RESERVED: Final = frozenset({*SPELLINGS, *UNITS, *PI})


# --- The symbols that an exercise declares


Kind = Literal["angle", "length", "number"]

_CANONICAL: Final = regex(r"[A-Za-z][A-Za-z0-9]*(?:_[A-Za-z0-9]+)*")
_NORMAL: Final = regex(rf"[A-Za-z{characters.CLASS}][A-Za-z0-9{characters.CLASS}]*")
_SUBSCRIPT: Final = regex(r"_\{\s*([^{}]*?)\s*\}")
_SUBSCRIPT_DIGITS: Final = str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")


@dataclass(frozen=True, slots=True)
class Symbol:
    """A declared symbol.

    ``name`` is its canonical ASCII name, such as theta1. ``aliases`` are its other names. ``joint``
    is the index of a joint if the symbol is its variable, else None. ``latex`` overrides the LaTeX
    that is derived from the name.
    """

    # Values of angles are radians. Greek spellings and subscripts need no alias. A joint variable
    # is an angle for a revolute joint, and a length for a prismatic joint.

    name: str
    kind: Kind
    aliases: tuple[str, ...] = ()
    joint: int | None = None
    latex: str | None = None


# The function of a shorthand and its symbols, whose sum is the argument; a symbol has no function.
Operand = tuple[str, tuple[Symbol, ...]]


def normal_form(name: str) -> str:
    """Return ``name`` with subscripts as plain digits: θ_1, θ₁ and θ_{1} -> θ1."""
    # Greek letters stay letters; ``Vocabulary`` knows each name in both spellings.
    plain = name.strip().replace("\\", "").translate(_SUBSCRIPT_DIGITS)
    plain = _SUBSCRIPT.sub(r"\1", plain).replace("_", "")
    return "".join(characters.VARIANTS.get(letter, letter) for letter in plain)


def joint_variable(index: int, *, sliding: bool = False) -> Symbol:
    """Return the variable of a joint: theta1 (or q1), for a sliding joint d3 (or q3)."""
    if sliding:
        return Symbol(f"d{index}", "length", (f"q{index}",), joint=index)
    return Symbol(f"theta{index}", "angle", (f"q{index}",), joint=index)


@lru_cache(maxsize=1024)
def _shared(symbols: tuple[Symbol, ...]) -> tuple[Symbol, ...]:
    return symbols


class Vocabulary:
    """The declared symbols, by all their names. Immutable, equal by content.

    The symbols are those of an exercise, or with ``of_books`` those of textbooks. With
    ``decimal_comma``, numbers may have a decimal comma. Raises ValueError for symbols that clash.
    """

    # Symbols clash if two have the same name, or two joint variables have the same index.
    # ValueError also if a name cannot be written in an expression. With ``of_books``, messages do
    # not mention an exercise.

    __slots__ = (
        "_hash", "_shared", "by_name", "decimal_comma", "joints", "longest", "of_books", "operands",
        "sliding", "symbols", "turning",
    )  # fmt: skip

    def __init__(
        self, symbols: Sequence[Symbol], *, of_books: bool = False, decimal_comma: bool = False
    ) -> None:
        self.symbols: Final = tuple(symbols)
        self.of_books: Final = of_books
        self.decimal_comma: Final = decimal_comma
        self.by_name: Final[dict[str, Symbol]] = {}
        self.turning: Final[dict[int, Symbol]] = {}
        self.sliding: Final[dict[int, Symbol]] = {}
        # The results of ``sole_operand``: a dictionary of short keys is the fastest cache.
        self.operands: Final[dict[str, Operand]] = {}
        for symbol in self.symbols:
            self._declare(symbol)
        self.joints: Final = sorted(self.turning | self.sliding)
        self.longest: Final = max(map(len, (*self.by_name, *RESERVED)))
        self._hash: Final = hash((self.symbols, of_books, decimal_comma))
        # Equal vocabularies share one tuple, so that comparing them is fast: many exercises declare
        # the same symbols, and the vocabulary is a cache key for each word of a text.
        self._shared: Final = _shared(self.symbols)

    def _declare(self, symbol: Symbol) -> None:
        if not _CANONICAL.fullmatch(symbol.name):
            raise ValueError(
                say("the symbol name {name!r} is not a plain ASCII name", name=symbol.name)
            )
        for alias in (symbol.name, *symbol.aliases):
            plain = normal_form(alias)
            if not _NORMAL.fullmatch(plain):
                raise ValueError(say("{name!r} cannot be the name of a symbol", name=alias))
            for spelling in characters.spellings(plain):
                if spelling in RESERVED:
                    raise ValueError(
                        say("{name!r} already names a function, a unit or a constant", name=alias)
                    )
                other = self.by_name.setdefault(spelling, symbol)
                if other is not symbol:
                    raise ValueError(
                        say(
                            "{name!r} names both {first!r} and {second!r}",
                            name=alias,
                            first=other.name,
                            second=symbol.name,
                        )
                    )
        # Formulas name their symbols so: l_arm, although its normal form is larm.
        self.by_name[symbol.name] = symbol
        if symbol.joint is not None:
            if symbol.joint in self.turning or symbol.joint in self.sliding:
                raise ValueError(say("joint {joint} has two joint variables", joint=symbol.joint))
            (self.turning if symbol.kind == "angle" else self.sliding)[symbol.joint] = symbol

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Vocabulary) and (
            self.of_books == other.of_books
            and self.decimal_comma == other.decimal_comma
            and (self._shared is other._shared or self.symbols == other.symbols)
        )

    def __hash__(self) -> int:
        return self._hash

    def __repr__(self) -> str:
        return f"Vocabulary({list(self.symbols)!r})"


# --- The syntax tree, whose leaves are these names
#
# The classes are not frozen, because a frozen dataclass takes four times as long to construct.


UnitName = Literal["deg", "rad"]
Operator = Literal["+", "-", "*", "/", "^"]


@dataclass(slots=True)
class Number:
    """A numeric constant, never negative; ``literal`` is its text."""

    value: float
    literal: str = field(compare=False)
    start: int = field(default=0, compare=False)
    end: int = field(default=0, compare=False)


@dataclass(slots=True)
class Pi:
    """The constant π."""

    start: int = field(default=0, compare=False)
    end: int = field(default=0, compare=False)


@dataclass(slots=True)
class SymbolNode:
    """A declared symbol."""

    symbol: Symbol
    start: int = field(default=0, compare=False)
    end: int = field(default=0, compare=False)


@dataclass(slots=True)
class Unit:
    """An operand with an explicit angle unit."""

    operand: "Node"
    unit: UnitName
    start: int = field(default=0, compare=False)
    end: int = field(default=0, compare=False)


@dataclass(slots=True)
class Negation:
    """A minus sign and its operand."""

    operand: "Node"
    start: int = field(default=0, compare=False)
    end: int = field(default=0, compare=False)


@dataclass(slots=True)
class Binary:
    """Two operands joined by an operator."""

    operator: Operator
    left: "Node"
    right: "Node"
    start: int = field(default=0, compare=False)
    end: int = field(default=0, compare=False)


@dataclass(slots=True)
class Call:
    """A function call."""

    function: str
    arguments: tuple["Node", ...]
    start: int = field(default=0, compare=False)
    end: int = field(default=0, compare=False)


Node = Number | Pi | SymbolNode | Unit | Negation | Binary | Call


def children(node: Node) -> tuple[Node, ...]:
    """Return the operands or arguments of ``node``, from left to right."""
    kind = type(node)
    if kind is Binary:
        return (node.left, node.right)  # type: ignore[union-attr]
    if kind is Call:
        return node.arguments  # type: ignore[union-attr]
    if kind is Negation or kind is Unit:
        return (node.operand,)  # type: ignore[union-attr]
    return ()
