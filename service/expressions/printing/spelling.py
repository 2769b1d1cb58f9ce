"""A student's spelling: the names of symbols, the unit of angles and the shorthand in formulas.

Reports print formulas in the student's spelling: a student who writes ``q1 - 90°`` does not read
``theta1 - pi/2``.
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Final, NamedTuple

from service.expressions.characters import greek
from service.expressions.tree import (
    Binary,
    Call,
    Negation,
    Node,
    Number,
    SymbolNode,
    Unit,
    children,
)
from service.expressions.vocabulary.symbols import Symbol, Vocabulary, normal_form
from service.regex import regex

_LOWERED: Final = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
# A word followed by an index: θ_1, th1, q₁; not LaTeX and not q[0].
_INDEXED: Final = regex(rf"([A-Za-z{greek.CLASS}]+_?)([0-9]+|[₀-₉]+)")
_NAME: Final = regex(rf"[A-Za-z{greek.CLASS}][A-Za-z0-9_₀-₉{greek.CLASS}]*")
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
    return "".join(greek.NAMES.get(letter, letter) for letter in normal_form(name))


def _added_joints(node: Node) -> list[int]:
    match node:
        case SymbolNode(Symbol(kind="angle", joint=int(joint))):
            return [joint]
        case Binary("+", left, right):
            first, second = _added_joints(left), _added_joints(right)
            return [*first, *second] if first and second else []
        case _:
            return []


# --- the spelling that formulas have in common


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
    return Habits(_unit(formula), _names(formula, vocabulary), has_shorthand)


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
    unit = _unit(formula)
    common = replace(common, names={**common.names, **_names(formula, vocabulary)})
    if unit is None:
        return common if common.degree or formula.degrees else replace(common, degree="deg")
    return _with_unit(common, unit, degrees=formula.degrees)


def _with_unit(spelling: Spelling, unit: str, *, degrees: bool) -> Spelling:
    if unit in ("pi", "π"):
        return replace(spelling, pi=unit, in_degrees=False, degree=_BARE if degrees else "deg")
    return replace(spelling, degree=unit, in_degrees=True)


def _unit(formula: TypedFormula) -> str | None:
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
        for match in filter(None, map(_INDEXED.fullmatch, models)):
            index = str(symbol.joint)
            typed = match[1] + (index.translate(_LOWERED) if match[2][0] >= "₀" else index)
            if symbol.name not in found and _is_name(typed, symbol, vocabulary):
                found[symbol.name] = typed
    return found
