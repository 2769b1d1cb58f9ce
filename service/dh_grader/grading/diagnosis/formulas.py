"""Find a wrong formula's quantity, and a small change that makes it right.

This file rewrites the trees of formulas. Which rewriting stands for which mistake of a student is
in ``matrices.py``.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, reduce
from itertools import combinations
from operator import is_
from typing import Any, Final, NamedTuple, TypeAlias, TypeGuard

import numpy as np

from dh_grader.expressions import Kind, Symbol
from dh_grader.expressions.evaluate import Known, compile_tree, known_values, value_at
from dh_grader.expressions.printing import to_text
from dh_grader.expressions.vocabulary import (
    Binary,
    Call,
    Negation,
    Node,
    Number,
    Pi,
    SymbolNode,
    Unit,
    children,
)
from dh_grader.grading.misconception import AnyHypothesis, Repaired, WrongValue, spelled
from dh_grader.grading.numbers import EXACT_VALUE, ROUNDED_VALUE
from dh_grader.kinematics import Numbers
from dh_grader.translations import say

# --- Find out if a formula is a length, an angle or a plain number


# None if a formula has no single quantity, or an unknown one: l1 + theta1, l1*l2.
Quantity: TypeAlias = Kind | None

_ANGLE_OF: Final = frozenset({"asin", "acos", "atan", "atan2"})
_NUMBER_OF: Final = frozenset({"sin", "cos", "tan"})
# Deeper than any formula of a student; a longer sum has no quantity.
_DEEPEST: Final = 60


def quantity_of(tree: Node, depth: int = 0) -> Quantity:
    """Return the quantity of a formula: length, angle or plain number; None if it is unknown.

    For example, ``90deg`` is an angle, and ``l1 cos(theta1)`` is a length.
    """
    # The sum of a number and an angle is an angle; the sum of a number and a length is a length.
    if depth > _DEEPEST:
        return None
    match tree:
        case Number():
            return "number"
        case Pi() | Unit():
            return "angle"
        case SymbolNode(symbol):
            return symbol.kind
        case Negation(operand):
            return quantity_of(operand, depth + 1)
        case Binary(operator, left, right):
            return _combined(operator, quantity_of(left, depth + 1), quantity_of(right, depth + 1))
        case Call(function, _):
            if function in _ANGLE_OF:
                return "angle"
            return "number" if function in _NUMBER_OF else None


def _combined(operator: str, left: Quantity, right: Quantity) -> Quantity:
    if left is None or right is None:
        return None
    if right == "number":
        return left if operator != "^" or left == "number" else None
    if operator in "+-":
        return right if left in (right, "number") else None
    if operator == "*":
        return right if left == "number" else None
    return "number" if operator == "/" and left == right else None


# --- Search for the formula that the student intended with a wrong entry


# A formula with more nodes is compared, but not rewritten.
MAX_NODES = 100
# A longer formula is too long for a correction.
MAX_TEXT = 200


@dataclass(slots=True)
class Rewritten(Repaired[Node]):
    """The student's formula with one possible mistake corrected.

    The mistake explains the wrong entry if the corrected formula is right.
    """

    # If False, the corrected formula may also have the opposite sign.
    signed: bool = False


@dataclass(frozen=True, kw_only=True)
class WrongEntry(WrongValue):
    """A wrong entry of a matrix or a list."""

    # The symbol of the angle of each turning joint, by the number of the joint.
    turning: Mapping[int, Symbol]
    # If True, the formula of the entry is not rewritten.
    only_compared: bool = False

    @cached_property
    def tree(self) -> Node:
        """The student's formula."""
        return self.expression.tree

    @cached_property
    def size(self) -> int:
        """The number of nodes of the formula."""
        return sum(1 for _ in nodes(self.tree))

    @cached_property
    def can_be_repaired(self) -> bool:
        """True if the formula is short enough to be rewritten and always has a value."""
        is_small = not self.only_compared and self.size <= MAX_NODES
        return is_small and bool(np.isfinite(self.actual).all())

    @cached_property
    def sines_and_cosines(self) -> list[Call]:
        """The sines and cosines in the formula."""
        return list(filter(is_sine_or_cosine, nodes(self.tree)))

    def explained_by(self, hypotheses: Iterable[AnyHypothesis]) -> Iterator[AnyHypothesis]:
        """Yield the misconceptions that explain the entry."""
        for hypothesis in hypotheses:
            if not isinstance(hypothesis, Rewritten):
                yield from super().explained_by((hypothesis,))
            elif (sign := self._sign(hypothesis)) is not None:
                yield self._completed(hypothesis, sign)

    def _sign(self, rewritten: Rewritten) -> int | None:
        # 1 if the rewritten formula is correct, -1 if its negative is. None also if the formula has
        # the same value as the student's.
        tree = rewritten.answer
        if tree is self.tree:
            return None
        value = value_at(tree, self._point, self._known)
        if not abs(abs(value) - abs(float(self.expected[0]))) <= self._tolerance:
            return None
        values = self._evaluated(tree)
        if self.equal(values, self.actual):
            return None
        if self.equal(values, self.expected):
            return 1
        return None if rewritten.signed or not self.equal(-values, self.expected) else -1

    @cached_property
    def _point(self) -> Mapping[str, float]:
        return {name: float(self.samples.values[name][0]) for name in self.samples.values}

    @cached_property
    def _known(self) -> Known:
        return known_values(self.tree, self._point)

    @cached_property
    def _tolerance(self) -> float:
        size = float(np.sqrt(np.mean(self.expected * self.expected)))
        return ROUNDED_VALUE * size + EXACT_VALUE * self.scale

    def _evaluated(self, tree: Node) -> Numbers:
        program = compile_tree(tree)
        if isinstance(program, float):
            return np.full_like(self.expected, program)
        with np.errstate(all="ignore"):
            return np.asarray(program(self.samples.values, {}))

    def _completed(self, rewritten: Any, sign: int) -> Any:
        [finding] = rewritten.findings
        hint = finding.hint
        if sign < 0:
            hint = say("{sentence} The sign is wrong, too.", sentence=hint)
        tree = rewritten.answer if sign > 0 else negated(rewritten.answer)
        correction = spelled(tree, self.spelling) if self.corrects else None
        if correction is None or len(correction.text) > MAX_TEXT:
            return replace(rewritten, finding=replace(finding, hint=hint))
        return replace(rewritten, finding=replace(finding, hint=hint, correction=correction))


