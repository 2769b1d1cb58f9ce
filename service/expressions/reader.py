"""What a student wrote -> an expression: characters, tokens, grammar, tree."""

import math
import re
from collections.abc import Iterable, Mapping
from functools import lru_cache
from typing import Any, Final, Literal, NamedTuple

import numpy as np

from service.expressions.characters.normalise import normalise
from service.expressions.errors import ExpressionError, Note
from service.expressions.evaluation.samples import Samples, compile_tree
from service.expressions.limits import LIMITS
from service.expressions.parsing.degrees import in_degrees, without_degree_functions
from service.expressions.parsing.lexer import tokenise
from service.expressions.parsing.parser import parse
from service.expressions.parsing.tree_builder import Builder
from service.expressions.printing.latex import to_latex
from service.expressions.printing.mathml import to_mathml
from service.expressions.printing.text import to_text
from service.expressions.repairs import Failure, explain
from service.expressions.tree import Binary, Node, Number, Variable, children
from service.expressions.unreadable import UnreadableError
from service.expressions.vocabulary.symbols import Kind, Vocabulary

AngleUnits = Literal["radians", "degrees"]

_REMEMBERED: Final = 8192
# Whoever grades asks for the tree soon after reading, if at all.
_TREES: Final = 128
_SETS_OF_SYMBOLS: Final = 1024
# What may stand to the left of an operator without brackets, and in one run with it.
_RUNS: Final = {"+": "+-", "-": "+-", "*": "*/", "/": "*/", "^": "^"}
_DECIMAL: Final = re.compile(r"\d\.|\.\d")
# How many repaired texts may be tried on one that cannot be read, before there is none to offer.
_ATTEMPTS: Final = 6
# A JSON number is one whatever the symbols are called: 1e-7 is no product of 1 and e.
_NO_SYMBOLS: Final = Vocabulary([])


# How a text is read: the names it may use, whether all of it is an angle, whether angles are in
# degrees.
Manner = tuple[Vocabulary, bool, bool]


class Expression:
    """A text that was read. Immutable.

    `notes` are on how it was read, `symbols` holds the canonical names used, and `has_decimal`
    tells whether a decimal number was written.

    Thousands of texts are remembered, each as a program and a handful of other objects. Their trees
    are not: together they are a million objects, and the garbage collector would look at every one
    of them in each of its rounds. A tree is built anew from the text when it is asked for.
    """

    __slots__ = (
        "_degrees", "_is_angle", "_program", "_tree", "_vocabulary", "has_decimal", "notes",
        "source", "symbols",
    )  # fmt: skip

    def __init__(
        self,
        source: str,
        tree: Node,
        notes: tuple[Note, ...],
        symbols: frozenset[str],
        manner: Manner | None = None,
    ) -> None:
        """With a `manner` of reading that gives this tree, the tree itself is not kept."""
        self.source: Final = source
        self.notes: Final = notes
        self.symbols: Final = symbols
        self.has_decimal: Final = "." in source and _DECIMAL.search(source) is not None
        self._program: Final = compile_tree(tree)
        # A tuple of them would be one more object for each text.
        self._vocabulary: Final = manner and manner[0]
        self._is_angle: Final = manner is not None and manner[1]
        self._degrees: Final = manner is not None and manner[2]
        self._tree: Final = tree if manner is None else None

    @property
    def tree(self) -> Node:
        """The syntax tree, with the units that degrees imply. It must not be written to."""
        if self._tree is not None:
            return self._tree
        assert self._vocabulary is not None
        return _parsed(self.source, self._vocabulary, self._is_angle, self._degrees).tree

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
        if isinstance(program, float):
            return program
        if program.symbol is not None:
            return values[program.symbol]
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


def evaluate_all(
    expressions: Iterable[Expression | None], values: Mapping[str, Samples], memo: dict[str, Any]
) -> list[Samples | float]:
    """Return what each `evaluate` gives, in less time; nan where there is no expression."""
    with np.errstate(all="ignore"):
        programs = [math.nan if each is None else each._program for each in expressions]
        return [each if isinstance(each, float) else each(values, memo) for each in programs]


