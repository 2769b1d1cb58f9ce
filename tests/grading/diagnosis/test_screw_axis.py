"""Each misconception about a screw axis: one axis that it explains, one that it leaves alone."""

from collections.abc import Callable

import numpy as np
import pytest

from service.grading.diagnosis import screw_axis
from service.grading.diagnosis.screw_axis import MISCONCEPTIONS, WrongScrew, explain_screw
from service.grading.feedback import Finding
from service.grading.samples import SAMPLES
from service.kinematics.transforms import Numbers

RNG = np.random.default_rng(9)
LENGTH = RNG.uniform(0.3, 0.9, SAMPLES)
PITCH = RNG.uniform(0.1, 0.4, SAMPLES)


def axis(*numbers: Numbers | float) -> Numbers:
    return np.array([np.zeros(SAMPLES) + number for number in numbers])


# The axis along z through (l, 0, 0), from the base; the tool lies at (2l, 0, 0).
TURN = axis(0, 0, 1, 0, -LENGTH, 0)
TURN_SEEN_FROM_TOOL = axis(0, 0, 1, 0, LENGTH * 2 - LENGTH, 0)
SCREW = axis(0, 0, 1, 0, -LENGTH, PITCH)
SLIDE = axis(0, 0, 0, 1, 0, 0)


def case(actual: Numbers, expected: Numbers = TURN, elsewhere: Numbers | None = None) -> WrongScrew:
    return WrongScrew(actual, expected, elsewhere, "space", 0.5)


Misconception = Callable[[WrongScrew], Finding | None]
# An axis seen from a third place, so that the other frame is told from the sign of the moment.
ELSEWHERE = axis(0, 0, 1, 0.2, LENGTH, 0)
PAIRS: list[tuple[Misconception, WrongScrew, WrongScrew, str]] = [
    (
        screw_axis.other_frame,
        case(ELSEWHERE, TURN, ELSEWHERE),
        case(axis(0, 0, 1, 0.3, 0, 0), TURN, ELSEWHERE),
        "body_for_space",
    ),
    (
        screw_axis.moment_sign,
        case(axis(0, 0, 1, 0, LENGTH, PITCH), SCREW),
        case(axis(0, 0, 1, 0, LENGTH, -PITCH), SCREW),
        "moment_sign",
    ),
    (screw_axis.axis_reversed, case(-SCREW, SCREW), case(-SLIDE + 0.1, SLIDE), "axis_reversed"),
    (
        screw_axis.not_normalised,
        case(3 * TURN),
        case(axis(0, 0, 3, 0, -LENGTH, 0)),
        "not_normalised",
    ),
    (
        screw_axis.sliding_as_turning,
        case(axis(1, 0, 0, 0, 0, 0), SLIDE),
        case(axis(0, 1, 0, 0, 0, 0), SLIDE),
        "infinite_pitch",
    ),
    (
        screw_axis.turning_as_sliding,
        case(axis(0, 0, 0, 0, 0, 1)),
        case(axis(0, 0, 0, 0, 1, 0)),
        "infinite_pitch",
    ),
    (
        screw_axis.exchanged_halves,
        case(axis(0, -LENGTH, 0, 0, 0, 1)),
        case(axis(0, LENGTH, 0, 0, 0, 1)),
        "exchanged_halves",
    ),
    (
        screw_axis.point_for_velocity,
        case(axis(0, 0, 1, LENGTH, 0, 0.4)),
        case(axis(0, 0, 1, 0, LENGTH, 0)),
        "point_for_velocity",
    ),
    (
        screw_axis.pitch,
        case(axis(0, 0, 1, 0, -LENGTH, 0), SCREW),
        case(axis(0, 0, 1, 0, LENGTH, 0), SCREW),
        "pitch",
    ),
]


@pytest.mark.parametrize(("misconception", "explained", "left", "code"), PAIRS)
def test_a_misconception(
    misconception: Misconception, explained: WrongScrew, left: WrongScrew, code: str
) -> None:
    finding = misconception(explained)
    assert finding is not None
    assert finding.code == code
    assert finding.hint
    assert misconception(left) is None


def test_every_misconception_is_tested_and_tried() -> None:
    assert {pair[0] for pair in PAIRS} == set(MISCONCEPTIONS)


@pytest.mark.parametrize("right", [TURN, SCREW, SLIDE])
def test_a_right_axis_is_left_alone(right: Numbers) -> None:
    assert explain_screw(case(right, right, TURN_SEEN_FROM_TOOL)) is None


def test_an_axis_without_values_is_left_alone() -> None:
    assert explain_screw(case(TURN * np.nan)) is None
