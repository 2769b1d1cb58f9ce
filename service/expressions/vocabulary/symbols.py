"""The names that an expression may use."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Final, Literal

from service.expressions.characters import greek
from service.expressions.vocabulary.functions import RESERVED
from service.regex import regex
from service.translations import say

Kind = Literal["angle", "length", "number"]

_CANONICAL: Final = regex(r"[A-Za-z][A-Za-z0-9]*(?:_[A-Za-z0-9]+)*")
_NORMAL: Final = regex(rf"[A-Za-z{greek.CLASS}][A-Za-z0-9{greek.CLASS}]*")
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
    return "".join(greek.VARIANTS.get(letter, letter) for letter in plain)


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
            for spelling in greek.spellings(plain):
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
