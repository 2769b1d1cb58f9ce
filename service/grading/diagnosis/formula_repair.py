"""A wrong matrix entry, and the trying out of formulas that its writer may have meant."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from service.expressions import Symbol
from service.expressions.evaluation.point import Known, known_values, value_at
from service.expressions.evaluation.samples import compile_tree
from service.expressions.printing.text import to_text
from service.expressions.tree import Call, Node
from service.grading.diagnosis.formula_rewriting import EXCHANGED, negated, nodes
from service.grading.diagnosis.wrong_value import WrongValue
from service.grading.tolerances import EXACT_VALUE, ROUNDED_VALUE
from service.kinematics.transforms import Numbers

# A formula of more nodes is compared, but not taken apart.
MAX_NODES = 100
# How much of a repaired formula is worth reading.
MAX_TEXT = 200


@dataclass(frozen=True, slots=True)
class Repair:
    """A formula that is right, or right but for its sign, and the place where it was changed."""

    tree: Node
    negated: bool
    place: Node | None

    @property
    def correction(self) -> str:
        """The sentence that gives the repaired formula, where it is short enough to be read."""
        text = to_text(negated(self.tree) if self.negated else self.tree)
        return f"It should be {text}." if len(text) <= MAX_TEXT else ""

    @property
    def sign_too(self) -> str:
        """What is to be said where only the other sign makes it right."""
        return " Its sign is wrong, too." if self.negated else ""


@dataclass(frozen=True)
class WrongEntry(WrongValue):
    """A wrong matrix entry. ``turning`` are the exercise's turning joints by their number."""

    turning: Mapping[int, Symbol]

    @cached_property
    def tree(self) -> Node:
        """What the student wrote."""
        return self.expression.tree

    @cached_property
    def size(self) -> int:
        """How many nodes the formula has."""
        return sum(1 for _ in nodes(self.tree))

    @property
    def can_be_repaired(self) -> bool:
        """Whether the formula is small enough to be taken apart, and has a value everywhere."""
        return self.size <= MAX_NODES and bool(np.isfinite(self.actual).all())

    @cached_property
    def waves(self) -> list[Call]:
        """The sines and cosines that were written."""
        calls = (node for node in nodes(self.tree) if isinstance(node, Call))
        return [call for call in calls if call.function in EXCHANGED]

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

    def repaired_by(self, trees: Iterable[Node]) -> Repair | None:
        """The first of the trees that is right, or right but for its sign.

        One that has the value of what was written explains nothing.
        """
        return self.repaired_at((tree, None) for tree in trees)

    def repaired_at(
        self, trees: Iterable[tuple[Node, Node | None]], *, negated_too: bool = True
    ) -> Repair | None:
        """The same for trees that come with the place where each was changed.

        Only what is right at one point is evaluated at all samples.
        """
        expected = float(self.expected[0])
        for tree, place in trees:
            if tree is self.tree:
                continue
            value = value_at(tree, self._point, self._known)
            if not abs(abs(value) - abs(expected)) <= self._tolerance:
                continue
            actual = self._evaluated(tree)
            if self.equal(actual, self.actual):
                continue
            for turned in (False, True) if negated_too else (False,):
                if self.equal(-actual if turned else actual, self.expected):
                    return Repair(tree, turned, place)
        return None

    def _evaluated(self, tree: Node) -> Numbers:
        program = compile_tree(tree)
        if isinstance(program, float):
            return np.full_like(self.expected, program)
        with np.errstate(all="ignore"):
            return np.asarray(program(self.samples.values, {}))
