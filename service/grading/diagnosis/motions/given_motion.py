"""Split a composite motion into turns and displacements.

A displacement is the sum of the terms of a position that are turned by the same angles. A turn is
the rotation that remains if all angles except one are 0.
"""

# An exercise gives the motion in formulas. The turns before a displacement are those whose angles
# change it.

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, reduce
from itertools import chain, permutations

import numpy as np

from service.catalogue import Exercise, FormulaGrid, grid_values
from service.expressions import Expression
from service.grading.numerics.samples import Samples
from service.grading.numerics.tolerances import EXACT_VALUE
from service.kinematics.transforms import Matrices, Numbers

# With more turns, they are not told apart.
MAX_TURNS = 4


@dataclass(frozen=True, slots=True)
class Displacement:
    """A term of a position, which contains ``lengths`` and is turned by ``angles``."""

    lengths: tuple[str, ...]
    angles: tuple[str, ...]


IN_NUMBERS = Displacement((), ())


@dataclass(frozen=True)
class GivenMotion:
    """A composite motion, which an exercise gives in formulas."""

    # A position (one row), a rotation or a transform.
    grid: FormulaGrid
    # The values of the symbols at count samples.
    values: Mapping[str, Numbers]
    count: int
    # The symbols in the formulas.
    angles: tuple[str, ...]
    lengths: tuple[str, ...]

    @classmethod
    def of(cls, part_id: str, exercise: Exercise, samples: Samples) -> "GivenMotion | None":
        """Return the motion that an exercise gives in formulas, or None without formulas."""
        grid = exercise.formulas.get(part_id)
        if grid is None:
            return None
        used = {name for formula in chain(*grid) for name in formula.symbols}
        of_kind = {
            kind: tuple(v.name for v in exercise.variables if v.kind == kind and v.name in used)
            for kind in ("angle", "length")
        }
        angles = of_kind["angle"] if len(of_kind["angle"]) <= MAX_TURNS else ()
        return cls(grid, samples.values, samples.count, angles, of_kind["length"])

    def position(self, zeros: Iterable[str] = ()) -> Numbers:
        """Return the n coordinates ``(n, samples)`` of the position.

        The symbols ``zeros`` are set to 0.
        """
        column = self.grid[0] if len(self.grid) == 1 else [row[3] for row in self.grid[:3]]
        return np.asarray(self._numbers([column], zeros)[0])

    def rotation(self, zeros: Iterable[str] = ()) -> Numbers:
        """Return the rotation ``(3, 3, samples)`` with the symbols ``zeros`` set to 0."""
        return self._numbers([row[:3] for row in self.grid[:3]], zeros)

    def _numbers(self, grid: Sequence[Sequence[Expression]], zeros: Iterable[str]) -> Numbers:
        values = {**self.values, **{name: np.zeros(self.count) for name in zeros}}
        with np.errstate(all="ignore"):
            return grid_values(tuple(map(tuple, grid)), values, self.count)

    def part(self, displacement: Displacement, straight: Sequence[str] = ()) -> Numbers:
        """Return the values of one displacement, with the angles ``straight`` set to 0."""
        key = displacement.lengths, tuple(straight)
        if key not in self._parts:
            self._parts[key] = self._part(displacement, straight)
        return self._parts[key]

    @cached_property
    def _parts(self) -> dict[tuple[tuple[str, ...], tuple[str, ...]], Numbers]:
        return {}

    def _part(self, displacement: Displacement, straight: Sequence[str]) -> Numbers:
        others = [name for name in self.lengths if name not in displacement.lengths]
        alone = self.position((*others, *straight))
        # The terms without a length are a displacement in numbers.
        return alone - self.position((*self.lengths, *straight)) if displacement.lengths else alone

    @cached_property
    def displacements(self) -> list[Displacement]:
        """The displacements that sum to the position, or an empty list."""
        # Displacements with few turns before them come first.
        by_angles: dict[tuple[str, ...], list[str]] = {}
        for name in self.lengths:
            by_angles.setdefault(self._turning(Displacement((name,), ())), []).append(name)
        found = [Displacement(tuple(names), angles) for angles, names in by_angles.items()]
        if not _is_zero(self.part(IN_NUMBERS)):
            found.append(replace(IN_NUMBERS, angles=self._turning(IN_NUMBERS)))
        rest = self.position() - sum(map(self.part, found), np.zeros(1))
        return sorted(found, key=lambda each: len(each.angles)) if _is_zero(rest) else []

    def _turning(self, displacement: Displacement) -> tuple[str, ...]:
        right = self.part(displacement)
        return tuple(
            angle for angle in self.angles if not _is_zero(self.part(displacement, [angle]) - right)
        )

    @cached_property
    def order(self) -> tuple[str, ...] | None:
        """The angles in the order of their turns. None if the rotation is no product of turns."""
        if not self.angles or not _is_zero(self.rotation(self.angles) - np.eye(3)[..., None]):
            return None
        right = self.rotation()
        fits = (each for each in permutations(self.angles) if _is_zero(self.turned(each) - right))
        return next(fits, None)

    def turned(self, order: Sequence[str]) -> Numbers:
        """Return the product ``(3, 3, samples)`` of the turns in this order."""
        return np.moveaxis(product([self._turns[angle] for angle in order]), 0, -1)

    @cached_property
    def _turns(self) -> dict[str, Matrices]:
        # The rotation (samples, 3, 3) about each angle, with all other angles 0.
        return {
            angle: np.moveaxis(self.rotation(set(self.angles) - {angle}), -1, 0)
            for angle in self.angles
        }

    @cached_property
    def steps(self) -> list[Matrices] | None:
        """The motions ``(samples, 4, 4)`` whose product is the whole motion, or None."""
        # Each of them is a displacement and then a turn.
        if self.order is None or len(self.displacements) > len(self.order) + 1:
            return None
        places = {frozenset(self.order[:i]): i for i in range(len(self.order) + 1)}
        steps = [np.tile(np.eye(4), (self.count, 1, 1)) for _ in places]
        for step, angle in zip(steps, self.order, strict=False):
            step[:, :3, :3] = self._turns[angle]
        for displacement in self.displacements:
            place = places.get(frozenset(displacement.angles))
            if place is None:
                return None
            steps[place][:, :3, 3] = self.part(displacement, self.angles).T
        error = np.moveaxis(product(steps), 0, -1) - self._numbers(self.grid, ())
        return steps if _is_zero(error) else None


def _is_zero(numbers: Numbers) -> bool:
    return bool(np.abs(numbers).max(initial=0.0) < EXACT_VALUE)


def product(matrices: Sequence[Matrices]) -> Matrices:
    """Return the product of matrices ``(samples, n, n)``."""
    return np.asarray(reduce(np.matmul, matrices))
