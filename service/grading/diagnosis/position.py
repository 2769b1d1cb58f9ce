"""Slips in the coordinates of a point, taken together.

Each function is one misconception that the student may have held. It returns what to say where the
coordinates without that misconception are right, else None.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import permutations

import numpy as np

from service.grading.comparison import Match, matches
from service.grading.diagnosis.link_products import alternatives
from service.grading.diagnosis.matrix_case import Chain
from service.grading.feedback import Finding
from service.grading.tolerances import EXACT_VALUE
from service.kinematics.transforms import Numbers


@dataclass(frozen=True, slots=True)
class WrongPosition:
    """Coordinates ``(n, SAMPLES)`` of the ``axes`` 0, 1, 2, as handed in and as expected.

    ``chains`` holds the links that lead to the point, where it is the end of a chain.
    """

    actual: Numbers
    expected: Numbers
    axes: tuple[int, ...]
    scale: float
    chains: tuple[Chain, ...] = ()

    def is_what_was_written(self, other: Numbers) -> bool:
        """Whether the coordinates handed in are ``other``, and those expected are not."""
        written, right = (
            (matches(one, other, self.scale) >= Match.ROUNDED).all()
            for one in (self.actual, self.expected)
        )
        return bool(written and not right)


def exchanged_coordinates(case: WrongPosition) -> Finding | None:
    """The coordinates are right, but stand in the wrong places."""
    for order in permutations(range(len(case.axes))):
        if case.is_what_was_written(case.expected[list(order)]):
            names = ", ".join("xyz"[axis] for axis in case.axes)
            return Finding(
                "exchanged_coordinates",
                f"These coordinates stand in each other's places: the order is {names}.",
            )
    return None


def reversed_position(case: WrongPosition) -> Finding | None:
    """The vector was taken from the point to the origin."""
    if not case.is_what_was_written(-case.expected):
        return None
    return Finding(
        "reversed_position",
        "Every coordinate has the wrong sign: the vector leads from the origin of the first frame "
        "to the point.",
    )


def other_pose(case: WrongPosition) -> Finding | None:
    """The position was taken from another pose of the chain.

    A constant one, such as the origin itself, is no sign of where it came from.
    """
    for alternative in alternatives(case.chains):
        position = np.moveaxis(alternative.pose, 0, -1)[list(case.axes), 3]
        if np.ptp(position, axis=-1).max() > EXACT_VALUE and case.is_what_was_written(position):
            look = f"This position comes from {alternative.what}. {alternative.hint}"
            return Finding(alternative.code, look, alternative.correction)
    return None


MISCONCEPTIONS: tuple[Callable[[WrongPosition], Finding | None], ...] = (
    exchanged_coordinates,
    reversed_position,
    other_pose,
)


def explain_position(case: WrongPosition) -> Finding | None:
    """The first misconception that explains the coordinates together."""
    for misconception in MISCONCEPTIONS:
        finding = misconception(case)
        if finding is not None:
            return finding
    return None
