"""A syntax tree -> text, LaTeX or MathML, in the student's own spelling.

Formulas are never rearranged; reading the printed text gives the same tree.
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from html import escape
from typing import Final, NamedTuple

from dh_grader.expressions import characters
from dh_grader.expressions.vocabulary import (
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
    Vocabulary,
    children,
    normal_form,
)
from dh_grader.regex import regex

# --- A student's spelling: the names of symbols, the unit of angles and the shorthand in formulas
#
# Reports print formulas in the student's spelling: a student who writes ``q1 - 90°`` does not read
# ``theta1 - pi/2``.


_LOWERED: Final = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
# A word followed by an index: θ_1, th1, q₁; not LaTeX and not q[0].
_INDEXED_NAME: Final = regex(rf"([A-Za-z{characters.CLASS}]+_?)([0-9]+|[₀-₉]+)")
_NAME: Final = regex(rf"[A-Za-z{characters.CLASS}][A-Za-z0-9_₀-₉{characters.CLASS}]*")
_SHORT: Final = regex(r"[cs](?:_?[0-9]+|_\{[0-9]+\}|[₀-₉]+)")
_SHORT_NAME: Final = regex(r"[cs][0-9]+")
_DEGREE_SIGN: Final = regex(r"[°º˚∘]|\\circ|\\degree")
_DEGREE_WORD: Final = regex(r"(?<![A-Za-z])deg")
_PI: Final = regex(r"π|(?<![A-Za-z])[Pp]i(?![A-Za-z])")
# A constant angle of more than a whole turn in radians is meant in degrees.
_WHOLE_TURN: Final = 6.2832
_BARE: Final = ""


@dataclass(frozen=True, slots=True)
class Spelling:
    """How formulas are printed.

    ``names`` maps canonical names of symbols to typed names; other symbols keep their canonical
    name. ``degree`` is printed after a number of degrees: "deg", "°", or "" if bare numbers are
    degrees. With ``in_degrees``, constant angles are printed in degrees, not as fractions of π.
    With ``shorthand``, cos(q1 + q2) is printed as c12.
    """

    names: Mapping[str, str] = field(default_factory=dict)
    pi: str = "pi"
    degree: str = "deg"
    in_degrees: bool = False
    shorthand: bool = False

    def name(self, symbol: Symbol) -> str:
        """Return the name under which the symbol is printed."""
        return self.names.get(symbol.name, symbol.name)

    def in_shorthand(self, call: Call) -> str | None:
        """Return a call such as cos(q1 + q2) in shorthand (c12), or None."""
        if not self.shorthand or call.function not in ("sin", "cos"):
            return None
        joints = _added_joints(call.arguments[0])
        if not joints or len(set(joints)) < len(joints) or (joints[1:] and max(joints) > 9):
            return None
        return f"{call.function[0]}{''.join(map(str, joints))}"

    def renamed(self, node: Node) -> Node:
        """Return the tree with symbols renamed to the student's names, to print as LaTeX."""
        match node:
            case SymbolNode(symbol) if symbol.name in self.names:
                name = _spelled_out(self.names[symbol.name])
                same = name == normal_form(symbol.name)
                return node if same else SymbolNode(replace(symbol, name=name, latex=None))
            case Binary(operator, left, right):
                return Binary(operator, self.renamed(left), self.renamed(right))
            case Negation(operand):
                return Negation(self.renamed(operand))
            case Call(function, arguments):
                return Call(function, tuple(map(self.renamed, arguments)))
            case _:
                return node


PLAIN: Final = Spelling()


class TypedFormula(NamedTuple):
    """A formula as typed and as a tree. With ``degrees``, angles without a unit are in degrees."""

    source: str
    tree: Node
    degrees: bool


def _spelled_out(name: str) -> str:
    """Return the name with Greek letters as words and a plain index: θ_1 -> theta1."""
    return "".join(characters.NAMES.get(letter, letter) for letter in normal_form(name))


