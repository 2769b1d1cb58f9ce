"""Compare numbers at random joint values: the samples, the tolerances, and the comparison.

This file knows when two values are equal, exactly or except for rounding. What the values are, and
what follows if they differ, is not known here.
"""

import hashlib
import json
import math
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field
from datetime import date, time
from enum import IntEnum
from functools import cached_property, lru_cache
from typing import Any, Final, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dh_grader.catalogue import Exercise, Joint, Variable
from dh_grader.expressions import Decimals, Expression, decimals_of
from dh_grader.kinematics import LARGEST_ANGLE, LARGEST_LENGTH, Numbers

# --- All tolerances of grading, with their reasons
#
# Unless stated otherwise, lengths are in units of the exercise's typical length, and angles are in
# radians. Tolerances of poses are in ``kinematics``.


# The difference of equal answers: far above the floating-point error of a formula with 200
# operations, far below any slip. Relative to the scale of the expected value, which does not depend
# on the draw.
EXACT_VALUE: Final = 1e-9
# The floating-point error of values far larger than their scale, relative to their size. It is so
# small that the draw, on which the size depends, does not matter.
FLOATING_POINT: Final = 1e-12
# The distance of the true number from a decimal, in units of its last place: half a unit in either
# direction if it was rounded, nearly one unit away from 0 if digits were cut off. 0.999 is not 1.
ROUNDED_UP: Final = 0.5 + 1e-6
CUT_OFF: Final = 1 - 1e-3
# The difference of two numbers with three figures, when slips are guessed. Relative to their size.
ROUNDED_VALUE: Final = 1e-3
# The difference of an angle from that of the intended triple: too small to fit both triples.
SAME_TRIPLE: Final = 1e-6

# The difference of a cell in the right answer from the lazy one, if their formulas are equal.
SAME_CONTENT: Final = 1e-9

# The difference of a change with the joints from the expected change.
SAME_MOTION: Final = 1e-6
# The least change between samples of a value that moves with the joints: the joints' ranges are far
# wider, and 1e-8 q is not a motion.
MOVES: Final = 0.01

# The variation of a constant over all samples.
CONSTANT: Final = 1e-9
# The variation of an entry that is printed as a number: practically none.
PRINTED_NUMBER: Final = 1e-12
# The difference of a number from a whole multiple of a letter or a fraction of π: larger, because
# the number is the remainder of a least-squares fit.
WHOLE_MULTIPLE: Final = 1e-6
# The difference of two terms (multiples of a letter, or numbers) when slips are compared.
SAME_TERM: Final = 1e-6
# The difference of a constant angle from a multiple of 15°.
MULTIPLE_OF_STEP: Final = 1e-9
# The difference of a factor between two units of length from a whole number.
SAME_FACTOR: Final = 1e-9

# The least difference from a cell of the reference at the first sample that rounding cannot
# explain, so that the table is not the reference's own.
PLAINLY_DIFFERENT: Final = 0.02
# A length is huge, and loses figures, if it is larger than the robot's lengths by this factor.
HUGE_LENGTH: Final = 100.0
# The largest error of a cell that the lost figures of a huge length can explain.
HUGE_CELL: Final = 1e-6

# The difference of a right cell from the intended table. INTENDED_CELL is for tables in the wrong
# convention or angle unit, for which both are computed from the same numbers.
UNCHANGED_CELL: Final = 1e-9
INTENDED_CELL: Final = 1e-6
# The difference of an intended table's pose from the reference's: products of rounded angles over a
# whole arm lose four figures. Relative to the arm's reach.
INTENDED_POSE: Final = 1e-2

# The difference of a matrix from the link transform of the row that was computed from it.
LINK_TRANSFORM: Final = 1e-6

# A student's arm that later parts follow from may have rounded numbers. These are the differences
# of its frames from rigid ones, and between the axes of one joint at two joint values.
NOT_RIGID: Final = 5e-3
SAME_AXIS: Final = 2e-2
# The singular value that counts as 0 for such an arm, relative to the largest one. Real arms have
# singular values of 1 %: a larger limit would refuse them at some samples and not at others.
NO_MOTION: Final = 1e-3


# --- The random values of symbols at which the answers in a submission are compared
#
# The seed is a hash of the exercise and the answers. So students cannot predict the values, and a
# regrade uses the same values to the last bit, on every machine and with every version of numpy.


_ENCODER: Final = json.JSONEncoder(sort_keys=True, separators=(",", ":"))

HALF = 16
SAMPLES = 2 * HALF

_T = TypeVar("_T")


