"""Read a typed formula in four stages: characters, tokens, syntax tree, program."""

import math
from bisect import bisect_left
from collections.abc import Iterable, Mapping
from functools import lru_cache
from typing import Any, Final, Literal, NamedTuple

import numpy as np

from service.expressions.characters.decimal_comma import with_points_and_commas
from service.expressions.characters.normalise import normalise
from service.expressions.errors import ExpressionError, Note, UnreadableError
from service.expressions.evaluation.samples import SampleArray, SymbolValues, compile_tree
from service.expressions.limits import LIMITS
from service.expressions.parsing.degrees import in_degrees, without_degree_functions
from service.expressions.parsing.equation import right_side
from service.expressions.parsing.lexing.lexer import Lexer
from service.expressions.parsing.lexing.tokens import END, Token
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
from service.regex import regex
from service.time_slices import checkpoint

AngleUnit = Literal["radians", "degrees"]

# The cached texts: of up to 40 characters, of up to 160, of up to 640, and longer ones. A character
# may take 100 bytes of memory, so each group takes about 16 MB at most.
_LENGTHS: Final = (40, 160, 640)
_CACHED_TEXTS: Final = (4096, 1024, 256, 64)
# Grading needs a tree soon after reading, if at all.
_CACHED_TREES: Final = 128
_CACHED_SYMBOL_SETS: Final = 1024
# For each operator: the operators of a left operand that needs no brackets and extends its run.
_RUNS: Final = {"+": "+-", "-": "+-", "*": "*/", "/": "*/", "^": "^"}
# A token becomes at most 20 nodes, so so few of them never exceed the limit of nodes: c123456789.
_FEW_TOKENS: Final = LIMITS.nodes // 20
# The levels of the tree that a token adds at most, if not one. The square of a hypotenuse has four.
# All operands together add three: c12 is a cosine of a sum of symbols.
_LEVELS: Final = {
    "NAME": 0, "NUMBER": 0, "LEFT": 0, "RIGHT": 0, "OPEN": 0, "CLOSE": 0, END: 0, "FUNCTION": 4,
}  # fmt: skip
_LEVELS_OF_OPERAND: Final = 3
_DECIMAL: Final = regex(r"\d\.|\.\d")
# The number of repaired texts that may be tried for one unreadable text, and the number of symbols
# in all of them (about two texts of the longest that are repaired).
_ATTEMPTS: Final = 6
_TRIED_SYMBOLS: Final = 1200
# A JSON number is read without symbols: 1e-7 is never a product of 1 and e.
_NO_SYMBOLS: Final = Vocabulary([])


class ReadingOptions(NamedTuple):
    """How a text is read: whether in degrees, and whether the whole entry is an angle."""

    vocabulary: Vocabulary
    is_angle: bool
    degrees: bool


class Expression:
    """A text that was read. Immutable.

    ``notes`` describe ambiguous passages, ``symbols`` are the canonical names used, and
    ``has_decimal`` is True if the text contains a decimal number.
    """

    # Thousands of expressions are memoized, each as a program and a few other objects, but without
    # their trees: these would be a million objects, which the garbage collector would visit in each
    # round. The tree is parsed from the text again when it is needed.

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
        # Store ``tree`` only if ``options`` is None; else ``source`` can be parsed again.
        self.source: Final = source
        self.notes: Final = notes
        self.symbols: Final = symbols
        self.has_decimal: Final = "." in source and _DECIMAL.search(source) is not None
        self._program: Final = compile_tree(tree)
        # Storing the options as one tuple would need one more object for each text.
        self._vocabulary: Final = options and options.vocabulary
        self._is_angle: Final = options is not None and options.is_angle
        self._degrees: Final = options is not None and options.degrees
        self._tree: Final = tree if options is None else None

    @property
    def tree(self) -> Node:
        """The syntax tree, which must not be changed."""
        # It has units on numbers that are degrees.
        if self._tree is not None:
            return self._tree
        assert self._vocabulary is not None
        return _parsed(self.source, self._vocabulary, self._is_angle, self._degrees).tree

    @property
    def typed(self) -> TypedFormula:
        """The formula as typed, with its syntax tree."""
        return TypedFormula(self.source, self.tree, self._degrees)

    def evaluate(
        self, values: SymbolValues, memo: dict[str, Any] | None = None
    ) -> SampleArray | float:
        """Return the value at each sample ``(samples,)``, or a float if no symbol is used.

        ``values`` maps each symbol to an array ``(samples,)``, angles in radians. Do not change the
        result.
        """
        # Undefined values are nan or infinite, without warnings. Expressions evaluated at the same
        # ``values`` may share a ``memo``. The result may be one of ``values``, or in the memo.
        program = self._program
        if isinstance(program, float):
            return program
        if program.symbol is not None:
            return values[program.symbol]
        with np.errstate(all="ignore"):
            result: SampleArray = program(values, {} if memo is None else memo)
        return result

    def text(self) -> str:
        """Return the formula as plain text. Reading the text gives the same tree."""
        return to_text(self.tree)

    def latex(self) -> str:
        """Return the formula in LaTeX for math mode."""
        return to_latex(self.tree)

    def mathml(self) -> str:
        """Return the formula as one presentation ``<math>`` element."""
        return to_mathml(self.tree)

    def __repr__(self) -> str:
        return f"Expression({self.source!r})"