# --- Functions that correct one possible mistake in a student's formula
#
# The functions return a new tree, which shares all unchanged parts with the old one, and never
# change the old one. If there is nothing to rewrite, the old tree itself is returned.


Rewriting = Callable[[Node], Node]
# A factor or term with its sign.
Signed = tuple[int, Node]

EXCHANGED = {"sin": "cos", "cos": "sin"}


def nodes(tree: Node) -> Iterator[Node]:
    """Yield all nodes of the tree, each before its children."""
    pending = [tree]
    while pending:
        node = pending.pop()
        yield node
        pending.extend(reversed(children(node)))


def is_sine_or_cosine(node: Node) -> TypeGuard[Call]:
    """True if the node is a sine or cosine."""
    return isinstance(node, Call) and node.function in EXCHANGED


def mapped(node: Node, rewrite: Rewriting) -> Node:
    """Return the node with ``rewrite`` applied to each operand or argument."""
    if isinstance(node, Binary):
        left, right = rewrite(node.left), rewrite(node.right)
        unchanged = left is node.left and right is node.right
        return node if unchanged else Binary(node.operator, left, right)
    if isinstance(node, Call):
        arguments = tuple(map(rewrite, node.arguments))
        unchanged = all(map(is_, arguments, node.arguments))
        return node if unchanged else Call(node.function, arguments)
    if isinstance(node, Negation | Unit):
        operand = rewrite(node.operand)
        if operand is node.operand:
            return node
        return Unit(operand, node.unit) if isinstance(node, Unit) else Negation(operand)
    return node


def everywhere(tree: Node, rewrite: Rewriting) -> Node:
    """Return the tree with ``rewrite`` applied to every node, the innermost first."""

    def visit(node: Node) -> Node:
        return rewrite(mapped(node, visit))

    return visit(tree)


def at_sines_and_cosines(tree: Node, rewrite: Rewriting) -> Node:
    """Return the tree with ``rewrite`` applied to each sine and cosine."""

    def visit(node: Node) -> Node:
        return rewrite(node) if is_sine_or_cosine(node) else mapped(node, visit)

    return visit(tree)


def one_place(node: Node, rewrite: Rewriting) -> Iterator[tuple[Node, Node]]:
    """Yield each tree with one node rewritten, and the node that was replaced."""
    changed = rewrite(node)
    if changed is not node:
        yield changed, node
    for child in children(node):
        for repaired, place in one_place(child, rewrite):
            yield _with_child(node, child, repaired), place


