r"""Tokens -> a syntax tree, by recursive descent; ambiguous passages are noted or refused.

It also converts bare degrees. It knows no typed characters, only tokens.

In the grammar, a word in capitals is a token, and { } may be repeated or left out:

    sum       = product { (PLUS | MINUS) product }
    product   = signed { (STAR | SLASH) signed | JOIN power }
    signed    = { PLUS | MINUS } power
    power     = postfix [ POWER exponent ] | bare_call
    exponent  = { PLUS | MINUS } ( postfix | bare_call )
    postfix   = atom { UNIT }
    atom      = simple | LEFT sum RIGHT
    simple    = NUMBER | NAME | ROOT atom | OPEN sum CLOSE
              | FUNCTION LEFT sum { COMMA sum } RIGHT
    bare_call = FUNCTION argument
    argument  = simple { UNIT } [ POWER exponent ] | simple TIGHT power | bare_call

``JOIN`` is a product without a sign: ``2q1``, ``l1 c1``, ``a(b)``. ``TIGHT`` is such a product in
the argument of a function without brackets: ``sin 2q1`` is ``sin(2q1)``. A function without
brackets takes one operand, so ``sin q1 * l1`` is ``sin(q1)*l1``. ``OPEN`` and ``CLOSE`` enclose a
fraction that is one operand, ``½`` or ``\frac{a}{b}``. A power of a power is ambiguous, so
``2^3^2`` is not in the grammar.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import Final, NamedTuple

from dh_grader.expressions.errors import LIMITS, Note, Span, UnreadableError, shortened
from dh_grader.expressions.lexer import END, Token
from dh_grader.expressions.vocabulary import (
    ARITY,
    BUILT,
    INVERSE,
    OF_DEGREES,
    TRIGONOMETRIC,
    Binary,
    Call,
    Negation,
    Node,
    Number,
    Operator,
    Pi,
    Symbol,
    SymbolNode,
    Unit,
    UnitName,
    children,
)
from dh_grader.regex import regex
from dh_grader.translations import say

# --- Parse tokens into a syntax tree, by recursive descent
#
# Only brackets are parsed by recursion, and the lexer allows at most ``LIMITS.depth`` open
# brackets. Everything else that can be repeated (signs, roots, powers, functions without brackets)
# is kept in a list until its operand is parsed, so no text comes near Python's recursion limit.


# Signs, powers and functions that wait for their operand.
_Pending = list[Callable[[Node], Node]]
_SIMPLE: Final = frozenset({"NAME", "NUMBER"})
_POSTFIXES: Final = frozenset({"UNIT", "POWER"})
_SUMS: Final[dict[str, Operator]] = {"PLUS": "+", "MINUS": "-"}


def parse(tokens: Sequence[Token], builder: "Builder") -> Node:
    """Return the tree that ``builder`` makes of ``tokens``, whose last token is ``END``.

    Raises UnreadableError with the index of the first token that the grammar does not allow.
    """
    parser = _Parser(tokens, builder)
    tree = parser.sum()
    parser.take(END)
    return tree


class _Parser:
    # One method for each rule of the grammar; ``at`` is the index of the next token.
    # The method ``power`` implements the rules ``power``, ``exponent``, ``postfix``, ``bare_call``
    # and ``argument`` without recursion.
    __slots__ = ("at", "builder", "tokens")

    def __init__(self, tokens: Sequence[Token], builder: "Builder") -> None:
        self.tokens = tokens
        self.builder = builder
        self.at = 0

    def take(self, terminal: str) -> Token:
        """Consume and return the next token, which must be a ``terminal``."""
        token = self.tokens[self.at]
        if token[0] != terminal:
            raise self.unexpected()
        self.at += 1
        return token

    def unexpected(self) -> UnreadableError:
        """Return the error that the grammar does not allow the next token."""
        place = self.tokens[self.at][2:]
        return UnreadableError("grammar", place, tokens=self.tokens, index=self.at)

    def sum(self) -> Node:
        left = self.product()
        while operator := _SUMS.get(self.tokens[self.at][0]):
            self.at += 1
            left = self.builder.add(operator, left, self.product())
        return left

    def product(self) -> Node:
        tokens, builder = self.tokens, self.builder
        left = self.signed()
        while True:
            at = self.at
            terminal = tokens[at][0]
            if terminal == "STAR":
                # A fast path, as in ``signed``.
                factor = tokens[at + 1]
                if factor[0] in _SIMPLE and tokens[at + 2][0] not in _POSTFIXES:
                    self.at = at + 2
                    left = builder.multiply(left, factor[1])
                    continue
                self.at = at + 1
                left = builder.multiply(left, self.signed())
            elif terminal == "JOIN":
                self.at += 1
                left = builder.join(left, self.power([]))
            elif terminal == "SLASH":
                self.at += 1
                left = builder.divide(left, self.signed())
            else:
                return left

    def signed(self) -> Node:
        # A fast path for most factors: a name or a number without a sign, a unit or a power.
        tokens, at = self.tokens, self.at
        terminal = tokens[at][0]
        if terminal in _SIMPLE and tokens[at + 1][0] not in _POSTFIXES:
            self.at += 1
            node: Node = tokens[at][1]
            return node
        pending: _Pending = []
        if terminal in _SUMS:
            self.signs(pending)
        return self.power(pending)

    def signs(self, pending: _Pending) -> None:
        """Parse signs. Raises UnreadableError for +-90°, which may be ±."""
        end = -1
        while True:
            terminal, _, start, stop = self.tokens[self.at]
            if start == end and {terminal, self.tokens[self.at - 1][0]} == {"PLUS", "MINUS"}:
                raise UnreadableError("plus_minus", (start - 1, stop))
            end = stop
            if terminal == "MINUS":
                pending.append(partial(self.builder.negate, start))
            elif terminal == "PLUS":
                pending.append(partial(self.builder.keep, start))
            else:
                return
            self.at += 1

    def power(self, pending: _Pending) -> Node:
        """Parse the next power, and apply the ``pending`` signs to it."""
        tokens, builder = self.tokens, self.builder
        is_argument = is_exponent = False
        while True:
            token = tokens[self.at]
            if token[0] == "FUNCTION" and tokens[self.at + 1][0] != "LEFT":
                self.at += 1
                pending.append(partial(builder.bare_call, token))
                is_argument, is_exponent = True, False
                continue
            operand = self.atom()
            token = tokens[self.at]
            if is_argument and token[0] == "TIGHT":
                self.at += 1
                pending.append(partial(builder.tight, operand))
                is_argument = False
                continue
            while token[0] == "UNIT":
                self.at += 1
                operand = builder.unit(operand, token[1], token[3])
                token = tokens[self.at]
            if token[0] != "POWER":
                break
            if is_exponent:
                raise self.unexpected()
            self.at += 1
            pending.append(partial(builder.raise_to, operand, token[2]))
            self.signs(pending)
            is_argument, is_exponent = False, True
        while pending:
            operand = pending.pop()(operand)
        return operand

    def atom(self) -> Node:
        token = self.tokens[self.at]
        terminal, value, start, _ = token
        if terminal == "NAME" or terminal == "NUMBER":
            self.at += 1
            node: Node = value
            return node
        if terminal == "FUNCTION":
            self.at += 1
            return self.call(token)
        if terminal == "LEFT":
            self.at += 1
            inner = self.sum()
            return self.builder.group(start, inner, self.take("RIGHT")[3])
        if terminal == "OPEN":
            self.at += 1
            inner = self.sum()
            return self.builder.fraction(start, inner, self.take("CLOSE")[3])
        if terminal == "ROOT":
            return self.root()
        raise self.unexpected()

    def root(self) -> Node:
        starts = []
        while self.tokens[self.at][0] == "ROOT":
            starts.append(self.take("ROOT")[2])
        operand = self.atom()
        for start in reversed(starts):
            operand = self.builder.root(start, operand)
        return operand

    def call(self, function: Token) -> Node:
        self.take("LEFT")
        arguments = [self.sum()]
        while self.tokens[self.at][0] == "COMMA":
            self.at += 1
            arguments.append(self.sum())
        return self.builder.call(function, arguments, self.take("RIGHT")[3])


# --- Build the syntax tree of a formula, and note its ambiguous passages
#
# The parser calls one method for each rule of the grammar.


_MOST_PARTS: Final = 64
# The nodes that may be a number, with or without a sign or a unit.
_MAY_BE_NUMBERS: Final = frozenset({Number, Negation, Unit})
# The codes of notes that a number was read in radians.
_ON_RADIANS: Final = frozenset({"bare_radians", "mixed_units"})


class Builder:
    """Builds the tree of one text from the bottom up."""

    __slots__ = (
        "barred", "degree_functions", "degrees", "grouped", "notes", "source", "turning",
    )  # fmt: skip

    def __init__(
        self,
        source: str,
        notes: list[Note],
        turning: Mapping[int, Symbol],
        *,
        degrees: bool = False,
    ) -> None:
        # ``turning`` maps each revolute joint to its variable.
        self.source = source
        self.notes = notes
        self.turning = turning
        self.degrees = degrees
        # The ids of nodes in brackets, and of fractions with a bar.
        self.grouped: set[int] = set()
        self.barred: set[int] = set()
        self.degree_functions = False

    def add(self, operator: Operator, left: Node, right: Node) -> Node:
        """Build left + right or left - right."""
        if type(left) in _MAY_BE_NUMBERS or type(right) in _MAY_BE_NUMBERS:
            self._note_degrees(left, right)
            self._add_note(on_sum(left, right, degrees=self.degrees))
            if operator == "+":
                self._add_note(on_shorthand(self.source, left, right, self.turning))
        return Binary(operator, left, right, left.start, right.end)

    def multiply(self, left: Node, right: Node) -> Node:
        """Build left * right."""
        if type(left) is Number and type(right) is Number:
            self._add_note(on_product(self.source, left, right))
        return Binary("*", left, right, left.start, right.end)

    def divide(self, left: Node, right: Node) -> Node:
        """Build left / right, with a note on ``sin q1/2``, which may mean sin(q1/2).

        Raises UnreadableError for 180/2°, which is ambiguous.
        """
        if type(right) is Unit and self._is_open(right):
            check_divisor(left, right)
        if not (
            type(left) is Call and left.function == "sqrt" and type(left.arguments[0]) is Number
        ):
            self._note_bare(left)
        return Binary("/", left, right, left.start, right.end)

    def join(self, left: Node, right: Node) -> Node:
        """Build a product without a sign, such as 2q1.

        Raises UnreadableError for two values, such as 90° (π/2).
        """
        check_product(self.source, left, right)
        if type(left) is Binary and left.operator == "/" and self._is_open(left):
            message = say(
                "This was read from left to right, as ({quotient})*{factor}. "
                "Add brackets if all of it belongs below the line.",
                quotient=self._text(left),
                factor=self._text(right),
            )
            self._note("division_then_product", message, left.start, right.end)
        if type(right) is not Call:
            self._note_bare(left)
        return Binary("*", left, right, left.start, right.end)

    def tight(self, left: Node, right: Node) -> Node:
        """Build the product 2q1 in ``sin 2q1``."""
        if self.source[right.start] == "(":
            self._note_argument(left.start, right.end)
        return Binary("*", left, right, left.start, right.end)

    def negate(self, sign: int, operand: Node) -> Node:
        """Build -operand."""
        return Negation(operand, sign, operand.end)

    def keep(self, sign: int, operand: Node) -> Node:
        """Build +operand: the same node, but its span includes the sign."""
        operand.start = sign
        return operand

    def raise_to(self, base: Node, caret: int, exponent: Node) -> Node:
        """Build base ^ exponent.

        Raises UnreadableError for 90^0, which may mean 90°.
        """
        if type(exponent) is Number and not exponent.value and self._may_be_degrees(base):
            raise UnreadableError("raised_zero", (caret, exponent.end), power=True)
        return Binary("^", base, exponent, base.start, exponent.end)

    def unit(self, operand: Node, unit: UnitName, end: int, start: int | None = None) -> Node:
        """Build an operand with a unit, such as 90°.

        Raises UnreadableError for a unit after an angle or a length.
        """
        # ``start`` is the place where deg2rad(…) starts. π° is also refused, but (π)deg is read.
        span = (operand.start, end)
        for node in _outside_calls(operand):
            if type(node) is Unit or (type(node) is Call and node.function in INVERSE):
                raise UnreadableError("two_units", span)
            if type(node) is SymbolNode and node.symbol.kind != "number":
                name, place = node.symbol.name, (node.start, node.end)
                raise UnreadableError("unit_on_variable", span, name=name, variable=place)
        if start is not None:
            span = (start, end)
        in_words = self.source[operand.end : end].strip().isalpha()
        if unit == "deg" and not (in_words and id(operand) in self.grouped):
            check_unit(operand, span)
        return Unit(operand, unit, *span)

    def group(self, start: int, inner: Node, end: int) -> Node:
        """Build (inner): the same node, but its span includes the brackets."""
        inner.start, inner.end = start, end
        self.grouped.add(id(inner))
        return inner

    def fraction(self, start: int, inner: Node, end: int) -> Node:
        r"""Build ½ or \frac{a}{b}."""
        inner.start, inner.end = start, end
        self.barred.add(id(inner))
        return inner

    def root(self, start: int, operand: Node) -> Node:
        """Build √operand."""
        return Call("sqrt", (operand,), start, operand.end)

    def call(self, function: Token, arguments: list[Node], end: int) -> Node:
        """Build the syntax tree of a function with arguments in brackets, such as atan2(y, x).

        Raises UnreadableError for a wrong number of arguments.
        """
        _, (name, _), start, _ = function
        if name == "atan" and len(arguments) == 2 and self._is_mathematica(function):
            return self._angle_of_point(function, arguments, end)
        if len(arguments) != _arity(name, arguments):
            raise _wrong_number(function, arguments, end)
        if name == "deg" or name == "rad":
            return self.unit(arguments[0], name, end, start)
        if name == "atan2":
            self._note_order(arguments[0], arguments[1], start, end)
        return self._called(function, tuple(arguments), end)

    def bare_call(self, function: Token, argument: Node) -> Node:
        """Build a function of one argument without brackets.

        Raises UnreadableError for a function that needs brackets.
        """
        name = function[1][0]
        if _arity(name) != 1 or name == "deg" or name == "rad":
            raise _wrong_number(function, [argument], argument.end)
        if type(argument) is Binary and (
            argument.operator == "^" or (name == "sqrt" and id(argument) not in self.grouped)
        ):
            self._note_argument(argument.start, argument.end)
        return self._called(function, (argument,), argument.end)

    def _called(self, function: Token, arguments: tuple[Node, ...], end: int) -> Node:
        _, (name, power), start, _ = function
        if name in OF_DEGREES:
            self.degree_functions = True
            # The numbers inside are in degrees, so remove notes that they were read in radians.
            inside = (each for each in self.notes if each.span[0] >= start)
            untrue = [each for each in inside if each.code in _ON_RADIANS]
            self.notes[:] = [each for each in self.notes if each not in untrue]
        self._add_note(on_call(name, arguments[0], self.turning, degrees=self.degrees))
        call: Node = Call(name, arguments, start, end)
        if name in BUILT:
            call = build_function(name, arguments, start, end)
            self.grouped.add(id(call))
        if power is None:
            return call
        return Binary("^", call, Number(float(power), str(power), start, start), start, end)

    def _is_mathematica(self, function: Token) -> bool:
        start, end = function[2:]
        return self.source[start:end] == "ArcTan" and self.source[end : end + 1] == "["

    def _angle_of_point(self, function: Token, arguments: list[Node], end: int) -> Node:
        """Build atan2(y, x) from Mathematica's ArcTan[x, y]."""
        (_, (_, power), start, stop), (x, y) = function, arguments
        message = say("Mathematica's ArcTan[x, y] was read as atan2(y, x).")
        self._note("atan2_order", message, start, end)
        return self._called(("FUNCTION", ("atan2", power), start, stop), (y, x), end)

    def _may_be_degrees(self, base: Node) -> bool:
        if type(base) is Number and base.literal == "10":
            times = ("*", "×", "·", "⋅", r"\cdot", r"\times")
            return not self.source[: base.start].rstrip().endswith(times)
        return all(type(part) in {Number, Negation, Binary} for part in _outside_calls(base))

    def _is_open(self, node: Node) -> bool:
        return id(node) not in self.grouped and id(node) not in self.barred

    def _note_degrees(self, left: Node, right: Node) -> None:
        """Add a note on a sum such as 90 + 45°, in which only one number is in degrees."""
        for one, other in ((left, right), (right, left)):
            number = _number(other)
            if type(one) is not Unit or one.unit != "deg" or number is None:
                continue
            if number.value and not self.degrees:
                message = say(
                    "Only one of these is in degrees: {number} was read as radians. For degrees, "
                    "write {number}°.",
                    number=self._text(number),
                )
                self._note("mixed_units", message, number.start, number.end)

    def _note_order(self, y: Node, x: Node, start: int, end: int) -> None:
        """Add a note on atan2(x, y), whose arguments seem to be swapped."""
        first, second = _names(y), _names(x)
        for ours, theirs in (("sin", "cos"), ("y", "x")):
            if theirs in first and ours in second and not {ours} & first and not {theirs} & second:
                message = say(
                    "atan2 takes y first: atan2(y, x), so atan2(sin, cos). These two look as if "
                    "they were the other way round."
                )
                self._note("atan2_order", message, start, end)
                return

    def _text(self, node: Node) -> str:
        return shortened(self.source[node.start : node.end])

    def _note(self, code: str, message: str, start: int, end: int) -> None:
        self._add_note(Note(code, message, (start, end)))

    def _add_note(self, note: Note | None) -> None:
        if note is not None and len(self.notes) < LIMITS.notes:
            self.notes.append(note)

    def _note_argument(self, start: int, end: int) -> None:
        message = say(
            "Without brackets, {text} was read as the function's argument.",
            text=shortened(self.source[start:end]),
        )
        self._note("bare_argument", message, start, end)

    def _note_bare(self, left: Node) -> None:
        """Add a note on sin q1/2, which is read as (sin q1)/2."""
        last = left
        while type(last) is Binary and self._is_open(last) and last.right.end == last.end:
            last = last.right
        if type(last) is Binary and type(last.left) is Call:
            last = last.left  # sin^2 q1 is a power of a call that ends where the power does
        if type(last) is Call and last.start < last.arguments[-1].start < last.end:
            argument = last.arguments[-1]
            if last.end == argument.end and id(argument) not in self.grouped:
                self._note_argument(argument.start, argument.end)