def _added_joints(node: Node) -> list[int]:
    match node:
        case SymbolNode(Symbol(kind="angle", joint=int(joint))):
            return [joint]
        case Binary("+", left, right):
            first, second = _added_joints(left), _added_joints(right)
            return [*first, *second] if first and second else []
        case _:
            return []


# --- The spelling that formulas have in common


class Habits(NamedTuple):
    """How one formula writes angles, names and shorthand.

    ``unit`` is how the formula writes constant angles ("pi", "π", "deg", "°", ""), or None if the
    formula has none. ``names`` maps canonical names of symbols to typed names.
    """

    unit: str | None
    names: Mapping[str, str]
    has_shorthand: bool


def habits_of(formula: TypedFormula, vocabulary: Vocabulary) -> Habits:
    """Return how a formula writes angles, names and shorthand."""
    has_shorthand = any(_is_short(node, formula) for node in _nodes(formula.tree))
    return Habits(_unit_of(formula), _names(formula, vocabulary), has_shorthand)


def spelling_of(formulas: Iterable[Habits], vocabulary: Vocabulary, *, degrees: bool) -> Spelling:
    """Return one spelling (names, angle unit and shorthand) for several formulas.

    The spelling has the most frequent unit of angles and, for each symbol, the name that is used
    first.
    """
    # ``degrees`` is True if the student works in degrees; it decides the unit if no formula has
    # one.
    names: dict[str, str] = {}
    angles: Counter[str] = Counter()
    shorthand = False
    for formula in formulas:
        if formula.unit is not None:
            angles[formula.unit] += 1
        names = {**formula.names, **names}
        shorthand = shorthand or formula.has_shorthand
    shorthand = shorthand and not any(map(_SHORT_NAME.fullmatch, vocabulary.by_name))
    names |= _names_by_analogy(names, vocabulary)
    most = angles.most_common(1)
    unit = most[0][0] if most else _BARE if degrees else "pi"
    found = Spelling({name: typed for name, typed in names.items() if typed != name}, "pi", "deg")
    return _with_unit(replace(found, shorthand=shorthand), unit, degrees=degrees)


def spelling_for(formula: TypedFormula, common: Spelling, vocabulary: Vocabulary) -> Spelling:
    """Return the common spelling, but with the names and the angle unit that ``formula`` uses."""
    unit = _unit_of(formula)
    common = replace(common, names={**common.names, **_names(formula, vocabulary)})
    if unit is None:
        return common if common.degree or formula.degrees else replace(common, degree="deg")
    return _with_unit(common, unit, degrees=formula.degrees)


def _with_unit(spelling: Spelling, unit: str, *, degrees: bool) -> Spelling:
    if unit in ("pi", "π"):
        return replace(spelling, pi=unit, in_degrees=False, degree=_BARE if degrees else "deg")
    return replace(spelling, degree=unit, in_degrees=True)


def _unit_of(formula: TypedFormula) -> str | None:
    source, tree, degrees = formula
    if type(tree) is SymbolNode:  # as most are
        return None
    if _DEGREE_SIGN.search(source):
        return "°"
    if _DEGREE_WORD.search(source):
        return "deg"
    if found := _PI.search(source):
        return "π" if found[0] == "π" else "pi"
    if degrees:
        has_bare = any(isinstance(node, Unit) and node.unit == "deg" for node in _nodes(tree))
        return _BARE if has_bare else None
    number = tree.operand if isinstance(tree, Negation) else tree
    meant = isinstance(number, Number) and number.value > _WHOLE_TURN
    return "deg" if meant else None


def _nodes(tree: Node) -> Iterator[Node]:
    pending = [tree]
    while pending:
        node = pending.pop()
        yield node
        pending.extend(reversed(children(node)))


def _names(formula: TypedFormula, vocabulary: Vocabulary) -> dict[str, str]:
    names: dict[str, str] = {}
    # Shorthand such as c12 contains no names of angles. Remember it, because it may occur often.
    nameless: set[tuple[str, str]] = set()
    for node in _nodes(formula.tree):
        if isinstance(node, SymbolNode) and (name := node.symbol.name) not in names:
            typed = _typed(node, formula)
            if (name, typed) in nameless:
                continue
            if _is_name(typed, node.symbol, vocabulary):
                names[name] = typed
            else:
                nameless.add((name, typed))
    return names


