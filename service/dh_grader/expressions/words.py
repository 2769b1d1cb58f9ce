"""Split a run of letters and digits into names, functions and units.

It knows the spellings of programs, indices and letter case, but no sentence around the run.
"""

from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from string import ascii_letters, digits
from typing import Final, Literal, NamedTuple

from dh_grader.expressions.characters import CLASS
from dh_grader.expressions.vocabulary import (
    ALONE,
    CAPITALS,
    CONSTANTS,
    IN_DEGREES,
    MODULES,
    OF_DEGREES,
    PI,
    PI_CAPITALS,
    REFUSED,
    RESERVED,
    SPELLINGS,
    UNITS,
    Binary,
    Call,
    Node,
    Number,
    Operand,
    Pi,
    PieceKind,
    Symbol,
    Vocabulary,
)
from dh_grader.regex import regex

# --- Split a run of letters and digits into names, functions and units
#
# ``l1c1`` is l1·c1 and ``2sinq1`` is 2·sin(q1). The longest known name comes first; a shorter one
# is taken only if the rest of the run would otherwise have no meaning. A name never ends between
# two digits, so q12 is not q1·2.


RUN: Final = rf"[A-Za-z{CLASS}](?:_?[A-Za-z0-9{CLASS}])*"

_SHORTHAND: Final = regex(r"(?P<function>cos|sin|[cCsS])(?P<angle>theta|th|θ|q)?(?P<index>[0-9]+)")
_SHORT: Final = {"c": "cos", "s": "sin", "C": "cos", "S": "sin"}
_DIGITS: Final = regex(r"[0-9]+")
_WORDS: Final[dict[str, tuple[PieceKind, str]]] = {
    **{spelling: ("function", name) for spelling, name in CAPITALS.items()},
    **dict.fromkeys(PI_CAPITALS, ("pi", "pi")),
    **{spelling: ("function", name) for spelling, name in SPELLINGS.items()},
    **{spelling: ("unit", name) for spelling, name in UNITS.items()},
    **dict.fromkeys(PI, ("pi", "pi")),
}
_WHOLE: Final = ALONE | _WORDS
# An underscore after one of these does not begin a new factor: a_b is not a product.
_NAMES: Final = frozenset({"symbol", "pi", "shorthand", "invalid_shorthand", "number", "unit"})
# The memoized operands of one vocabulary; they are its names and shorthands in all spellings.
_MOST_OPERANDS: Final = 512
# A longer run is not a formula.
LONGEST_RUN: Final = 80
# sind30 might mean sin(d30), so these functions need a bracket or a space before a number.
_NOT_BEFORE_NUMBERS: Final = frozenset({*OF_DEGREES, *IN_DEGREES})


@dataclass(frozen=True, slots=True)
class Piece:
    """One name, function, number or unit in a run of letters and digits.

    ``word`` is the name of a function or unit, or the digits of a number. ``symbols`` are the
    symbols in the piece: one, or the joint angles that a shorthand such as c12 adds.
    """

    # ``ambiguous`` is True for a shorthand that could also mean something else, such as sin12.
    # ``joint`` is the joint number in a shorthand whose joint has no angle. The piece is
    # ``run[start:end]``.

    kind: PieceKind
    start: int
    end: int
    word: str = ""
    symbols: tuple[Symbol, ...] = ()
    ambiguous: bool = False
    joint: int = 0


@lru_cache(maxsize=8192)
def split(run: str, vocabulary: Vocabulary) -> tuple[Piece, ...] | None:
    """Split ``run`` into names, functions, numbers and units; return None if this is impossible."""
    # The longest reading wins, so try the whole run first.
    if (symbol := vocabulary.by_name.get(run)) is not None:
        return (Piece("symbol", 0, len(run), symbols=(symbol,)),)
    if (word := _WHOLE.get(run)) is not None:
        return (Piece(word[0], 0, len(run), word[1]),)
    if run in REFUSED or len(run) > LONGEST_RUN:
        return None
    if "_" not in run:
        short = _shorthand(run, 0, vocabulary) if run[0] in _SHORT else None
        if short is not None and short.kind == "shorthand" and short.end == len(run):
            return (short,)
        return _split(run, vocabulary)
    kept = [index for index, letter in enumerate(run) if letter != "_"]
    pieces = _split(run.replace("_", ""), vocabulary)
    if pieces is None or any(
        piece.kind in _NAMES and run[kept[following.start] - 1] == "_"
        for piece, following in pairwise(pieces)
    ):
        return None
    return tuple(_with_underscores(piece, kept, run) for piece in pieces)