def _with_child(node: Node, child: Node, replacement: Node) -> Node:
    return mapped(node, lambda other: replacement if other is child else other)


def exchanged(node: Node) -> Node:
    """Return a cosine for a sine and a sine for a cosine; return other nodes unchanged."""
    return Call(EXCHANGED[node.function], node.arguments) if is_sine_or_cosine(node) else node


def other_operator(node: Node) -> Node:
    """Return a difference for a sum and a sum for a difference; return other nodes unchanged."""
    if not _is_sum(node):
        return node
    return Binary("-" if node.operator == "+" else "+", node.left, node.right)


def first_term_negated(node: Node) -> Node:
    """Return the sum with the sign of its first term changed."""
    if not _is_sum(node) or _is_sum(node.left):
        return node
    return Binary(node.operator, negated(node.left), node.right)


def without_degrees(node: Node) -> Node:
    """Return the number without its unit degrees. The number itself does not change."""
    return node.operand if isinstance(node, Unit) and node.unit == "deg" else node


def summed_from(first: int, turning: Mapping[int, Symbol]) -> Rewriting:
    """Return a function that replaces joint angles by sums of angles: c2 becomes c12.

    The angle of joint ``k`` becomes the sum of the angles from joint ``first`` to joint ``k``.
    """

    def rewrite(node: Node) -> Node:
        last = _joint_of(node.arguments[0]) if is_sine_or_cosine(node) else None
        if not isinstance(node, Call) or last is None or last <= first:
            return node
        angles = [SymbolNode(turning[k]) for k in sorted(turning) if first <= k <= last]
        total = joined([(1, angle) for angle in angles])
        return Call(node.function, (total,))

    return rewrite


def with_angle(symbol: Symbol) -> Rewriting:
    """Return a function that adds ``symbol`` to the angle of a sine or cosine."""

    def rewrite(node: Node) -> Node:
        if not (isinstance(node, Call) and is_sine_or_cosine(node)):
            return node
        joints = _joints_in(node)
        if not joints or symbol.joint in joints:
            return node
        return Call(node.function, (Binary("+", node.arguments[0], SymbolNode(symbol)),))

    return rewrite


def without_angle(symbol: Symbol) -> Rewriting:
    """Return a function that removes ``symbol`` from the angle of a sine or cosine."""

    def rewrite(node: Node) -> Node:
        if not (isinstance(node, Call) and is_sine_or_cosine(node)):
            return node
        joints = _joints_in(node)
        if symbol.joint not in joints or len(joints) < 2:
            return node
        terms = terms_of(node.arguments[0])
        rest = [(sign, term) for sign, term in terms if _joint_of(term) != symbol.joint]
        return Call(node.function, (joined(rest),)) if rest else node

    return rewrite


def _joints_in(call: Call) -> set[int]:
    joints = map(_joint_of, nodes(call.arguments[0]))
    return {joint for joint in joints if joint is not None}


def _joint_of(node: Node) -> int | None:
    if isinstance(node, SymbolNode) and node.symbol.kind == "angle":
        return node.symbol.joint
    return None


class _Term(NamedTuple):
    # The last sine or cosine of a term is apart from its other factors.
    sign: int
    factors: list[Node]
    call: Call | None


def sums_merged(node: Node) -> Node:
    """Return the node with cos a + cos b replaced by cos(a + b), and likewise for sines.

    Only terms with equal other factors are merged.
    """
    if not _is_sum(node):
        return mapped(node, sums_merged)
    terms = [_split(sign, sums_merged(term)) for sign, term in terms_of(node)]
    groups: dict[tuple[object, ...], list[_Term]] = {}
    for i, term in enumerate(terms):
        like = term.call.function if term.call else i
        groups.setdefault((like, *sorted(map(to_text, term.factors))), []).append(term)
    if len(groups) == len(terms):
        return mapped(node, sums_merged)
    return joined([_merged_term(group) for group in groups.values()])


def _split(sign: int, term: Node) -> _Term:
    inner, factors = factors_of(term)
    last = next(filter(is_sine_or_cosine, reversed(factors)), None)
    return _Term(sign * inner, [factor for factor in factors if factor is not last], last)


