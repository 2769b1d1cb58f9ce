"""Compare the factors of a table with the link transforms of textbooks."""

import numpy as np
import pytest
from dh_grader.kinematics import (
    Convention,
    axis_frames,
    factors_of,
    pose,
    read_screws,
    rot_x,
    rot_z,
    screws,
)

from tests.kinematics.constructions import trans

BOTH = pytest.mark.parametrize("convention", list(Convention))
RNG = np.random.default_rng(4)
TABLE = RNG.uniform(-2, 2, (5, 4, 3))


@BOTH
def test_the_product_of_the_factors_is_the_pose(convention: Convention) -> None:
    factors = factors_of(TABLE, convention)
    for k in range(len(factors.axes) + 1):
        whole = factors.before[k] @ factors.after[k]
        np.testing.assert_allclose(whole, pose(TABLE, convention), atol=1e-12)


@BOTH
def test_each_cell_has_its_factor_and_kind(convention: Convention) -> None:
    factors = factors_of(TABLE, convention)
    for row in range(len(TABLE)):
        for column in range(4):
            factor, kind = factors.position((row, column))
            assert factors.cell(factor, kind) == (row, column)
            np.testing.assert_array_equal(factors.sizes[factor, kind], TABLE[row, column])


@BOTH
def test_lengths_are_measured_in_the_unit(convention: Convention) -> None:
    in_unit = factors_of(TABLE, convention, unit=0.25).before[-1]
    expected = pose(TABLE, convention)
    expected[:, :3, 3] *= 4
    np.testing.assert_allclose(in_unit, expected, atol=1e-12)


@pytest.mark.parametrize("written", list(Convention))
def test_axis_frames_are_those_of_the_wanted_convention(written: Convention) -> None:
    factors = factors_of(TABLE, written)
    z_first = written is Convention.STANDARD
    for wanted in Convention:
        found = axis_frames(TABLE, written, wanted)
        at = np.arange(len(TABLE)) * 2 + (not z_first) + (wanted is Convention.MODIFIED)
        np.testing.assert_allclose(found[:-1], factors.before[at], atol=1e-12)
        np.testing.assert_allclose(found[-1], pose(TABLE, written), atol=1e-12)


def test_a_screw_is_read_back_and_other_transforms_deviate() -> None:
    axes, sizes = np.array([0, 2]), RNG.uniform(-1, 1, (2, 2, 3))
    made = screws(axes, sizes[:, 0], sizes[:, 1])
    np.testing.assert_allclose(made[0], trans(sizes[0, 0], 0, 0) @ rot_x(sizes[0, 1]), atol=1e-12)
    np.testing.assert_allclose(made[1], trans(0, 0, sizes[1, 0]) @ rot_z(sizes[1, 1]), atol=1e-12)
    read, missed = read_screws(made, axes)
    np.testing.assert_allclose(read, sizes, atol=1e-12)
    assert missed.max() < 1e-12
    aside = made @ trans(0, 1e-3, 0)
    turned = made @ rot_x(1e-3) @ rot_z(1e-3)
    opposite = made @ rot_x(np.pi) @ rot_z(np.pi)
    for other in (aside, turned, opposite):
        assert read_screws(other, axes)[1].min() > 1e-4
