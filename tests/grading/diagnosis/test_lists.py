"""Test misconceptions in angles and positions."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.expressions import Symbol, Vocabulary, read
from dh_grader.grading import FeedbackLevel
from dh_grader.grading.diagnosis import lists as angle
from dh_grader.grading.diagnosis import lists as angle_sum
from dh_grader.grading.diagnosis import lists as euler_triple
from dh_grader.grading.diagnosis import lists as position
from dh_grader.grading.diagnosis.lists import (
    WrongPosition,
    WrongSum,
    WrongTriple,
    diagnose_angle,
    explain_triple,
)
from dh_grader.grading.diagnosis.motions import Chain
from dh_grader.grading.misconception import WrongValue, diagnosed, undefined
from dh_grader.grading.numbers import SAMPLES, Samples
from dh_grader.grading.report import Correction
from dh_grader.kinematics import Convention, Numbers
from scipy.spatial.transform import Rotation

from tests.grading.diagnosis.pairs import Pair, assert_explains_only_the_first, each_pair
from tests.grading.support.submitting import HEAD, Make, all_codes, handed_in, part

# --- Test the misconceptions about a single angle

RNG = np.random.default_rng(8)
VALUES = {"q1": RNG.uniform(-3, 3, SAMPLES), "q2": RNG.uniform(-3, 3, SAMPLES)}
WORDS = Vocabulary([Symbol("q1", "angle"), Symbol("q2", "angle")])


def wrong(text: str, expected: str) -> WrongValue:
    expression = read(text, WORDS, quantity="angle")
    right = read(expected, WORDS, quantity="angle")
    zeros = np.zeros(SAMPLES)
    return WrongValue(
        expression=expression,
        actual=zeros + expression.evaluate(VALUES),
        expected=zeros + right.evaluate(VALUES),
        correction=Correction(expected, expected),
        samples=Samples(VALUES),
        scale=1.0,
        angle=True,
    )


PAIRS = [
    Pair(undefined, wrong("1/0", "q1"), wrong("q2", "q1")),
    Pair(angle.sign, wrong("-q1", "q1"), wrong("-q1 + 0.1", "q1")),
    Pair(angle.degrees_as_radians, wrong("90", "pi/2"), wrong("91", "pi/2")),
    Pair(angle.radians_as_degrees, wrong("pi*pi/360", "pi/2"), wrong("pi/180", "pi/2")),
    Pair(angle.lost_quadrant, wrong("atan(sin(q1)/cos(q1))", "q1"), wrong("q1 + pi", "q1")),
    Pair(
        angle.lost_sign,
        wrong("acos(cos(q1))", "q1"),
        wrong("acos(cos(q1)/2)", "q1"),
        "lost_quadrant",
    ),
    Pair(angle.half_turn, wrong("q1 - pi", "q1"), wrong("q1 + pi/2", "q1")),
    Pair(angle.swapped_atan2, wrong("atan2(cos(q1), sin(q1))", "q1"), wrong("0", "pi/2")),
    Pair(angle.quarter_turn, wrong("0", "pi/2"), wrong("q1 + pi", "q1")),
]


@each_pair(PAIRS)
def test_a_misconception_explains_only_its_case(pair: Pair) -> None:
    assert_explains_only_the_first(pair)


def test_an_unexplained_angle_gets_a_counterexample() -> None:
    finding = diagnose_angle(wrong("q1 + 0.5", "q1"))
    assert finding.code == "value"
    assert finding.values is not None


def test_asin_loses_the_quadrant() -> None:
    finding = diagnose_angle(wrong("asin(sin(q1))", "q1"))
    assert finding.code == "lost_quadrant"
    assert "asin" in finding.hint


def test_an_arctangent_in_a_sum_need_not_be_exchanged() -> None:
    """Exchanging the arguments of atan2(0, 1) + π/2 gives π, not 0."""
    assert diagnose_angle(wrong("atan2(0, 1) + pi/2", "0")).code == "quarter_turn"
    assert diagnose_angle(wrong("atan2(1, 0)", "0")).code == "swapped_atan2"


# --- Test the misconceptions about a sum of angles

ANGLE_SUM_RNG = np.random.default_rng(12)
NAMES = ("q1", "q2", "q3", "q4")
ANGLE_SUM_VALUES = {name: ANGLE_SUM_RNG.uniform(-3, 3, SAMPLES) for name in (*NAMES, "l")}
ANGLE_SUM_WORDS = Vocabulary([*(Symbol(name, "angle") for name in NAMES), Symbol("l", "length")])
RIGHT = "q1 + q2 + q3 - pi/2"


def angle_sum_wrong(text: str, expected: str = RIGHT) -> WrongValue:
    expression, right = (read(each, ANGLE_SUM_WORDS, quantity="angle") for each in (text, expected))
    zeros = np.zeros(SAMPLES)
    return WrongValue(
        expression=expression,
        actual=zeros + expression.evaluate(ANGLE_SUM_VALUES),
        expected=zeros + right.evaluate(ANGLE_SUM_VALUES),
        samples=Samples(ANGLE_SUM_VALUES),
        scale=1.0,
        angle=True,
    )


ANGLE_SUM_PAIRS = [
    Pair(
        angle_sum.left_out,
        angle_sum_wrong("q3 - 90deg"),
        angle_sum_wrong("q3"),
        "joint_variable_missing",
    ),
    Pair(
        angle_sum.reversed_addends,
        angle_sum_wrong("q1 - q2 + q3 - pi/2"),
        angle_sum_wrong("q1 - q2 - pi/2"),
        "joint_variable_sign",
    ),
    Pair(
        angle_sum.counted_twice,
        angle_sum_wrong("q1 + 2q2 + q3 - pi/2"),
        angle_sum_wrong("q1 + 3q2 + q3 - pi/2"),
        "joint_variable_doubled",
    ),
    Pair(
        angle_sum.added,
        angle_sum_wrong("q1 + q2 + q3 - q4 - pi/2"),
        angle_sum_wrong("q1 + q2 + q4 - pi/2"),
        "joint_variable_extra",
    ),
    Pair(
        angle_sum.of_another_joint,
        angle_sum_wrong("q1 + q2 + q4 - pi/2"),
        angle_sum_wrong("q1 + q4 - pi/2"),
        "joint_variable_index",
    ),
    Pair(
        angle_sum.constant, angle_sum_wrong("0.3"), angle_sum_wrong("q4"), "joint_variable_missing"
    ),
]
ANGLE_SUM_PAIRS = [pair._replace(source=WrongSum.of) for pair in ANGLE_SUM_PAIRS]


@each_pair(ANGLE_SUM_PAIRS)
def test_a_misconception_explains_only_its_sum_of_angles(pair: Pair) -> None:
    assert_explains_only_the_first(pair)


def test_a_missing_angle_is_named_unless_it_is_the_answer() -> None:
    assert diagnose_angle(angle_sum_wrong("q3 - pi/2")).hint.startswith("q1 and q2 are missing")
    assert diagnose_angle(angle_sum_wrong("q2+q3 - pi/2")).hint.startswith("q1 is missing")
    # If the angle is that of a single joint, its name would be the answer.
    assert "q1" not in diagnose_angle(angle_sum_wrong("0", "q1")).hint


def test_an_angle_that_is_no_sum_has_no_addends() -> None:
    assert angle_sum.addends(angle_sum_wrong("q1", "q1*q2")) == {}
    assert angle_sum.addends(angle_sum_wrong("q1", "2.5q1")) == {}
    assert angle_sum.addends(replace(angle_sum_wrong("q1", "-2q1 + 1"))) == {"q1": -2}


PLANAR_4R = f"""{HEAD}
[robot]
structure = "RRRR"
convention = "standard"
joints = ["q1", "q2", "q3", "q4"]
table = [["l", "0", "0", "q1"], ["l", "0", "0", "q2"], ["l", "0", "0", "q3"], ["l", "0", "0", "q4"]]
[symbols]
l = {{ kind = "length", description = "each link" }}
[[parts]]
id = "it"
kind = "vector"
title = "It"
points = 6
components = [
    {{ name = "x", quantity = "length", expected = "l*(c1 + c12 + c123 + c1234)" }},
    {{ name = "phi", quantity = "angle", expected = "q1 + q2 + q3 + q4" }},
]
"""
X = "l*(c1 + c12 + c123 + c1234)"
SUMS: Mapping[str, str] = {
    "θ4": "θ1, θ2 and θ3 are missing",
    "θ2 + θ3 + θ4": "θ1 is missing",
    "θ1 + θ3 + θ4": "θ2 is missing",
    "θ1 + θ2 + θ3": "θ4 is missing",
    "θ1 + θ2 - θ3 + θ4": "θ3 has the wrong sign",
    "θ1 + θ2 + 2θ3 + θ4": "θ3 counts twice",
}


@pytest.mark.parametrize("text", SUMS)
def test_the_orientation_of_a_planar_arm(text: str, make_exercise: Make) -> None:
    exercise: Exercise = make_exercise(PLANAR_4R)
    report = part(handed_in(exercise, {"it": [X, text]}, feedback=FeedbackLevel.HINTS), "it")
    [message] = report.rows[1].cells[0].feedback
    assert message.message.startswith(SUMS[text])
    assert len(all_codes(report)) == 1


# --- Test the misconceptions about three angles that describe a rotation

Q1, Q2 = np.random.default_rng(8).uniform(-3, 3, (2, SAMPLES))


def triple(*angles: Numbers | float) -> Numbers:
    return np.array([np.zeros(SAMPLES) + angle for angle in angles])


EULER_TRIPLE_RIGHT = triple(Q1, 0.4, Q2)
ROTATION = Rotation.from_euler("ZYX", EULER_TRIPLE_RIGHT.T)


def case(*angles: Numbers | float) -> WrongTriple:
    return WrongTriple(triple(*angles), ROTATION.as_matrix(), "ZYX", fixed=False)


def in_sequence(name: Any, rotation: Rotation = ROTATION) -> Numbers:
    return np.asarray(rotation.as_euler(name).T)


EULER_TRIPLE_PAIRS = [
    Pair(euler_triple.some_angles, case(-Q1, 0.4, -Q2), case(Q1 + 0.1, 0.4, Q2), "sign"),
    Pair(euler_triple.other_order, case(Q2, 0.4, Q1), case(Q2, 0.5, Q1), "angle_order"),
    Pair(
        euler_triple.other_sequence,
        case(*in_sequence("XZX")),
        case(*in_sequence("XZX") + 0.1),
        "other_euler_sequence",
    ),
    Pair(
        euler_triple.inverse_rotation,
        case(*in_sequence("ZYX", ROTATION.inv())),
        case(Q1, -0.4, Q2),
    ),
]


@each_pair(EULER_TRIPLE_PAIRS)
def test_a_misconception_explains_only_its_euler_angles(pair: Pair) -> None:
    assert_explains_only_the_first(pair)


@pytest.mark.parametrize(
    ("written", "code", "slipped"),
    [
        (case(Q1, -0.4, Q2), "sign", [False, True, False]),
        (case(Q1, np.degrees(0.4), np.degrees(Q2)), "degrees_as_radians", [False, True, True]),
        (case(Q1, np.radians(0.4), Q2), "radians_as_degrees", [False, True, False]),
        (case(np.pi / 2 - Q1, 0.4, np.pi / 2 - Q2), "swapped_atan2", [True, False, True]),
    ],
)
def test_only_the_angles_with_the_slip_are_named(
    written: WrongTriple, code: str, slipped: list[bool]
) -> None:
    found = explain_triple(written)
    assert found is not None
    assert [finding.code for finding in found.findings] == [code]
    assert np.asarray(found.entries).tolist() == slipped


def test_a_constant_is_no_exchanged_arctangent() -> None:
    assert explain_triple(case(Q1, np.pi / 2 - 0.4, Q2)) is None


def test_right_angles_get_no_finding() -> None:
    assert explain_triple(case(Q1, 0.4, Q2)) is None


# --- Test the misconceptions about the coordinates of a point

POSITION_RNG = np.random.default_rng(11)
ONE, TWO = POSITION_RNG.uniform(-3, 3, (2, SAMPLES))
L1, L2 = POSITION_RNG.uniform(0.3, 0.9, (2, SAMPLES))
ZERO = np.zeros(SAMPLES)

# The planar RR arm.
TABLE = np.array([[L1, ZERO, ZERO, ONE], [L2, ZERO, ZERO, TWO]])
TIP = np.array([L1 * np.cos(ONE), L1 * np.sin(ONE)]) + L2 * np.array(
    [np.cos(ONE + TWO), np.sin(ONE + TWO)]
)
ELBOW = np.array([L1 * np.cos(ONE), L1 * np.sin(ONE)])


def position_case(written: Numbers) -> WrongPosition:
    chain = Chain(TABLE, Convention.STANDARD, ("0", "1", "2"))
    return WrongPosition(written, TIP, 0.6, (0, 1), (chain,))


POSITION_PAIRS = [
    Pair(position.exchanged_coordinates, position_case(TIP[::-1]), position_case(TIP[::-1] + 0.1)),
    Pair(position.reversed_position, position_case(-TIP), position_case(TIP * [[1], [-1]])),
    Pair(
        position.length_unit,
        position_case(1000 * TIP),
        position_case(700 * TIP),
        "other_length_unit",
    ),
    Pair(position.other_pose, position_case(ELBOW), position_case(2 * ELBOW), "wrong_frame"),
]


@each_pair(POSITION_PAIRS)
def test_a_misconception_explains_only_its_position(pair: Pair) -> None:
    assert_explains_only_the_first(pair)


def test_a_right_position_gets_no_finding() -> None:
    assert diagnosed(position_case(TIP)) is None