def sole_operand(run: str, vocabulary: Vocabulary) -> Operand | None:
    """Return the meaning of ``run`` if it is one symbol or a shorthand such as c12; else None."""
    # None also if ``run`` is the name of a module, or if its shorthand may get a note. A meaning
    # that is found is stored in ``vocabulary``.
    pieces = None if run in MODULES else split(run, vocabulary)
    if pieces is None or len(pieces) > 1:
        return None
    piece = pieces[0]
    is_noted = piece.ambiguous or run[0] in "CS"
    if piece.kind != "symbol" and (piece.kind != "shorthand" or is_noted):
        return None
    if len(vocabulary.operands) >= _MOST_OPERANDS:
        vocabulary.operands.clear()
    operand = vocabulary.operands[run] = (piece.word, piece.symbols)
    return operand


def _with_underscores(piece: Piece, kept: list[int], run: str) -> Piece:
    start, end = kept[piece.start], kept[piece.end - 1] + 1
    ambiguous = piece.ambiguous and "_" not in run[start:end]
    return Piece(piece.kind, start, end, piece.word, piece.symbols, ambiguous, piece.joint)


def _split(run: str, vocabulary: Vocabulary) -> tuple[Piece, ...] | None:
    length = len(run)
    # For each position: the first pieces of the rest of the run, and True if no piece is invalid.
    first: list[tuple[Piece, ...] | None] = [None] * length
    is_valid = [False] * length + [True]
    for start in range(length - 1, -1, -1):
        if run[start].isdigit():
            continue
        for pieces in _candidates(run, start, vocabulary):
            end = pieces[-1].end
            if end < length and first[end] is None:
                continue
            valid = is_valid[end] and pieces[0].kind != "invalid_shorthand"
            if valid or first[start] is None:
                first[start] = pieces
            if valid:
                is_valid[start] = True
                break
    found = _joined(first)
    return found and _with_other_readings(found, run)


def _joined(first: list[tuple[Piece, ...] | None]) -> tuple[Piece, ...] | None:
    found: list[Piece] = []
    at = 0
    while at < len(first):
        pieces = first[at]
        if pieces is None:
            return None
        found += pieces
        at = pieces[-1].end
    return tuple(found)


def _with_other_readings(pieces: tuple[Piece, ...], run: str) -> tuple[Piece, ...]:
    if len(pieces) == 1:
        return pieces
    return tuple(
        replace(piece, ambiguous=True)
        if piece.kind == "shorthand"
        and run[piece.start + 1].isdigit()
        and following is not None
        and following.kind == "symbol"
        and following.symbols[0].kind == "angle"
        else piece
        for piece, following in zip(pieces, (*pieces[1:], None), strict=True)
    )


def _candidates(run: str, start: int, vocabulary: Vocabulary) -> list[tuple[Piece, ...]]:
    shorthand = _shorthand(run, start, vocabulary) or _angle_shorthand(run, start, vocabulary)
    found: list[tuple[Piece, ...]] = [] if shorthand is None else [(shorthand,)]
    for end in range(min(len(run), start + vocabulary.longest), start, -1):
        word = run[start:end]
        if end < len(run) and run[end].isdigit():
            known = _WORDS.get(word)
            digits = _DIGITS.match(run, end)
            is_function = known and known[0] == "function" and known[1] not in _NOT_BEFORE_NUMBERS
            if known and is_function and not run[end - 1].isdigit() and digits:
                number = Piece("number", end, digits.end(), digits.group())
                found.append((Piece("function", start, end, known[1]), number))
            continue
        symbol = vocabulary.by_name.get(word)
        if symbol is not None:
            found.append((Piece("symbol", start, end, symbols=(symbol,)),))
        elif word in _WORDS:
            kind, name = _WORDS[word]
            found.append((Piece(kind, start, end, name),))
    return sorted(found, key=lambda pieces: (-pieces[-1].end, pieces[0].kind != "symbol"))


