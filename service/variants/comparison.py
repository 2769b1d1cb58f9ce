"""Compare variants of an exercise by their robot and by their difficulty."""

from dataclasses import astuple, dataclass
from typing import Final, TypeAlias

import numpy as np

from service.catalogue import Exercise, Robot, grid_values
from service.kinematics.chain import ALPHA, A, D
from service.kinematics.transforms import Numbers

# Numbers of a file have a few decimals; what is closer is the same.
_DECIMALS: Final = 6
_QUARTER: Final = np.pi / 2

# The joints, the axes and the pose at home, and the answers in the file, as rounded numbers.
Form: TypeAlias = tuple[str, tuple[float, ...]]


@dataclass(frozen=True, slots=True)
class VariantDifficulty:
    """Counts of what makes a robot hard.

    ``turns`` counts the twists (α) that are not 0, and ``odd_twists`` those that are not multiples
    of 90°. ``free`` counts the pairs of parallel neighbouring axes.
    """

    # A table of variants shows each count in a column. On parallel axes, a frame may be chosen.

    joints: int = 0
    sliding: int = 0
    turns: int = 0
    odd_twists: int = 0
    lengths: int = 0
    free: int = 0

    @property
    def score(self) -> int:
        """The difficulty as one number."""
        # It is the sum of the counts; ``odd_twists`` has three times the weight.
        counts: tuple[int, ...] = astuple(self)
        return sum(counts) + 2 * self.odd_twists


def form_of(exercise: Exercise) -> Form:
    """Describe an exercise so that variants with the same answers get equal descriptions."""
    # It does not depend on frames chosen or on texts.
    values = _home(exercise)
    numbers: list[float] = []
    if exercise.reference is not None:
        numbers += exercise.reference.screws(values, 1).ravel().tolist()
        numbers += exercise.reference.frame("tool", values, 1).ravel().tolist()
    moved = {name: value + 0.37 for name, value in values.items()}
    for name in sorted(exercise.formulas):
        numbers += grid_values(exercise.formulas[name], moved, 1).ravel().tolist()
    # The sum makes 0 of −0.
    rounded = tuple(round(number, _DECIMALS) + 0.0 for number in numbers)
    return exercise.structure or "", rounded


def difficulty_of(exercise: Exercise) -> VariantDifficulty:
    """Return what makes an exercise hard."""
    # All counts are 0 without a table.
    if not isinstance(exercise.reference, Robot):
        return VariantDifficulty(joints=len(exercise.joints))
    robot = exercise.reference
    table = robot.tables[robot.convention].values(_home(exercise), 1)[..., 0]
    twists = np.abs(table[:, ALPHA]) % np.pi
    twists = np.minimum(twists, np.pi - twists)
    turned = twists > 10.0**-_DECIMALS
    odd = turned & (np.abs(twists - _QUARTER) > 10.0**-_DECIMALS)
    return VariantDifficulty(
        joints=len(robot.joints),
        sliding=sum(joint.prismatic for joint in robot.joints),
        turns=int((np.abs(table[:, ALPHA]) > 10.0**-_DECIMALS).sum()),
        odd_twists=int(odd.sum()),
        lengths=int((np.abs(table[:, [A, D]]) > 10.0**-_DECIMALS).sum()),
        free=int((~turned).sum()),
    )


def _home(exercise: Exercise) -> dict[str, Numbers]:
    return {
        variable.name: np.array([0.0 if variable.joint is not None else 0.31 + 0.0713 * i])
        for i, variable in enumerate(exercise.variables)
    }