def _merged_term(group: list[_Term]) -> Signed:
    sign, factors, call = group[0]
    if call is None:
        return sign, _product(factors)
    angles = [(sign * term.sign, term.call.arguments[0]) for term in group if term.call]
    return sign, _product([*factors, Call(call.function, (joined(angles),))])


def products_merged(tree: Node, joints: frozenset[int] | None = None) -> Node:
    """Return the tree with cos a cos b replaced by cos(a + b), and likewise for sines."""

    # With joints, only the angles of these joints are merged, and only in products that contain all
    # these angles.
    def visit(node: Node) -> Node:
        if is_sine_or_cosine(node):
            return node
        if not (isinstance(node, Binary) and node.operator == "*"):
            return mapped(node, visit)
        sign, factors = factors_of(node)
        factors = [visit(factor) for factor in factors]
        merged = factors
        for function in EXCHANGED:
            merged = _merged_factors(merged, function, joints)
        if len(merged) == len(factors):
            return mapped(node, visit)
        return _with_sign(sign, _product(merged))

    return visit(tree)


def _merged_factors(
    factors: list[Node], function: str, joints: frozenset[int] | None
) -> list[Node]:
    chosen = [
        factor
        for factor in factors
        if isinstance(factor, Call)
        and factor.function == function
        and (joints is None or _joint_of(factor.arguments[0]) in joints)
    ]
    if len(chosen) < (2 if joints is None else len(joints)):
        return factors
    merged = Call(function, (joined([(1, call.arguments[0]) for call in chosen]),))
    rest = [factor for factor in factors if not any(factor is call for call in chosen[1:])]
    return [merged if factor is chosen[0] else factor for factor in rest]


def joints_multiplied(tree: Node, turning: Sequence[int]) -> list[frozenset[int]]:
    """Return sets of joints whose sines (or cosines) are multiplied: {1, 2} for c1 c2.

    Each set has two or more consecutive joints of ``turning``.
    """
    found: dict[frozenset[int], None] = {}
    for factors in _products(tree):
        for function in EXCHANGED:
            joints = {
                _joint_of(factor.arguments[0])
                for factor in factors
                if isinstance(factor, Call) and factor.function == function
            }
            present = [joint in joints for joint in turning]
            for i, j in combinations(range(len(turning) + 1), 2):
                if j - i > 1 and all(present[i:j]):
                    found[frozenset(turning[i:j])] = None
    return list(found)


def _products(tree: Node) -> Iterator[list[Node]]:
    pending = [tree]
    while pending:
        node = pending.pop()
        if isinstance(node, Binary) and node.operator == "*":
            _, factors = factors_of(node)
            yield factors
            pending.extend(factors)
        elif not is_sine_or_cosine(node):
            pending.extend(children(node))


def _is_sum(node: Node) -> TypeGuard[Binary]:
    return isinstance(node, Binary) and node.operator in ("+", "-")


def terms_of(node: Node) -> list[Signed]:
    """Return the terms of a sum with their signs."""
    if _is_sum(node):
        sign = 1 if node.operator == "+" else -1
        right = [(sign * inner, term) for inner, term in terms_of(node.right)]
        return [*terms_of(node.left), *right]
    if isinstance(node, Negation):
        return [(-sign, term) for sign, term in terms_of(node.operand)]
    return [(1, node)]


def factors_of(node: Node) -> tuple[int, list[Node]]:
    """Return the sign of a product, and its factors without minus signs."""
    if isinstance(node, Binary) and node.operator == "*":
        first, left = factors_of(node.left)
        second, right = factors_of(node.right)
        return first * second, [*left, *right]
    if isinstance(node, Negation):
        sign, factors = factors_of(node.operand)
        return -sign, factors
    return 1, [node]


def joined(terms: list[Signed]) -> Node:
    """Return the sum of one or more terms."""
    (sign, first), *others = terms
    total = _with_sign(sign, first)
    for sign, term in others:
        total = Binary("+" if sign > 0 else "-", total, term)
    return total


def _product(factors: list[Node]) -> Node:
    return reduce(lambda first, factor: Binary("*", first, factor), factors)


def _with_sign(sign: int, node: Node) -> Node:
    return node if sign > 0 else negated(node)


def negated(node: Node) -> Node:
    """Return the node with the opposite sign.

    In a product the first factor gets the minus.
    """
    if isinstance(node, Negation):
        return node.operand
    if isinstance(node, Binary) and node.operator in ("*", "/"):
        return Binary(node.operator, negated(node.left), node.right)
    return Negation(node)