def _outside_calls(node: Node) -> Iterator[Node]:
    """Yield the nodes in ``node`` that are outside all functions except abs."""
    pending = [node]
    while pending:
        part = pending.pop()
        yield part
        if type(part) is not Call or part.function == "abs":
            pending.extend(reversed(children(part)))


def _names(node: Node) -> set[str]:
    found: set[str] = set()
    pending = [node]
    # The arguments of atan2 may be long and nested.
    for _ in range(_MOST_PARTS):
        if not pending:
            break
        part = pending.pop()
        if type(part) is Call:
            found.add(part.function)
        elif type(part) is SymbolNode:
            found.add(part.symbol.name.rstrip("0123456789_")[-1:])
        pending.extend(children(part))
    return found


def _arity(name: str, arguments: Sequence[Node] = ()) -> int:
    number = BUILT.get(name)
    return ARITY.get(name, 1) if number is None else number or len(arguments)


def _wrong_number(function: Token, arguments: list[Node], end: int) -> UnreadableError:
    _, (name, _), start, stop = function
    return UnreadableError(
        "arguments", (start, end), name=name, function=(start, stop), wanted=_arity(name) or 2,
        places=[(argument.start, argument.end) for argument in arguments],
    )  # fmt: skip


# --- Build functions such as sec, pow and hypot from the functions that a tree may contain
#
# For example, sec(x) gets the same tree as 1/cos(x).


