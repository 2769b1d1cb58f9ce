"""A tree -> normal text, which reads back to the same tree."""

from typing import Final

from service.expressions.tree import Binary, Call, Negation, Node, Number, Pi, Unit, Variable

# How tightly each form binds; a part that binds less than its place needs brackets.
SUM, PRODUCT, SIGNED, POWER, ATOM = range(5)
_LEVELS: Final = {"+": SUM, "-": SUM, "*": PRODUCT, "/": PRODUCT, "^": POWER}


def level(node: Node) -> int:
    """Return how tightly `node` binds."""
    match node:
        case Binary(operator):
            return _LEVELS[operator]
        case Negation():
            return SIGNED
        case _:
            return ATOM


def to_text(node: Node) -> str:
    """Return `node` in normal text: canonical names, every product written."""
    match node:
        case Number(literal=literal):
            return literal
        case Pi():
            return "pi"
        case Variable(symbol):
            return symbol.name
        case Call(function, arguments):
            return f"{function}({', '.join(map(to_text, arguments))})"
        case Unit(operand, unit):
            # A name and its unit would run together into one word.
            gap = " " if isinstance(operand, Pi | Variable) else ""
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
            first = f"({to_text(left)})" if level(left) < PRODUCT else to_text(left)
            return f"{first}{operator}{_at(right, POWER)}"


def _at(node: Node, needed: int) -> str:
    """Return `node` in a place that needs `needed`, where a sign must not come first."""
    text = to_text(node)
    return f"({text})" if level(node) < needed or text.startswith("-") else text
