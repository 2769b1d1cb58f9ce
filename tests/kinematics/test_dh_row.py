"""Test the two DH conditions, and the row if both hold."""

import doctest

import numpy as np
import pytest
from dh_grader import kinematics as dh_row
from dh_grader.kinematics import (
    Convention,
    dh1_residual,
    dh2_residual,
    link_transforms,
    rot_x,
    rot_y,
    rot_z,
    row,
)

from tests.kinematics.constructions import trans

RNG = np.random.default_rng(6)
BOTH = list(Convention)


def test_the_example_in_the_docstring_is_right() -> None:
    results = doctest.testmod(dh_row)
    assert (results.attempted >= 1, results.failed) == (True, 0)


@pytest.mark.parametrize("convention", BOTH)
def test_a_link_transform_has_its_own_row(convention: Convention) -> None:
    cells = RNG.uniform(-np.pi, np.pi, (4, 30))
    link = link_transforms(convention, *cells)
    np.testing.assert_allclose(dh1_residual(link, convention), 0.0, atol=1e-14)
    np.testing.assert_allclose(dh2_residual(link, convention), 0.0, atol=1e-14)
    np.testing.assert_allclose(row(link, convention), cells, atol=1e-12)


def test_dh1_fails_if_x1_is_not_perpendicular_to_z0() -> None:
    # A turn by 0.3 about y gives x_1 the component −sin 0.3 along z_0; x_1 still meets z_0.
    transform = trans(0.5, 0.0, 0.2) @ rot_y(0.3)
    assert dh1_residual(transform, Convention.STANDARD) == pytest.approx(-np.sin(0.3))
    assert dh2_residual(transform, Convention.STANDARD) == pytest.approx(0.0)


def test_dh2_fails_if_x1_does_not_meet_z0() -> None:
    # With a shift by 0.4 along y_0 and no turn about z, x_1 passes z_0 at the distance 0.4.
    transform = trans(0.5, 0.4, 0.2) @ rot_x(0.3)
    assert dh1_residual(transform, Convention.STANDARD) == pytest.approx(0.0)
    assert dh2_residual(transform, Convention.STANDARD) == pytest.approx(0.4)


def test_both_residuals_are_right_if_x1_is_parallel_to_z0() -> None:
    transform = trans(0.3, 0.4, 0.2) @ rot_y(-np.pi / 2)
    assert dh1_residual(transform, Convention.STANDARD) == pytest.approx(1.0)
    assert dh2_residual(transform, Convention.STANDARD) == pytest.approx(0.5)


def test_a_transform_may_be_a_link_of_one_convention_only() -> None:
    transform = rot_z(0.7) @ trans(0.5, 0.0, 0.1) @ rot_x(0.4)
    assert dh2_residual(transform, Convention.STANDARD) == pytest.approx(0.0)
    assert abs(dh1_residual(transform, Convention.MODIFIED)) > 0.1