RECIPROCALS: Final = {"sec": "cos", "csc": "sin", "cot": "tan"}
_OPERATORS: Final[dict[str, Operator]] = {
    "pow": "^", "quotient": "/", "sum": "+", "product": "*",
}  # fmt: skip


def build_function(name: str, arguments: Sequence[Node], start: int, end: int) -> Node:
    """Return the tree of a function such as sec. The number of arguments must be correct."""
    if name in RECIPROCALS:
        one = Number(1.0, "1", start, start)
        return Binary("/", one, Call(RECIPROCALS[name], tuple(arguments), start, end), start, end)
    if name == "hypot":
        squares = [
            Binary("^", side, Number(2.0, "2", side.end, side.end), side.start, side.end)
            for side in arguments
        ]
        total = Binary("+", squares[0], squares[1], start, end)
        return Call("sqrt", (total,), start, end)
    whole = arguments[0]
    for argument in arguments[1:]:
        whole = Binary(_OPERATORS[name], whole, argument, start, end)
    return whole


# --- Notes on formulas that are read literally although the student may mean something else
#
# ``θ1 + 90`` adds 90 radians, ``cos(1)`` is the cosine of 1 radian, ``s1+2`` is a sine plus 2, and
# ``0·5`` is 0.


# Students hardly mean larger angles (90, 180 or 22.5) in radians.
_WHOLE_TURN: Final = 2 * math.pi
_SHORTHAND: Final = regex(r"(?:[cCsS]|cos|sin)_?[0-9₀-₉]+")
_DIGIT: Final = regex(r"[1-9]")
_DOTS: Final = ("·", "⋅", "∙", "•")