def _is_short(node: Node, formula: TypedFormula) -> bool:
    return isinstance(node, Call) and _SHORT.fullmatch(_typed(node, formula)) is not None


def _typed(node: Node, formula: TypedFormula) -> str:
    return formula.source[node.start : node.end].strip("() ")


def _is_name(typed: str, symbol: Symbol, vocabulary: Vocabulary) -> bool:
    if typed == symbol.name:
        return True
    known = _NAME.fullmatch(typed) and vocabulary.by_name.get(normal_form(typed))
    return known == symbol


def _names_by_analogy(names: Mapping[str, str], vocabulary: Vocabulary) -> dict[str, str]:
    """Return names for the other joint variables, formed like the typed names.

    A student who writes q1 also writes q2; a student who writes θ_1 also writes θ_2.
    """
    found: dict[str, str] = {}
    joints = [symbol for symbol in vocabulary.symbols if symbol.joint is not None]
    models = [names[symbol.name] for symbol in joints if symbol.name in names]
    for symbol in joints:
        if symbol.name in names:
            continue
        for match in filter(None, map(_INDEXED_NAME.fullmatch, models)):
            index = str(symbol.joint)
            typed = match[1] + (index.translate(_LOWERED) if match[2][0] >= "₀" else index)
            if symbol.name not in found and _is_name(typed, symbol, vocabulary):
                found[symbol.name] = typed
    return found


# --- Print a tree as plain text


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
            return _text_unit(node, spelling)
        case Negation(operand):
            return f"-{_text_at(operand, POWER, spelling)}"
        case Binary("^", base, exponent):
            sign = "-" if type(exponent) is Negation else ""
            inner = exponent.operand if isinstance(exponent, Negation) else exponent
            return f"{_text_at(base, ATOM, spelling)}^{sign}{_text_at(inner, ATOM, spelling)}"
        case Binary("+" | "-" as operator, left, right):
            return f"{to_text(left, spelling)} {operator} {_text_at(right, PRODUCT, spelling)}"
        case Binary(operator, left, right):
            first = _text_at(left, PRODUCT, spelling, first=True)
            return f"{first}{operator}{_factor(operator, right, spelling)}"


def _text_unit(node: Unit, spelling: Spelling) -> str:
    operand, unit = node.operand, node.unit
    sign = spelling.degree if unit == "deg" else unit
    if unit == "deg" and isinstance(operand, Pi | Call):
        # π° has two readings.
        return f"({to_text(operand, spelling)}){sign}"
    # A name and its unit would run together into one word.
    gap = " " if sign.isalpha() and isinstance(operand, Pi | SymbolNode) else ""
    return f"{_text_at(operand, ATOM, spelling)}{gap}{sign}"


def _factor(operator: Operator, node: Node, spelling: Spelling) -> str:
    if operator == "/" and isinstance(node, Unit) and node.unit == "deg":
        # 180/2° has two readings.
        return f"({to_text(node, spelling)})"
    return _text_at(node, POWER, spelling)


def _text_at(node: Node, place: int, spelling: Spelling, *, first: bool = False) -> str:
    text = to_text(node, spelling)
    signed = not first and text[0] == "-"
    return f"({text})" if needs_brackets(node, place, signed=signed, drawn=False) else text


# --- Print a tree as LaTeX


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
            return _latex_call(function, [to_latex(argument) for argument in arguments])
        case Unit(operand, unit):
            return _latex_at(operand, ATOM) + (r"^{\circ}" if unit == "deg" else r"\,\mathrm{rad}")
        case Negation(operand):
            return f"-{_latex_at(operand, PRODUCT)}"
        case Binary():
            return _latex_binary(node)