def _shorthand(run: str, start: int, vocabulary: Vocabulary) -> Piece | None:
    """Return the shorthand of joint angles at ``start``, such as c12 or cosθ12, or None."""
    match = _SHORTHAND.match(run, start)
    if match is None or not vocabulary.joints:
        return None
    function, angle, index = match.group("function", "angle", "index")
    spelled = len(function) > 1
    if angle and (function in vocabulary.by_name or (spelled and len(index) == 1)):
        # Other readings come first: c·θ1 if c is declared; cosθ1 is a plain function call.
        return None
    joints = _joints(index, vocabulary)
    wrong = [joint for joint in joints if joint not in vocabulary.turning]
    if wrong or len(set(joints)) < len(joints):
        if spelled and not angle:
            # cos45 on an arm with three joints is the cosine of a number, not an invalid shorthand.
            return None
        joint = int(index[:4]) if 0 in wrong else (wrong or joints)[0]
        return Piece("invalid_shorthand", start, match.end(), match.group(), joint=joint)
    return Piece(
        "shorthand",
        start,
        match.end(),
        _SHORT.get(function, function),
        tuple(vocabulary.turning[joint] for joint in joints),
        ambiguous=spelled and not angle,
    )


def _angle_shorthand(run: str, start: int, vocabulary: Vocabulary) -> Piece | None:
    """Return the shorthand of a declared angle at ``start``, such as cα1, or None."""
    function = _SHORT.get(run[start])
    if function is None or run[start] in vocabulary.by_name:
        return None
    first = start + 1
    for end in range(min(len(run), first + vocabulary.longest), first, -1):
        symbol = vocabulary.by_name.get(run[first:end])
        goes_on = end < len(run) and run[end].isdigit()
        if symbol is not None and symbol.kind == "angle" and not goes_on:
            return Piece("shorthand", start, end, function, (symbol,))
    return None


def _joints(index: str, vocabulary: Vocabulary) -> tuple[int, ...]:
    digits = tuple(map(int, index))
    if len(set(digits)) == len(digits) and set(digits).issubset(vocabulary.joints):
        return digits
    # A table has at most twelve rows, so a longer index is not one joint.
    whole = int(index) if len(index) == 2 else -1
    return (whole,) if whole in vocabulary.joints else digits


# --- Names in another letter case than declared: l1 if only L1 is declared
#
# Such a name is accepted if it has no other meaning and fits only one symbol.


_PLAIN: Final = frozenset(ascii_letters + digits)


def split_in_other_case(run: str, vocabulary: Vocabulary) -> tuple[Piece, ...] | None:
    """Split a run of letters and digits into known names, ignoring letter case.

    Return None if this is impossible.
    """
    # A single letter of another case is a name only if it is the whole run.
    pieces = split(run, _with_other_capitals(vocabulary))
    if pieces is None:
        return None
    declared = {symbol.name: symbol for symbol in vocabulary.symbols}
    found = []
    for piece in pieces:
        written = run[piece.start : piece.end].replace("_", "")
        if piece.kind == "symbol" and written not in vocabulary.by_name:
            if len(written) == 1 and len(pieces) > 1:
                return None
            piece = replace(piece, word=declared[piece.symbols[0].name].name)
        symbols = tuple(declared[symbol.name] for symbol in piece.symbols)
        found.append(replace(piece, symbols=symbols))
    return tuple(found)


