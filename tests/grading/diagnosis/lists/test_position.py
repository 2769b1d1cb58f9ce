"""Test the misconceptions about the coordinates of a point."""

import numpy as np
from dh_grader.grading.diagnosis import lists as position
from dh_grader.grading.diagnosis.lists import WrongPosition
from dh_grader.grading.diagnosis.motions import Chain
from dh_grader.grading.misconception import diagnosed
from dh_grader.grading.numbers import SAMPLES
from dh_grader.kinematics import Convention, Numbers

from tests.grading.diagnosis.pairs import Pair, assert_explains_only_the_first, each_pair

RNG = np.random.default_rng(11)
ONE, TWO = RNG.uniform(-3, 3, (2, SAMPLES))
L1, L2 = RNG.uniform(0.3, 0.9, (2, SAMPLES))
ZERO = np.zeros(SAMPLES)

# The planar RR arm.
TABLE = np.array([[L1, ZERO, ZERO, ONE], [L2, ZERO, ZERO, TWO]])
TIP = np.array([L1 * np.cos(ONE), L1 * np.sin(ONE)]) + L2 * np.array(
    [np.cos(ONE + TWO), np.sin(ONE + TWO)]
)
ELBOW = np.array([L1 * np.cos(ONE), L1 * np.sin(ONE)])


def case(written: Numbers) -> WrongPosition:
    chain = Chain(TABLE, Convention.STANDARD, ("0", "1", "2"))
    return WrongPosition(written, TIP, 0.6, (0, 1), (chain,))


PAIRS = [
    Pair(position.exchanged_coordinates, case(TIP[::-1]), case(TIP[::-1] + 0.1)),
    Pair(position.reversed_position, case(-TIP), case(TIP * [[1], [-1]])),
    Pair(position.length_unit, case(1000 * TIP), case(700 * TIP), "other_length_unit"),
    Pair(position.other_pose, case(ELBOW), case(2 * ELBOW), "wrong_frame"),
]


@each_pair(PAIRS)
def test_a_misconception_explains_only_its_case(pair: Pair) -> None:
    assert_explains_only_the_first(pair)


def test_a_right_position_gets_no_finding() -> None:
    assert diagnosed(case(TIP)) is None
