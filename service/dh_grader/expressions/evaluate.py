"""A syntax tree -> its values: at all samples at once, or for one value of each symbol."""

import math
import operator
from collections.abc import Callable, Mapping
from functools import lru_cache
from math import isfinite, pi
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from dh_grader.expressions.vocabulary import (
    Binary,
    Call,
    Negation,
    Node,
    Number,
    SymbolNode,
    Unit,
    children,
)

# --- Compile a tree to a program that computes its values at all samples at once
#
# A program is one flat tuple of the tree's parts. Each part has a key (its formula in reverse
# Polish notation), then its function and the places of its operands. The program of 2*cos(theta1)
# is:
#
#      0  "#2.0", None, 2.0
#      3  "theta1", None
#      5  "theta1 cos", "cos", 3, None
#      9  "#2.0 theta1 cos *", "*", 0, 5
#
# Equal parts have equal keys, so programs with a common ``memo`` compute cos(theta1) only once.
#
# Parts without symbols are folded to constants. The programs of thousands of texts are memoized as
# flat tuples, because the garbage collector skips a tuple of strings and numbers but visits every
# tree and closure.


SampleArray = NDArray[np.float64]
SymbolValues = Mapping[str, SampleArray]
Memo = dict[str, Any]
Function = Callable[..., Any]
# Consecutive parts, operands before their function; the whole expression is last. A part is its
# key, the name of its function and the places of its operands. A symbol is its key and None; a
# constant is its key, None and its value. The key of a part too long to occur again is None.
Steps = tuple[Any, ...]

_RADIANS: Final = {"deg": pi / 180, "rad": 1.0}
# These may give a finite value for a non-finite operand, but 1/(1/0) must not be 0.
_MAY_HIDE_NON_FINITE: Final = frozenset({"/", "^", "atan", "atan2", "exp"})
# These may be undefined or infinite although all operands are finite.
_MAY_BE_NON_FINITE: Final = frozenset({"/", "^", "tan", "asin", "acos", "sqrt", "exp"})
# Longer parts rarely occur twice, and their keys would need much memory.
_LONGEST_KEY: Final = 100


def _strict(function: Function) -> Function:
    """Return ``function`` changed so that it gives nan wherever an operand is not finite."""

    def apply(*operands: Any) -> Any:
        finite = np.isfinite(operands[0])
        for operand in operands[1:]:
            finite = finite & np.isfinite(operand)
        return np.where(finite, function(*operands), np.nan)

    return apply


_SAMPLES_FUNCTIONS: Final[dict[str | None, Function]] = {
    "+": np.add, "-": np.subtract, "*": np.multiply, "/": np.divide, "^": np.power, "²": np.square,
    "negative": np.negative, "sin": np.sin, "cos": np.cos, "tan": np.tan, "asin": np.arcsin,
    "acos": np.arccos, "atan": np.arctan, "atan2": np.arctan2, "sqrt": np.sqrt, "abs": np.absolute,
    "exp": np.exp,
}  # fmt: skip
# Python's own arithmetic gives the same bits in a tenth of the time, without warnings.
_EXACT: Final[dict[str, Function]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "negative": operator.neg,
}  # fmt: skip
_STRICT: Final = {name: f"strict {name}" for name in _MAY_HIDE_NON_FINITE}
_SAMPLES_FUNCTIONS.update(
    {strict: _strict(_SAMPLES_FUNCTIONS[name]) for name, strict in _STRICT.items()}
)


class Program:
    """The compiled form of one expression with at least one symbol. Immutable.

    The step at index ``whole`` computes the whole expression. ``symbol`` is the name of an
    expression that is a single symbol, else None.
    """

    __slots__ = ("steps", "symbol", "whole")

    def __init__(self, steps: Steps, whole: int) -> None:
        self.steps: Final = steps
        self.whole: Final = whole
        self.symbol: Final[str | None] = steps[0] if whole == 0 else None

    def __call__(self, values: SymbolValues, memo: Memo) -> Any:
        """Return the value at each sample.

        ``values`` has an array ``(samples,)`` for each symbol. A ``memo`` may be used again only
        with the same values.
        """
        # An undefined part makes the whole result undefined; numpy warns of it unless warnings are
        # off.
        if not memo:
            memo.update(values)
        result = memo.get(self.steps[self.whole])
        return _samples_value(self.steps, self.whole, memo) if result is None else result


