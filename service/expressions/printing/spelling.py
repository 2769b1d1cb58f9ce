"""The spelling of a student: the names, the unit of angles and the shorthand of the formulas.

A formula that answers a student is printed in it: ``q1 - 90°`` is not answered by
``theta1 - pi/2``.
"""

import re
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

_LOWERED: Final = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
# A word and an index behind it: θ_1, th1, q₁. LaTeX and q[0] are left aside.
_INDEXED: Final = re.compile(rf"([A-Za-z{greek.CLASS}]+_?)([0-9]+|[₀-₉]+)")
_NAME: Final = re.compile(rf"[A-Za-z{greek.CLASS}][A-Za-z0-9_₀-₉{greek.CLASS}]*")
_SHORT: Final = re.compile(r"[cs](?:_?[0-9]+|_\{[0-9]+\}|[₀-₉]+)")
_SHORT_NAME: Final = re.compile(r"[cs][0-9]+")
_DEGREE_SIGN: Final = re.compile(r"[°º˚∘]|\\circ|\\degree")
_DEGREE_WORD: Final = re.compile(r"(?<![A-Za-z])deg")
_PI: Final = re.compile(r"π|(?<![A-Za-z])[Pp]i(?![A-Za-z])")
# Nobody writes a constant angle of more than a whole turn in radians.
_WHOLE_TURN: Final = 6.2832
_BARE: Final = ""


@dataclass(frozen=True, slots=True)
class Spelling:
    """How formulas are printed.

    ``names`` are the symbols' names as typed, by their canonical names; a symbol that is not in it
    keeps its own. ``degree`` stands behind a number of degrees: "deg", "°", or nothing where bare
    numbers are degrees. ``in_degrees`` says that a constant angle is such a number, and no fraction
    of π. With ``shorthand`` cos(q1 + q2) is c12.
    """

    names: Mapping[str, str] = field(default_factory=dict)
    pi: str = "pi"
    degree: str = "deg"
    in_degrees: bool = False
    shorthand: bool = False

    def name(self, symbol: Symbol) -> str:
        """The symbol's name."""
        return self.names.get(symbol.name, symbol.name)

    def in_shorthand(self, call: Call) -> str | None:
        """The sine or cosine of a sum of joint angles in shorthand; None where it has none."""
        if not self.shorthand or call.function not in ("sin", "cos"):
            return None
        joints = _added_joints(call.arguments[0])
        if not joints or len(set(joints)) < len(joints) or (joints[1:] and max(joints) > 9):
            return None
        return f"{call.function[0]}{''.join(map(str, joints))}"

    def renamed(self, node: Node) -> Node:
        """The tree with symbols of the student's names, for LaTeX."""
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
    """A formula as typed and as a tree; ``degrees`` says that bare angles in it are degrees."""

    source: str
    tree: Node
    degrees: bool


def _spelled_out(name: str) -> str:
    """The name with its Greek letters as words and a plain index: θ_1 is theta1."""
    return "".join(greek.NAMES.get(letter, letter) for letter in normal_form(name))


def _added_joints(node: Node) -> list[int]:
    """The joints whose angles are added up, from left to right; none for anything else."""
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
    """What one formula shows of its writer's spelling.

    ``unit`` is what constant angles are written with, None where it shows none, ``names`` those of
    its symbols as typed, by their canonical names.
    """

    unit: str | None
    names: Mapping[str, str]
    has_shorthand: bool


def habits_of(formula: TypedFormula, vocabulary: Vocabulary) -> Habits:
    """Return what one formula shows of its writer's spelling."""
    has_shorthand = any(_is_short(node, formula) for node in _nodes(formula.tree))
    return Habits(_unit(formula), _names(formula, vocabulary), has_shorthand)


def spelling_of(formulas: Iterable[Habits], vocabulary: Vocabulary, *, degrees: bool) -> Spelling:
    """The spelling of formulas: what most of them do, of equals the first.

    ``degrees`` says that bare angles are degrees where no formula shows a unit.
    """
    names: dict[str, str] = {}
    angles: Counter[str] = Counter()
    shorthand = False
    for formula in formulas:
        if formula.unit is not None:
            angles[formula.unit] += 1
        names = {**formula.names, **names}
        shorthand = shorthand or formula.has_shorthand
    shorthand = shorthand and not any(map(_SHORT_NAME.fullmatch, vocabulary.by_name))
    names |= _likewise(names, vocabulary)
    most = angles.most_common(1)
    unit = most[0][0] if most else _BARE if degrees else "pi"
    found = Spelling({name: typed for name, typed in names.items() if typed != name}, "pi", "deg")
    return _with_unit(replace(found, shorthand=shorthand), unit, degrees=degrees)


def spelling_for(formula: TypedFormula, common: Spelling, vocabulary: Vocabulary) -> Spelling:
    """The spelling to answer one formula in: with its own names, and its own unit of angles."""
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
    """What the constant angles in a formula are written with; None where it shows none.

    That is "pi" or "π", or what stands behind a number of degrees.
    """
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
    """The names of the symbols in a formula as they were typed."""
    names: dict[str, str] = {}
    # In c12 stands a sum of angles without their names, and in a long formula many times.
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
    """Whether what was typed is one of the symbol's names, and can be typed again."""
    if typed == symbol.name:
        return True
    known = _NAME.fullmatch(typed) and vocabulary.by_name.get(normal_form(typed))
    return known == symbol


def _likewise(names: Mapping[str, str], vocabulary: Vocabulary) -> dict[str, str]:
    """The names of the other joint variables in the way of those that were typed.

    A student who writes q1 writes q2, and one who writes θ_1 writes θ_2.
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
