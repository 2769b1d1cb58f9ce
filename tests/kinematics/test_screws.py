"""Compare screws with SciPy and with the book Modern Robotics."""

import doctest

import numpy as np
import pytest
from dh_grader import kinematics as screws
from dh_grader.kinematics import (
    adjoint,
    exponential,
    inverse,
    moved,
    product_in_body,
    product_in_space,
    rot_x,
    rot_z,
    skew,
    sliding_axis,
    turning_axis,
)
from numpy.typing import NDArray
from scipy.linalg import expm

from tests.kinematics.constructions import screw_axis, trans
from tests.together import together

Numbers = NDArray[np.float64]
RNG = np.random.default_rng(5)


def bracket(screw: Numbers) -> Numbers:
    """Return the 4×4 matrix [S] of a screw."""
    w1, w2, w3, v1, v2, v3 = screw
    return np.array([[0, -w3, w2, v1], [w3, 0, -w1, v2], [-w2, w1, 0, v3], [0, 0, 0, 0.0]])


def unit(vector: Numbers) -> Numbers:
    return np.asarray(vector / np.linalg.norm(vector))


SCREWS = {
    "turning": screw_axis(unit(np.array([1.0, -2, 0.5])), [0.3, 0.2, -0.7]),
    "screwing": screw_axis(unit(np.array([0.0, 1, 1])), [1.0, 0, 2], 0.35),
    "sliding": screw_axis(unit(np.array([1.0, 2, 2])), [5.0, 5, 5], np.inf),
    "not of unit length": np.array([0.0, 0, 3, 1, 2, 3]),
    "nothing": np.zeros(6),
}


def test_the_examples_in_docstrings_are_right() -> None:
    results = doctest.testmod(screws)
    assert (results.attempted >= 2, results.failed) == (True, 0)


@together("name", SCREWS)
@together("amount", [0.0, 1e-9, 0.7, -2.9, 11.0])
def test_the_exponential_equals_the_matrix_exponential(name: str, amount: float) -> None:
    screw = SCREWS[name]
    np.testing.assert_allclose(
        exponential(screw, amount), expm(bracket(screw) * amount), atol=1e-12
    )


def test_each_member_of_a_batch_is_computed_independently() -> None:
    batch = np.array(list(SCREWS.values()))
    amounts = RNG.uniform(-3, 3, (7, len(batch)))
    motions = exponential(batch, amounts)
    assert motions.shape == (7, len(batch), 4, 4)
    for i, j in np.ndindex(7, len(batch)):
        np.testing.assert_allclose(motions[i, j], exponential(batch[j], amounts[i, j]), atol=1e-14)


def test_a_screw_with_infinite_pitch_does_not_turn() -> None:
    assert screw_axis([0, 1, 0], [3, 4, 5], np.inf).tolist() == [0, 0, 0, 0, 1, 0]
    mixed = screw_axis([0, 1, 0], [3, 4, 5], np.array([np.inf, 0.0]))
    assert (mixed + 0.0).tolist() == [[0, 0, 0, 0, 1, 0], [0, 1, 0, -5, 0, 3]]


def test_the_pitch_is_the_advance_per_radian() -> None:
    motion = exponential(screw_axis([0, 0, 1], [0, 0, 0], 0.25), 2 * np.pi)
    np.testing.assert_allclose(motion, trans(0, 0, np.pi / 2), atol=1e-14)


def test_the_twist_of_a_turning_car_is_that_of_the_book() -> None:
    # Modern Robotics, example 3.23: V_s = (0,0,2,−2,−4,0), V_b = (0,0,−2,2.8,4,0).
    #
    # r_s = (2,−1,0), r_b = (2,−1.4,0), ω = 2, and T_sb = [[−1,0,0,4],[0,1,0,0.4],[0,0,−1,0],…].
    space = 2 * screw_axis([0, 0, 1], [2, -1, 0])
    body = 2 * screw_axis([0, 0, -1], [2, -1.4, 0])
    transform = np.array([[-1.0, 0, 0, 4], [0, 1, 0, 0.4], [0, 0, -1, 0], [0, 0, 0, 1]])
    np.testing.assert_allclose(space, [0, 0, 2, -2, -4, 0], atol=1e-14)
    np.testing.assert_allclose(body, [0, 0, -2, 2.8, 4, 0], atol=1e-14)
    np.testing.assert_allclose(moved(transform, body), space, atol=1e-14)


