"""A tree -> LaTeX, as typed and not rearranged."""

from typing import Final

from service.expressions.printing.symbol_names import symbol_latex
from service.expressions.printing.text import ATOM, POWER, PRODUCT, level
from service.expressions.tree import (
    Binary,
    Call,
    Negation,
    Node,
    Number,
    Operator,
    Pi,
    Unit,
    Variable,
)

_FUNCTIONS: Final = {
    "sin": r"\sin",
    "cos": r"\cos",
    "tan": r"\tan",
    "asin": r"\arcsin",
    "acos": r"\arccos",
    "atan": r"\arctan",
    "atan2": r"\operatorname{atan2}",
    "exp": r"\exp",
}


def to_latex(node: Node) -> str:
    """Return `node` in LaTeX, for math mode."""
    match node:
        case Number(literal=literal):
            return number(literal)
        case Pi():
            return r"\pi"
        case Variable(symbol):
            return symbol_latex(symbol)
        case Call(function, arguments):
            return _call(function, [to_latex(argument) for argument in arguments])
        case Unit(operand, unit):
            return _at(operand, ATOM) + (r"^{\circ}" if unit == "deg" else r"\,\mathrm{rad}")
        case Negation(operand):
            return f"-{_at(operand, PRODUCT)}"
        case Binary(operator, left, right):
            return _binary(operator, left, right)


def _binary(operator: Operator, left: Node, right: Node) -> str:
    if operator == "^":
        return _power(left, right)
    if operator == "/":
        # The sign of -π/2 stands before the bar, as it was typed.
        sign, upper = ("-", left.operand) if isinstance(left, Negation) else ("", left)
        return rf"{sign}\frac{{{to_latex(upper)}}}{{{to_latex(right)}}}"
    if operator == "*":
        first = rf"\left({to_latex(left)}\right)" if level(left) < PRODUCT else to_latex(left)
        return f"{first}{_times(right)}{_at(right, POWER)}"
    return f"{to_latex(left)} {operator} {_at(right, PRODUCT)}"


def number(literal: str) -> str:
    r"""Return a number in LaTeX: 1e-3 -> 1 \cdot 10^{-3}."""
    mantissa, _, exponent = literal.lower().partition("e")
    return rf"{mantissa} \cdot 10^{{{int(exponent)}}}" if exponent else mantissa


def is_power_of_ten(node: Node) -> bool:
    """Tell whether `node` is a number that prints as a product: 1e-3."""
    return isinstance(node, Number) and "e" in node.literal.lower()


def first_is_digit(node: Node) -> bool:
    """Tell whether `node` prints a digit first, so that a product before it needs a dot."""
    match node:
        case Number():
            return True
        case Unit(operand):
            return first_is_digit(operand)
        case Binary("^" | "*", left):
            return first_is_digit(left)
        case Binary("/", left):
            # Beside a bar, too, a product needs its dot: 2½ is no product.
            return type(left) is not Negation
        case _:
            return False


def _times(right: Node) -> str:
    return r" \cdot " if first_is_digit(right) else " "


def _call(function: str, arguments: list[str]) -> str:
    if function == "sqrt":
        return rf"\sqrt{{{arguments[0]}}}"
    if function == "abs":
        return rf"\left|{arguments[0]}\right|"
    return rf"{_FUNCTIONS[function]}\left({', '.join(arguments)}\right)"


def _power(base: Node, exponent: Node) -> str:
    raised = f"^{{{to_latex(exponent)}}}"
    if (
        isinstance(base, Call)
        and base.function in {"sin", "cos", "tan"}
        and type(exponent) is Number
        and exponent.literal.isdigit()
        and len(exponent.literal) < 5
    ):
        return rf"{_FUNCTIONS[base.function]}{raised}\left({to_latex(base.arguments[0])}\right)"
    if isinstance(base, Unit):
        return rf"\left({to_latex(base)}\right){raised}"
    return f"{_at(base, ATOM)}{raised}"


def _at(node: Node, needed: int) -> str:
    text = to_latex(node)
    # A fraction's bar groups what a / does not.
    is_fraction = type(node) is Binary and node.operator == "/"
    too_loose = needed == ATOM if is_fraction else level(node) < needed
    too_loose = too_loose or (needed == ATOM and is_power_of_ten(node))
    return rf"\left({text}\right)" if too_loose or text.startswith("-") else text