def on_sum(left: Node, right: Node, *, degrees: bool) -> Note | None:
    """Return a note on a sum such as θ1 + 90, which may mean degrees; else None."""
    for one, other in ((left, right), (right, left)):
        number = _number(other)
        if number is not None and not degrees and _is_large(number) and _has_angle(one):
            return _radians(number)
    return None


def on_shorthand(
    source: str, left: Node, right: Node, turning: Mapping[int, Symbol]
) -> Note | None:
    """Return a note on a sum such as s1+2, which may mean s12; else None."""
    if type(right) is not Number or not _DIGIT.fullmatch(right.literal):
        return None
    last, digit = left, right.literal
    while type(last) is Binary and last.right.end == last.end:
        last = last.right
    written = source[last.start : last.end]
    if type(last) is not Call or source[last.end : right.start] != "+":
        return None
    joint = _last_joint(last.arguments[0])
    if joint is None or not joint < int(digit) or int(digit) not in turning:
        return None
    if not _SHORTHAND.fullmatch(written):
        return None
    if last.function == "sin":
        message = say(
            "This was read as {sine} + {digit}. For the sine of a sum of joint angles, write "
            "{sine}{digit}.",
            sine=written,
            digit=digit,
        )
    else:
        message = say(
            "This was read as {cosine} + {digit}. For the cosine of a sum of joint angles, write "
            "{cosine}{digit}.",
            cosine=written,
            digit=digit,
        )
    return Note("shorthand", message, (last.start, right.end))


