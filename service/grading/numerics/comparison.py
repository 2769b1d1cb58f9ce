"""Compare values with the expected ones.

Values must be equal at all samples (random joint values). Decimals with at least three figures may
be rounded.
"""

# Arrays are ``(..., samples)``. No tolerance depends on the drawn samples, so that every draw gives
# the same result. A rounded decimal is right if it is the true number, rounded or cut off
# (``expressions.evaluation.decimals``). So an entry is right if shifts of its decimals, each no
# larger than rounding allows and the same at all samples, make it equal to the expected one.

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

# If an entry has more decimals, they count as exact: the work grows with their number.
MAX_DECIMALS = 16
MAX_SHARED_DECIMALS = 32
PROJECTIONS = 200
# The number of projections after which a plane that separates the two sets is searched.
SEPARATIONS = 8
# The size of a component of the plane's normal that counts as 0, and the least distance between the
# separated sets, in the largest unit.
FLAT = 1e-9
SEPARATED = 1e-3
# Over-relaxed projections, which continue beyond the bounds, converge faster (Motzkin).
RELAXATION = 1.9
# The least effect of an unknown on the errors, relative to the largest effect, in each step of a
# fit; unknowns with less are left unchanged. If two axes are parallel except for rounding, only the
# sum of offsets along them has an effect; this shows better the smaller the remaining errors are.
LEAST_EFFECTS = (5e-2, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-9)
# Half the digits of a double, the best step for differences.
LEAST_STEP = 1e-6
# A fit ends if a shift is further out of bounds than this share of the first error.
MISSED = 0.1
# A fit ends if the error is larger than the effect of all shifts together by this factor.
OUT_OF_REACH = 10.0
# How far a shift may be out of bounds, relative to the tolerance of the errors.
FLOATING_SHIFT = 1e-3
# The largest relative error of a number that is cut off after three figures.
LARGEST_SLACK = 0.01


class Match(IntEnum):
    """The result of comparing a value with the expected value."""

    DIFFERENT = 0
    UNDEFINED = 1
    ROUNDED = 2
    EXACT = 3


def difference(actual: Numbers, expected: Numbers, angle: ArrayLike = False) -> Numbers:
    """Return ``actual − expected``, modulo 2π in [−π, π] where the mask ``angle`` is true."""
    return _turned(actual - expected, angle)


def _turned(plain: Numbers, angle: ArrayLike | bool) -> Numbers:
    if isinstance(angle, bool) and not angle:
        return plain
    turns = np.where(angle, np.round(plain / (2 * np.pi)), 0.0)
    return plain - 2 * np.pi * turns


def matches(
    actual: Numbers, expected: Numbers, scale: ArrayLike, angle: ArrayLike = False
) -> NDArray[np.int_]:
    """Return the comparison result of each entry ``(...)``, from values ``(..., samples)``.

    ``scale`` is the unit of the tolerance: 1 for angles, a typical length for lengths.
    """
    # ``scale`` gives the tolerance an absolute minimum, so that sin² + cos² − 1 always equals 0.
    # The minimum is far too small to hide a wrong constant in a large entry.
    with np.errstate(invalid="ignore", over="ignore"):
        plain = actual - expected
        # Most answers equal the expected one to the last bit; NaN does not equal 0.
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
    """Return the comparison result of each entry; correctly rounded decimals count as equal.

    ``expressions`` are the expressions of the entries, None for an unreadable entry.
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
    """True if rounding of an entry's decimals explains its difference from ``expected``."""
    # ``expected`` is ``(samples,)``.
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
    # A fit in closed form. Most decimals of a table are the only one in their cell, such as 1.571
    # for π/2, and the general fit takes ten times as long.
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
    """Return a mask ``(...)`` of the values that are equal except for rounding.

    Use this only for guesses, never for a verdict. ``slack`` is a known rounding error.
    """
    # The tolerance is at least a thousandth of the size of the values. For values that are larger
    # than any number of the robot, it is at least a thousandth of the robot's largest numbers.
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
    """True if two single values ``(samples,)`` are nearly equal."""
    # ``nearly_equal`` for one value, at a fifth of its cost.
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
    """Return an estimate of an entry's largest rounding error."""
    if not expression.has_decimal:
        return 0.0
    # Cache the result: a table is judged in several ways, which all need the same cells.
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
    """Find small shifts of m decimals after which no error is left, or return None.

    ``errors`` takes K sets of shifts, ``(K, m)``, and returns n errors for each set, ``(K, n)``.
    """
    # ``units`` ``(m,)`` are the units of the decimals. Each shift is at most as large as rounding
    # or cutting off allows.
    count = len(units)
    steps = difference_steps(units)
    ways = np.concatenate([np.diag(steps), -np.diag(steps), np.zeros((1, count))])

    def linearised(shifts: Numbers) -> tuple[Numbers, Numbers]:
        found = errors(shifts + ways)
        return found[-1], (found[:count] - found[count:-1]).T / (2 * steps)

    return fitted_unknowns(linearised, units, count, tolerance)