@lru_cache(maxsize=256)
def _with_other_capitals(vocabulary: Vocabulary) -> Vocabulary:
    """Return the vocabulary, extended by the names of its symbols in other letter cases."""
    owners: dict[str, dict[str, Symbol]] = {}
    for name, symbol in vocabulary.by_name.items():
        for other in {name.lower(), name.upper(), name[0].swapcase() + name[1:]}:
            # A capital alpha is not accepted, because it looks like an A.
            if not set(other) - set(CLASS) <= _PLAIN:
                continue
            owners.setdefault(other, {})[symbol.name] = symbol
    names: dict[str, tuple[str, ...]] = {}
    for other, symbols in owners.items():
        if len(symbols) == 1 and other not in RESERVED and split(other, vocabulary) is None:
            [owner] = symbols
            names[owner] = (*names.get(owner, ()), other)
    return Vocabulary(
        [
            replace(symbol, aliases=(*symbol.aliases, *names.get(symbol.name, ())))
            for symbol in vocabulary.symbols
        ]
    )


# --- Indices as programs write them: q[0] in Python and q(1) or q{1} in MATLAB are both joint 1


Style = Literal["[", "("]

INDEX: Final = regex(r"\s?(?:\[\s*([0-9]{1,3})\s*\]|\(\s*([0-9]{1,3})\s*\)|"
                          r"\{\s*([0-9]{1,3})\s*\})")  # fmt: skip
_STEM: Final = regex(rf"[A-Za-z{CLASS}]+$")


class Indexed(NamedTuple):
    """A name and its index in brackets, such as q[0].

    ``pieces`` are the names that the text means, here q1, or None. ``style`` is the kind of
    brackets. ``digits`` is the index as the exercise counts it, here "1". ``end`` is the position
    after the brackets.
    """

    pieces: tuple[Piece, ...] | None
    style: Style
    digits: str
    end: int


def indexed(
    run: str, text: str, end: int, vocabulary: Vocabulary, *, from_one: bool = False
) -> Indexed | None:
    """Read the index in brackets after the letters ``run``, which end at ``text[end]``.

    Return None if no index follows. With ``from_one``, indices in square brackets count from 1.
    """
    match = INDEX.match(text, end)
    if match is None or _STEM.search(run) is None:
        return None
    style: Style = "[" if match[1] is not None and not from_one else "("
    number = int(match[1] or match[2] or match[3])
    if style == "[":
        number += _first(run, vocabulary)
    name = f"{run}{number}"
    pieces = split(name, vocabulary) or split_in_other_case(name, vocabulary)
    if pieces is not None and pieces[-1].kind not in {"symbol", "invalid_shorthand", "shorthand"}:
        pieces = None
    return Indexed(pieces, style, str(number), match.end())


def is_family(run: str, vocabulary: Vocabulary) -> bool:
    """True if the letters ``run`` are a known name without its index: q, if q1 is known."""
    return any(split(f"{run}{index}", vocabulary) for index in {1, 2, *vocabulary.joints})


def _first(run: str, vocabulary: Vocabulary) -> int:
    for joint in vocabulary.joints:
        pieces = split(f"{run}{joint}", vocabulary)
        if pieces and pieces[-1].kind == "symbol" and pieces[-1].symbols[0].joint is not None:
            return vocabulary.joints[0]
    return 1


# --- Words in the notation of programs: np.cos, std::cos, M_PI_2, Subscript[θ, 1], 0.5f, %pi


MEMBER: Final = regex(r"(?:\.|::)(?=[^\W\d_])")
_RADIANS: Final = regex(r"(?:radians|toRadians|rad)(?=\()")
# More than a turn in radians, so probably degrees, which ``rad`` converts in SymPy.
_MANY: Final = regex(r"\(\s*[-+]?\s*(?:[7-9]|\d\d+)(?:\.\d*)?\s*\)")
ZERO_IN_BRACKETS: Final = regex(r"\(\s*[-+]?\s*0+(?:\.0*)?\s*\)")
_SUBSCRIPT: Final = regex(rf"\[\s*([A-Za-z{CLASS}]+)\s*,\s*([A-Za-z0-9]{{1,12}})\s*\]")
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
