"""Each misconception about a position: one case that it explains, one that it leaves alone."""

from collections.abc import Callable

import numpy as np
import pytest

from service.grading.diagnosis import position
from service.grading.diagnosis.matrix_case import Chain
from service.grading.diagnosis.position import MISCONCEPTIONS, WrongPosition, explain_position
from service.grading.feedback import Finding
from service.grading.samples import SAMPLES
from service.kinematics.dh import Convention
from service.kinematics.transforms import Numbers

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
    return WrongPosition(written, TIP, (0, 1), 0.6, (chain,))


Misconception = Callable[[WrongPosition], Finding | None]
PAIRS: list[tuple[Misconception, Numbers, Numbers, str]] = [
    (position.exchanged_coordinates, TIP[::-1], TIP[::-1] + 0.1, "exchanged_coordinates"),
    (position.reversed_position, -TIP, TIP * [[1], [-1]], "reversed_position"),
    (position.other_pose, ELBOW, 2 * ELBOW, "wrong_frame"),
]


@pytest.mark.parametrize(("misconception", "explained", "left", "code"), PAIRS)
def test_a_misconception(
    misconception: Misconception, explained: Numbers, left: Numbers, code: str
) -> None:
    finding = misconception(case(explained))
    assert finding is not None
    assert finding.code == code
    assert misconception(case(left)) is None


def test_every_misconception_is_tested_and_tried() -> None:
    assert {pair[0] for pair in PAIRS} == set(MISCONCEPTIONS)


def test_a_right_position_is_left_alone() -> None:
    assert explain_position(case(TIP)) is None
