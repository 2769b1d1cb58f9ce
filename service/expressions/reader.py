"""What a student wrote -> an expression: characters, tokens, grammar, tree."""

import math
from collections.abc import Mapping
from functools import lru_cache
from typing import Any, Final, Literal

import numpy as np

from service.expressions.build import Builder
from service.expressions.characters import normalise
from service.expressions.degrees import in_degrees, without_degree_functions
from service.expressions.errors import ExpressionError, Note
from service.expressions.evaluate import Program, Samples, compile_tree
from service.expressions.latex import to_latex
from service.expressions.limits import LIMITS
from service.expressions.mathml import to_mathml
from service.expressions.repairs import Failure, explain
from service.expressions.table import Table, UnexpectedTokenError
from service.expressions.text import level, to_text
from service.expressions.tokens import tokenise
from service.expressions.tree import Binary, Node, Number, Variable, children
from service.expressions.unreadable import UnreadableError
from service.expressions.vocabulary import Kind, Vocabulary

AngleUnits = Literal["radians", "degrees"]

_TABLE: Final = Table()
_REMEMBERED: Final = 8192
# How many repaired texts may be tried on one that cannot be read, before there is none to offer.
_ATTEMPTS: Final = 6
# A JSON number is one whatever the symbols are called: 1e-7 is no product of 1 and e.
_NO_SYMBOLS: Final = Vocabulary([])


class Expression:
    """A text that was read. Immutable, except that it compiles itself when first evaluated.

    `tree` carries the units that degrees imply; `symbols` holds the canonical names used.
    """

    __slots__ = ("_program", "notes", "source", "symbols", "tree")

    def __init__(
        self, source: str, tree: Node, notes: tuple[Note, ...], symbols: frozenset[str]
    ) -> None:
        self.source: Final = source
        self.tree: Final = tree
        self.notes: Final = notes
        self.symbols: Final = symbols
        self._program: Program | float | None = None

    def evaluate(
        self, values: Mapping[str, Samples], memo: dict[str, Any] | None = None
    ) -> Samples | float:
        """Return the value for each sample, or a float where no symbol is used.

        `values` gives each symbol of `symbols` as an array of shape (samples,), angles in radians.
        Where the expression is undefined the value is nan or infinite; nothing warns. Expressions
        evaluated at the same `values` may share a `memo`. The result must not be written to: it
        may be one of `values`, or kept in the memo.
        """
        program = self._program
        if program is None:
            program = self._program = compile_tree(self.tree)
        if isinstance(program, float):
            return program
        with np.errstate(all="ignore"):
            result: Samples = program(values, {} if memo is None else memo)
        return result

    def text(self) -> str:
        """Return normal text, which reads back to the same tree."""
        return to_text(self.tree)

    def latex(self) -> str:
        """Return LaTeX for math mode, as typed and not rearranged."""
        return to_latex(self.tree)

    def mathml(self) -> str:
        """Return one presentation <math> element, as typed and not rearranged."""
        return to_mathml(self.tree)

    def __repr__(self) -> str:
        return f"Expression({self.source!r})"


def read(
    source: str | int | float,
    vocabulary: Vocabulary,
    *,
    quantity: Kind = "number",
    angle_unit: AngleUnits = "radians",
) -> Expression:
    """Return the expression that `source` is, in the names of `vocabulary`.

    With `angle_unit` in degrees, bare numbers are degrees inside sin, cos and tan, and in the
    whole entry if `quantity` is "angle". What was read, or why it could not be, is remembered.
    Raises ExpressionError, and nothing else, whatever the text or number.
    """
    if isinstance(source, str):
        text = source
    else:
        text, vocabulary = _written(source), _NO_SYMBOLS
    if len(text) > LIMITS.characters:
        span = (LIMITS.characters, len(text))
        stop = UnreadableError("beyond", span, limit="characters", length=len(text))
        raise _explained(text, stop, vocabulary)
    result = _remembered(text, vocabulary, quantity == "angle", angle_unit == "degrees")
    if isinstance(result, ExpressionError):
        raise result.again()
    return result


