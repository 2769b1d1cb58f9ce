"""Formula as typed -> expression: characters, tokens, syntax tree, program."""

import math
import re
from bisect import bisect_left
from collections.abc import Iterable, Mapping
from functools import lru_cache
from typing import Any, Final, Literal, NamedTuple

import numpy as np

from service.expressions.characters.normalise import normalise
from service.expressions.errors import ExpressionError, Note, UnreadableError
from service.expressions.evaluation.samples import SampleArray, SymbolValues, compile_tree
from service.expressions.limits import LIMITS
from service.expressions.parsing.degrees import in_degrees, without_degree_functions
from service.expressions.parsing.equation import right_side
from service.expressions.parsing.lexing.lexer import Lexer
from service.expressions.parsing.parser import parse
from service.expressions.parsing.tree_builder import Builder
from service.expressions.printing.latex import to_latex
from service.expressions.printing.mathml import to_mathml
from service.expressions.printing.spelling import TypedFormula
from service.expressions.printing.text import to_text
from service.expressions.reading_work import symbols_in
from service.expressions.repairs import Failure, explain
from service.expressions.tree import Binary, Node, Number, SymbolNode, children
from service.expressions.vocabulary.symbols import Kind, Vocabulary
from service.time_slices import checkpoint

AngleUnit = Literal["radians", "degrees"]

# The numbers of texts that are remembered: of up to 40 characters, of up to 160, 640, and of more.
# A character may take 100 bytes of memory, so the texts of each group take about 16 MB at most.
_LENGTHS: Final = (40, 160, 640)
_REMEMBERED: Final = (4096, 1024, 256, 64)
# The grading asks for a tree soon after reading, if at all.
_TREES: Final = 128
_SETS_OF_SYMBOLS: Final = 1024
# The operators of a left operand that stands without brackets, in one run with its operator.
_RUNS: Final = {"+": "+-", "-": "+-", "*": "*/", "/": "*/", "^": "^"}
_DECIMAL: Final = re.compile(r"\d\.|\.\d")
# How many repaired texts may be tried for one that cannot be read, and how many symbols they may
# have together: two of the longest that are repaired.
_ATTEMPTS: Final = 6
_TRIED_SYMBOLS: Final = 1200
# A JSON number is one whatever the symbols are called: 1e-7 is no product of 1 and e.
_NO_SYMBOLS: Final = Vocabulary([])


class ReadingOptions(NamedTuple):
    """How a text is read.

    ``degrees`` tells whether angles are in degrees, and ``is_angle`` whether the whole entry is
    then such an angle.
    """

    vocabulary: Vocabulary
    is_angle: bool
    degrees: bool