@dataclass(frozen=True)
class Samples:
    """Random values of every symbol, each of shape ``(SAMPLES,)``.

    Both halves of the samples have the same link parameters, but different joint values: changes
    between the halves are due to the joints alone. ``in_degrees`` are the angles that are shown to
    the student in degrees. ``bare_count`` is the number of samples if there are no symbols.
    """

    values: Mapping[str, Numbers]
    in_degrees: Set[str] = frozenset()
    bare_count: int = SAMPLES

    @cached_property
    def memo(self) -> dict[str, Numbers]:
        """Memoized sines and cosines of expressions at the samples."""
        return {}

    @cached_property
    def _cache(self) -> dict[Hashable, Any]:
        return {}

    def cached(self, key: Hashable, compute: Callable[[], _T]) -> _T:
        """Return a value that depends only on the exercise and the samples, computed once.

        Do not modify the value.
        """
        if key not in self._cache:
            self._cache[key] = compute()
        found: _T = self._cache[key]
        return found

    @property
    def count(self) -> int:
        """The number of values of each symbol."""
        return next(map(len, self.values.values()), self.bare_count)

    def subset(self, count: int) -> "Samples":
        """Return a subset of the samples: the first ``count`` of each half."""
        return self.cached(
            count,
            lambda: Samples(
                {name: self.subset_of(values, count) for name, values in self.values.items()},
                bare_count=2 * count,
            ),
        )

    def with_names(self, names: Iterable[str]) -> "Samples":
        """Return a copy of the samples with random values of more symbols.

        The seed is the samples themselves, so that equal samples get equal values.
        """
        drawn = next((values.tobytes().hex() for values in self.values.values()), "")
        more = {name: 0.5 + _uniform(name + drawn, self.count) for name in sorted(names)}
        return Samples({**self.values, **more}, self.in_degrees)

    def absent_names(self, expressions: Iterable[Expression | None]) -> set[str]:
        """Return the names in the expressions that have no values in the samples."""
        names = (each.symbols for each in expressions if each is not None)
        return set[str]().union(*names).difference(self.values)

    def values_for(self, expression: Expression) -> Mapping[str, Numbers]:
        """Return the values of all symbols, including those that only the expression has."""
        absent = self.absent_names([expression])
        return self.with_names(absent).values if absent else self.values

    def renamed(self, meanings: Mapping[str, str]) -> "Samples":
        """Return a copy of the samples with more names, which ``meanings`` maps to symbols."""
        values = {name: self.values[meaning] for name, meaning in meanings.items()}
        return Samples({**self.values, **values}, self.in_degrees)

    @staticmethod
    def subset_of(values: Numbers, count: int) -> Numbers:
        """Return values ``(..., SAMPLES)`` at the same samples as ``subset``."""
        return np.concatenate([values[..., :count], values[..., HALF : HALF + count]], axis=-1)

    def at(self, sample: int, names: Set[str]) -> dict[str, float]:
        """Return the values of the named symbols in one sample, rounded to four figures."""
        units = {name: math.degrees if name in self.in_degrees else float for name in names}
        return {
            name: float(f"{units[name](values[sample]):.4g}")
            for name, values in self.values.items()
            if name in names
        }


def draw(exercise: Exercise, answers: object, *, degrees: bool = False) -> Samples:
    """Return the random values for comparing these answers to this exercise."""
    ranges = _ranges_of(_Symbols(exercise.version, exercise.variables))
    moving, count = ranges.moving, len(ranges.names)
    split = moving * SAMPLES
    seed = exercise.version + _canonical([answers, degrees])
    uniform = _uniform(seed, split + (count - moving) * HALF)
    drawn = np.empty((count, SAMPLES))
    drawn[:moving] = uniform[:split].reshape(moving, SAMPLES)
    drawn[moving:, :HALF] = drawn[moving:, HALF:] = uniform[split:].reshape(-1, HALF)
    drawn = ranges.low + ranges.width * drawn
    in_degrees = ranges.angles if degrees else frozenset[str]()
    return Samples(dict(zip(ranges.names, drawn, strict=True)), in_degrees)


@dataclass(frozen=True, slots=True)
class _Symbols:
    # Two instances are equal if the exercise versions are equal.
    version: str
    variables: tuple[Variable, ...] = field(compare=False)


@dataclass(frozen=True, slots=True)
class _Ranges:
    # ``(n, 1)``; the joint variables come first. ``moving`` is the number of joint variables,
    # ``angles`` are the names of all angles.
    names: tuple[str, ...]
    moving: int
    low: Numbers
    width: Numbers
    angles: frozenset[str]


@lru_cache(maxsize=256)
def _ranges_of(symbols: _Symbols) -> _Ranges:
    joints = [variable for variable in symbols.variables if variable.joint is not None]
    others = [variable for variable in symbols.variables if variable.joint is None]
    variables = (*joints, *others)
    return _Ranges(
        tuple(variable.name for variable in variables),
        len(joints),
        np.array([variable.low for variable in variables])[:, None],
        np.array([variable.high - variable.low for variable in variables])[:, None],
        frozenset(variable.name for variable in variables if variable.kind == "angle"),
    )


