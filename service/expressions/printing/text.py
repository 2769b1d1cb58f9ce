"""Print a tree as plain text. Reading the text gives the same tree."""

from service.expressions.printing.brackets import ATOM, POWER, PRODUCT, needs_brackets
from service.expressions.printing.spelling import PLAIN, Spelling
from service.expressions.tree import (
    Binary,
    Call,
    Negation,
    Node,
    Number,
    Operator,
    Pi,
    SymbolNode,
    Unit,
)


def to_text(node: Node, spelling: Spelling = PLAIN) -> str:
    """Return ``node`` as plain text with all product signs."""
    match node:
        case Number(literal=literal):
            return literal
        case Pi():
            return spelling.pi
        case SymbolNode(symbol):
            return spelling.name(symbol)
        case Call(function, arguments):
            inside = ", ".join(to_text(argument, spelling) for argument in arguments)
            return spelling.in_shorthand(node) or f"{function}({inside})"
        case Unit():
            return _unit(node, spelling)
        case Negation(operand):
            return f"-{_at(operand, POWER, spelling)}"
        case Binary("^", base, exponent):
            sign = "-" if type(exponent) is Negation else ""
            inner = exponent.operand if isinstance(exponent, Negation) else exponent
            return f"{_at(base, ATOM, spelling)}^{sign}{_at(inner, ATOM, spelling)}"
        case Binary("+" | "-" as operator, left, right):
            return f"{to_text(left, spelling)} {operator} {_at(right, PRODUCT, spelling)}"
        case Binary(operator, left, right):
            first = _at(left, PRODUCT, spelling, first=True)
            return f"{first}{operator}{_factor(operator, right, spelling)}"


def _unit(node: Unit, spelling: Spelling) -> str:
    operand, unit = node.operand, node.unit
    sign = spelling.degree if unit == "deg" else unit
    if unit == "deg" and isinstance(operand, Pi | Call):
        # π° has two readings.
        return f"({to_text(operand, spelling)}){sign}"
    # A name and its unit would run together into one word.
    gap = " " if sign.isalpha() and isinstance(operand, Pi | SymbolNode) else ""
    return f"{_at(operand, ATOM, spelling)}{gap}{sign}"


def _factor(operator: Operator, node: Node, spelling: Spelling) -> str:
    if operator == "/" and isinstance(node, Unit) and node.unit == "deg":
        # 180/2° has two readings.
        return f"({to_text(node, spelling)})"
    return _at(node, POWER, spelling)


def _at(node: Node, place: int, spelling: Spelling, *, first: bool = False) -> str:
    text = to_text(node, spelling)
    signed = not first and text[0] == "-"
    return f"({text})" if needs_brackets(node, place, signed=signed, drawn=False) else text