def _samples_value(steps: Steps, at: int, memo: Memo) -> Any:
    key, name = steps[at], steps[at + 1]
    if name is None:
        if key[0] != "#":
            raise KeyError(key)
        # numpy takes an array of no dimensions faster than a Python float.
        result = memo[key] = np.asarray(steps[at + 2])
        return result
    left, right = steps[at + 2], steps[at + 3]
    first = memo.get(steps[left])
    if first is None:
        first = _samples_value(steps, left, memo)
    if right is None:
        result = _SAMPLES_FUNCTIONS[name](first)
    else:
        second = memo.get(steps[right])
        if second is None:
            second = _samples_value(steps, right, memo)
        result = _SAMPLES_FUNCTIONS[name](first, second)
    if key is not None:
        memo[key] = result
    return result


def compile_tree(tree: Node) -> Program | float:
    """Return the program of ``tree``, or its value if it has no symbols."""
    compiler = _Compiler()
    whole = compiler.part(tree)
    value = compiler.constants.get(whole)
    return Program(tuple(compiler.steps), whole) if value is None else value


@lru_cache(maxsize=1024)
def _sine_or_cosine_key(function: str, symbol: str) -> str:
    return f"{symbol} {function}"


class _Compiler:
    __slots__ = ("constants", "maybe_non_finite", "steps")

    def __init__(self) -> None:
        self.steps: list[Any] = []
        self.constants: dict[int, float] = {}
        self.maybe_non_finite: set[int | None] = set()

    def part(self, node: Node) -> int:
        """Append the steps that compute ``node``. Return the index of the last step."""
        # Comparing types takes a third of the time of ``match``, and this is on the grading path.
        kind = type(node)
        if kind is Binary:
            left, right = self.part(node.left), self.part(node.right)  # type: ignore[union-attr]
            name = node.operator  # type: ignore[union-attr]
            steps = self.steps
            if self.constants or name in _MAY_BE_NON_FINITE or self.maybe_non_finite:
                return self._apply(name, left, right)
            # A fast path, as in ``_apply``.
            first, second = steps[left], steps[right]
            is_short = first and second and len(first) + len(second) < _LONGEST_KEY
            steps += (f"{first} {second} {name}" if is_short else None, name, left, right)
            return len(steps) - 4
        if kind is SymbolNode:
            steps = self.steps
            steps += (node.symbol.name, None)  # type: ignore[union-attr]
            return len(steps) - 2
        if kind is Call:
            function, arguments = node.function, node.arguments  # type: ignore[union-attr]
            if type(arguments[0]) is SymbolNode and (function == "cos" or function == "sin"):
                # A fast path for most calls.
                steps, symbol = self.steps, arguments[0].symbol.name
                at = len(steps)
                steps += (symbol, None, _sine_or_cosine_key(function, symbol), function, at, None)
                return at + 2
            return self._apply(function, *map(self.part, arguments))
        if kind is Number:
            return self._constant(node.value)  # type: ignore[union-attr]
        if kind is Negation:
            return self._apply("negative", self.part(node.operand))  # type: ignore[union-attr]
        if kind is Unit:
            operand = self.part(node.operand)  # type: ignore[union-attr]
            return self._apply("*", operand, self._constant(_RADIANS[node.unit]))  # type: ignore[union-attr]
        return self._constant(pi)

    def _constant(self, value: float) -> int:
        at = len(self.steps)
        self.steps += (f"#{value!r}", None, value)
        self.constants[at] = value
        if not isfinite(value):
            self.maybe_non_finite.add(at)
        return at

    def _apply(self, name: str, left: int, right: int | None = None) -> int:
        constants, steps = self.constants, self.steps
        if constants:
            if name == "^" and right is not None and constants.get(right) == 2.0:
                self._remove(right)
                name, right = "²", None
            if left in constants and (right is None or right in constants):
                return self._folded(name, self._remove(left, right))
        at = len(steps)
        if self.maybe_non_finite and not self.maybe_non_finite.isdisjoint((left, right)):
            name = _STRICT.get(name, name)
            self.maybe_non_finite.add(at)
        elif name in _MAY_BE_NON_FINITE:
            self.maybe_non_finite.add(at)
        key = steps[left]
        if right is not None:
            other = steps[right]
            key = None if key is None or other is None else f"{key} {other}"
        key = None if key is None or len(key) > _LONGEST_KEY else f"{key} {name}"
        steps += (key, name, left, right)
        return at

    def _remove(self, *places: int | None) -> list[float]:
        taken = [at for at in places if at is not None]
        self.maybe_non_finite.difference_update(taken)
        del self.steps[taken[0] :]
        return [self.constants.pop(at) for at in taken]

    def _folded(self, name: str, values: list[float]) -> int:
        if name in _EXACT:
            return self._constant(_EXACT[name](*values))
        if not all(map(isfinite, values)):
            name = _STRICT.get(name, name)
        with np.errstate(all="ignore"):
            return self._constant(float(_SAMPLES_FUNCTIONS[name](*values)))


