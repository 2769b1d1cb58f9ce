"""Compare link transforms with products of four elementary matrices."""

import numpy as np
from dh_grader.kinematics import Convention, link_transforms, modified_link, standard_link
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]
ANGLE = st.floats(-20, 20)
LENGTH = st.floats(-10, 10)


def turn(axis: str, angle: float) -> Array:
    matrix = np.eye(4)
    matrix[:3, :3] = Rotation.from_euler(axis, angle).as_matrix()
    return matrix


def shift(axis: int, length: float) -> Array:
    matrix = np.eye(4)
    matrix[axis, 3] = length
    return matrix


@given(LENGTH, ANGLE, LENGTH, ANGLE)
def test_a_standard_link_is_the_product_of_elementary_transforms(
    a: float, alpha: float, d: float, theta: float
) -> None:
    # Source: MEAM 520, More Denavit-Hartenberg (DH).
    expected = turn("z", theta) @ shift(2, d) @ shift(0, a) @ turn("x", alpha)
    np.testing.assert_allclose(standard_link(a, alpha, d, theta), expected, atol=1e-12)


@given(LENGTH, ANGLE, LENGTH, ANGLE)
def test_a_modified_link_is_the_product_of_elementary_transforms(
    a: float, alpha: float, d: float, theta: float
) -> None:
    # Source: Robotic Fundamentals, Forward Kinematics.
    expected = turn("x", alpha) @ shift(0, a) @ turn("z", theta) @ shift(2, d)
    np.testing.assert_allclose(modified_link(a, alpha, d, theta), expected, atol=1e-12)


@given(ANGLE, ANGLE)
def test_the_two_dh_conditions_hold(alpha: float, theta: float) -> None:
    # x_1 is perpendicular to z_0 and meets it: Direct Kinematics (Part 2), §2.3.
    link = standard_link(1.3, alpha, 0.7, theta)
    x1, origin = link[:3, 0], link[:3, 3]
    assert abs(x1[2]) < 1e-12
    meets = origin - 1.3 * x1
    np.testing.assert_allclose(meets[:2], 0, atol=1e-12)


def test_links_of_the_stanford_arm_are_as_printed() -> None:
    # Source: A_1 and A_2 of MEAM 520, More Denavit-Hartenberg (DH), at one joint value.
    c, s = np.cos(0.4), np.sin(0.4)
    first = [[c, 0, -s, 0], [s, 0, c, 0], [0, -1, 0, 0], [0, 0, 0, 1]]
    second = [[c, 0, s, 0], [s, 0, -c, 0], [0, 1, 0, 0.3], [0, 0, 0, 1]]
    np.testing.assert_allclose(standard_link(0, -np.pi / 2, 0, 0.4), first, atol=1e-15)
    np.testing.assert_allclose(standard_link(0, np.pi / 2, 0.3, 0.4), second, atol=1e-15)


def test_the_convention_chooses_the_link() -> None:
    cells = (0.3, 0.5, 0.7, 1.1)
    standard = link_transforms(Convention.STANDARD, *cells)
    modified = link_transforms(Convention.MODIFIED, *cells)
    assert (standard == standard_link(*cells)).all()
    assert (modified == modified_link(*cells)).all()
    assert not np.allclose(standard, modified)


def test_batches_broadcast() -> None:
    links = standard_link(np.zeros((5, 1)), 0.0, np.arange(3.0), 0.2)
    assert links.shape == (5, 3, 4, 4)
    assert (links[4, :, 2, 3] == [0, 1, 2]).all()
    assert modified_link(0, 0, 0, np.zeros((2, 7))).shape == (2, 7, 4, 4)
