"""Print a tree as presentation MathML, without rearranging the formula."""

from html import escape  # that of xml.sax would load an HTTP client
from typing import Final

from service.expressions.characters import greek
from service.expressions.printing.brackets import (
    ATOM,
    POWER,
    PRODUCT,
    needs_brackets,
    needs_dot,
)
from service.expressions.printing.symbol_names import stem_and_index
from service.expressions.tree import Binary, Call, Negation, Node, Number, Pi, SymbolNode, Unit
from service.expressions.vocabulary.symbols import Symbol
from service.regex import regex

_NAMES: Final = {"asin": "arcsin", "acos": "arccos", "atan": "arctan"}
_OPERATORS: Final = {"+": "<mo>+</mo>", "-": "<mo>−</mo>"}
# The LaTeX that a symbol may declare: a letter or a word, an index, and a superscript.
_WORD: Final = r"\\(?:mathrm|text|mathit|operatorname)\{([^{}]*)\}"
_IN_COMMAND: Final = regex(_WORD)
_PART: Final = rf"(?:\\[A-Za-z]+|\{{(?:[^{{}}]|{_WORD})*\}}|[A-Za-z0-9*'])"
_LATEX: Final = regex(
    rf"(?P<base>{_WORD}|\\?[A-Za-z]+)(?:_(?P<below>{_PART}))?"
    rf"(?:\^(?P<above>{_PART}))?(?:_(?P<below2>{_PART}))?"
)
_STARS: Final = {"*": "*", "ast": "*", "star": "⋆", "prime": "′", "'": "′", "circ": "°"}
_INVISIBLE_TIMES: Final = "<mo>&#x2062;</mo>"
# Before the name of a function: l cos φ, not lcos φ.
_THIN_TIMES: Final = "<mo rspace='0.17em'>&#x2062;</mo>"
_APPLY: Final = "<mo>&#x2061;</mo>"


def to_mathml(node: Node) -> str:
    """Return ``node`` as one ``<math>`` element."""
    return f'<math xmlns="http://www.w3.org/1998/Math/MathML">{row(node)}</math>'


def row(node: Node) -> str:
    """Return ``node`` as one MathML element, which belongs inside ``<math>``."""
    match node:
        case Number(literal=literal):
            return _number(literal)
        case Pi():
            return "<mi>π</mi>"
        case SymbolNode(symbol):
            return _variable(symbol)
        case Call(function, arguments):
            return _call(function, [row(argument) for argument in arguments])
        case Unit(operand, "deg"):
            return _mrow(f"{_at(operand, ATOM)}<mo>°</mo>")
        case Unit(operand):
            return _mrow(f"{_at(operand, ATOM)}<mspace width='0.2em'/><mi>rad</mi>")
        case Negation(operand):
            return _mrow(f"<mo>−</mo>{_at(operand, PRODUCT)}")
        case Binary():
            return _binary(node)


def _binary(node: Binary) -> str:
    operator, left, right = node.operator, node.left, node.right
    if operator == "^":
        return f"<msup>{_at(left, ATOM)}{row(right)}</msup>"
    if operator == "/":
        if isinstance(left, Negation):
            # The sign of -π/2 is drawn before the fraction, as typed.
            return _mrow(f"<mo>−</mo><mfrac>{row(left.operand)}{row(right)}</mfrac>")
        return f"<mfrac>{row(left)}{row(right)}</mfrac>"
    if operator == "*":
        is_function = type(right) is Call or (type(right) is Binary and type(right.left) is Call)
        invisible = _THIN_TIMES if is_function else _INVISIBLE_TIMES
        times = "<mo>⋅</mo>" if needs_dot(left, right) else invisible
        return _mrow(f"{_at(left, PRODUCT, first=True)}{times}{_at(right, POWER)}")
    return _mrow(f"{row(left)}{_OPERATORS[operator]}{_at(right, PRODUCT)}")


def _mrow(inside: str) -> str:
    return f"<mrow>{inside}</mrow>"


def _number(literal: str) -> str:
    mantissa, _, exponent = literal.lower().partition("e")
    if not exponent:
        return f"<mn>{mantissa}</mn>"
    power = f"<msup><mn>10</mn><mn>{int(exponent)}</mn></msup>"
    return _mrow(f"<mn>{mantissa}</mn><mo>⋅</mo>{power}")


def _variable(symbol: Symbol) -> str:
    match = None if symbol.latex is None else _LATEX.fullmatch(symbol.latex)
    if match is None:
        stem, index = stem_and_index(symbol.name)
        return scripted(stem, index, "")
    below = match["below"] or match["below2"] or ""
    return scripted(match["base"], below, match["above"] or "")


def scripted(base: str, below: str, above: str) -> str:
    """Return the MathML element of a name with an index and a superscript."""
    # Each of them is LaTeX or plain text.
    parts = [_identifier(base), *(_identifier(_unbraced(part)) for part in (below, above) if part)]
    if len(parts) == 1:
        return parts[0]
    tag = "msubsup" if below and above else "msub" if below else "msup"
    return f"<{tag}>{''.join(parts)}</{tag}>"


def _unbraced(part: str) -> str:
    return part[1:-1] if part.startswith("{") else part


def _identifier(text: str) -> str:
    in_command = _IN_COMMAND.fullmatch(text)
    plain = in_command[1] if in_command else text.removeprefix("\\")
    plain = _STARS.get(plain, plain)
    tag = "mn" if plain.isdigit() else "mo" if plain in _STARS.values() else "mi"
    upright = " mathvariant='normal'" if in_command and len(plain) == 1 and tag == "mi" else ""
    return f"<{tag}{upright}>{escape(greek.LETTERS.get(plain, plain), quote=False)}</{tag}>"


def _call(function: str, arguments: list[str]) -> str:
    if function == "sqrt":
        return f"<msqrt>{arguments[0]}</msqrt>"
    if function == "abs":
        return _mrow(f"<mo>|</mo>{arguments[0]}<mo>|</mo>")
    inside = "<mo>,</mo>".join(arguments)
    name = f"<mi>{_NAMES.get(function, function)}</mi>"
    return _mrow(f"{name}{_APPLY}{_mrow(f'<mo>(</mo>{inside}<mo>)</mo>')}")


def _at(node: Node, place: int, *, first: bool = False) -> str:
    element = row(node)
    if not needs_brackets(node, place, signed=not first and _begins_with_sign(node)):
        return element
    return _mrow(f"<mo>(</mo>{element}<mo>)</mo>")


def _begins_with_sign(node: Node) -> bool:
    while type(node) is Binary and node.operator != "^":
        node = node.left
    return type(node) is Negation