def read(
    source: str | int | float,
    vocabulary: Vocabulary,
    *,
    quantity: Kind = "number",
    angle_unit: AngleUnits = "radians",
    repairs: bool = True,
) -> Expression:
    """Return the expression that `source` is, in the names of `vocabulary`.

    With `angle_unit` in degrees, bare numbers are degrees inside sin, cos and tan, and in the
    whole entry if `quantity` is "angle". What was read, or why it could not be, is remembered.
    Without `repairs`, repaired texts are not tried, which costs more than all else.
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
    manner = (vocabulary, quantity == "angle", angle_unit == "degrees")
    result = _remembered(text, *manner, _ATTEMPTS if repairs else 0)
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
    text: str, vocabulary: Vocabulary, is_angle: bool, degrees: bool, attempts: int
) -> Expression | ExpressionError:
    # An error is kept without its traceback, which would hold every frame of the parse.
    return _Attempts((vocabulary, is_angle, degrees), attempts).read(text)


class _Attempts:
    """The reading of a text and, where it cannot be read, of a few repaired ones."""

    def __init__(self, manner: Manner, attempts: int) -> None:
        self.manner = manner
        self.left = attempts

    def read(self, text: str) -> Expression | ExpressionError:
        try:
            parsed = _parsed(text, *self.manner)
        except UnreadableError as stop:
            return explain(Failure(text, self.manner[0], stop, self.repaired))
        return Expression(text, parsed.tree, parsed.notes, parsed.symbols, self.manner)

    def repaired(self, text: str) -> str | None:
        """Return `text` where it can be read, else what it would be repaired to, if anything."""
        if not self.left or len(text) > LIMITS.characters:
            return None
        self.left -= 1
        result = self.read(text)
        return text if isinstance(result, Expression) else result.suggestion


class _Parsed(NamedTuple):
    """What a text was read as."""

    tree: Node
    notes: tuple[Note, ...]
    symbols: frozenset[str]


@lru_cache(maxsize=_TREES)
def _parsed(text: str, vocabulary: Vocabulary, is_angle: bool, degrees: bool) -> _Parsed:
    """Return what `text` is. Raises UnreadableError."""
    characters = normalise(text)
    if not characters.text or characters.text.isspace():
        raise UnreadableError("empty", (0, len(text)))
    notes: list[Note] = []
    tokens = tokenise(text, characters, vocabulary, degrees=degrees, notes=notes)
    builder = Builder(text, notes, degrees=degrees)
    tree = parse(tokens, builder)
    symbols = _shared(_measure(tree))
    if degrees:
        tree = in_degrees(tree, is_angle=is_angle, notes=notes)
    elif builder.degree_functions:
        tree = without_degree_functions(tree, notes=notes)
    return _Parsed(tree, tuple(notes), symbols)


@lru_cache(maxsize=_SETS_OF_SYMBOLS)
def _shared(symbols: frozenset[str]) -> frozenset[str]:
    """Return the same set for every text that uses the same symbols."""
    return symbols


def _measure(tree: Node) -> frozenset[str]:
    """Return the symbols used. Raises UnreadableError for too large or too deep a tree.

    A run of sums, or of products, counts as one level, for that is how it is written.
    """
    symbols = set()
    count, depth = 0, 0
    nodes: list[Any] = [tree]
    while nodes:
        below: list[Any] = []
        for node in nodes:
            kind = type(node)
            if kind is Variable:
                symbols.add(node.symbol.name)
            elif kind is Binary:
                (nodes if _runs_on(node) else below).append(node.left)
                below.append(node.right)
            elif kind is not Number:
                below += children(node)
        count, depth = count + len(nodes), depth + 1
        if count > LIMITS.nodes or depth > LIMITS.depth:
            raise UnreadableError("beyond", (tree.start, tree.end), limit=_broken(tree))
        nodes = below
    return frozenset(symbols)


def _broken(tree: Node) -> str:
    """Return the limit that is met first on the way from right to left: a student is told one."""
    count = 0
    pending: list[tuple[Any, int]] = [(tree, 1)]
    while pending:
        node, depth = pending.pop()
        count += 1
        if depth > LIMITS.depth:
            return "depth"
        if count > LIMITS.nodes:
            break
        pending.extend((child, depth + 1) for child in children(node))
        if type(node) is Binary and _runs_on(node):
            pending[-2] = node.left, depth
    return "nodes"


def _runs_on(node: Binary) -> bool:
    """Tell whether the operand on the left is in one run with `node`."""
    return type(node.left) is Binary and node.left.operator in _RUNS[node.operator]