def on_product(source: str, left: Number, right: Number) -> Note | None:
    """Return a note on a product such as 0·5, whose dot may be a decimal point; else None."""
    if source[left.end : right.start] not in _DOTS or "." in left.literal + right.literal:
        return None
    message = say(
        "{written} was read as a product. In a decimal number, write a full stop: {number}.",
        written=source[left.start : right.end],
        number=f"{left.literal}.{right.literal}",
    )
    return Note("raised_dot", message, (left.start, right.end))


def on_call(
    function: str, argument: Node, turning: Mapping[int, Symbol], *, degrees: bool
) -> Note | None:
    """Return a note on cos(1), which may mean joint angle 1, or cos(90), which may mean 90°."""
    number = _number(argument)
    if number is None or function not in TRIGONOMETRIC:
        return None
    joint = turning.get(int(number.literal)) if _DIGIT.fullmatch(number.literal) else None
    if joint is not None:
        text, formula = number.literal, f"{function}({joint.name})"
        if degrees:
            message = say(
                "{number} was read as a number of degrees. For the joint angle, write {formula}.",
                number=text,
                formula=formula,
            )
        else:
            message = say(
                "{number} was read as a number of radians. For the joint angle, write {formula}.",
                number=text,
                formula=formula,
            )
        return Note("bare_radians", message, (number.start, number.end))
    return _radians(number) if not degrees and _is_large(number) else None


