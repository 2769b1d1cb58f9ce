"""Test the misconceptions about a product of rotations."""

from functools import reduce

import numpy as np
import pytest
from dh_grader.grading.diagnosis import products as rotation_steps
from dh_grader.grading.diagnosis.motions import MatrixCase
from dh_grader.grading.diagnosis.products import Step
from dh_grader.grading.misconception import explanation
from dh_grader.kinematics import Numbers
from scipy.spatial.transform import Rotation

from tests.grading.diagnosis.example_chain import COUNT, wrong_matrix
from tests.grading.diagnosis.pairs import Pair, assert_explains_only_the_first, each_pair

ANGLES = np.random.default_rng(12).uniform(0.2, 1.4, (3, COUNT))


def turn(axis: str, angles: Numbers) -> Numbers:
    """Return the rotations by ``angles`` about "x", "y" or "z"."""
    return np.asarray(Rotation.from_euler(axis, angles[:, None]).as_matrix())


X, Y, Z = (turn(axis, angles) for axis, angles in zip("xyz", ANGLES, strict=True))
# Turns about the fixed x axis, the fixed y axis and the moving z axis: Y X Z.
STEPS = [Step("X", X, fixed=True), Step("Y", Y, fixed=True), Step("Z", Z, fixed=False)]


def wrong(*factors: Numbers) -> MatrixCase:
    return wrong_matrix(reduce(np.matmul, factors), Y @ X @ Z)


def steps(_case: MatrixCase) -> list[Step]:
    return STEPS


PAIRS = [
    Pair(
        rotation_steps.fixed_for_moving,
        wrong(X, Y, Z),
        wrong(Y, Z, X),
        "fixed_for_moving_axes",
        steps,
    ),
    Pair(
        rotation_steps.turned_back,
        wrong(Y, turn("x", -ANGLES[0]), Z),
        wrong(Y, turn("x", -2 * ANGLES[0]), Z),
        "turn_sign",
        steps,
    ),
    Pair(
        rotation_steps.about_another_axis,
        wrong(Y, turn("z", ANGLES[0]), Z),
        wrong(Y, turn("z", ANGLES[1]), Z),
        "turn_axis",
        steps,
    ),
    Pair(
        rotation_steps.by_another_angle,
        wrong(Y, turn("x", ANGLES[2]), turn("z", ANGLES[0])),
        wrong(Y, turn("z", ANGLES[0]), Z),
        "turn_angle",
        steps,
    ),
    Pair(rotation_steps.another_order, wrong(Y, Z, X), wrong(Y, Z), "reversed_product", steps),
    Pair(rotation_steps.left_out, wrong(Y, Z), wrong(Z, Y), "missing_turn", steps),
]


@each_pair(PAIRS)
def test_a_misconception_explains_only_its_case(pair: Pair) -> None:
    assert_explains_only_the_first(pair)


@pytest.mark.parametrize(
    ("factors", "said"),
    [
        ((turn("y", -ANGLES[1]), turn("x", -ANGLES[0]), Z), "Turns 1 and 2 go the wrong way"),
        ((Z,), "Turns 1 and 2 are missing"),
        ((Y, turn("x", ANGLES[1]), Z), "Turn 1 was made by the angle of turn 2"),
        ((Y, turn("x", ANGLES[2]), turn("z", ANGLES[0])), "The angles of turns 1 and 3"),
    ],
)
def test_several_wrong_turns_are_named(factors: tuple[Numbers, ...], said: str) -> None:
    found = explanation(wrong(*factors), STEPS, Step)
    assert found is not None
    assert found.findings[0].hint.startswith(said)