def test_the_adjoint_commutes_with_the_exponential() -> None:
    # T e^{[S]θ} T⁻¹ = e^{[Ad_T S]θ} (Modern Robotics, eq. 3.91).
    transform = rot_z(0.4) @ trans(0.3, -0.2, 0.9) @ rot_x(1.1)
    for screw in SCREWS.values():
        np.testing.assert_allclose(
            transform @ exponential(screw, 0.8) @ inverse(transform),
            exponential(moved(transform, screw), 0.8),
            atol=1e-12,
        )
    np.testing.assert_allclose(
        adjoint(transform) @ adjoint(inverse(transform)), np.eye(6), atol=1e-14
    )


def test_skew_is_the_matrix_of_the_cross_product() -> None:
    one, other = RNG.normal(size=(2, 5, 3))
    np.testing.assert_allclose(
        (skew(one) @ other[..., None])[..., 0], np.cross(one, other), atol=1e-15
    )


def test_both_products_give_the_pose_of_the_book() -> None:
    # Source: the example of FKinSpace and FKinBody, Modern Robotics, code library, chapter 4.
    home = np.array([[-1.0, 0, 0, 0], [0, 1, 0, 6], [0, 0, -1, 2], [0, 0, 0, 1]])
    space = np.array([[0.0, 0, 1, 4, 0, 0], [0, 0, 0, 0, 1, 0], [0, 0, -1, -6, 0, -0.1]])
    body = np.array([[0.0, 0, -1, 2, 0, 0], [0, 0, 0, 0, 1, 0], [0, 0, 1, 0, 0, 0.1]])
    amounts = np.array([np.pi / 2, 3, np.pi])
    expected = np.array([[0.0, 1, 0, -5], [1, 0, 0, 4], [0, 0, -1, 1.68584073], [0, 0, 0, 1]])
    np.testing.assert_allclose(product_in_space(space, amounts, home), expected, atol=1e-8)
    np.testing.assert_allclose(product_in_body(body, amounts, home), expected, atol=1e-8)
    np.testing.assert_allclose(moved(home, body), space, atol=1e-12)


def test_both_products_give_the_closed_form_of_the_planar_rpr_arm() -> None:
    # The closed form is x = (L1 + θ2) c1 + L2 c13, with the rotation θ1 + θ3 about z.
    l1, l2 = 0.7, 0.4
    one, two, three = amounts = RNG.uniform(-1, 1, (3, 6))
    space = np.array([[0.0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0], [0, 0, 1, 0, -l1, 0]])
    body = np.array([[0.0, 0, 1, 0, l1 + l2, 0], [0, 0, 0, 1, 0, 0], [0, 0, 1, 0, l2, 0]])
    home = trans(l1 + l2, 0, 0)
    x = (l1 + two) * np.cos(one) + l2 * np.cos(one + three)
    y = (l1 + two) * np.sin(one) + l2 * np.sin(one + three)
    expected = trans(x, y, 0.0) @ rot_z(one + three)
    in_space = product_in_space(space[:, None], amounts, home)
    in_body = product_in_body(body[:, None], amounts, home)
    np.testing.assert_allclose(in_space, expected, atol=1e-14)
    np.testing.assert_allclose(in_body, expected, atol=1e-14)


@pytest.mark.parametrize("angle", [0.4, 1.1, -0.7])
def test_the_axis_of_a_turn_is_found(angle: float) -> None:
    # The turn is SciPy's exponential of an axis without pitch.
    axis = screw_axis(np.array([0.36, -0.48, 0.8]), np.array([0.5, 0.1, -0.4]))
    displacement = expm(bracket(axis) * angle)
    np.testing.assert_allclose(turning_axis(displacement, angle), axis, atol=1e-12)


def test_other_displacements_give_an_axis_of_another_motion() -> None:
    axis = screw_axis(np.array([0.0, 0.0, 1.0]), np.array([0.5, 0.1, 0.0]))
    with_pitch = expm(bracket(axis + np.array([0, 0, 0, 0, 0, 0.3])) * 0.4)
    twice = expm(bracket(axis) * 0.8)
    for displacement in (with_pitch, twice, trans(0.1, 0.2, 0.3)):
        found = turning_axis(displacement, 0.4)
        error = np.abs(exponential(found, 0.4) - displacement).max()
        length = np.linalg.norm(found[:3])
        assert error > 0.05 or abs(length - 1) > 0.05


def test_the_axis_of_a_slide_is_found() -> None:
    displacement = trans(0.0, 0.6, 0.8)
    np.testing.assert_allclose(sliding_axis(displacement, 1.0), [0, 0, 0, 0, 0.6, 0.8])
    np.testing.assert_allclose(exponential(sliding_axis(displacement, 0.5), 0.5), displacement)
