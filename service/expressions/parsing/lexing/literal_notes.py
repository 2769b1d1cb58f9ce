"""Notes on formulas that are read literally although the student may mean something else.

``θ1 + 90`` adds 90 radians, ``cos(1)`` is the cosine of 1 radian, ``s1+2`` is a sine plus 2, and
``0·5`` is 0.
"""

import math
from collections.abc import Mapping
from typing import Final

from service.expressions.errors import Note
from service.expressions.tree import Binary, Call, Negation, Node, Number, SymbolNode
from service.expressions.vocabulary.functions import TRIGONOMETRIC
from service.expressions.vocabulary.symbols import Symbol
from service.regex import regex
from service.translations import say

# Students hardly mean larger angles (90, 180 or 22.5) in radians.
_WHOLE_TURN: Final = 2 * math.pi
_SHORTHAND: Final = regex(r"(?:[cCsS]|cos|sin)_?[0-9₀-₉]+")
_DIGIT: Final = regex(r"[1-9]")
_DOTS: Final = ("·", "⋅", "∙", "•")


def on_sum(left: Node, right: Node, *, degrees: bool) -> Note | None:
    """Return a note on a sum such as θ1 + 90, which may mean degrees; else None."""
    for one, other in ((left, right), (right, left)):
        number = _number(other)
        if number is not None and not degrees and _is_large(number) and _is_angle(one):
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


def _number(node: Node) -> Number | None:
    node = node.operand if type(node) is Negation else node
    return node if type(node) is Number else None


def _is_large(number: Number) -> bool:
    return number.value > _WHOLE_TURN and (2 * number.value).is_integer()


def _is_angle(node: Node) -> bool:
    parts: list[Node] = [node]
    if type(node) is Binary:
        parts += [node.left, node.right]
    plain = (part.operand if type(part) is Negation else part for part in parts)
    return any(type(part) is SymbolNode and part.symbol.kind == "angle" for part in plain)


def _last_joint(argument: Node) -> int | None:
    last = argument.right if type(argument) is Binary else argument
    return last.symbol.joint if type(last) is SymbolNode else None
