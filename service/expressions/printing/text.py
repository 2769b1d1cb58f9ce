"""A tree -> normal text, which reads back to the same tree."""

from service.expressions.printing.brackets import ATOM, POWER, PRODUCT, needs_brackets
from service.expressions.tree import Binary, Call, Negation, Node, Number, Pi, SymbolNode, Unit


def to_text(node: Node) -> str:
    """``node`` in normal text: canonical names, every product written."""
    match node:
        case Number(literal=literal):
            return literal
        case Pi():
            return "pi"
        case SymbolNode(symbol):
            return symbol.name
        case Call(function, arguments):
            return f"{function}({', '.join(map(to_text, arguments))})"
        case Unit(operand, unit):
            # A name and its unit would run together into one word.
            gap = " " if isinstance(operand, Pi | SymbolNode) else ""
            return f"{_at(operand, ATOM)}{gap}{unit}"
        case Negation(operand):
            return f"-{_at(operand, POWER)}"
        case Binary("^", base, exponent):
            sign = "-" if type(exponent) is Negation else ""
            inner = exponent.operand if isinstance(exponent, Negation) else exponent
            return f"{_at(base, ATOM)}^{sign}{_at(inner, ATOM)}"
        case Binary("+" | "-" as operator, left, right):
            return f"{to_text(left)} {operator} {_at(right, PRODUCT)}"
        case Binary(operator, left, right):
            return f"{_at(left, PRODUCT, first=True)}{operator}{_at(right, POWER)}"


def _at(node: Node, place: int, *, first: bool = False) -> str:
    text = to_text(node)
    signed = not first and text[0] == "-"
    return f"({text})" if needs_brackets(node, place, signed=signed, drawn=False) else text
