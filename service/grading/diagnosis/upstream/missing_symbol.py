"""Symbols that an entry lacks or should not contain."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from service.catalogue import Exercise
from service.expressions.evaluation.samples import SymbolValues
from service.grading.diagnosis.formulas.formula_repair import WrongEntry
from service.grading.diagnosis.upstream.slip import Change, SymbolChange
from service.grading.diagnosis.upstream.slipped_answers import SlippedAnswers
from service.grading.diagnosis.wrong_value import UNEXPLAINED, Mask, differs, finding_on
from service.grading.feedback import Finding
from service.grading.misconception import check
from service.grading.numerics.comparison import nearly_equal
from service.grading.numerics.samples import Samples
from service.kinematics.transforms import Numbers
from service.translations import listed, say

# A change that has an effect on every entry: not a whole turn, and not a multiple of a length.
PROBE = 0.37
TWICE = 2.0
NOT_ZERO = say("This must not be 0: check which lengths have a part here.")


@dataclass(frozen=True, slots=True)
class Required:
    """The symbols that a correct entry depends on."""

    symbols: frozenset[str]
    # 1 if the entry doubles when all lengths double, 0 if it stays the same, else None.
    grows: int | None
    # All lengths, and the variables of sliding joints.
    lengths: frozenset[str]
    # The variables of all joints.
    joints: tuple[str, ...]


@dataclass(frozen=True)
class Requirements:
    """The search for the symbols that each correct entry depends on."""

    answers: SlippedAnswers
    exercise: Exercise
    samples: Samples
    # (..., SAMPLES).
    expected: Numbers
    # Broadcasts to (...).
    scale: Numbers

    def of(self, *place: int) -> Required | None:
        """Return the symbols that an entry must contain, or None if they are unknown."""
        if not self.answers.by_symbols:
            return None
        depends, grows = self._dependences
        symbols = {name for k, name in enumerate(self.samples.values) if depends[(k, *place)]}
        joints = tuple(joint.variable for joint in self.exercise.joints)
        alike = [k for k in (0, 1) if grows[(k, *place)]]
        return Required(
            frozenset(symbols.difference(joints) if self.answers.at_home else symbols),
            # Zero passes both tests, so it is not known to be a length or a number.
            alike[0] if len(alike) == 1 else None,
            self._lengths,
            joints,
        )

    @cached_property
    def _lengths(self) -> frozenset[str]:
        return frozenset(each.name for each in self.exercise.variables if each.kind == "length")

    @cached_property
    def _dependences(self) -> tuple[Mask, Mask]:
        # The first mask (symbols, ...) marks the entries that depend on each symbol. The second
        # mask (2, ...) marks the entries that stay the same if all lengths double, and those that
        # double.
        probes = [
            Change(symbols=(SymbolChange(name, name, 1.0, PROBE),)) for name in self.samples.values
        ]
        doubled = tuple(SymbolChange(name, name, TWICE) for name in sorted(self._lengths))
        few = self.samples.subset(1)
        *changed, larger = self.answers.at([*probes, Change(symbols=doubled)], few)
        right = Samples.subset_of(self.expected, 1)
        depends = [~nearly_equal(each, right, self.scale) for each in changed]
        grows = [nearly_equal(larger, size * right, self.scale) for size in (1.0, TWICE)]
        return np.array(depends), np.array(grows)


@dataclass(frozen=True)
class Dependence:
    """A wrong entry, and the symbols that the correct entry depends on."""

    case: WrongEntry
    # None if the symbols are unknown.
    required: Required | None

    @property
    def written(self) -> frozenset[str]:
        """The symbols that the student wrote."""
        return frozenset(self.case.expression.symbols)

    @property
    def joints(self) -> list[str]:
        """The joint variables that the student left out."""
        known = self.required
        return (
            [name for name in known.joints if name in known.symbols - self.written] if known else []
        )


def _is_formula(entry: Dependence) -> bool:
    return entry.required is not None and bool(entry.written)


@check(
    of=Dependence,
    rank=10,
    code="independent_of",
    rule="dependence",
    means="the entry does not contain a joint variable or a length that it must depend on",
    example=("planar-rpr-poe", "position", "[0, 0]"),
    unlike={"1/1": "theta1"},
)
def constant(entry: Dependence) -> Finding | None:
    """The student wrote a number, but the correct entry changes with a joint."""
    if entry.written or not entry.joints:
        return None
    hint = say("This is a constant, but it must change with the joints.")
    return finding_on(entry.case, hint)


@check(
    of=Dependence,
    rank=20,
    code=UNEXPLAINED,
    rule="dependence",
    means="the value is wrong, and no other code explains it",
    example=("rigid-motion-chain", "point", "[0, 0, 0]"),
    unlike={"3/1": "h"},
)
def zero(entry: Dependence) -> Finding | None:
    """The student wrote 0 for a length."""
    case, required = entry.case, entry.required
    if required is None or required.grows != 1 or not required.lengths:
        return None
    return differs(case, NOT_ZERO) if _same(case, case.actual, 0 * case.actual) else None


@check(
    of=Dependence,
    rank=30,
    code="quantity",
    rule="dependence",
    when=_is_formula,
    means="the entry must be a length and is not, or must be a plain number and contains a length",
    example=("planar-rr", "pose", {"1/4": "c1 + c12"}),
    unlike={"1/4": "a1 c1"},
)
def quantity(entry: Dependence) -> Finding | None:
    """The formula is a plain number instead of a length, or a length instead of a number."""
    case, required = entry.case, entry.required
    if required is None or required.grows is None or not required.lengths:
        return None
    few = case.samples.subset(1)
    larger = {
        name: values * TWICE if name in required.lengths else values
        for name, values in few.values.items()
    }
    once, twice = (_value(case, values) for values in (few.values, larger))
    if not np.isfinite([once, twice]).all() or _same(case, once, 0 * once):
        return None
    if _same(case, twice, (1 + required.grows) * once):
        return None
    if required.grows == 0:
        return finding_on(case, say("A plain number is asked for, but this contains a length."))
    if _same(case, twice, once):
        return finding_on(case, say("A length is asked for, but this contains none."))
    return finding_on(case, say("A length is asked for, but not every term here is a length."))


@check(
    of=Dependence,
    rank=40,
    code="independent_of",
    rule="dependence",
    when=_is_formula,
    means="the entry does not contain a joint variable or a length that it must depend on",
    example=("planar-rr", "pose", {"1/4": "a1 c1"}),
    unlike={"1/4": "c1 + c12"},
)
def missing_joints(entry: Dependence) -> Finding | None:
    """Joint variables are missing in the entry."""
    case, names = entry.case, entry.joints
    if not names or any(_is_whole(case, name) for name in names):
        return None
    hint = say(
        "Nothing here depends on {variables}. Check what these joints move.",
        variables=_named(case, names),
    )
    if len(names) == 1:
        hint = say(
            "Nothing here depends on {variable}. Check what this joint moves.",
            variable=_named(case, names),
        )
    return finding_on(case, hint)


@check(
    of=Dependence,
    rank=50,
    code="joint_variable_extra",
    rule="dependence",
    when=_is_formula,
    means="the entry contains a joint variable too many, alone or in a sum of joint angles",
    example=("planar-rrr-drawn", "links", {"A3.1/3": "c12"}),
    unlike={"A2.3/4": "1"},
)
def extra_joints(entry: Dependence) -> Finding | None:
    """The entry contains joint variables that should not be in the entry."""
    case, required = entry.case, entry.required
    assert required is not None
    few = case.samples.subset(1)
    now = _value(case, few.values)
    moving = [
        name
        for name in required.joints
        if name in entry.written - required.symbols
        and not _same(case, _value(case, {**few.values, name: few.values[name] + PROBE}), now)
    ]
    if not moving:
        return None
    hint = say(
        "This must not change with {variables}: check which joints move it.",
        variables=_named(case, moving),
    )
    return finding_on(case, hint)


@check(
    of=Dependence,
    rank=60,
    code="independent_of",
    rule="dependence",
    when=_is_formula,
    means="the entry does not contain a joint variable or a length that it must depend on",
    example=("rigid-motion-chain", "point", {"3/1": "h"}),
    unlike={"3/1": "-pi/2"},
)
def missing_length(entry: Dependence) -> Finding | None:
    """A length is missing in the entry."""
    # The hint does not name the length: it may be the answer.
    required = entry.required
    assert required is not None
    if not required.symbols & required.lengths - entry.written - set(required.joints):
        return None
    hint = say("A length is missing here: check which lengths have a part in this.")
    return finding_on(entry.case, hint)


@check(
    of=Dependence,
    rank=90,
    code=UNEXPLAINED,
    rule="dependence",
    means="the value is wrong, and no other code explains it",
    example=("planar-rr", "pose", {"1/4": "a1 c1 + 2 a2 c12"}),
    unlike={"1/2": "s12"},
)
def unexplained(entry: Dependence) -> Finding:
    """No misconception explains the entry."""
    hint = say("This is not right. Check each term: its factor, length, angle and sign.")
    return differs(entry.case, hint)


def _is_whole(case: WrongEntry, name: str) -> bool:
    # Then the name of the symbol would give the entry away.
    return _same(case, np.abs(case.expected), np.abs(case.samples.values[name]))


def _named(case: WrongEntry, names: Iterable[str]) -> str:
    return listed([case.spelling.names.get(name, name) for name in names])


def _value(case: WrongEntry, values: SymbolValues) -> Numbers:
    value = case.expression.evaluate(values)
    return np.broadcast_to(value, next(iter(values.values())).shape)


def _same(case: WrongEntry, one: Numbers, other: Numbers) -> bool:
    return bool(nearly_equal(one, other, case.scale, case.angle))
