"""Wrong values, table cells and arrays, and how misconceptions explain them."""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from service.catalogue import Joint
from service.expressions import Expression
from service.expressions.printing.spelling import PLAIN, Spelling
from service.grading.diagnosis.wording import AXES, SYMBOLS
from service.grading.feedback import EXPECTED, YOURS, Finding
from service.grading.misconception import AnyHypothesis, Hypothesis, Index, Repaired, Written, check
from service.grading.numerics.comparison import (
    difference,
    nearly_equal,
    rounding_slack,
    same,
)
from service.grading.numerics.samples import Samples
from service.grading.numerics.tolerances import PRINTED_NUMBER
from service.grading.report import Correction
from service.kinematics.transforms import Numbers
from service.translations import say

Mask = NDArray[np.bool_]
Hypotheses = Iterator[Hypothesis[Numbers]]


@dataclass(frozen=True, kw_only=True)
class WrongValue:
    """A submitted value that differs from the expected value."""

    expression: Expression
    # (SAMPLES,), like expected; angles in radians.
    actual: Numbers
    expected: Numbers
    samples: Samples
    scale: float
    angle: bool
    # The correct answer as the student would write it, or None if no formula is known.
    correction: Correction | None = None
    # If False, the report must not contain corrections.
    corrects: bool = True
    spelling: Spelling = PLAIN

    @property
    def constants(self) -> tuple[Numbers, Numbers]:
        """The actual and the expected value."""
        return self.actual, self.expected

    @cached_property
    def slack(self) -> float:
        """The largest error that rounding can cause in the value."""
        return rounding_slack(self.expression, self.samples)

    def equal(self, one: Numbers, other: Numbers) -> bool:
        """True if two values are equal within rounding."""
        return same(one, other, self.scale, self.angle, self.slack)

    def explained_by(self, hypotheses: Iterable[AnyHypothesis]) -> Iterator[AnyHypothesis]:
        """Return the misconceptions that explain the value."""
        return filter(self._is_explained_by, hypotheses)

    def _is_explained_by(self, hypothesis: Hypothesis[Any]) -> bool:
        actual, expected = self.constants
        answer = hypothesis.answer
        if isinstance(hypothesis, Repaired):
            return self.equal(answer, expected) and not self.equal(answer, actual)
        if isinstance(hypothesis, Written) and hypothesis.tolerance is not None:
            error = difference(actual, answer, self.angle)
            return bool(np.abs(error).max() <= hypothesis.tolerance)
        # Compare as plain numbers, so that −180° for 180° has the wrong sign.
        return self.equal(actual, answer) and not same(
            expected, answer, self.scale, slack=self.slack
        )


def finding_on(
    case: WrongValue,
    hint: str,
    values: dict[str, float | str] | None = None,
    *,
    otherwise: str = "",
) -> Finding:
    """Return a finding with a hint and the correction of the value."""
    # Without a correction, otherwise takes its place.
    return Finding("", hint, case.correction or otherwise, values=values)


@dataclass(frozen=True, kw_only=True)
class WrongCell(WrongValue):
    """A wrong cell of a DH table."""

    column: int
    # The joint of the row, or None in a fixed row.
    joint: Joint | None
    # The factor of each joint's variable in the student's cell, or None if the cell is not linear
    # in the variables.
    contained: Mapping[Joint, int] | None
    # The factor of each joint's variable in the expected cell.
    required: Mapping[Joint, int]
    # True if the joint's axis is parallel to a neighbouring axis, so that offsets along both axes
    # add up.
    shared: bool = False
    # All joints of the robot.
    joints: tuple[Joint, ...] = ()
    # "" if there is only one row.
    label: str = ""

    @property
    def symbol(self) -> str:
        """The parameter in the cell: a, α, d or θ."""
        return SYMBOLS[self.column]

    @property
    def axis(self) -> str:
        """The axis along or about which the cell is measured: x or z."""
        return AXES[self.column]

    def name(self, joint: Joint) -> str:
        """Return the joint's variable as the student writes it."""
        return self.spelling.names.get(joint.variable, joint.variable)

    @property
    def same_motion(self) -> bool:
        """True if only the constant of the cell is wrong, not its joint variables."""
        return self.contained == self.required

    @property
    def contained_alone(self) -> tuple[Joint, int] | tuple[None, int]:
        """The only joint variable in the cell and its factor, or ``(None, 0)``."""
        contained = self.contained or {}
        return next(iter(contained.items())) if len(contained) == 1 else (None, 0)

    @cached_property
    def constants(self) -> tuple[Numbers, Numbers]:
        """The actual and the expected value without the joint variables that the cell needs."""
        values = self.samples.values
        motion = sum(count * values[joint.variable] for joint, count in self.required.items())
        return self.actual - motion, self.expected - motion

    def explained_by(self, hypotheses: Iterable[AnyHypothesis]) -> Iterator[AnyHypothesis]:
        """Return the misconceptions that explain the constant of the cell."""
        # None of them does if the joint variables differ.
        return super().explained_by(hypotheses if self.same_motion else ())


