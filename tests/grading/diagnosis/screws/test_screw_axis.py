"""Test the misconceptions about a screw axis."""

import numpy as np
import pytest
from dh_grader.grading.diagnosis import screws_and_placements as screw_axis
from dh_grader.grading.diagnosis.screws_and_placements import WrongScrew, explain_screw
from dh_grader.grading.numbers import SAMPLES
from dh_grader.kinematics import Numbers

from tests.grading.diagnosis.pairs import Pair, assert_explains_only_the_first, each_pair

RNG = np.random.default_rng(9)
LENGTH = RNG.uniform(0.3, 0.9, SAMPLES)
PITCH = RNG.uniform(0.1, 0.4, SAMPLES)


def axis(*numbers: Numbers | float) -> Numbers:
    return np.array([np.zeros(SAMPLES) + number for number in numbers])


# The axis along z through (l, 0, 0) in the base frame; the tool is at (2l, 0, 0).
TURN = axis(0, 0, 1, 0, -LENGTH, 0)
TURN_SEEN_FROM_TOOL = axis(0, 0, 1, 0, LENGTH * 2 - LENGTH, 0)
SCREW = axis(0, 0, 1, 0, -LENGTH, PITCH)
SLIDE = axis(0, 0, 0, 1, 0, 0)


def case(actual: Numbers, expected: Numbers = TURN, elsewhere: Numbers | None = None) -> WrongScrew:
    scale = np.repeat([1.0, 0.5], 3)
    return WrongScrew(actual, expected, scale, elsewhere, "space")


# In a third frame, so that it differs from the axis with the other sign of v.
ELSEWHERE = axis(0, 0, 1, 0.2, LENGTH, 0)
PAIRS = [
    Pair(
        screw_axis.screw_axis_other_frame,
        case(ELSEWHERE, TURN, ELSEWHERE),
        case(axis(0, 0, 1, 0.3, 0, 0), TURN, ELSEWHERE),
        "body_for_space",
    ),
    Pair(
        screw_axis.moment_sign,
        case(axis(0, 0, 1, 0, LENGTH, PITCH), SCREW),
        case(axis(0, 0, 1, 0, LENGTH, -PITCH), SCREW),
        "moment_sign",
    ),
    Pair(screw_axis.axis_reversed, case(-SCREW, SCREW), case(-SLIDE + 0.1, SLIDE), "axis_reversed"),
    Pair(
        screw_axis.not_normalised,
        case(3 * TURN),
        case(axis(0, 0, 3, 0, -LENGTH, 0)),
        "not_normalised",
    ),
    Pair(
        screw_axis.sliding_as_turning,
        case(axis(1, 0, 0, 0, 0, 0), SLIDE),
        case(axis(0, 0, 0, 0, 1, 0), SLIDE),
        "infinite_pitch",
    ),
    Pair(
        screw_axis.turning_as_sliding,
        case(axis(0, 0, 0, 0, 0, 1)),
        case(axis(0, 0, 0, 0, 1, 0)),
        "infinite_pitch",
    ),
    Pair(
        screw_axis.screw_axis_exchanged_halves,
        case(axis(0, -LENGTH, 0, 0, 0, 1)),
        case(axis(0, LENGTH, 0, 0, 0, 1)),
        "exchanged_halves",
    ),
    Pair(
        screw_axis.point_for_velocity,
        case(axis(0, 0, 1, LENGTH, 0, 0.4)),
        case(axis(0, 0, 1, 0, LENGTH, 0)),
        "point_for_velocity",
    ),
    Pair(
        screw_axis.pitch,
        case(axis(0, 0, 1, 0, -LENGTH, 0), SCREW),
        case(axis(0, 0, 1, 0, LENGTH, 0), SCREW),
        "pitch",
    ),
    Pair(
        screw_axis.point_off_axis,
        case(axis(0, 0, 1, 0.4, LENGTH / 2, PITCH), SCREW),
        case(axis(0, 0, 1, 0.4, LENGTH / 2, 0), SCREW),
    ),
    Pair(
        screw_axis.other_direction,
        case(axis(0, 0.6, 0.8, 0.4, 0, 0)),
        case(axis(0, 0, -1, 0.4, 0, 0)),
    ),
]


@pytest.mark.parametrize("direction", [(0, 0, 1), (0.6, 0, 0.8)])
def test_a_slide_along_another_line_is_explained(direction: tuple[float, float, float]) -> None:
    finding = explain_screw(case(axis(0, 0, 0, *direction), SLIDE))
    assert finding is not None
    assert finding.code == "other_direction"
    assert "v is not along the axis" in finding.hint


@each_pair(PAIRS)
def test_a_misconception_explains_only_its_case(pair: Pair) -> None:
    assert_explains_only_the_first(pair)


@pytest.mark.parametrize("right", [TURN, SCREW, SLIDE])
def test_a_right_axis_gets_no_finding(right: Numbers) -> None:
    assert explain_screw(case(right, right, TURN_SEEN_FROM_TOOL)) is None


def test_an_axis_without_values_gets_no_finding() -> None:
    assert explain_screw(case(TURN * np.nan)) is None