def difference_steps(sizes: Numbers) -> Numbers:
    """Return the step size of each unknown for computing derivatives by central differences."""
    # ``sizes`` is the effect of each unknown.
    # The steps are about as large as the unknowns, and large compared with floating-point errors.
    return np.maximum(0.5, LEAST_STEP / sizes)


def fitted_unknowns(
    linearised: Callable[[Numbers], tuple[Numbers, Numbers]],
    sizes: Numbers,
    count: int,
    tolerance: float,
) -> Numbers | None:
    """Find values of N unknowns that leave no error, or return None.

    ``linearised`` returns n errors, and their derivatives ``(n, N)`` by the unknowns.
    """
    # The first ``count`` unknowns are shifts. ``sizes`` ``(N,)`` is the direct effect of each
    # unknown on an error. All unknowns are small, so that the Gauss-Newton method needs few steps.
    unknowns, first, beyond = np.zeros(len(sizes)), np.inf, 0.0
    for step, least_effect in enumerate(LEAST_EFFECTS):
        error, rates = linearised(unknowns)
        if not (np.isfinite(rates).all() and np.isfinite(error).all()):
            return None
        largest = float(np.abs(error).max())
        # If a unit is as small as floating-point errors, a shift may be slightly out of bounds.
        shifts, outside = unknowns[:count], FLOATING_SHIFT * tolerance / sizes[:count]
        allowed = (shifts >= -ROUNDED_UP - outside) & (shifts <= CUT_OFF + outside)
        if largest <= tolerance and allowed.all():
            return unknowns
        if step == 0:
            first = largest
            if count == len(sizes) and _is_out_of_reach(error, rates, tolerance):
                return None
        elif step > 1 and (largest > first / 2 or beyond > MISSED * first):
            return None
        # The triangle of the QR decomposition has the same singular values and is far smaller.
        orthogonal, triangle = np.linalg.qr(rates / sizes)
        solver = np.linalg.pinv(triangle, rcond=least_effect) @ orthogonal.T
        moved = unknowns * sizes - solver @ error
        bounds = np.outer([-ROUNDED_UP, CUT_OFF], sizes[:count])
        moved = _nearest_inside(moved, solver @ (rates / sizes), bounds)
        beyond = float(np.abs(moved[:count] - np.clip(moved[:count], *bounds)).max())
        unknowns = moved / sizes
    return None


class SharedDecimals:
    """The rounded decimals of several entries, which must be tested together.

    ``units`` ``(count,)`` is the last place of each decimal.
    """

    # ``count`` is 0 if there are no decimals or too many.
    def __init__(self, expressions: Sequence[Expression | None], samples: Samples) -> None:
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
        """Return ``values`` with shifted decimals, for each of K sets of shifts ``(K, count)``."""
        # ``values`` is ``(entries, samples)``, the result ``(K, entries, ...)``.
        moved = np.repeat(values[None], len(shifts), axis=0)
        for i, decimals, places, symbol_values in self._parts:
            moved[:, i] = decimals.shifted(shifts[:, places], symbol_values)
        return moved


def _nearest_inside(unknowns: Numbers, determined: Numbers, bounds: Numbers) -> Numbers:
    # Other unknowns that have the same effect, with shifts within ``bounds`` ``(2, count)`` if that
    # is possible. ``determined`` ``(N, N)`` projects unknowns on those with an effect. If only the
    # sum of two decimals has an effect, both decimals may have to share the shift. The unknowns are
    # projected in turn on the set with the same effect and on the set within bounds. These
    # projections converge to the intersection of the sets (von Neumann, Bregman), or end if a plane
    # separates the sets.
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


def _is_out_of_reach(error: Numbers, rates: Numbers, tolerance: float) -> bool:
    # The largest possible shifts still leave an error far from 0. Errors on which the shifts have
    # no effect are floating-point errors, and need not be 0.
    reached = OUT_OF_REACH * CUT_OFF * np.abs(rates).sum(axis=1) + tolerance
    return bool((np.abs(error) > reached).any())


def _is_between(normal: Numbers, effect: Numbers, bounds: Numbers) -> bool:
    # The plane with this ``normal`` separates the bounds from the needed effect.
    count, size = bounds.shape[1], math.sqrt(normal @ normal)
    if np.abs(normal[count:]).max(initial=0.0) > FLAT * size:
        return False
    reached = np.maximum(normal[:count] * bounds[0], normal[:count] * bounds[1]).sum()
    return bool(normal @ effect - reached > SEPARATED * bounds[1].max() * size)


def _tolerance(expected: Numbers, scale: ArrayLike) -> Numbers:
    # ``np.mean`` takes as long as the rest of this function, so compute the mean directly.
    size = np.sqrt((expected * expected).sum(axis=-1) / expected.shape[-1])
    return np.asarray(EXACT_VALUE * np.asarray(scale) + FLOATING_POINT * size)