def _radians(number: Number) -> Note:
    message = say(
        "{number} was read as {number} radians. For degrees, write {number}°.",
        number=number.literal,
    )
    return Note("bare_radians", message, (number.start, number.end))


def _unsigned(node: Node) -> Node:
    return node.operand if type(node) is Negation else node


def _number(node: Node) -> Number | None:
    node = _unsigned(node)
    return node if type(node) is Number else None


def _is_angle(node: Node) -> bool:
    node = _unsigned(node)
    return type(node) is SymbolNode and node.symbol.kind == "angle"


def _is_large(number: Number) -> bool:
    return number.value > _WHOLE_TURN and (2 * number.value).is_integer()


def _has_angle(node: Node) -> bool:
    return any(map(_is_angle, (node, node.left, node.right) if type(node) is Binary else (node,)))


def _last_joint(argument: Node) -> int | None:
    last = argument.right if type(argument) is Binary else argument
    return last.symbol.joint if type(last) is SymbolNode else None


# --- Refuse two values that look like a product: ``90° (π/2)``, ``a2 (0.4318)``, ``θ1 (0)``
#
# Students write a value in brackets after its name, or after the same angle in another unit.


_FEW_PARTS: Final = 16
_LARGEST_FACTOR: Final = 1.0
_HALF_A_TURN: Final = 180.0