def _written(number: int | float) -> str:
    """Return a JSON number as text."""
    if isinstance(number, bool):
        raise _explained("", UnreadableError("boolean", (0, 0)), _NO_SYMBOLS)
    # Python refuses to write out an integer of several thousand digits.
    too_large = isinstance(number, int) and abs(number) > 10**308
    if too_large or not math.isfinite(number):
        raise _explained("", UnreadableError("not_finite", (0, 0)), _NO_SYMBOLS)
    return str(number) if isinstance(number, int) else repr(float(number))


def _explained(text: str, stop: UnreadableError, vocabulary: Vocabulary) -> ExpressionError:
    """Return the error for a text that is not even tried."""
    return explain(Failure(text, vocabulary, stop, lambda _: None))


@lru_cache(maxsize=_REMEMBERED)
def _remembered(
    text: str, vocabulary: Vocabulary, is_angle: bool, degrees: bool
) -> Expression | ExpressionError:
    # An error is kept without its traceback, which would hold every frame of the parse.
    return _Attempts(vocabulary, is_angle, degrees).read(text)


class _Attempts:
    """The reading of a text and, where it cannot be read, of a few repaired ones."""

    def __init__(self, vocabulary: Vocabulary, is_angle: bool, degrees: bool) -> None:
        self.vocabulary = vocabulary
        self.is_angle = is_angle
        self.degrees = degrees
        self.left = _ATTEMPTS

    def read(self, text: str) -> Expression | ExpressionError:
        try:
            return _read(text, self.vocabulary, is_angle=self.is_angle, degrees=self.degrees)
        except UnreadableError as stop:
            return explain(Failure(text, self.vocabulary, stop, self.repaired))

    def repaired(self, text: str) -> str | None:
        """Return `text` where it can be read, else what it would be repaired to, if anything."""
        if not self.left or len(text) > LIMITS.characters:
            return None
        self.left -= 1
        result = self.read(text)
        return text if isinstance(result, Expression) else result.suggestion


def _read(text: str, vocabulary: Vocabulary, *, is_angle: bool, degrees: bool) -> Expression:
    characters = normalise(text)
    if not characters.text or characters.text.isspace():
        raise UnreadableError("empty", (0, len(text)))
    notes: list[Note] = []
    tokens = tokenise(text, characters, vocabulary, degrees=degrees, notes=notes)
    builder = Builder(text, notes, degrees=degrees)
    try:
        tree: Node = _TABLE.parse(tokens, builder.table())
    except UnexpectedTokenError as unexpected:
        at = unexpected.index
        raise UnreadableError("grammar", tokens[at][2:], tokens=tokens, index=at) from None
    symbols = _measure(tree)
    if degrees:
        tree = in_degrees(tree, is_angle=is_angle, notes=notes)
    elif builder.degree_functions:
        tree = without_degree_functions(tree, notes=notes)
    return Expression(text, tree, tuple(notes), symbols)


def _measure(tree: Node) -> frozenset[str]:
    """Return the symbols used. Raises UnreadableError for too large or too deep a tree.

    A run of sums, or of products, counts as one level, for that is how it is written.
    """
    symbols = set()
    count = 0
    pending = [(tree, 1)]
    while pending:
        node, depth = pending.pop()
        count += 1
        if depth > LIMITS.depth:
            raise UnreadableError("beyond", (tree.start, tree.end), limit="depth")
        if count > LIMITS.nodes:
            raise UnreadableError("beyond", (tree.start, tree.end), limit="nodes")
        kind = type(node)
        if kind is Variable:
            symbols.add(node.symbol.name)  # type: ignore[union-attr]
        elif kind is Binary:
            left: Node = node.left  # type: ignore[union-attr]
            flat = type(left) is Binary and level(left) == level(node)
            pending.append((left, depth if flat else depth + 1))
            pending.append((node.right, depth + 1))  # type: ignore[union-attr]
        elif kind is not Number:
            pending.extend([(child, depth + 1) for child in children(node)])
    return frozenset(symbols)