# --- Evaluate many trees for one value of each symbol, in plain floats
#
# The trees share most of their nodes, so the value of a shared node is computed once. To evaluate
# one tree at many samples, use ``samples``.


Known = dict[int, float]

_POINT_FUNCTIONS: Final[dict[str, Callable[..., float]]] = {
    "sin": math.sin, "cos": math.cos, "tan": math.tan, "asin": math.asin, "acos": math.acos,
    "atan": math.atan, "atan2": math.atan2, "sqrt": math.sqrt, "abs": abs, "exp": math.exp,
}  # fmt: skip
# math.pow raises an error for a root of a negative number; ** would return a complex number.
_OPERATORS: Final[dict[str, Callable[[float, float], float]]] = {
    "+": operator.add, "-": operator.sub, "*": operator.mul, "/": operator.truediv, "^": math.pow,
}  # fmt: skip


def known_values(tree: Node, at: Mapping[str, float]) -> Known:
    """Map the id of each node of ``tree`` to its value; ``at`` has the value of each symbol.

    The ids are valid only as long as the tree exists.
    """
    known: Known = {}
    _learn(tree, at, known)
    return known


def _learn(node: Node, at: Mapping[str, float], known: Known) -> None:
    for child in children(node):
        _learn(child, at, known)
    known[id(node)] = value_at(node, at, known)


def value_at(node: Node, at: Mapping[str, float], known: Known) -> float:
    """Return the value of ``node`` for the symbols' values ``at``; nan if it is undefined.

    Nodes whose ids are in ``known`` are not evaluated again.
    """
    try:
        return _point_value(node, at, known)
    except (ValueError, ArithmeticError):
        return math.nan


def _point_value(node: Node, at: Mapping[str, float], known: Known) -> float:
    value = known.get(id(node))
    if value is not None:
        return value
    if isinstance(node, Binary):
        left, right = _point_value(node.left, at, known), _point_value(node.right, at, known)
        return _OPERATORS[node.operator](left, right)
    if isinstance(node, Call):
        return _POINT_FUNCTIONS[node.function](
            *[_point_value(part, at, known) for part in node.arguments]
        )
    if isinstance(node, SymbolNode):
        return at[node.symbol.name]
    if isinstance(node, Number):
        return node.value
    if isinstance(node, Negation):
        return -_point_value(node.operand, at, known)
    if isinstance(node, Unit):
        operand = _point_value(node.operand, at, known)
        return math.radians(operand) if node.unit == "deg" else operand
    return pi
