"""Print a tree as LaTeX, without rearranging the formula."""

from typing import Final

from service.expressions.printing.brackets import (
    ATOM,
    POWER,
    PRODUCT,
    needs_brackets,
    needs_dot,
)
from service.expressions.printing.symbol_names import symbol_latex
from service.expressions.tree import Binary, Call, Negation, Node, Number, Pi, SymbolNode, Unit

_FUNCTIONS: Final = {
    "sin": r"\sin", "cos": r"\cos", "tan": r"\tan", "asin": r"\arcsin", "acos": r"\arccos",
    "atan": r"\arctan", "atan2": r"\operatorname{atan2}", "exp": r"\exp",
}  # fmt: skip


def to_latex(node: Node) -> str:
    """Return ``node`` in LaTeX for math mode."""
    match node:
        case Number(literal=literal):
            return number(literal)
        case Pi():
            return r"\pi"
        case SymbolNode(symbol):
            return symbol_latex(symbol)
        case Call(function, arguments):
            return _call(function, [to_latex(argument) for argument in arguments])
        case Unit(operand, unit):
            return _at(operand, ATOM) + (r"^{\circ}" if unit == "deg" else r"\,\mathrm{rad}")
        case Negation(operand):
            return f"-{_at(operand, PRODUCT)}"
        case Binary():
            return _binary(node)


def _binary(node: Binary) -> str:
    operator, left, right = node.operator, node.left, node.right
    if operator == "^":
        return _power(left, right)
    if operator == "/":
        # The sign of -π/2 is drawn before the fraction, as typed.
        sign, upper = ("-", left.operand) if isinstance(left, Negation) else ("", left)
        return rf"{sign}\frac{{{to_latex(upper)}}}{{{to_latex(right)}}}"
    if operator == "*":
        times = r" \cdot " if needs_dot(left, right) else " "
        return f"{_at(left, PRODUCT, first=True)}{times}{_at(right, POWER)}"
    return f"{to_latex(left)} {operator} {_at(right, PRODUCT)}"


def number(literal: str) -> str:
    r"""Return a number in LaTeX: 1e-3 -> 1 \cdot 10^{-3}."""
    mantissa, _, exponent = literal.lower().partition("e")
    return rf"{mantissa} \cdot 10^{{{int(exponent)}}}" if exponent else mantissa


def _call(function: str, arguments: list[str]) -> str:
    if function == "sqrt":
        return rf"\sqrt{{{arguments[0]}}}"
    if function == "abs":
        return rf"\left|{arguments[0]}\right|"
    return rf"{_FUNCTIONS[function]}\left({', '.join(arguments)}\right)"


def _power(base: Node, exponent: Node) -> str:
    match base, exponent:
        case Call("sin" | "cos" | "tan" as function, (argument,)), Number(literal=power):
            if power.isdigit() and len(power) < 5:
                return rf"{_FUNCTIONS[function]}^{{{power}}}\left({to_latex(argument)}\right)"
    return f"{_at(base, ATOM)}^{{{to_latex(exponent)}}}"


def _at(node: Node, place: int, *, first: bool = False) -> str:
    latex = to_latex(node)
    signed = not first and latex[0] == "-"
    return rf"\left({latex}\right)" if needs_brackets(node, place, signed=signed) else latex