@dataclass(frozen=True)
class WrongNumbers:
    """Submitted numbers that differ from the expected numbers, ``(..., SAMPLES)`` each."""

    actual: Numbers
    expected: Numbers
    # The size (...) that the error of each number is compared with.
    scale: ArrayLike
    angle: ClassVar[ArrayLike] = False

    def agree(self, one: Numbers, other: Numbers, entries: Index = ...) -> Mask:
        """Return a mask ``(...)`` of the numbers that are equal within rounding."""
        scale = np.asarray(self.scale)[entries]
        return nearly_equal(one, other, scale, self.angle)

    def explained_by(self, hypotheses: Iterable[AnyHypothesis]) -> list[AnyHypothesis]:
        """Return the misconceptions that explain the numbers."""
        # All hypotheses must be about the same entries, because they are compared at once.
        tried = list(hypotheses)
        if not tried:
            return []
        entries = tried[0].entries
        answers = np.array([hypothesis.answer for hypothesis in tried])
        inner = tuple(range(1, answers.ndim - 1))
        explains = self.agree(self.actual[entries], answers, entries).all(axis=inner)
        if not explains.any():
            return []
        explains &= ~self.agree(self.expected[entries], answers, entries).all(axis=inner)
        return [tried[i] for i in np.flatnonzero(explains)]


# The code of a wrong value that no known misconception explains.
UNEXPLAINED = "value"


@check(
    of=WrongValue,
    rank=10,
    code="undefined",
    rule="dependence",
    means="the formula has no value: it divides by zero, takes the root of a negative number, "
    "or is too large",
    example=("stanford-arm", "table", {"2/d": "d2/0"}),
    unlike={"6/d": "0"},
)
def undefined(case: WrongValue) -> Finding | None:
    """The formula has no value at some pose, for example 1/0 or √−1."""
    bad = np.flatnonzero(~np.isfinite(case.actual))
    if not bad.size:
        return None
    at = case.samples.at(int(bad[0]), case.expression.symbols)
    formula = case.expression.text()
    values = ", ".join(f"{name} = {number:g}" for name, number in at.items())
    hint = say(
        "{formula} has no value: check for a division by zero, a root of a negative number, or a "
        "number that is too large.",
        formula=formula,
    )
    if values:
        hint = say(
            "{formula} has no value at {values}: check for a division by zero, a root of a "
            "negative number, or a number that is too large.",
            formula=formula,
            values=values,
        )
    return finding_on(case, hint, {**at})


def differs(case: WrongValue, hint: str) -> Finding:
    """Return a finding with a hint and a counterexample."""
    return finding_on(case, hint, _counterexample(case))


def _counterexample(case: WrongValue) -> dict[str, float | str] | None:
    # The counterexample is computed from the printed numbers, so that a pocket calculator agrees.
    # A right number without its formula can be checked only with the values of all symbols.
    alone = case.corrects and case.correction is None
    symbols = case.samples.values.keys() if alone else case.expression.symbols
    for i, expected in enumerate(case.expected):
        values: dict[str, float | str] = {**case.samples.at(i, symbols)}
        if not values:
            return None
        values[YOURS] = _printed(case, _at_printed(case, i))
        if not case.corrects:
            return values
        values[EXPECTED] = _printed(case, float(expected))
        # Two numbers that look the same show no mistake.
        if values[YOURS] != values[EXPECTED]:
            return values
    return None


def _at_printed(case: WrongValue, sample: int) -> float:
    samples, names = case.samples, case.expression.symbols
    printed = {
        name: np.array([math.radians(number) if name in samples.in_degrees else number])
        for name, number in samples.at(sample, names).items()
    }
    return float(np.ravel(case.expression.evaluate(printed))[0])


def _printed(case: WrongValue, value: float) -> float:
    number = math.degrees(value) if case.angle and case.samples.in_degrees else value
    return 0.0 if abs(number) < PRINTED_NUMBER else float(f"{number:.4g}")