def check_product(source: str, left: Node, right: Node) -> None:
    """Raise UnreadableError if a product without a sign is more likely to be two values."""
    kind = type(right)
    if kind is SymbolNode or kind is Call:
        return
    in_brackets = source[right.start] in "([{" and source[right.end - 1] in ")]}"
    is_whole = in_brackets and not source[: left.start].strip() and not source[right.end :].strip()
    if not (in_brackets or kind is Unit or kind is Pi) or not _is_constant(right):
        return
    if _is_name(left):
        in_words = not source[right.start - 1].strip()
        if not is_whole or not (in_words or _is_angle(left) or _is_decimal(right)):
            return
        instead = left if in_words and (_is_zero(right) or not _is_angle(left)) else None
    elif _is_constant(left) and _are_values(left, right, is_whole=is_whole):
        instead = (right if type(left) is Number else left) if is_whole else None
    else:
        return
    span = left.start, right.end
    raise UnreadableError("values", span, number=False, instead=instead and _text(source, instead))


def _is_name(node: Node) -> bool:
    node = _unsigned(node)
    return type(node) is SymbolNode and node.symbol.kind != "number"


def _is_zero(value: Node) -> bool:
    return all(type(part) is not Number or not part.value for part in _first_parts(value))


def _is_decimal(value: Node) -> bool:
    number = _number(value)
    return number is not None and "." in number.literal


def _are_values(left: Node, right: Node, *, is_whole: bool) -> bool:
    of_left, of_right = _first_parts(left), _first_parts(right)
    # 180/π and π/180 convert a value from one unit to another.
    if any(map(_divides_half_a_turn, (*of_left, *of_right))):
        return False
    units = [any(type(part) is Unit for part in parts) for parts in (of_left, of_right)]
    angles = [any(type(part) in {Unit, Pi} for part in parts) for parts in (of_left, of_right)]
    if all(angles):
        return any(units) or is_whole
    number = _number(left if angles[1] else right)
    return is_whole and any(angles) and number is not None and _is_value(number)


def _divides_half_a_turn(node: Node) -> bool:
    return (
        type(node) is Binary
        and node.operator == "/"
        and any(type(part) is Number and part.value == _HALF_A_TURN for part in _first_parts(node))
    )


def _is_value(number: Number) -> bool:
    return number.value > _LARGEST_FACTOR and ("." in number.literal or number.value >= 30)


def _text(source: str, node: Node) -> str:
    text = source[node.start : node.end]
    return text[1:-1] if text[0] in "([{" and text[-1] in ")]}" else text


def _is_constant(node: Node) -> bool:
    parts = _first_parts(node)
    return len(parts) <= _FEW_PARTS and not any(type(part) is SymbolNode for part in parts)


# --- Refuse ambiguous degree signs: π/2° may mean π/2 or 90°


# With one of these numbers, π belongs to a conversion, as in (q*180/π)°.
_HALF_TURNS: Final = frozenset({180.0, 360.0})


def check_unit(operand: Node, span: Span) -> None:
    """Raise UnreadableError if ``operand``, which has a degree sign, contains π."""
    if _is_of_pi(operand):
        inside = (operand.start, operand.end)
        raise UnreadableError("ambiguous_unit", span, opens=False, of_pi=True, inside=inside)


def check_divisor(left: Node, right: Unit) -> None:
    """Raise UnreadableError for a quotient in which only the divisor is in degrees: 180/2°."""
    inside = right.operand
    # The unit of deg2rad(2) belongs to the divisor.
    if right.unit != "deg" or inside.start != right.start or _has(left, Unit):
        return
    raise UnreadableError(
        "ambiguous_unit",
        (left.start, right.end),
        opens=False,
        of_pi=_is_of_pi(left),
        inside=(left.start, inside.end),
    )


def _is_of_pi(node: Node) -> bool:
    parts = _first_parts(node, _MOST_PARTS)
    half_turns = (type(part) is Number and part.value in _HALF_TURNS for part in parts)
    return _has(node, Pi) and not any(half_turns)


def _has(node: Node, kind: type[Node]) -> bool:
    return any(type(part) is kind for part in _first_parts(node, _MOST_PARTS))


def _first_parts(node: Node, most: int = _FEW_PARTS) -> list[Node]:
    """Return ``node`` and the parts below it, level by level; of a large node only the first."""
    found = [node]
    for part in found:
        if len(found) > most:
            break
        found += children(part)
    return found


# --- Add the unit of degrees to bare numbers in a tree, for a student who works in degrees
#
# An angle context is the argument of sin, cos or tan, or a whole entry that is an angle. In an
# angle context, a constant term is in degrees unless it contains π, a unit or an inverse function;
# joint variables and angle symbols are in radians. ``cos(q1 + 90)`` becomes ``cos(q1 + 90deg)``.
#
# The argument of sind, cosd or tand is an angle context for every student; these functions become
# sin, cos and tan.