def _canonical(answers: object) -> str:
    # Text that does not depend on the order of keys.
    try:
        return _ENCODER.encode(answers)
    except (TypeError, ValueError, RecursionError):
        return "".join(_pieces(answers))


def _pieces(answers: object) -> Iterator[str]:
    # For answers that JSON cannot write, such as huge numbers and TOML's dates. Depth and cycles do
    # no harm: each list or table is entered only once.
    waiting, met = [answers], set[int]()
    while waiting:
        value = waiting.pop()
        if isinstance(value, dict | list | tuple):
            inside = list(value)
            if isinstance(value, dict):
                inside = [each for key in sorted(value, key=str) for each in (key, value[key])]
            yield f"{type(value).__name__} {len(inside)};"
            if id(value) not in met:
                met.add(id(value))
                waiting += reversed(inside)
        elif isinstance(value, bool | str | float | date | time | None):
            yield f"{value!r};"
        elif isinstance(value, int):
            # Python limits the digits of integers in decimal, but not in hexadecimal.
            yield f"{value:x};"
        else:
            yield f"{type(value).__name__};"


def _uniform(seed: str, count: int) -> Numbers:
    # Numbers in [0, 1) from an extendable hash of the seed.
    stream = hashlib.shake_128(seed.encode("utf-8", "surrogatepass")).digest(4 * count)
    return np.frombuffer(stream, dtype="<u4") * 2.0**-32


# --- Find how values change when only the joints move


def halves(values: Numbers) -> tuple[Numbers, Numbers]:
    """Split values in two halves with the same link lengths, but different joint values."""
    half = values.shape[-1] // 2
    return values[..., :half], values[..., half:]


def changes(values: Numbers) -> Numbers:
    """Return the changes ``(..., HALF)`` of values ``(..., SAMPLES)`` when only the joints move."""
    before, after = halves(values)
    return after - before


def moves_with(values: Numbers, motion: Numbers, angle: ArrayLike) -> NDArray[np.bool_]:
    """Return a mask of the values that change by ``motion`` or −``motion`` if the joints move.

    Values are ``(..., samples)``, ``motion`` is ``(..., samples / 2)``. The mask is false for NaN.
    """
    either_sign = np.array([motion, -motion])
    shape = (2, *[1] * (values.ndim - motion.ndim), *motion.shape)
    error = np.abs(difference(changes(values), either_sign.reshape(shape), angle)).max(axis=-1)
    return np.asarray(error.min(axis=0) < SAME_MOTION)


def joint_counts(
    values: Numbers, joints: tuple[Joint, ...], samples: Samples, angle: NDArray[np.bool_]
) -> tuple[NDArray[np.int_], NDArray[np.bool_]]:
    """Return the factor of each joint variable in each cell, ``(cells, joints)``, and a mask.

    The mask marks the cells that are a constant plus whole multiples of the joint variables. Angles
    are compared up to whole turns. ``values`` is ``(cells, SAMPLES)``, ``angle`` and the mask are
    ``(cells,)``.
    """
    if not joints:
        return np.zeros((len(values), 0), np.int_), np.asarray(np.isfinite(values).all(axis=-1))

    names = tuple(joint.variable for joint in joints)

    def moves_and_inverse() -> tuple[Numbers, Numbers]:
        moves = changes(np.array([samples.values[name] for name in names]))
        return moves, np.asarray(np.linalg.pinv(moves), dtype=np.float64)

    moves, solver = samples.cached(names, moves_and_inverse)
    change = np.nan_to_num(changes(values), nan=np.inf, posinf=np.inf, neginf=np.inf)
    finite = np.asarray(np.isfinite(change).all(axis=-1))
    change = np.where(finite[:, None], change, 0.0)
    counts = np.round(change @ solver)
    counts = np.clip(counts, -99, 99)
    linear = finite & (np.abs(counts @ moves - change).max(axis=-1) < SAME_MOTION)
    # Whole turns spoil the least squares; for such cells, try each joint alone.
    turned = np.flatnonzero(finite & ~linear & angle)
    if len(turned):
        either_sign = np.array([moves, -moves])
        error = difference(change[turned, None, None], either_sign, angle=True)
        found = np.abs(error).max(axis=-1) < SAME_MOTION
        for k, negative, joint in np.argwhere(found):
            counts[turned[k]], linear[turned[k]] = 0, True
            counts[turned[k], joint] = 1 - 2 * negative
    return counts.astype(np.int_), linear


