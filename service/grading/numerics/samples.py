"""The random values of symbols at which the answers in a submission are compared.

The seed is a hash of the exercise and the answers, so that a regrade uses the same values.
"""

# So students cannot predict the values, and a regrade uses them to the last bit, on every machine
# and with every version of numpy.

import hashlib
import json
import math
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Set
from dataclasses import dataclass, field
from datetime import date, time
from functools import cached_property, lru_cache
from typing import Any, Final, TypeVar

import numpy as np

from service.catalogue import Exercise, Variable
from service.expressions import Expression
from service.kinematics.transforms import Numbers

_ENCODER: Final = json.JSONEncoder(sort_keys=True, separators=(",", ":"))

HALF = 16
SAMPLES = 2 * HALF

_T = TypeVar("_T")


@dataclass(frozen=True)
class Samples:
    """Random values of every symbol, each of shape ``(SAMPLES,)``.

    Both halves of the samples have the same link parameters, but different joint values.
    """

    # Changes between the halves are due to the joints alone. ``in_degrees`` are the angles that are
    # shown to the student in degrees. ``bare_count`` is the number of samples if there are no
    # symbols.
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
        """Return a copy of the samples with random values of more symbols."""
        # The seed is the samples themselves, so that equal samples get equal values.
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
        """Return values ``(..., SAMPLES)`` at a subset of the samples."""
        # The same subset as in ``subset``.
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
