"""When two columns of numbers are the same answer.

Arrays are ``(..., samples)``; what is asked of them must hold at all samples. No tolerance depends
on the values that were drawn, so that every draw finds the same.

A decimal number with three or more figures is right if it is the true number, rounded or cut off
(``expressions.evaluation.decimals``). So an entry is right if its decimals can each be moved as far
as rounding may have moved it, once for all samples, so that the entry is what was expected.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from enum import IntEnum

import numpy as np
from numpy.typing import ArrayLike, NDArray

from service.expressions import Decimals, Expression, decimals_of
from service.grading.numerics.samples import Samples
from service.grading.numerics.tolerances import (
    CUT_OFF,
    EXACT_VALUE,
    FLOATING_POINT,
    ROUNDED_UP,
    ROUNDED_VALUE,
)
from service.kinematics.tolerances import LARGEST_ANGLE, LARGEST_LENGTH
from service.kinematics.transforms import Numbers

# More decimals in one entry are taken as they are written: the work grows with their number.
MAX_DECIMALS = 16
MAX_SHARED_DECIMALS = 32
PROJECTIONS = 200
# After so many projections a plane is looked for that keeps them from meeting.
SEPARATIONS = 8
# What counts as 0 in its direction, and how far apart what it separates must be, in the largest
# unit.
FLAT = 1e-9
SEPARATED = 1e-3
# Projections that go on beyond the bounds by nearly as much as they came meet sooner (Motzkin).
RELAXATION = 1.9
# What an unknown must at least do to the errors, for its size and relative to those that do most,
# in each step of a fit. Where two axes are parallel but for rounding, only the sum of what is
# measured along them has an effect; the smaller the errors that are left, the better this is seen.
LEAST_EFFECTS = (5e-2, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-9)
# Half the digits of a double, as it is best for differences.
LEAST_STEP = 1e-6
# A shift that is further out of bounds than this share of the first error will not come back.
MISSED = 0.1
# An error so many times as large as all shifts together undo is not made by rounding.
OUT_OF_REACH = 10.0
# How far outside a shift may lie, relative to the tolerance of the errors.
FLOATING_SHIFT = 1e-3
# Of a number with three figures rounding leaves off up to a hundredth.
LARGEST_SLACK = 0.01


class Match(IntEnum):
    """How an answer compares with what was expected."""

    DIFFERENT = 0
    UNDEFINED = 1
    ROUNDED = 2
    EXACT = 3


def difference(actual: Numbers, expected: Numbers, angle: ArrayLike = False) -> Numbers:
    """``actual − expected``; where ``angle`` (it broadcasts), turned into [−π, π] radians."""
    return _turned(actual - expected, angle)


def _turned(plain: Numbers, angle: ArrayLike | bool) -> Numbers:
    """Differences, turned into [−π, π] where they are those of an ``angle``."""
    if isinstance(angle, bool) and not angle:
        return plain
    turns = np.where(angle, np.round(plain / (2 * np.pi)), 0.0)
    return plain - 2 * np.pi * turns


def matches(
    actual: Numbers, expected: Numbers, scale: ArrayLike, angle: ArrayLike = False
) -> NDArray[np.int_]:
    """The Match of each entry ``(...)`` as it is written, from ``(..., samples)``.

    ``scale`` is the unit of the tolerance: 1 for angles and direction cosines, a typical length for
    lengths. It gives the tolerance an absolute floor, so that sin² + cos² − 1 is 0 every time; the
    floor is far too low for a wrong constant to hide beside a large entry.
    """
    with np.errstate(invalid="ignore", over="ignore"):
        plain = actual - expected
        # Most answers are the expected one to the last bit; NaN is not 0.
        if not plain.any():
            return np.full(plain.shape[:-1], int(Match.EXACT))
        error = np.abs(_turned(plain, angle)).max(axis=-1)
        found = np.where(error <= _tolerance(expected, scale), Match.EXACT, Match.DIFFERENT)
    return np.where(np.isfinite(actual).all(axis=-1), found, Match.UNDEFINED)


def entry_matches(
    expressions: Sequence[Expression | None],
    actual: Numbers,
    expected: Numbers,
    scale: ArrayLike,
    samples: Samples,
    angle: ArrayLike = False,
) -> NDArray[np.int_]:
    """The Match of each entry ``(...)``; those that are not exact may be rounded.

    ``expressions`` are those of the entries in order, None where there is none.
    """
    found = matches(actual, expected, scale, angle)
    different = np.flatnonzero(found == Match.DIFFERENT).tolist()
    if not any((each := expressions[i]) is not None and each.has_decimal for i in different):
        return found
    shape = found.shape
    scales = np.broadcast_to(scale, shape).ravel()
    angles = np.broadcast_to(angle, (*shape, 1)).ravel()
    found, wanted = found.ravel(), expected.reshape(-1, expected.shape[-1])
    for i in different:
        expression = expressions[i]
        if expression is not None and is_rounded(
            expression, wanted[i], float(scales[i]), samples, angle=bool(angles[i])
        ):
            found[i] = Match.ROUNDED
    return found.reshape(shape)


def is_rounded(
    expression: Expression,
    expected: Numbers,
    scale: float,
    samples: Samples,
    *,
    angle: bool = False,
) -> bool:
    """Whether an entry would be the expected one, ``(samples,)``, but for its rounded decimals."""
    if not expression.has_decimal or not 0 < len(decimals_of(expression).units) <= MAX_DECIMALS:
        return False
    # A table is compared several times, and most of its cells with the same numbers.
    return samples.cached(
        (expression, expected.tobytes(), scale, angle),
        lambda: _is_rounded(expression, expected, scale, samples, angle),
    )


def _is_rounded(
    expression: Expression, expected: Numbers, scale: float, samples: Samples, angle: bool
) -> bool:
    decimals = decimals_of(expression)
    symbol_values = samples.values_for(expression)
    tolerance = float(_tolerance(expected, scale))
    if decimals.sign:
        value = expression.evaluate(symbol_values)
        error = difference(np.asarray(value), expected, angle)
        return _is_rounded_number(error, float(decimals.units[0]), decimals.sign, tolerance)

    def errors(shifts: Numbers) -> Numbers:
        values = decimals.shifted(shifts, symbol_values)
        return np.asarray(difference(values, expected[None], angle))

    return fitted_shifts(errors, decimals.units, tolerance) is not None


def _is_rounded_number(error: Numbers, unit: float, sign: int, tolerance: float) -> bool:
    """Whether a shift of one decimal leaves no ``error`` ``(samples,)``: the fit in closed form.

    Most decimals of a table stand alone, as 1.571 for π/2, and the fit takes ten times as long.
    """
    mean = float(error.mean())
    shift, outside = -sign * mean / unit, FLOATING_SHIFT * tolerance / unit
    if not -ROUNDED_UP - outside <= shift <= CUT_OFF + outside:
        return False
    return bool(np.abs(error - mean).max() <= tolerance)


def nearly_equal(
    one: Numbers,
    other: Numbers,
    scale: ArrayLike = 1.0,
    angle: ArrayLike = False,
    slack: float = 0.0,
) -> NDArray[np.bool_]:
    """Whether values ``(..., samples)`` are equal but for what rounding does to them: ``(...)``.

    This is for guesses, such as which slip explains an answer, and never for a verdict. ``slack``
    is what rounding is known to do. Values are never nearer than three figures of their size, or of
    the largest size that the robot's own numbers have, if that is smaller.
    """
    error = np.abs(difference(one, other, angle)).max(axis=-1)
    size = np.sqrt(np.mean(other * other, axis=-1))
    largest = np.where(np.any(angle, axis=-1), LARGEST_ANGLE, LARGEST_LENGTH) * scale
    tolerance = np.maximum(ROUNDED_VALUE * np.minimum(size, largest), _tolerance(other, scale))
    # NaN is not within any tolerance.
    near = error <= np.maximum(tolerance, np.minimum(slack, LARGEST_SLACK * size))
    return np.asarray(near & np.isfinite(size))


def same(
    one: Numbers, other: Numbers, scale: float = 1.0, angle: bool = False, slack: float = 0.0
) -> bool:
    """Whether two single values ``(samples,)`` are nearly equal.

    It asks the same as ``nearly_equal``, for a fifth of its cost.
    """
    error = one - other
    if angle:
        error -= 2 * np.pi * np.round(error / (2 * np.pi))
    size = math.sqrt(float(other @ other) / other.size)
    largest = (LARGEST_ANGLE if angle else LARGEST_LENGTH) * scale
    exact = EXACT_VALUE * scale + FLOATING_POINT * size
    tolerance = max(ROUNDED_VALUE * min(size, largest), exact, min(slack, LARGEST_SLACK * size))
    # NaN is not within any tolerance.
    return bool(np.abs(error).max() <= tolerance) and math.isfinite(size)


def rounding_slack(expression: Expression, samples: Samples) -> float:
    """By how much rounding may have moved an entry, to first order."""
    if not expression.has_decimal:
        return 0.0
    # A table is judged in several ways, and each of them asks for the same cells.
    return samples.cached(("slack", expression), lambda: _rounding_slack(expression, samples))


def _rounding_slack(expression: Expression, samples: Samples) -> float:
    decimals = decimals_of(expression)
    count = len(decimals.units)
    if not 0 < count <= MAX_DECIMALS:
        return 0.0
    steps = np.eye(count) / 2
    values = samples.values_for(expression)
    # An infinite entry has no rate.
    with np.errstate(invalid="ignore"):
        rates = decimals.shifted(steps, values) - decimals.shifted(-steps, values)
    return float(np.nan_to_num(np.abs(rates).sum(axis=0).max()))


def fitted_shifts(
    errors: Callable[[Numbers], Numbers], units: Numbers, tolerance: float
) -> Numbers | None:
    """The shifts ``(m,)`` of decimals that leave no error; None if there are none.

    ``errors`` gives the errors ``(K, n)`` for shifts ``(K, m)``, ``units`` ``(m,)`` are those of
    the decimals. Each shift is as large as rounding or cutting off leaves it.
    """
    count = len(units)
    steps = difference_steps(units)
    ways = np.concatenate([np.diag(steps), -np.diag(steps), np.zeros((1, count))])

    def linearised(shifts: Numbers) -> tuple[Numbers, Numbers]:
        found = errors(shifts + ways)
        return found[-1], (found[:count] - found[count:-1]).T / (2 * steps)

    return fitted_unknowns(linearised, units, count, tolerance)


def difference_steps(sizes: Numbers) -> Numbers:
    """The steps ``(N,)`` of central differences for unknowns of which 1 has an effect of ``sizes``.

    They are as large as the unknowns, and so large that floating point does not show.
    """
    return np.maximum(0.5, LEAST_STEP / sizes)


def fitted_unknowns(
    linearised: Callable[[Numbers], tuple[Numbers, Numbers]],
    sizes: Numbers,
    count: int,
    tolerance: float,
) -> Numbers | None:
    """The unknowns ``(N,)`` that leave no error, of which the first ``count`` are shifts.

    None if there are none. ``linearised`` gives the errors ``(n,)`` for unknowns, and their
    derivative ``(n, N)``; ``sizes`` ``(N,)`` is how large an error an unknown makes that acts
    directly. All unknowns are small, so Gauss and Newton's method needs few steps.
    """
    unknowns, first, beyond = np.zeros(len(sizes)), np.inf, 0.0
    for step, least_effect in enumerate(LEAST_EFFECTS):
        error, rates = linearised(unknowns)
        if not (np.isfinite(rates).all() and np.isfinite(error).all()):
            return None
        largest = float(np.abs(error).max())
        # Where a unit is as small as what floating point leaves, a shift is a little outside.
        shifts, outside = unknowns[:count], FLOATING_SHIFT * tolerance / sizes[:count]
        allowed = (shifts >= -ROUNDED_UP - outside) & (shifts <= CUT_OFF + outside)
        if largest <= tolerance and allowed.all():
            return unknowns
        if step == 0:
            first = largest
            if count == len(sizes) and _is_out_of_reach(error, rates):
                return None
        elif step > 1 and (largest > first / 2 or beyond > MISSED * first):
            return None
        # The singular values are those of the triangle, which is far smaller.
        orthogonal, triangle = np.linalg.qr(rates / sizes)
        solver = np.linalg.pinv(triangle, rcond=least_effect) @ orthogonal.T
        moved = unknowns * sizes - solver @ error
        bounds = np.outer([-ROUNDED_UP, CUT_OFF], sizes[:count])
        moved = _nearest_inside(moved, solver @ (rates / sizes), bounds)
        beyond = float(np.abs(moved[:count] - np.clip(moved[:count], *bounds)).max())
        unknowns = moved / sizes
    return None


class SharedDecimals:
    """The rounded decimals of several entries, which may be right together and not each by itself.

    ``units`` ``(count,)`` are theirs; ``count`` is 0 where there are none or too many.
    """

    def __init__(self, expressions: Sequence[Expression | None], samples: Samples) -> None:
        """``expressions`` are those of the entries, None where there is none."""
        self._parts: list[tuple[int, Decimals, slice, Mapping[str, Numbers]]] = []
        self.count = 0
        self.units = np.zeros(0)
        for i, expression in enumerate(expressions):
            if expression is None or not expression.has_decimal:
                continue
            decimals = decimals_of(expression)
            if 0 < len(decimals.units) <= MAX_DECIMALS:
                places = slice(self.count, self.count + len(decimals.units))
                self._parts.append((i, decimals, places, samples.values_for(expression)))
                self.count = places.stop
                self.units = np.append(self.units, decimals.units)
        if self.count > MAX_SHARED_DECIMALS:
            self._parts, self.count, self.units = [], 0, np.zeros(0)

    def shifted(self, shifts: Numbers, values: Numbers) -> Numbers:
        """The ``values`` ``(entries, samples)`` with the decimals shifted: ``(K, entries, ...)``.

        ``shifts`` is ``(K, count)``.
        """
        moved = np.repeat(values[None], len(shifts), axis=0)
        for i, decimals, places, symbol_values in self._parts:
            moved[:, i] = decimals.shifted(shifts[:, places], symbol_values)
        return moved


def _nearest_inside(unknowns: Numbers, determined: Numbers, bounds: Numbers) -> Numbers:
    """Unknowns with the same effect, the first of which are inside bounds, if there are any.

    ``bounds`` ``(2, count)`` are the lower and the upper ones. ``determined`` ``(N, N)`` projects
    unknowns on those that have an effect. Of two decimals of which only the sum counts, one alone
    may not make up for both. Projections on both sets in turn meet in their intersection (von
    Neumann, Bregman), or end where a plane lies between the two: then there are none.
    """
    (lower, upper), count = bounds, bounds.shape[1]
    effect = determined @ unknowns
    for step in range(PROJECTIONS):
        outside = unknowns[:count] - np.minimum(np.maximum(unknowns[:count], lower), upper)
        if not outside.any():
            break
        if step % SEPARATIONS == 1 and _is_between(determined[:count].T @ outside, effect, bounds):
            break
        inside = unknowns.copy()
        inside[:count] -= RELAXATION * outside
        unknowns = inside - determined @ inside + effect
    return unknowns


def _is_out_of_reach(error: Numbers, rates: Numbers) -> bool:
    """Whether shifts alone, each as large as it may be, leave an error far from 0."""
    return bool((np.abs(error) > OUT_OF_REACH * CUT_OFF * np.abs(rates).sum(axis=1)).any())


def _is_between(normal: Numbers, effect: Numbers, bounds: Numbers) -> bool:
    """Whether no unknowns within the bounds reach as far along ``normal`` as the effect demands."""
    count, size = bounds.shape[1], math.sqrt(normal @ normal)
    if np.abs(normal[count:]).max(initial=0.0) > FLAT * size:
        return False
    reached = np.maximum(normal[:count] * bounds[0], normal[:count] * bounds[1]).sum()
    return bool(normal @ effect - reached > SEPARATED * bounds[1].max() * size)


def _tolerance(expected: Numbers, scale: ArrayLike) -> Numbers:
    """How far two values may be apart that are the same: ``(...)``."""
    # The mean by its definition, for ``np.mean`` takes as long as all the rest.
    size = np.sqrt((expected * expected).sum(axis=-1) / expected.shape[-1])
    return np.asarray(EXACT_VALUE * np.asarray(scale) + FLOATING_POINT * size)
