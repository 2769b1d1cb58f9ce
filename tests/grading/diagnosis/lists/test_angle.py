"""Test the misconceptions about a single angle."""

import numpy as np
from dh_grader.expressions import Symbol, Vocabulary, read
from dh_grader.grading.diagnosis import lists as angle
from dh_grader.grading.diagnosis.lists import diagnose_angle
from dh_grader.grading.misconception import WrongValue, undefined
from dh_grader.grading.numbers import SAMPLES, Samples
from dh_grader.grading.report import Correction

from tests.grading.diagnosis.pairs import Pair, assert_explains_only_the_first, each_pair

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
