"""Test the misconceptions about three angles that describe a rotation."""

from typing import Any

import numpy as np
import pytest
from dh_grader.grading.diagnosis import lists as euler_triple
from dh_grader.grading.diagnosis.lists import WrongTriple, explain_triple
from dh_grader.grading.numbers import SAMPLES
from dh_grader.kinematics import Numbers
from scipy.spatial.transform import Rotation

from tests.grading.diagnosis.pairs import Pair, assert_explains_only_the_first, each_pair

Q1, Q2 = np.random.default_rng(8).uniform(-3, 3, (2, SAMPLES))


def triple(*angles: Numbers | float) -> Numbers:
    return np.array([np.zeros(SAMPLES) + angle for angle in angles])


RIGHT = triple(Q1, 0.4, Q2)
ROTATION = Rotation.from_euler("ZYX", RIGHT.T)


def case(*angles: Numbers | float) -> WrongTriple:
    return WrongTriple(triple(*angles), ROTATION.as_matrix(), "ZYX", fixed=False)


def in_sequence(name: Any, rotation: Rotation = ROTATION) -> Numbers:
    return np.asarray(rotation.as_euler(name).T)


PAIRS = [
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


@each_pair(PAIRS)
def test_a_misconception_explains_only_its_case(pair: Pair) -> None:
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
