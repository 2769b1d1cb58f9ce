"""A wrong cell or entry with everything that its diagnosis may look at."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from service.catalogue import Joint
from service.expressions import Expression
from service.grading.comparison import same
from service.grading.feedback import Finding
from service.grading.samples import Samples
from service.kinematics.transforms import Numbers


@dataclass(frozen=True)
class WrongValue:
    """Something handed in whose value is not the expected one.

    ``actual`` and ``expected`` are ``(SAMPLES,)``, angles in radians. ``expected_text`` is what
    would be right, as the student would write it, or empty where it is not known as a formula.
    """

    expression: Expression
    actual: Numbers
    expected: Numbers
    expected_text: str
    samples: Samples
    scale: float
    angle: bool

    @property
    def correction(self) -> str:
        """The sentence that gives the answer away."""
        return f"It should be {self.expected_text}." if self.expected_text else ""

    def equal(self, one: Numbers, other: Numbers) -> bool:
        """Whether two values of this quantity are the same."""
        return same(one, other, self.scale, self.angle)


@dataclass(frozen=True)
class WrongCell(WrongValue):
    """A wrong table cell. ``joint`` is the row's joint, or None in a fixed row.

    The coefficients say how often each of ``joints`` is contained in what was written, None if not
    linearly, and in what was expected. ``shared`` says that the joint's axis has a parallel
    neighbour, so that offsets along it add up.
    """

    column: str
    joint: Joint | None
    joints: tuple[Joint, ...] = ()
    actual_coefficients: tuple[int, ...] | None = ()
    expected_coefficients: tuple[int, ...] = ()
    shared: bool = False

    @property
    def same_motion(self) -> bool:
        """Whether the cell moves with the joints as expected, so that only its constant is off."""
        return self.actual_coefficients == self.expected_coefficients

    @cached_property
    def constants(self) -> tuple[Numbers, Numbers]:
        """Actual and expected value without the joint variables that they share."""
        motion = sum(
            count * self.samples.values[joint.variable]
            for count, joint in zip(self.expected_coefficients, self.joints, strict=True)
            if count
        )
        return self.actual - motion, self.expected - motion


# The code of a wrong value that no known misconception explains.
UNEXPLAINED = "value"


def undefined(case: WrongValue) -> Finding | None:
    """The formula has no value where the robot can be: 1/0, √−1, or beyond all bounds."""
    bad = np.flatnonzero(~np.isfinite(case.actual))
    if not bad.size:
        return None
    at = case.samples.at(int(bad[0]), case.expression.symbols)
    where = ", ".join(f"{name} = {number:g}" for name, number in at.items())
    return Finding(
        "undefined",
        f"{case.expression.text()} has no value{' at ' if where else ''}{where}: it divides by "
        f"zero, takes the root of a negative number, or grows beyond all bounds.",
        case.correction,
        values={**at},
    )


def differs(case: WrongValue, look: str) -> Finding:
    """No misconception that is known explains the value: ``look``, and one counterexample."""
    at = case.samples.at(0, case.expression.symbols)
    return Finding(
        UNEXPLAINED, look, case.correction, values={**at, "yours": float(f"{case.actual[0]:.4g}")}
    )
