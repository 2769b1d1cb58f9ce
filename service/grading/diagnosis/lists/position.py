"""Slips in the coordinates of a point, taken together."""

from dataclasses import dataclass
from itertools import permutations

import numpy as np

from service.grading.diagnosis.motions.link_products import Chain, named, other_poses
from service.grading.diagnosis.upstream.slip_search import BEHIND_SIGNS, SlipSearch
from service.grading.diagnosis.wrong_value import Hypotheses, WrongNumbers
from service.grading.feedback import Finding
from service.grading.misconception import Written, diagnosed
from service.grading.numerics.tolerances import EXACT_VALUE


@dataclass(frozen=True)
class WrongPosition(WrongNumbers):
    """Wrong coordinates ``(n, SAMPLES)`` of a point, along the ``axes`` 0, 1, 2.

    ``chains`` holds the links that lead to the point, where it is the end of a chain.
    """

    axes: tuple[int, ...]
    chains: tuple[Chain, ...] = ()


def exchanged_coordinates(case: WrongPosition) -> Hypotheses:
    """The coordinates are right, but stand in the wrong places."""
    names = ", ".join("xyz"[axis] for axis in case.axes)
    finding = Finding(
        "exchanged_coordinates",
        f"These coordinates are in the wrong order: it must be {names}.",
    )
    for order in permutations(range(len(case.axes))):
        yield Written(case.expected[list(order)], finding)


def reversed_position(case: WrongPosition) -> Hypotheses:
    """The vector was taken from the point to the origin."""
    finding = Finding(
        "reversed_position",
        "Every coordinate has the wrong sign: check where the vector must start and end.",
    )
    yield Written(-case.expected, finding)


def other_pose(case: WrongPosition) -> Hypotheses:
    """The position was taken from another pose of the chain.

    A constant position, such as the origin itself, does not show where it was taken from.
    """
    for pose in other_poses(case.chains):
        position = np.moveaxis(pose.answer, 0, -1)[list(case.axes), 3]
        if np.ptp(position, axis=-1).max() > EXACT_VALUE:
            yield Written(position, named(pose, "This position comes from"))


LIKELIER = (exchanged_coordinates, reversed_position)
MISCONCEPTIONS = (*LIKELIER, other_pose)


def explain_position(case: WrongPosition, slips: SlipSearch | None) -> Finding | None:
    """What explains all coordinates: themselves, a slip of the table, or another pose."""
    whole = diagnosed(case, LIKELIER)
    if whole is None or whole.code == "reversed_position":
        slip = slips and slips.finding(np.ones(len(case.axes), dtype=np.bool_))
        # A position that is reversed is half a turn off, too; a length says more.
        if slip and (whole is None or slip.code not in BEHIND_SIGNS):
            return slip
    return whole or diagnosed(case, (other_pose,))
