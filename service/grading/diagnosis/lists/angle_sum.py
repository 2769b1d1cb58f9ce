"""Slips in an angle that is a sum of joint angles."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain, combinations, product

import numpy as np

from service.grading.diagnosis.wrong_value import Hypotheses, WrongValue, finding_on
from service.grading.misconception import Written, misconception
from service.grading.numerics.comparison import difference
from service.grading.numerics.tolerances import CONSTANT, WHOLE_MULTIPLE
from service.kinematics.transforms import Numbers
from service.translations import listed, say, say_count

# An angle of more addends is not taken apart: ten addends have a thousand subsets.
MAX_ADDENDS = 6


def addends(case: WrongValue) -> dict[str, int]:
    """Return the factor of each symbol in the correct angle: {"theta1": 1, "theta2": -1}.

    The result is empty if the correct angle is not a sum of angles.
    """
    names = list(case.samples.values)
    columns = [case.samples.values[name] for name in names]
    system = np.stack([*columns, np.ones_like(case.expected)], axis=1)
    found = np.linalg.lstsq(system, case.expected, rcond=None)[0]
    counts = np.round(found[:-1])
    is_sum = np.abs(found[:-1] - counts).max(initial=0.0) < WHOLE_MULTIPLE
    if is_sum and np.abs(system @ found - case.expected).max() < WHOLE_MULTIPLE:
        return {name: int(count) for name, count in zip(names, counts, strict=True) if count}
    return _computed(case, names)


def _computed(case: WrongValue, names: Sequence[str]) -> dict[str, int]:
    # A computed angle may differ from the sum of its symbols by whole turns.
    sums = [
        dict(zip(some, signs, strict=True))
        for count in (1, 2)
        for some in combinations(names, count)
        for signs in product((1, -1), repeat=count)
    ]
    rest = case.expected - np.array([_sum_of(case, counts) for counts in sums])
    off = np.abs(difference(rest, rest[:, :1], angle=True)).max(axis=1)
    return sums[int(off.argmin())] if off.min() < WHOLE_MULTIPLE else {}


def _sum_of(case: WrongValue, counts: Mapping[str, int]) -> Numbers:
    return np.asarray(sum(count * case.samples.values[name] for name, count in counts.items()))


@dataclass(frozen=True, slots=True)
class WrongSum:
    """A wrong angle whose correct value is a sum of angles."""

    case: WrongValue
    # The factor of each symbol in the correct angle.
    counts: Mapping[str, int]

    @classmethod
    def of(cls, case: WrongValue) -> "WrongSum":
        """Make a ``WrongSum`` from a wrong value."""
        return cls(case, addends(case))

    def named(self, names: Iterable[str]) -> str:
        """Return a phrase with the names of the symbols, as the student spells them."""
        return listed([self.case.spelling.names.get(name, name) for name in names])

    def subsets(self) -> Iterator[tuple[tuple[str, ...], Numbers]]:
        """Yield the names and the sum of each smaller set of the angles."""
        names = list(self.counts) if len(self.counts) <= MAX_ADDENDS else []
        for some in chain.from_iterable(combinations(names, k) for k in range(1, len(names))):
            yield some, _sum_of(self.case, {name: self.counts[name] for name in some})

    def others(self) -> Iterator[tuple[str, Numbers]]:
        """Yield the symbols that do not belong in the sum, with their values."""
        for name in sorted(self.case.expression.symbols) if self.counts else ():
            if name not in self.counts:
                yield name, self.case.samples.values[name]


@misconception(
    of=WrongSum,
    rank=10,
    code="joint_variable_missing",
    rule="angle_sum",
    means="one or more angles are missing in a sum of angles",
    example=("planar-rrr-standard", "task-space", {"3/1": "q1"}),
    unlike={"3/1": "2*q1 + q2 + q3"},
)
def left_out(wrong: WrongSum) -> Hypotheses:
    """Some angles are missing in the sum."""
    for names, part in wrong.subsets():
        hint = say_count(
            "{angles} is missing from this angle. Check which angles add up to it.",
            "{angles} are missing from this angle. Check which angles add up to it.",
            count=len(names),
            angles=wrong.named(names),
        )
        yield Written(wrong.case.expected - part, finding_on(wrong.case, hint))


@misconception(
    of=WrongSum,
    rank=60,
    code="joint_variable_missing",
    rule="angle_sum",
    means="one or more angles are missing in a sum of angles",
    example=("baxter-left-arm", "wrist", {"3/1": "0"}),
    unlike={"3/1": "theta7/2"},
)
def constant(wrong: WrongSum) -> Hypotheses:
    """The student wrote a constant instead of a sum of angles."""
    if wrong.counts and np.ptp(wrong.case.actual) < CONSTANT:
        hint = say(
            "This angle is constant, but it must not be: check which variables it depends on."
        )
        yield Written(wrong.case.actual, finding_on(wrong.case, hint))


@misconception(
    of=WrongSum,
    rank=20,
    code="joint_variable_sign",
    rule="angle_sum",
    means="an angle in a sum of angles has the wrong sign",
    example=("planar-rr", "task-space", {"3/1": "q1 - q2"}),
    unlike={"3/1": "0"},
)
def reversed_addends(wrong: WrongSum) -> Hypotheses:
    """Some angles have the wrong sign in the sum."""
    for names, part in wrong.subsets():
        hint = say_count(
            "{angles} has the wrong sign in this angle: check which way this turn counts positive.",
            "{angles} have the wrong sign in this angle: check which way this turn counts "
            "positive.",
            count=len(names),
            angles=wrong.named(names),
        )
        yield Written(wrong.case.expected - 2 * part, finding_on(wrong.case, hint))


@misconception(
    of=WrongSum,
    rank=30,
    code="joint_variable_doubled",
    rule="angle_sum",
    means="an angle in a sum of angles counts twice",
    example=("spherical-wrist", "zyz", {"1/1": "2*theta4"}),
    unlike={"1/1": "π/2"},
)
def counted_twice(wrong: WrongSum) -> Hypotheses:
    """An angle is counted twice in the sum."""
    for name, count in wrong.counts.items():
        hint = say(
            "{angle} counts twice in this angle. Check which angles add up to it.",
            angle=wrong.named([name]),
        )
        written = wrong.case.expected + count * wrong.case.samples.values[name]
        yield Written(written, finding_on(wrong.case, hint))


@misconception(
    of=WrongSum,
    rank=40,
    code="joint_variable_extra",
    rule="angle_sum",
    means="a sum of angles contains one too many",
    example=("spherical-wrist", "zyz", "[theta4 + theta6, theta5, theta6]"),
    unlike={"1/1": "theta5"},
)
def added(wrong: WrongSum) -> Hypotheses:
    """The sum contains an angle that should not be in the sum."""
    for name, value in wrong.others():
        hint = say(
            "{angle} does not belong in this angle: check which two directions it is measured "
            "between.",
            angle=wrong.named([name]),
        )
        for sign in (1, -1):
            finding = finding_on(wrong.case, hint)
            yield Written(wrong.case.expected + sign * value, finding)


@misconception(
    of=WrongSum,
    rank=50,
    code="joint_variable_index",
    rule="angle_sum",
    means="a sum of angles contains the angle of another joint in place of the right one",
    example=("baxter-left-arm", "wrist", {"1/1": "theta4"}),
    unlike={"3/1": "0"},
)
def of_another_joint(wrong: WrongSum) -> Hypotheses:
    """The sum contains the angle of a wrong joint."""
    for other, value in wrong.others():
        for name, count in wrong.counts.items():
            hint = say(
                "{angle} stands in the place of another angle: check which two directions it is "
                "measured between.",
                angle=wrong.named([other]),
            )
            written = wrong.case.expected + count * (value - wrong.case.samples.values[name])
            yield Written(written, finding_on(wrong.case, hint))