def _latex_binary(node: Binary) -> str:
    operator, left, right = node.operator, node.left, node.right
    if operator == "^":
        return _power(left, right)
    if operator == "/":
        # The sign of -π/2 is drawn before the fraction, as typed.
        sign, upper = ("-", left.operand) if isinstance(left, Negation) else ("", left)
        return rf"{sign}\frac{{{to_latex(upper)}}}{{{to_latex(right)}}}"
    if operator == "*":
        times = r" \cdot " if needs_dot(left, right) else " "
        return f"{_latex_at(left, PRODUCT, first=True)}{times}{_latex_at(right, POWER)}"
    return f"{to_latex(left)} {operator} {_latex_at(right, PRODUCT)}"


def number(literal: str) -> str:
    r"""Return a number in LaTeX: 1e-3 -> 1 \cdot 10^{-3}."""
    mantissa, _, exponent = literal.lower().partition("e")
    return rf"{mantissa} \cdot 10^{{{int(exponent)}}}" if exponent else mantissa


def _latex_call(function: str, arguments: list[str]) -> str:
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
    return f"{_latex_at(base, ATOM)}^{{{to_latex(exponent)}}}"


def _latex_at(node: Node, place: int, *, first: bool = False) -> str:
    latex = to_latex(node)
    signed = not first and latex[0] == "-"
    return rf"\left({latex}\right)" if needs_brackets(node, place, signed=signed) else latex


# --- Print a tree as presentation MathML


_FUNCTION_NAMES: Final = {"asin": "arcsin", "acos": "arccos", "atan": "arctan"}
_MATHML_OPERATORS: Final = {"+": "<mo>+</mo>", "-": "<mo>−</mo>"}
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
            return _mathml_call(function, [row(argument) for argument in arguments])
        case Unit(operand, "deg"):
            return _mrow(f"{_mathml_at(operand, ATOM)}<mo>°</mo>")
        case Unit(operand):
            return _mrow(f"{_mathml_at(operand, ATOM)}<mspace width='0.2em'/><mi>rad</mi>")
        case Negation(operand):
            return _mrow(f"<mo>−</mo>{_mathml_at(operand, PRODUCT)}")
        case Binary():
            return _mathml_binary(node)


def _mathml_binary(node: Binary) -> str:
    operator, left, right = node.operator, node.left, node.right
    if operator == "^":
        return f"<msup>{_mathml_at(left, ATOM)}{row(right)}</msup>"
    if operator == "/":
        if isinstance(left, Negation):
            # The sign of -π/2 is drawn before the fraction, as typed.
            return _mrow(f"<mo>−</mo><mfrac>{row(left.operand)}{row(right)}</mfrac>")
        return f"<mfrac>{row(left)}{row(right)}</mfrac>"
    if operator == "*":
        is_function = type(right) is Call or (type(right) is Binary and type(right.left) is Call)
        invisible = _THIN_TIMES if is_function else _INVISIBLE_TIMES
        times = "<mo>⋅</mo>" if needs_dot(left, right) else invisible
        return _mrow(f"{_mathml_at(left, PRODUCT, first=True)}{times}{_mathml_at(right, POWER)}")
    return _mrow(f"{row(left)}{_MATHML_OPERATORS[operator]}{_mathml_at(right, PRODUCT)}")


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
    return f"<{tag}{upright}>{escape(characters.LETTERS.get(plain, plain), quote=False)}</{tag}>"


def _mathml_call(function: str, arguments: list[str]) -> str:
    if function == "sqrt":
        return f"<msqrt>{arguments[0]}</msqrt>"
    if function == "abs":
        return _mrow(f"<mo>|</mo>{arguments[0]}<mo>|</mo>")
    inside = "<mo>,</mo>".join(arguments)
    name = f"<mi>{_FUNCTION_NAMES.get(function, function)}</mi>"
    return _mrow(f"{name}{_APPLY}{_mrow(f'<mo>(</mo>{inside}<mo>)</mo>')}")


def _mathml_at(node: Node, place: int, *, first: bool = False) -> str:
    element = row(node)
    if not needs_brackets(node, place, signed=not first and _begins_with_sign(node)):
        return element
    return _mrow(f"<mo>(</mo>{element}<mo>)</mo>")