class Expression:
    """A text that was read. Immutable.

    ``notes`` are on how it was read, ``symbols`` holds the canonical names used, and
    ``has_decimal`` tells whether a decimal number was written.

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
        options: ReadingOptions | None = None,
    ) -> None:
        """With the ``options`` that read ``source`` as ``tree``, the tree itself is not kept."""
        self.source: Final = source
        self.notes: Final = notes
        self.symbols: Final = symbols
        self.has_decimal: Final = "." in source and _DECIMAL.search(source) is not None
        self._program: Final = compile_tree(tree)
        # The options as one tuple would be one more object for each text.
        self._vocabulary: Final = options and options.vocabulary
        self._is_angle: Final = options is not None and options.is_angle
        self._degrees: Final = options is not None and options.degrees
        self._tree: Final = tree if options is None else None

    @property
    def tree(self) -> Node:
        """The syntax tree, with the units that degrees imply. It must not be changed."""
        if self._tree is not None:
            return self._tree
        assert self._vocabulary is not None
        return _parsed(self.source, self._vocabulary, self._is_angle, self._degrees).tree

    @property
    def typed(self) -> TypedFormula:
        """The text with its tree, as a spelling is found in it."""
        return TypedFormula(self.source, self.tree, self._degrees)

    def evaluate(
        self, values: SymbolValues, memo: dict[str, Any] | None = None
    ) -> SampleArray | float:
        """The value for each sample, of shape (samples,), or a float where no symbol is used.

        ``values`` gives each symbol of ``symbols`` as an array of shape (samples,), angles in
        radians. Where the expression is undefined the value is nan or infinite; nothing warns.
        Expressions evaluated at the same ``values`` may share a ``memo``. The result must not be
        changed: it may be one of ``values``, or kept in the memo.
        """
        program = self._program
        if isinstance(program, float):
            return program
        if program.symbol is not None:
            return values[program.symbol]
        with np.errstate(all="ignore"):
            result: SampleArray = program(values, {} if memo is None else memo)
        return result

    def text(self) -> str:
        """Normal text, which reads back to the same tree."""
        return to_text(self.tree)

    def latex(self) -> str:
        """LaTeX for math mode, as typed and not rearranged."""
        return to_latex(self.tree)

    def mathml(self) -> str:
        """One presentation ``<math>`` element, as typed and not rearranged."""
        return to_mathml(self.tree)

    def __repr__(self) -> str:
        return f"Expression({self.source!r})"


def evaluate_all(
    expressions: Iterable[Expression | None],
    values: Mapping[str, SampleArray],
    memo: dict[str, Any],
) -> list[SampleArray | float]:
    """The results of each ``evaluate``, in less time; nan where there is no expression."""
    with np.errstate(all="ignore"):
        programs = [math.nan if each is None else each._program for each in expressions]
        return [each if isinstance(each, float) else each(values, memo) for each in programs]


def read(
    source: str | int | float,
    vocabulary: Vocabulary,
    *,
    quantity: Kind = "number",
    angle_unit: AngleUnit = "radians",
    repairs: bool = True,
) -> Expression:
    """The expression that ``source`` is, in the names of ``vocabulary``.

    With ``angle_unit`` in degrees, bare numbers are degrees inside sin, cos and tan, and in the
    whole entry if ``quantity`` is "angle". The result, or the error, is remembered. Without
    ``repairs``, no repaired text is tried; trying them costs more than all else.
    Raises ExpressionError, and nothing else, whatever the text or number.
    """
    if isinstance(source, str):
        text = source
    else:
        text, vocabulary = _number_as_text(source), _NO_SYMBOLS
    if len(text) > LIMITS.characters:
        span = (LIMITS.characters, len(text))
        error = UnreadableError("beyond", span, limit="characters", length=len(text))
        raise _explained(text, error, vocabulary)
    degrees = angle_unit == "degrees"
    # In radians an angle is read as any number is, and is remembered as one.
    options = (vocabulary, degrees and quantity == "angle", degrees)
    remembered = _remembered[bisect_left(_LENGTHS, len(text))]
    result = remembered(text, *options, _ATTEMPTS if repairs else 0)
    if isinstance(result, ExpressionError):
        raise result.again()
    return result


def _number_as_text(number: int | float) -> str:
    if isinstance(number, bool):
        raise _explained("", UnreadableError("boolean", (0, 0)), _NO_SYMBOLS)
    # Python refuses to write out an integer of several thousand digits.
    too_large = isinstance(number, int) and abs(number) > 10**308
    if too_large or not math.isfinite(number):
        raise _explained("", UnreadableError("not_finite", (0, 0)), _NO_SYMBOLS)
    return str(number) if isinstance(number, int) else repr(float(number))


def _explained(text: str, error: UnreadableError, vocabulary: Vocabulary) -> ExpressionError:
    """The error for a text that is not even tried."""
    return explain(Failure(text, vocabulary, error, lambda _: None))


def _read(
    text: str, vocabulary: Vocabulary, is_angle: bool, degrees: bool, attempts: int
) -> Expression | ExpressionError:
    # An error is kept without its traceback, which would hold every frame of the parse.
    reading = _Reading(ReadingOptions(vocabulary, is_angle, degrees), attempts)
    result = reading.read(text)
    if isinstance(result, ExpressionError):
        result.tried = reading.tried
    return result


_remembered: Final = [lru_cache(maxsize=number)(_read) for number in _REMEMBERED]


class _Reading:
    """The reading of a text, with a number of attempts to read repaired ones."""

    def __init__(self, options: ReadingOptions, attempts: int) -> None:
        self.options = options
        self.attempts = attempts
        self.tried = 0

    def read(self, text: str) -> Expression | ExpressionError:
        checkpoint()
        try:
            parsed = _parsed(text, *self.options)
        except UnreadableError as error:
            return explain(Failure(text, self.options.vocabulary, error, self.repaired))
        return Expression(text, parsed.tree, parsed.notes, parsed.symbols, self.options)

    def repaired(self, text: str) -> str | None:
        """``text`` where it can be read, else its own repaired text, if it has one."""
        if not self.attempts or len(text) > LIMITS.repaired:
            return None
        symbols = symbols_in(text)
        if self.tried + symbols > _TRIED_SYMBOLS:
            return None
        self.attempts -= 1
        self.tried += symbols
        result = self.read(text)
        return text if isinstance(result, Expression) else result.suggestion


class _Parsed(NamedTuple):
    """A text's syntax tree, the notes on it and the canonical names in it."""

    tree: Node
    notes: tuple[Note, ...]
    symbols: frozenset[str]


