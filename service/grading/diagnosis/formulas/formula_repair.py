"""A wrong entry, and the formulas that its writer may have intended."""

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

# A formula of more nodes is compared, but not taken apart.
MAX_NODES = 100
# A longer formula is not worth reading.
MAX_TEXT = 200


@dataclass(slots=True)
class Rewritten(Repaired[Node]):
    """The student's formula without the misconception.

    It explains the entry if it is right, or right but for its sign unless ``signed``. The sign and
    the correction are added to the finding.
    """

    signed: bool = False


@dataclass(frozen=True, kw_only=True)
class WrongEntry(WrongValue):
    """A wrong entry of a matrix or a list. ``turning`` are the turning joints by their number.

    The formula of an entry that ``stays_whole`` is not taken apart.
    """

    turning: Mapping[int, Symbol]
    stays_whole: bool = False

    @cached_property
    def tree(self) -> Node:
        """The student's formula."""
        return self.expression.tree

    @cached_property
    def size(self) -> int:
        """How many nodes the formula has."""
        return sum(1 for _ in nodes(self.tree))

    @cached_property
    def can_be_repaired(self) -> bool:
        """Whether the formula is small enough to be taken apart, and has a value everywhere."""
        is_small = not self.stays_whole and self.size <= MAX_NODES
        return is_small and bool(np.isfinite(self.actual).all())

    @cached_property
    def sines_and_cosines(self) -> list[Call]:
        """The sines and cosines in the formula."""
        return list(filter(is_sine_or_cosine, nodes(self.tree)))

    def explained_by(self, hypotheses: Iterable[AnyHypothesis]) -> Iterator[AnyHypothesis]:
        """Those hypotheses that explain the entry, each tried when it is asked for."""
        for hypothesis in hypotheses:
            if not isinstance(hypothesis, Rewritten):
                yield from super().explained_by((hypothesis,))
            elif (sign := self._sign(hypothesis)) is not None:
                yield self._completed(hypothesis, sign)

    def _sign(self, rewritten: Rewritten) -> int | None:
        """The sign with which the formula is right; None where it is right with neither.

        A formula that is right at one point is evaluated at all samples. One that has the value of
        the student's formula explains nothing.
        """
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
        hint = finding.hint if sign > 0 else f"{finding.hint} The sign is wrong, too."
        tree = rewritten.answer if sign > 0 else negated(rewritten.answer)
        correction = spelled(tree, self.spelling) if self.corrects else None
        if correction is None or len(correction.text) > MAX_TEXT:
            return replace(rewritten, finding=replace(finding, hint=hint))
        return replace(rewritten, finding=replace(finding, hint=hint, correction=correction))