def _begins_with_sign(node: Node) -> bool:
    while type(node) is Binary and node.operator != "^":
        node = node.left
    return type(node) is Negation


# --- The rule for brackets in formulas that are printed as text, LaTeX or MathML
#
# An operand needs brackets if it binds less tightly than the operator next to it, or if its sign
# would follow that operator. In LaTeX and MathML, a fraction bar replaces brackets.
#
# A drawn formula needs more brackets than text for the base of a power, because ``90°`` and
# ``1·10⁻³`` consist of several signs.


# How tightly a node binds, and how tightly an operand must bind in a place.
SUM, PRODUCT, SIGNED, POWER, ATOM = range(5)
_PRECEDENCES: Final = {"+": SUM, "-": SUM, "*": PRODUCT, "/": PRODUCT, "^": POWER}


def needs_brackets(node: Node, place: int, *, signed: bool, drawn: bool = True) -> bool:
    """True if ``node`` needs brackets as an operand in a place of this precedence.

    ``signed`` is True if a sign of ``node`` would follow an operator. ``drawn`` is True for LaTeX
    and MathML.
    """
    precedence = ATOM
    # Comparing types takes a third of the time of ``match``.
    kind = type(node)
    if kind is Binary:
        operator = node.operator  # type: ignore[union-attr]
        precedence = POWER if drawn and operator == "/" else _PRECEDENCES[operator]
    elif kind is Negation:
        precedence = SIGNED
    elif drawn and (kind is Unit or is_power_of_ten(node)):
        precedence = POWER
    return signed or precedence < place


def is_power_of_ten(node: Node) -> bool:
    """True if ``node`` is a number such as 1e-3, which LaTeX and MathML show as 1·10⁻³."""
    return type(node) is Number and "e" in node.literal.lower()


def needs_dot(left: Node, right: Node) -> bool:
    """True if a product needs a dot in LaTeX and MathML, as 2·3 and θ1·(π + 1) do."""
    if begins_with_digit(right):
        return True
    if type(right) is Pi:
        return not _has_symbol(left) and _has_unit(left)
    is_in_brackets = type(right) is Negation or (type(right) is Binary and right.operator in "+-*")
    return is_in_brackets and not _has_symbol(right)


def _has_unit(node: Node) -> bool:
    return type(node) is Unit or any(map(_has_unit, children(node)))


def _has_symbol(node: Node) -> bool:
    return type(node) is SymbolNode or any(map(_has_symbol, children(node)))


def begins_with_digit(node: Node) -> bool:
    """True if ``node`` begins with a digit in LaTeX and MathML."""
    match node:
        case Number():
            return True
        case Unit(operand):
            return begins_with_digit(operand)
        case Binary("^" | "*", left):
            return begins_with_digit(left)
        case Binary("/", left):
            # A product needs a dot before a fraction, too: 2½ is not read as a product.
            return type(left) is not Negation
        case _:
            return False


# --- Split a symbol's name into stem and index: theta1 is θ with index 1


_INDEXED: Final = regex(r"([A-Za-z]+?)_?([0-9]+)")
_UNDERSCORED: Final = regex(r"([A-Za-z0-9]+)_([A-Za-z0-9_]+)")


def stem_and_index(name: str) -> tuple[str, str]:
    """Return the stem and the index of ``name``; the index may be empty."""
    match = _INDEXED.fullmatch(name) or _UNDERSCORED.fullmatch(name)
    return (match[1], match[2].replace("_", "")) if match else (name, "")


def symbol_latex(symbol: Symbol) -> str:
    r"""Return the symbol in LaTeX: theta1 -> \theta_{1}."""
    if symbol.latex is not None:
        return symbol.latex
    stem, index = stem_and_index(symbol.name)
    if stem in characters.LETTERS:
        stem = f"\\{stem}"
    elif len(stem) > 1:
        stem = f"\\mathrm{{{stem}}}"
    if not index:
        return stem
    upright = len(index) > 1 and not index.isdigit()
    return f"{stem}_{{\\mathrm{{{index}}}}}" if upright else f"{stem}_{{{index}}}"
