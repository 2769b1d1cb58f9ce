"""Read a typed formula: characters, tokens, tree, program; its cost is known before.

The results are memoized. What a refused text may have meant is in ``repairs``.
"""

import math
from bisect import bisect_left
from collections import Counter
from collections.abc import Iterable, Mapping
from functools import lru_cache
from typing import Any, Final, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dh_grader.expressions.characters import (
    SUBSCRIPTS,
    SUPERSCRIPTS,
    normalise,
    with_points_and_commas,
)
from dh_grader.expressions.errors import LIMITS, ExpressionError, Note, UnreadableError
from dh_grader.expressions.evaluate import Program, SampleArray, SymbolValues, compile_tree
from dh_grader.expressions.lexer import END, Lexer, Token, right_side
from dh_grader.expressions.parser import (
    Builder,
    in_degrees,
    parse,
    without_degree_functions,
)
from dh_grader.expressions.printing import TypedFormula, to_latex, to_mathml, to_text
from dh_grader.expressions.repairs import Failure, explain
from dh_grader.expressions.vocabulary import (
    Binary,
    Call,
    Kind,
    Negation,
    Node,
    Number,
    Symbol,
    SymbolNode,
    Unit,
    Vocabulary,
    children,
)
from dh_grader.regex import regex
from dh_grader.slices import checkpoint

# --- Read a typed formula in four stages: characters, tokens, syntax tree, program


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
    memoized = _reader_memoized[bisect_left(_LENGTHS, len(text))]
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


_reader_memoized: Final = [lru_cache(maxsize=number)(_read) for number in _CACHED_TEXTS]


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


# --- Find the rounded decimals of a formula, and evaluate it with slightly different decimals
#
# A decimal number with three or more figures is assumed to be rounded or cut off: 1.57 may mean
# π/2. The *unit* of a decimal is 1 in its last place, 0.01 for 1.57. A *shift* is the number of
# units by which the intended number exceeds the written one.


# With two figures, half a unit could be five per cent: 1.6 does not mean π/2.
LEAST_FIGURES: Final = 3


class Decimals:
    """The ``m`` rounded decimals of one formula, from left to right. Immutable.

    ``units`` ``(m,)`` has the unit of each decimal, such as 0.01 for 1.57. ``sign`` is 1 or -1 for
    a formula that is a single decimal, else 0.
    """

    __slots__ = ("_names", "_numbers", "_program", "sign", "units")

    def __init__(self, tree: Node) -> None:
        found: list[Number] = []
        replaced = _with_names(tree, found)
        self.units: Final = np.array([_unit(number.literal) for number in found])
        self._numbers: Final = np.array([number.value for number in found])
        self._names: Final = [_name(i) for i in range(len(found))]
        self._program: Final = compile_tree(replaced) if found else 0.0
        self.sign: Final = _sign(replaced)

    def shifted(self, shifts: NDArray[np.float64], values: SymbolValues) -> SampleArray:
        """Return the formula's values ``(K, samples)`` after each of K changes of its decimals.

        ``shifts`` ``(K, m)`` says how much to add to each of the m decimals, in units of its last
        place.
        """
        # The shape is ``(K, 1)`` if the formula has no symbols. Undefined values are NaN or
        # infinite, without warnings.
        assert isinstance(self._program, Program)
        moved = self._numbers + shifts * self.units
        named = {name: moved[:, i, None] for i, name in enumerate(self._names)}
        with np.errstate(all="ignore"):
            result: SampleArray = self._program({**values, **named}, {})
        return result


# Grading needs the decimals of the same answer several times.
@lru_cache(maxsize=128)
def decimals_of(expression: Expression) -> Decimals:
    """Return the rounded decimals of an expression (memoized)."""
    return Decimals(expression.tree)


def _name(i: int) -> str:
    # No symbol can have this name.
    return f"~{i}"


def _sign(replaced: Node) -> int:
    match replaced:
        case SymbolNode(Symbol(name)) if name == _name(0):
            return 1
        case Negation(SymbolNode(Symbol(name))) if name == _name(0):
            return -1
        case _:
            return 0


def _with_names(node: Node, found: list[Number]) -> Node:
    """Return ``node`` with symbols for rounded decimals; append the decimals to ``found``."""
    match node:
        case Number():
            if _unit(node.literal) == 0.0:
                return node
            found.append(node)
            return SymbolNode(Symbol(_name(len(found) - 1), "number"))
        case Binary(operator, left, right):
            return Binary(operator, _with_names(left, found), _with_names(right, found))
        case Negation(operand):
            return Negation(_with_names(operand, found))
        case Unit(operand, unit):
            return Unit(_with_names(operand, found), unit)
        case Call(function, arguments):
            return Call(function, tuple(_with_names(each, found) for each in arguments))
        case _:
            return node


def _unit(literal: str) -> float:
    """Return 1 in the last place of a decimal: 0.01 for 1.57. Return 0 for a short decimal."""
    # A short decimal has less than three figures.
    # Leading zeros are not figures.
    mantissa, _, exponent = literal.lower().partition("e")
    whole, _, fraction = mantissa.partition(".")
    if not fraction or len((whole + fraction).lstrip("0")) < LEAST_FIGURES:
        return 0.0
    return 10.0 ** (int(exponent or 0) - len(fraction))


# --- Estimate the cost of reading a text before it is read
#
# Every machine gets the same result.


# A name, a number or a sign. Long runs of letters are counted in pairs. Blanks are free.
_SYMBOL: Final = regex(r"\\[A-Za-z]+|[A-Za-z]{1,2}|[0-9.]+|[^A-Za-z0-9. ]")
# Characters that become several: ½ ² ₁.
_COMPOSED: Final = regex("[¼-¾⅐-⅞↉" + "".join((*SUPERSCRIPTS, *SUBSCRIPTS)) + "]")
_SYMBOLS_IN_COMPOSED: Final = 5
# Every character costs a little, also a blank.
_CHARACTERS_PER_SYMBOL: Final = 16