@lru_cache(maxsize=_TREES)
def _parsed(text: str, vocabulary: Vocabulary, is_angle: bool, degrees: bool) -> _Parsed:
    """The syntax tree of ``text`` and its notes. Raises UnreadableError."""
    notes: list[Note] = []
    text, note = right_side(text, vocabulary)
    notes += (note,) if note else ()
    characters = normalise(text)
    if not characters.text or characters.text.isspace():
        raise UnreadableError("empty", (0, len(text)))
    # One character, as ½, may stand for several.
    if len(characters.text) > LIMITS.characters:
        raise UnreadableError("beyond", (0, len(text)), limit="terms")
    tokens = Lexer(text, characters, vocabulary, degrees=degrees, notes=notes).run()
    builder = Builder(text, notes, vocabulary.turning, degrees=degrees)
    tree = parse(tokens, builder)
    symbols = _shared(_used_symbols(tree))
    if degrees:
        tree = in_degrees(tree, is_angle=is_angle, notes=notes)
    elif builder.degree_functions:
        tree = without_degree_functions(tree, notes=notes)
    return _Parsed(tree, tuple(notes[: LIMITS.notes]), symbols)


@lru_cache(maxsize=_SETS_OF_SYMBOLS)
def _shared(symbols: frozenset[str]) -> frozenset[str]:
    """One and the same set for all texts that use the same symbols."""
    return symbols


def _used_symbols(tree: Node) -> frozenset[str]:
    """The canonical names in ``tree``. Raises UnreadableError where it is too large or too deep.

    A run of sums, or of products, counts as one level, for that is how it is written.
    """
    symbols = set()
    count, depth = 0, 0
    nodes: list[Any] = [tree]
    while nodes:
        below: list[Any] = []
        for node in nodes:
            kind = type(node)
            if kind is SymbolNode:
                symbols.add(node.symbol.name)
            elif kind is Binary:
                (nodes if _is_run(node) else below).append(node.left)
                below.append(node.right)
            elif kind is not Number:
                below += children(node)
        count, depth = count + len(nodes), depth + 1
        if count > LIMITS.nodes or depth > LIMITS.depth:
            raise UnreadableError("beyond", (tree.start, tree.end), limit=_broken_limit(tree))
        nodes = below
    if count > LIMITS.tree_depth and _is_beyond_depth(tree):
        raise UnreadableError("beyond", (tree.start, tree.end), limit="terms")
    return frozenset(symbols)


def _is_beyond_depth(tree: Node) -> bool:
    """Whether the tree itself is too deep, which a long sum may be."""
    level: list[Any] = [tree]
    for _ in range(LIMITS.tree_depth):
        level = [child for node in level for child in children(node)]
    return bool(level)


def _broken_limit(tree: Node) -> str:
    """The limit that is broken first on the way from right to left, for a message names one."""
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
        if type(node) is Binary and _is_run(node):
            pending[-2] = node.left, depth
    return "nodes"


def _is_run(node: Binary) -> bool:
    """Whether the operand on the left is in one run with ``node``."""
    return type(node.left) is Binary and node.left.operator in _RUNS[node.operator]