def evaluate_all(
    expressions: Iterable[Expression | None],
    values: Mapping[str, SampleArray],
    memo: dict[str, Any],
) -> list[SampleArray | float]:
    """Return the value of each expression, and nan for None."""
    # This is faster than calls of ``evaluate``.
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
    """Read ``source`` in the names of ``vocabulary``. Raises only ExpressionError.

    With ``angle_unit`` "degrees", angles without a unit are in degrees. ``quantity`` is "angle" if
    the whole entry is an angle. Without ``repairs``, no corrected texts are tried.
    """
    # Trying corrected texts is the most expensive part. The result or the error is memoized. If the
    # vocabulary allows a decimal comma, the source of the expression has points instead.
    if isinstance(source, str):
        text = with_points_and_commas(source) if vocabulary.decimal_comma else source
    else:
        text, vocabulary = _number_as_text(source), _NO_SYMBOLS
    if len(text) > LIMITS.characters:
        span = (LIMITS.characters, len(text))
        error = UnreadableError("beyond", span, limit="characters", length=len(text))
        raise _explained(text, error, vocabulary)
    degrees = angle_unit == "degrees"
    # In radians, an angle is read like any number, so both share one cache entry.
    options = (vocabulary, degrees and quantity == "angle", degrees)
    memoized = _memoized[bisect_left(_LENGTHS, len(text))]
    result = memoized(text, *options, _ATTEMPTS if repairs else 0)
    if isinstance(result, ExpressionError):
        raise result.without_traceback()
    return result


def _number_as_text(number: int | float) -> str:
    if isinstance(number, bool):
        raise _explained("", UnreadableError("boolean", (0, 0)), _NO_SYMBOLS)
    # Python refuses to print an integer of several thousand digits.
    too_large = isinstance(number, int) and abs(number) > 10**308
    if too_large or not math.isfinite(number):
        raise _explained("", UnreadableError("not_finite", (0, 0)), _NO_SYMBOLS)
    return str(number) if isinstance(number, int) else repr(float(number))


def _explained(text: str, error: UnreadableError, vocabulary: Vocabulary) -> ExpressionError:
    return explain(Failure(text, vocabulary, error, lambda _: None))


def _read(
    text: str, vocabulary: Vocabulary, is_angle: bool, degrees: bool, attempts: int
) -> Expression | ExpressionError:
    # Return the error, do not raise it: its traceback would keep every frame of the parse.
    reading = _Reading(ReadingOptions(vocabulary, is_angle, degrees), attempts)
    result = reading.read(text)
    if isinstance(result, ExpressionError):
        result.tried = reading.tried
    return result


_memoized: Final = [lru_cache(maxsize=number)(_read) for number in _CACHED_TEXTS]


class _Reading:
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
        """Return ``text`` if it can be read, else a suggested correction of it, else None."""
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
    tree: Node
    notes: tuple[Note, ...]
    symbols: frozenset[str]


@lru_cache(maxsize=_CACHED_TREES)
def _parsed(text: str, vocabulary: Vocabulary, is_angle: bool, degrees: bool) -> _Parsed:
    notes: list[Note] = []
    text, note = right_side(text, vocabulary)
    notes += (note,) if note else ()
    characters = normalise(text)
    if not characters.text or characters.text.isspace():
        raise UnreadableError("empty", (0, len(text)))
    # One typed character, such as ½, may become several.
    if len(characters.text) > LIMITS.characters:
        raise UnreadableError("beyond", (0, len(text)), limit="terms")
    lexer = Lexer(text, characters, vocabulary, degrees=degrees, notes=notes)
    tokens = lexer.run()
    builder = Builder(text, notes, vocabulary.turning, degrees=degrees)
    tree = parse(tokens, builder)
    if not _is_small(tokens):
        _check_limits(tree)
    symbols = _shared(frozenset(lexer.symbols))
    if degrees:
        tree = in_degrees(tree, is_angle=is_angle, notes=notes)
    elif builder.degree_functions:
        tree = without_degree_functions(tree, notes=notes)
    return _Parsed(tree, tuple(notes[: LIMITS.notes]), symbols)


@lru_cache(maxsize=_CACHED_SYMBOL_SETS)
def _shared(symbols: frozenset[str]) -> frozenset[str]:
    """Return one shared set object for all texts that use the same symbols."""
    return symbols


def _is_small(tokens: list[Token]) -> bool:
    """True if no tree of these tokens can exceed a limit. This is faster than checking the tree."""
    if len(tokens) > _FEW_TOKENS:
        return False
    levels = sum([_LEVELS.get(token[0], 1) for token in tokens])
    return levels + _LEVELS_OF_OPERAND <= LIMITS.depth


def _check_limits(tree: Node) -> None:
    """Raise UnreadableError if ``tree`` is too large or deep."""
    # A run of sums, or of products, counts as one level of depth.
    count, depth = 0, 0
    nodes: list[Any] = [tree]
    while nodes:
        below: list[Any] = []
        for node in nodes:
            kind = type(node)
            if kind is Binary:
                (nodes if _is_run(node) else below).append(node.left)
                below.append(node.right)
            elif kind is not Number and kind is not SymbolNode:
                below += children(node)
        count, depth = count + len(nodes), depth + 1
        if count > LIMITS.nodes or depth > LIMITS.depth:
            raise UnreadableError("beyond", (tree.start, tree.end), limit=_broken_limit(tree))
        nodes = below
    if count > LIMITS.tree_depth and _is_beyond_depth(tree):
        raise UnreadableError("beyond", (tree.start, tree.end), limit="terms")


def _is_beyond_depth(tree: Node) -> bool:
    """True if the tree is deeper than ``LIMITS.tree_depth``, as for a very long sum."""
    level: list[Any] = [tree]
    for _ in range(LIMITS.tree_depth):
        level = [child for node in level for child in children(node)]
    return bool(level)


def _broken_limit(tree: Node) -> str:
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
    return type(node.left) is Binary and node.left.operator in _RUNS[node.operator]
