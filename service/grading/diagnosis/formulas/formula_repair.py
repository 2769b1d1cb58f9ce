"""Search for the formula that the student intended with a wrong entry."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from service.expressions import Symbol
from service.expressions.evaluation.point import Known, known_values, value_at
from service.expressions.evaluation.samples import compile_tree
from service.expressions.tree import Call, Node
from service.grading.diagnosis.formulas.formula_rewriting import is_sine_or_cosine, negated, nodes
from service.grading.diagnosis.wrong_value import WrongValue
from service.grading.formula_text import spelled
from service.grading.misconception import AnyHypothesis, Repaired
from service.grading.numerics.tolerances import EXACT_VALUE, ROUNDED_VALUE
from service.kinematics.transforms import Numbers
from service.translations import say

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