def coefficients(
    values: Numbers, joints: tuple[Joint, ...], samples: Samples, angle: NDArray[np.bool_]
) -> list[tuple[int, ...] | None]:
    """Return the factors of the joint variables in each cell; None for a nonlinear cell."""
    counts, linear = joint_counts(values, joints, samples, angle)
    found = zip(counts.tolist(), linear.tolist(), strict=True)
    return [tuple(cell) if is_linear else None for cell, is_linear in found]


# --- Compare values with the expected ones
#
# Values must be equal at all samples (random joint values). Arrays are ``(..., samples)``. No
# tolerance depends on the drawn samples, so that every draw gives the same result. Decimals with at
# least three figures may be rounded.


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

    ``scale`` is the unit of the tolerance: 1 for angles, a typical length for lengths. It gives the
    tolerance an absolute minimum, so that sin² + cos² − 1 always equals 0; the minimum is far too
    small to hide a wrong constant in a large entry.
    """
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


def nearly_equal(
    one: Numbers,
    other: Numbers,
    scale: ArrayLike = 1.0,
    angle: ArrayLike = False,
    slack: float = 0.0,
) -> NDArray[np.bool_]:
    """Return a mask ``(...)`` of the values that are equal except for rounding.

    Use this only for guesses, never for a verdict. ``slack`` is a known rounding error. The
    tolerance is at least a thousandth of the size of the values; for values that are larger than
    any number of the robot, at least a thousandth of the robot's largest numbers.
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
    """True if two single values ``(samples,)`` are nearly equal, at a fifth of that cost."""
    error = one - other
    if angle:
        error -= 2 * np.pi * np.round(error / (2 * np.pi))
    size = math.sqrt(float(other @ other) / other.size)
    largest = (LARGEST_ANGLE if angle else LARGEST_LENGTH) * scale
    exact = EXACT_VALUE * scale + FLOATING_POINT * size
    tolerance = max(ROUNDED_VALUE * min(size, largest), exact, min(slack, LARGEST_SLACK * size))
    # NaN is not within any tolerance.
    return bool(np.abs(error).max() <= tolerance) and math.isfinite(size)


def _tolerance(expected: Numbers, scale: ArrayLike) -> Numbers:
    # ``np.mean`` takes as long as the rest of this function, so compute the mean directly.
    size = np.sqrt((expected * expected).sum(axis=-1) / expected.shape[-1])
    return np.asarray(EXACT_VALUE * np.asarray(scale) + FLOATING_POINT * size)


# --- Find the shifts of rounded decimals that explain a difference
#
# A rounded decimal is right if it is the true number, rounded or cut off (``decimals_of``). So an
# entry is right if shifts of its decimals, each no larger than rounding allows and the same at all
# samples, make it equal to the expected one.


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


def is_rounded(
    expression: Expression,
    expected: Numbers,
    scale: float,
    samples: Samples,
    *,
    angle: bool = False,
) -> bool:
    """True if rounding of an entry's decimals explains its difference from ``expected``.

    ``expected`` is ``(samples,)``.
    """
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
    ``units`` ``(m,)`` are the units of the decimals. Each shift is at most as large as rounding or
    cutting off allows.
    """
    count = len(units)
    steps = difference_steps(units)
    ways = np.concatenate([np.diag(steps), -np.diag(steps), np.zeros((1, count))])

    def linearised(shifts: Numbers) -> tuple[Numbers, Numbers]:
        found = errors(shifts + ways)
        return found[-1], (found[:count] - found[count:-1]).T / (2 * steps)

    return fitted_unknowns(linearised, units, count, tolerance)


def fitted_unknowns(
    linearised: Callable[[Numbers], tuple[Numbers, Numbers]],
    sizes: Numbers,
    count: int,
    tolerance: float,
) -> Numbers | None:
    """Find values of N unknowns that leave no error, or return None.

    ``linearised`` returns n errors, and their derivatives ``(n, N)`` by the unknowns. The first
    ``count`` unknowns are shifts. ``sizes`` ``(N,)`` is the direct effect of each unknown on an
    error. All unknowns are small, so that the Gauss-Newton method needs few steps.
    """
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


def difference_steps(sizes: Numbers) -> Numbers:
    """Return the step size of each unknown for computing derivatives by central differences.

    ``sizes`` is the effect of each unknown. The steps are about as large as the unknowns, and large
    compared with floating-point errors.
    """
    return np.maximum(0.5, LEAST_STEP / sizes)


class SharedDecimals:
    """The rounded decimals of several entries, which must be tested together.

    ``units`` ``(count,)`` is the last place of each decimal. ``count`` is 0 if there are no
    decimals or too many.
    """

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
        """Return ``values`` with shifted decimals, for each of K sets of shifts ``(K, count)``.

        ``values`` is ``(entries, samples)``, the result ``(K, entries, ...)``.
        """
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
