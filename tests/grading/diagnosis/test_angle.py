"""Each misconception about angles: one case that it explains, one that it leaves alone."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from service.expressions import Symbol, Vocabulary, read
from service.grading.diagnosis import angle
from service.grading.diagnosis.angle import (
    MISCONCEPTIONS,
    TRIPLES,
    AnglesExplained,
    WrongAngles,
    diagnose_angle,
    explain_angles,
)
from service.grading.diagnosis.wrong_value import WrongValue, undefined
from service.grading.feedback import Finding
from service.grading.samples import SAMPLES, Samples
from service.kinematics.transforms import Numbers

RNG = np.random.default_rng(8)
VALUES = {"q1": RNG.uniform(-3, 3, SAMPLES), "q2": RNG.uniform(-3, 3, SAMPLES)}
WORDS = Vocabulary([Symbol("q1", "angle"), Symbol("q2", "angle")])

Misconception = Callable[[WrongValue], Finding | None]


def wrong(text: str, expected: str) -> WrongValue:
    expression = read(text, WORDS, quantity="angle")
    right = read(expected, WORDS, quantity="angle")
    lanes = np.zeros(SAMPLES)
    return WrongValue(
        expression=expression,
        actual=lanes + expression.evaluate(VALUES),
        expected=lanes + right.evaluate(VALUES),
        expected_text=expected,
        samples=Samples(VALUES),
        scale=1.0,
        angle=True,
    )


# The misconception, what was written and what is right, and the same for a case that it leaves
# alone.
PAIRS: list[tuple[Misconception, tuple[str, str], tuple[str, str]]] = [
    (undefined, ("1/0", "q1"), ("q2", "q1")),
    (angle.sign, ("-q1", "q1"), ("-q1 + 0.1", "q1")),
    (angle.degrees_as_radians, ("90", "pi/2"), ("91", "pi/2")),
    (angle.radians_as_degrees, ("pi*pi/360", "pi/2"), ("pi/180", "pi/2")),
    (angle.lost_quadrant, ("atan(sin(q1)/cos(q1))", "q1"), ("q1 + pi", "q1")),
    (angle.half_turn, ("q1 - pi", "q1"), ("q1 + pi/2", "q1")),
    (angle.swapped_atan2, ("atan2(cos(q1), sin(q1))", "q1"), ("0", "pi/2")),
    (angle.quarter_turn, ("0", "pi/2"), ("q1 + pi", "q1")),
]


@pytest.mark.parametrize(
    ("misconception", "explained", "left"), PAIRS, ids=lambda p: getattr(p, "__name__", "")
)
def test_a_misconception_about_one_angle(
    misconception: Misconception, explained: tuple[str, str], left: tuple[str, str]
) -> None:
    finding = misconception(wrong(*explained))
    assert finding is not None
    assert finding.code == misconception.__name__
    assert finding.hint
    assert misconception(wrong(*left)) is None


def test_every_misconception_about_one_angle_is_tested_and_tried() -> None:
    assert {pair[0] for pair in PAIRS} == set(MISCONCEPTIONS)


def test_what_no_misconception_explains() -> None:
    finding = diagnose_angle(wrong("q1 + 0.5", "q1"))
    assert finding.code == "value"
    assert finding.values is not None


def triple(*columns: Numbers | float) -> Numbers:
    return np.array([np.zeros(SAMPLES) + column for column in columns])


Q1, Q2 = VALUES["q1"], VALUES["q2"]
RIGHT = triple(Q1, 0.4, Q2)


def case(written: Numbers, sequence: str = "ZYX") -> WrongAngles:
    """``written`` where q1, 0.4, q2 would be right, about moving axes."""
    rotation = Rotation.from_euler(sequence, RIGHT.T).as_matrix()
    return WrongAngles(written, rotation, sequence, fixed=False)


def other(name: Any) -> Numbers:
    """The right rotation in another of SciPy's sequences."""
    return np.asarray(Rotation.from_euler("ZYX", RIGHT.T).as_euler(name).T)


TripleBelief = Callable[[WrongAngles], AnglesExplained | None]
TRIPLE_PAIRS: list[tuple[TripleBelief, Numbers, Numbers, str]] = [
    (angle.some_angles, triple(-Q1, 0.4, -Q2), triple(Q1 + 0.1, 0.4, Q2), "sign"),
    (angle.other_order, triple(Q2, 0.4, Q1), triple(Q2, 0.5, Q1), "angle_order"),
    (angle.other_sequence, other("XZX"), other("XZX") + 0.1, "other_euler_sequence"),
    (
        angle.inverse_rotation,
        np.asarray(Rotation.from_euler("ZYX", RIGHT.T).inv().as_euler("ZYX").T),
        triple(Q1, -0.4, Q2),
        "inverse_rotation",
    ),
]


@pytest.mark.parametrize(("misconception", "explained", "left", "code"), TRIPLE_PAIRS)
def test_a_misconception_about_three_angles(
    misconception: TripleBelief, explained: Numbers, left: Numbers, code: str
) -> None:
    found = misconception(case(explained))
    assert found is not None
    assert found.finding.code == code
    assert misconception(case(left)) is None


def test_every_misconception_about_three_angles_is_tested_and_tried() -> None:
    assert {pair[0] for pair in TRIPLE_PAIRS} == set(TRIPLES)


@pytest.mark.parametrize(
    ("written", "code", "blamed"),
    [
        (triple(Q1, -0.4, Q2), "sign", [False, True, False]),
        (triple(Q1, np.degrees(0.4), np.degrees(Q2)), "degrees_as_radians", [False, True, True]),
        (triple(Q1, np.radians(0.4), Q2), "radians_as_degrees", [False, True, False]),
        (triple(np.pi / 2 - Q1, 0.4, np.pi / 2 - Q2), "swapped_atan2", [True, False, True]),
    ],
)
def test_which_angles_a_slip_is_in(written: Numbers, code: str, blamed: list[bool]) -> None:
    found = explain_angles(case(written))
    assert found is not None
    assert found.blamed is not None
    assert (found.finding.code, found.blamed.tolist()) == (code, blamed)


def test_a_constant_is_no_exchanged_arctangent() -> None:
    written = triple(Q1, np.pi / 2 - 0.4, Q2)
    assert explain_angles(case(written)) is None
    assert explain_angles(case(RIGHT)) is None