class _Facts(NamedTuple):
    # Facts about a node of a formula.
    # ``constant``: the node has no symbol. ``angle``: it is an angle in radians. ``pi``: it is an
    # angle in radians because it contains π.
    constant: bool
    angle: bool
    pi: bool


def in_degrees(tree: Node, *, is_angle: bool, notes: list[Note]) -> Node:
    """Return ``tree`` with the unit of degrees on bare constants that are angles.

    ``is_angle`` is True if the whole entry is an angle. Constants written with π stay in radians.
    """
    conversion = _Conversion(tree, notes, TRIGONOMETRIC)
    return conversion.angle(tree) if is_angle else conversion.plain(tree)


def without_degree_functions(tree: Node, *, notes: list[Note]) -> Node:
    """Return ``tree`` with cosd(60) replaced by cos(60deg), for a student who works in radians."""
    return _Conversion(tree, notes, frozenset()).plain(tree)


class _Conversion:
    def __init__(self, tree: Node, notes: list[Note], functions: frozenset[str]) -> None:
        self.notes = notes
        self.functions = functions
        self.facts: dict[int, _Facts] = {}
        self._survey(tree)

    def _survey(self, node: Node) -> _Facts:
        below = [self._survey(child) for child in children(node)]
        facts = self.facts[id(node)] = _facts(node, below)
        return facts

    def plain(self, node: Node) -> Node:
        """Add the unit of degrees to the angles inside ``node``, which is not an angle itself."""
        match node:
            case Binary(operator, left, right):
                return Binary(operator, self.plain(left), self.plain(right), node.start, node.end)
            case Negation(operand):
                return Negation(self.plain(operand), node.start, node.end)
            case Unit(operand, unit):
                return Unit(self.plain(operand), unit, node.start, node.end)
            case Call(function, arguments):
                takes_degrees = function in self.functions or function in OF_DEGREES
                inside = self.angle if takes_degrees else self.plain
                name = OF_DEGREES.get(function, function)
                return Call(name, tuple(map(inside, arguments)), node.start, node.end)
            case _:
                return node

    def angle(self, node: Node) -> Node:
        """Add the unit of degrees to the bare constants in ``node``, which is an angle."""
        match node:
            case Negation(operand):
                return Negation(self.angle(operand), node.start, node.end)
            case Binary("+" | "-" as operator, left, right):
                return Binary(operator, self.angle(left), self.angle(right), node.start, node.end)
            case Call("abs", (argument,)):
                return Call("abs", (self.angle(argument),), node.start, node.end)
        if self.facts[id(node)].constant:
            return self._constant(node)
        match node:
            case Binary("*", left, right):
                return self._product(node, left, right)
            case Binary("/", left, right):
                return Binary("/", self.angle(left), self.plain(right), node.start, node.end)
            case _:
                return self.plain(node)

    def _constant(self, node: Node) -> Node:
        facts = self.facts[id(node)]
        if facts.pi:
            message = say(
                "This is written with π, so it was taken as radians although angles are in "
                "degrees here."
            )
            self.notes.append(Note("radians_in_degrees", message, (node.start, node.end)))
        if facts.angle or (type(node) is Number and node.value == 0):
            return self.plain(node)
        return Unit(self.plain(node), "deg", node.start, node.end)

    def _product(self, node: Node, left: Node, right: Node) -> Node:
        # Add degrees in the one factor that is an angle: q1 + 45 in 2*(q1 + 45), or 90 in k*90.
        one, other = self.facts[id(left)], self.facts[id(right)]
        angles = one.angle, other.angle
        if angles == (False, False):
            angles = (False, True) if other.constant else (one.constant, False)
        first = self.angle(left) if angles == (True, False) else self.plain(left)
        second = self.angle(right) if angles == (False, True) else self.plain(right)
        return Binary("*", first, second, node.start, node.end)


def _facts(node: Node, below: list[_Facts]) -> _Facts:
    constant = all(facts.constant for facts in below)
    angle = any(facts.angle for facts in below)
    pi = any(facts.pi for facts in below)
    match node:
        case Pi():
            return _Facts(constant, True, True)
        case Unit():
            return _Facts(constant, True, False)
        case SymbolNode(symbol):
            return _Facts(False, symbol.kind == "angle", False)
        case Call("abs"):
            return _Facts(constant, angle, pi)
        case Call(function):
            # A sine is not an angle, even if its argument is one.
            return _Facts(constant, function in INVERSE, False)
        case _:
            return _Facts(constant, angle, pi)
