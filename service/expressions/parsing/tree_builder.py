"""Build the syntax tree of a formula, and note its ambiguous passages.

The parser calls one method for each rule of the grammar.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from service.expressions.errors import Note, UnreadableError, shortened
from service.expressions.limits import LIMITS
from service.expressions.parsing.ambiguous_units import check_divisor, check_unit
from service.expressions.parsing.built import build_function
from service.expressions.parsing.lexing.literal_notes import (
    on_call,
    on_product,
    on_shorthand,
    on_sum,
)
from service.expressions.parsing.lexing.tokens import Token
from service.expressions.parsing.values_in_brackets import check_product
from service.expressions.tree import (
    Binary,
    Call,
    Negation,
    Node,
    Number,
    Operator,
    SymbolNode,
    Unit,
    UnitName,
    children,
)
from service.expressions.vocabulary.functions import ARITY, BUILT, INVERSE, OF_DEGREES
from service.expressions.vocabulary.symbols import Symbol
from service.translations import say

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
            number = other.operand if type(other) is Negation else other
            if type(one) is not Unit or one.unit != "deg" or type(number) is not Number:
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
