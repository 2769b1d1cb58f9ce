"""Words in the notation of programs: np.cos, std::cos, M_PI_2, Subscript[θ, 1], 0.5f, %pi."""

from typing import Final

from service.expressions.characters import greek
from service.expressions.tree import Binary, Call, Node, Number, Pi
from service.expressions.vocabulary.functions import CONSTANTS
from service.regex import regex

MEMBER: Final = regex(r"(?:\.|::)(?=[^\W\d_])")
_RADIANS: Final = regex(r"(?:radians|toRadians|rad)(?=\()")
# More than a turn in radians, so probably degrees, which ``rad`` converts in SymPy.
_MANY: Final = regex(r"\(\s*[-+]?\s*(?:[7-9]|\d\d+)(?:\.\d*)?\s*\)")
_SUBSCRIPT: Final = regex(rf"\[\s*([A-Za-z{greek.CLASS}]+)\s*,\s*([A-Za-z0-9]{{1,12}})\s*\]")
# Mathematica and Maxima count from 1, and write an index in square brackets.
_COUNTS_FROM_ONE: Final = regex(r"(?:Sin|Cos|Tan|Sqrt|ArcSin|ArcCos|ArcTan|Subscript)\s*\[|%pi")


def degrees_function_end(text: str, at: int) -> int | None:
    """Return the end of a function such as sympy.rad, which converts degrees, or None."""
    found = _RADIANS.match(text, at)
    return found and found.end()


def is_more_than_a_turn(text: str, at: int) -> bool:
    """True if the number in brackets at ``text[at]`` is more than a full turn in radians."""
    return _MANY.match(text, at) is not None


def subscripted(text: str, at: int) -> tuple[str, int] | None:
    """Return the name in ``Subscript[name, index]``, and its end; ``at`` is the position of [."""
    found = _SUBSCRIPT.match(text, at)
    return found and (f"{found[1]}{found[2]}", found.end())


def counts_from_one(text: str) -> bool:
    """True if ``text`` is from a program in which an index in square brackets counts from 1."""
    return _COUNTS_FROM_ONE.search(text) is not None


def constant(name: str, start: int, end: int) -> Node:
    """Return the tree of a constant of C: π/2 for M_PI_2."""
    form, value = CONSTANTS[name]
    number = Number(float(value), str(value), start, end)
    if form == "pi":
        return Binary("/", Pi(start, end), number, start, end)
    root = Call("sqrt", (number,), start, end)
    if form == "sqrt":
        return root
    return Binary("/", Number(1.0, "1", start, end), root, start, end)
