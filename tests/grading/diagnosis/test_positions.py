"""Each belief about a position: one case that it explains, one that it leaves alone."""

from collections.abc import Callable

import numpy as np
import pytest

from service.grading.comparison import Numbers
from service.grading.diagnosis import position
from service.grading.diagnosis.matrix_case import Chain
from service.grading.diagnosis.position import MISCONCEPTIONS, WrongPosition, explain_position
from service.grading.feedback import Finding
from service.grading.samples import LANES
from service.kinematics.dh import Convention

RNG = np.random.default_rng(11)
ONE, TWO = RNG.uniform(-3, 3, (2, LANES))
L1, L2 = RNG.uniform(0.3, 0.9, (2, LANES))
ZERO = np.zeros(LANES)

# The planar RR arm.
TABLE = np.array([[L1, ZERO, ZERO, ONE], [L2, ZERO, ZERO, TWO]])
TIP = np.array([L1 * np.cos(ONE), L1 * np.sin(ONE)]) + L2 * np.array(
    [np.cos(ONE + TWO), np.sin(ONE + TWO)]
)
ELBOW = np.array([L1 * np.cos(ONE), L1 * np.sin(ONE)])


def case(written: Numbers) -> WrongPosition:
    chain = Chain(TABLE, Convention.STANDARD, ("0", "1", "2"))
    return WrongPosition(written, TIP, (0, 1), 0.6, (chain,))


Belief = Callable[[WrongPosition], Finding | None]
PAIRS: list[tuple[Belief, Numbers, Numbers, str]] = [
    (position.exchanged_coordinates, TIP[::-1], TIP[::-1] + 0.1, "exchanged_coordinates"),
    (position.reversed_position, -TIP, TIP * [[1], [-1]], "reversed_position"),
    (position.other_pose, ELBOW, 2 * ELBOW, "wrong_frame"),
]


@pytest.mark.parametrize(("belief", "explained", "left", "code"), PAIRS)
def test_a_belief(belief: Belief, explained: Numbers, left: Numbers, code: str) -> None:
    finding = belief(case(explained))
    assert finding is not None
    assert finding.code == code
    assert belief(case(left)) is None


def test_every_belief_is_tested_and_tried() -> None:
    assert {pair[0] for pair in PAIRS} == set(MISCONCEPTIONS)


def test_a_right_position_is_left_alone() -> None:
    assert explain_position(case(TIP)) is None
