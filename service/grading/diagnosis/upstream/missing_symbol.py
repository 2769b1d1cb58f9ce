"""What an entry lacks or has too much: a joint variable, a length, the quantity asked for."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from service.catalogue import Exercise
from service.expressions.evaluation.samples import SymbolValues
from service.grading.diagnosis.formulas.formula_repair import WrongEntry
from service.grading.diagnosis.upstream.slip import Change, SymbolChange
from service.grading.diagnosis.upstream.slipped_answers import SlippedAnswers
from service.grading.diagnosis.wording import listed
from service.grading.diagnosis.wrong_value import Mask, differs, finding_on
from service.grading.feedback import Finding
from service.grading.numerics.comparison import nearly_equal
from service.grading.numerics.samples import Samples
from service.kinematics.transforms import Numbers

# A change that no entry of a robot is blind to: no whole turn, no factor of any length.
PROBE = 0.37
TWICE = 2.0
NOT_ZERO = "This must not be 0: check which lengths have a part here."


@dataclass(frozen=True, slots=True)
class Required:
    """What the right entry depends on, and whether it grows with all ``lengths`` alike.

    ``grows`` is 1 for a length, 0 for what no length changes, None for anything else. ``lengths``
    includes the variables of sliding joints, ``joints`` those of all joints.
    """

    symbols: frozenset[str]
    grows: int | None
    lengths: frozenset[str]
    joints: tuple[str, ...]


@dataclass(frozen=True)
class Requirements:
    """What the entries of the right answer depend on, found by changing one symbol after another.

    ``expected`` is ``(..., SAMPLES)``, ``scale`` broadcasts to ``(...)``.
    """

    answers: SlippedAnswers
    exercise: Exercise
    samples: Samples
    expected: Numbers
    scale: Numbers

    def of(self, *place: int) -> Required | None:
        """Those of one entry; None where the answers do not follow all symbols."""
        if not self.answers.by_symbols:
            return None
        names = self.samples.values.keys()
        depends, grows = self._found
        alike = [k for k in (0, 1) if grows[(k, *place)]]
        return Required(
            frozenset(name for k, name in enumerate(names) if depends[(k, *place)]),
            # A zero is as much a length as it is a number.
            alike[0] if len(alike) == 1 else None,
            self._lengths,
            tuple(joint.variable for joint in self.exercise.joints),
        )

    @cached_property
    def _lengths(self) -> frozenset[str]:
        return frozenset(each.name for each in self.exercise.variables if each.kind == "length")

    @cached_property
    def _found(self) -> tuple[Mask, Mask]:
        """Which symbols entries depend on ``(symbols, ...)``, and how they grow ``(2, ...)``."""
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


def explain_dependence(case: WrongEntry, required: Required) -> Finding | None:
    """What a wrong entry lacks, or what it has too much."""
    written = case.expression.symbols
    joints = [name for name in required.joints if name in required.symbols - written]
    if not written and joints:
        return _constant(case)
    if required.grows == 1 and required.lengths and _same(case, case.actual, 0 * case.actual):
        return differs(case, NOT_ZERO)
    if not written:
        return None
    lengths = sorted(required.symbols & required.lengths - written - set(required.joints))
    return (
        _wrong_quantity(case, required)
        or _missing_joints(case, joints)
        or _extra(case, [name for name in required.joints if name in written - required.symbols])
        or (_missing_length(case) if lengths else None)
    )


def _constant(case: WrongEntry) -> Finding:
    return finding_on(
        case, "independent_of", "This is a constant, but it must change with the joints."
    )


def _wrong_quantity(case: WrongEntry, required: Required) -> Finding | None:
    """A length without a length in it, or a number with one."""
    if required.grows is None or not required.lengths:
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
        hint = "A plain number is asked for, but this contains a length."
        return finding_on(case, "quantity", hint)
    if _same(case, twice, once):
        return finding_on(case, "quantity", "A length is asked for, but this contains none.")
    hint = "A length is asked for, but not every term here is a length."
    return finding_on(case, "quantity", hint)


def _missing_joints(case: WrongEntry, names: list[str]) -> Finding | None:
    if not names or any(_is_whole(case, name) for name in names):
        return None
    advice = "Check what this joint moves." if len(names) == 1 else "Check what these joints move."
    return finding_on(
        case, "independent_of", f"Nothing here depends on {_named(case, names)}. {advice}"
    )


def _missing_length(case: WrongEntry) -> Finding:
    """Its name is not told: it may be all that is missing."""
    hint = "A length is missing here: check which lengths have a part in this."
    return finding_on(case, "independent_of", hint)


def _extra(case: WrongEntry, names: Iterable[str]) -> Finding | None:
    """Joint variables in an entry that their joints do not change."""
    few = case.samples.subset(1)
    now = _value(case, few.values)
    moving = [
        name
        for name in names
        if not _same(case, _value(case, {**few.values, name: few.values[name] + PROBE}), now)
    ]
    if not moving:
        return None
    hint = f"This must not change with {_named(case, moving)}: check which joints move it."
    return finding_on(case, "joint_variable_extra", hint)


def _is_whole(case: WrongEntry, name: str) -> bool:
    """Whether a symbol is the whole of the right entry, so that its name would give it away."""
    return _same(case, np.abs(case.expected), np.abs(case.samples.values[name]))


def _named(case: WrongEntry, names: Iterable[str]) -> str:
    return listed([case.spelling.names.get(name, name) for name in names])


def _value(case: WrongEntry, values: SymbolValues) -> Numbers:
    value = case.expression.evaluate(values)
    return np.broadcast_to(value, next(iter(values.values())).shape)


def _same(case: WrongEntry, one: Numbers, other: Numbers) -> bool:
    return bool(nearly_equal(one, other, case.scale, case.angle))
