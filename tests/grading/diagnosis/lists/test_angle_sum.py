"""Test the misconceptions about a sum of angles."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.expressions import Symbol, Vocabulary, read
from dh_grader.grading import FeedbackLevel
from dh_grader.grading.diagnosis import lists as angle_sum
from dh_grader.grading.diagnosis.lists import WrongSum, diagnose_angle
from dh_grader.grading.misconception import WrongValue
from dh_grader.grading.numbers import SAMPLES, Samples

from tests.grading.diagnosis.pairs import Pair, assert_explains_only_the_first, each_pair
from tests.grading.support.exercise_texts import HEAD, Make, all_codes
from tests.grading.support.submitting import handed_in, part

RNG = np.random.default_rng(12)
NAMES = ("q1", "q2", "q3", "q4")
VALUES = {name: RNG.uniform(-3, 3, SAMPLES) for name in (*NAMES, "l")}
WORDS = Vocabulary([*(Symbol(name, "angle") for name in NAMES), Symbol("l", "length")])
RIGHT = "q1 + q2 + q3 - pi/2"


def wrong(text: str, expected: str = RIGHT) -> WrongValue:
    expression, right = (read(each, WORDS, quantity="angle") for each in (text, expected))
    zeros = np.zeros(SAMPLES)
    return WrongValue(
        expression=expression,
        actual=zeros + expression.evaluate(VALUES),
        expected=zeros + right.evaluate(VALUES),
        samples=Samples(VALUES),
        scale=1.0,
        angle=True,
    )


PAIRS = [
    Pair(
        angle_sum.left_out,
        wrong("q3 - 90deg"),
        wrong("q3"),
        "joint_variable_missing",
    ),
    Pair(
        angle_sum.reversed_addends,
        wrong("q1 - q2 + q3 - pi/2"),
        wrong("q1 - q2 - pi/2"),
        "joint_variable_sign",
    ),
    Pair(
        angle_sum.counted_twice,
        wrong("q1 + 2q2 + q3 - pi/2"),
        wrong("q1 + 3q2 + q3 - pi/2"),
        "joint_variable_doubled",
    ),
    Pair(
        angle_sum.added,
        wrong("q1 + q2 + q3 - q4 - pi/2"),
        wrong("q1 + q2 + q4 - pi/2"),
        "joint_variable_extra",
    ),
    Pair(
        angle_sum.of_another_joint,
        wrong("q1 + q2 + q4 - pi/2"),
        wrong("q1 + q4 - pi/2"),
        "joint_variable_index",
    ),
    Pair(angle_sum.constant, wrong("0.3"), wrong("q4"), "joint_variable_missing"),
]
PAIRS = [pair._replace(source=WrongSum.of) for pair in PAIRS]


@each_pair(PAIRS)
def test_a_misconception_explains_only_its_case(pair: Pair) -> None:
    assert_explains_only_the_first(pair)


def test_a_missing_angle_is_named_unless_it_is_the_answer() -> None:
    assert diagnose_angle(wrong("q3 - pi/2")).hint.startswith("q1 and q2 are missing")
    assert diagnose_angle(wrong("q2+q3 - pi/2")).hint.startswith("q1 is missing")
    # If the angle is that of a single joint, its name would be the answer.
    assert "q1" not in diagnose_angle(wrong("0", "q1")).hint


def test_an_angle_that_is_no_sum_has_no_addends() -> None:
    assert angle_sum.addends(wrong("q1", "q1*q2")) == {}
    assert angle_sum.addends(wrong("q1", "2.5q1")) == {}
    assert angle_sum.addends(replace(wrong("q1", "-2q1 + 1"))) == {"q1": -2}


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