# A fraction in LaTeX costs as much as ten of its braces, a root as six, a quotient as three.
_EXTRA: Final = {r"\frac": 9, r"\dfrac": 9, r"\tfrac": 9, r"\sqrt": 5, "√": 5, "/": 2}
# A function of degrees becomes two operations. A name of one or two letters is a whole factor.
_OF_DEGREES: Final = regex(r"(?:sin|cos|tan)d")
_SHORT_NAME: Final = regex(r"(?<![A-Za-z\\])[A-Za-z]{1,2}(?![A-Za-z0-9_])")
# Each match becomes a leaf of the tree. A long name such as ``numpy`` counts once.
_NAME_OR_NUMBER: Final = regex(r"(?<![A-Za-z\\])[A-Za-z]+|[0-9][0-9.]*")
_NUMBER: Final = regex(r"[0-9][0-9.]*")
# ½ is a quotient in brackets.
_FRACTION: Final = regex("[¼-¾⅐-⅞↉]")
_EXTRA_OF_FRACTION: Final = 5
# c12 is the cosine of a sum.
_SHORTHAND: Final = regex(r"(?<![A-Za-z\\])[cs]\d{2}")
# The sine of a number is checked for a note, because degrees may be meant.
_OF_NUMBER: Final = regex(r"(?:sin|cos|tan)\(\d")
_EXTRA_OF_DEGREES, _EXTRA_OF_SHORT_NAME, _EXTRA_OF_SHORTHAND, _EXTRA_OF_NUMBER = 10, 4, 5, 2
# The extra cost of shorter texts is ignored: the largest answers have only 300 of them.
_WORTH_IT: Final = 40

# Text that is counted as a unit. Only the last pattern above may match across such words.
_NAME: Final = regex(r"\\?[A-Za-z0-9_.]+")
_WORD: Final = regex(rf"{_NAME.pattern}|[^ ]")
# A formula has few distinct words, which are memoized. Other texts are counted as a whole.
_MOST_WORDS: Final = 100
# More symbols than any text has.
_PACKED: Final = 1 << 32

# Most texts are read repeatedly, so their counts are memoized, but longer texts need much memory.
_LONGEST_CACHED: Final = 500


class _Count(NamedTuple):
    symbols: int
    extra: int


def symbols_in(text: str) -> int:
    """Estimate the number of names, numbers and signs in a text."""
    # The estimate is never much too low.
    return _count(text).symbols


def reading_cost(text: str) -> int:
    """Estimate the cost of reading a text, as a number of symbols."""
    # In a long text, symbols are weighted by their cost. Braces and similar symbols of LaTeX cost
    # little.
    symbols, extra = _count(text)
    return symbols + extra if len(text) > _WORTH_IT else symbols


def _count(text: str) -> _Count:
    return _reading_work_memoized(text) if len(text) <= _LONGEST_CACHED else _count_by_words(text)


def _count_by_words(text: str) -> _Count:
    characters = len(text) // _CHARACTERS_PER_SYMBOL
    if len(text) <= _MOST_WORDS and text.isascii():
        # A fast path for most formulas: signs are counted, not looked up one by one.
        words = _NAME.findall(text)
        signs = len(text) - text.count(" ") - sum(map(len, words))
        extra, symbols = divmod(sum(map(_of_word, words)), _PACKED)
        return _Count(
            symbols + signs + characters, extra + _EXTRA["/"] * text.count("/") + _of_numbers(text)
        )
    words = _WORD.findall(text)
    if len(words) > _MOST_WORDS and len(set(words)) > _MOST_WORDS:
        symbols, extra = _scanned(text)
        return _Count(symbols + characters, extra)
    extra, symbols = divmod(sum(map(_of_word, words)), _PACKED)
    return _Count(symbols + characters, extra + _of_numbers(text))


def _of_numbers(text: str) -> int:
    if "n(" in text or "s(" in text:
        return _EXTRA_OF_NUMBER * len(_OF_NUMBER.findall(text))
    return 0


def _packed(word: str) -> int:
    # Return the number of symbols in a word and their extra cost, packed into one integer.
    # So the counts of many words can be summed at once.
    # A fast path: numbers are the words that are new most often.
    symbols, extra = (1, 1) if _NUMBER.fullmatch(word) else _scanned(word)
    return symbols + _PACKED * extra


def _scanned(text: str) -> _Count:
    found = _SYMBOL.findall(text)
    symbols = len(found)
    extra = sum(times * _EXTRA.get(symbol, 0) for symbol, times in Counter(found).items())
    extra += len(_NAME_OR_NUMBER.findall(text))
    extra += _EXTRA_OF_DEGREES * len(_OF_DEGREES.findall(text))
    extra += _EXTRA_OF_SHORTHAND * len(_SHORTHAND.findall(text))
    extra += _EXTRA_OF_SHORT_NAME * len(_SHORT_NAME.findall(text))
    extra += _EXTRA_OF_NUMBER * len(_OF_NUMBER.findall(text))
    if not text.isascii():
        symbols += _SYMBOLS_IN_COMPOSED * len(_COMPOSED.findall(text))
        extra += _EXTRA_OF_FRACTION * len(_FRACTION.findall(text))
    return _Count(symbols, extra)


_reading_work_memoized: Final = lru_cache(maxsize=8192)(_count_by_words)
_of_word: Final = lru_cache(maxsize=2048)(_packed)
