"""Compare rotations with SciPy; test translations and inverses."""

from collections.abc import Callable

import numpy as np
import pytest
from dh_grader.kinematics import identity, inverse, is_rigid, rot_x, rot_y, rot_z
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from tests.kinematics.constructions import trans

Array = NDArray[np.float64]
ANGLE = st.floats(-20, 20)
LENGTH = st.floats(-100, 100)
ROTATIONS = {"x": rot_x, "y": rot_y, "z": rot_z}
AXES = {"x": [1.0, 0.0, 0.0], "y": [0.0, 1.0, 0.0], "z": [0.0, 0.0, 1.0]}


def turns(axis: str, angles: list[float]) -> Array:
    matrices: Array = Rotation.from_rotvec(np.outer(angles, AXES[axis])).as_matrix()
    return matrices


def assert_close(actual: Array, expected: Array) -> None:
    np.testing.assert_allclose(actual, expected, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("axis", ROTATIONS)
@given(angles=st.lists(ANGLE, min_size=1, max_size=6))
def test_a_rotation_is_scipys(axis: str, angles: list[float]) -> None:
    matrices = ROTATIONS[axis](angles)
    assert matrices.shape == (len(angles), 4, 4)
    assert_close(matrices[:, :3, :3], turns(axis, angles))
    assert (matrices[:, 3] == [0, 0, 0, 1]).all()
    assert (matrices[:, :3, 3] == 0).all()


@pytest.mark.parametrize(
    ("rotation", "turned", "onto"),
    [(rot_x, [0, 1, 0], [0, 0, 1]), (rot_y, [0, 0, 1], [1, 0, 0]), (rot_z, [1, 0, 0], [0, 1, 0])],
)
def test_a_quarter_turn_is_right_handed(
    rotation: Callable[[float], Array], turned: list[int], onto: list[int]
) -> None:
    assert_close(rotation(np.pi / 2)[:3, :3] @ turned, np.array(onto, dtype=float))


@given(LENGTH, LENGTH, LENGTH)
def test_a_translation_moves_points_and_not_directions(x: float, y: float, z: float) -> None:
    moved = trans(x, y, z)
    assert (moved @ [1, 2, 3, 1] == [x + 1, y + 2, z + 3, 1]).all()
    assert (moved @ [1, 2, 3, 0] == [1, 2, 3, 0]).all()


@given(st.tuples(ANGLE, ANGLE, ANGLE), st.tuples(LENGTH, LENGTH, LENGTH))
def test_the_inverse_undoes_the_transform(
    angles: tuple[float, float, float], lengths: tuple[float, float, float]
) -> None:
    transform = trans(*lengths)
    transform[:3, :3] = Rotation.from_euler("XYZ", angles).as_matrix()
    inverted = inverse(transform)
    np.testing.assert_allclose(inverted @ transform, np.eye(4), atol=1e-10)
    np.testing.assert_allclose(transform @ inverted, np.eye(4), atol=1e-10)
    np.testing.assert_allclose(inverted, np.linalg.inv(transform), atol=1e-10)


def test_batches_broadcast() -> None:
    batch = trans(np.zeros((2, 1)), np.arange(3.0), 5.0)
    assert batch.shape == (2, 3, 4, 4)
    assert (batch[1, 2, :3, 3] == [0, 2, 5]).all()
    assert rot_z(np.zeros((2, 3))).shape == (2, 3, 4, 4)
    assert (inverse(batch)[..., :3, 3] == -batch[..., :3, 3]).all()
    assert (identity((2, 3)) == np.eye(4)).all()
    assert identity().shape == (4, 4)
    assert rot_x(0.0).dtype == rot_x(0).dtype == np.float64


def test_the_inverse_does_not_change_its_argument() -> None:
    transform = trans(1.0, 2.0, 3.0)
    before = transform.copy()
    inverse(transform)
    assert (transform == before).all()


def test_only_rotations_with_translations_are_rigid() -> None:
    right = Rotation.from_rotvec([0.3, -0.4, 0.5]).as_matrix()
    transforms = np.tile(np.eye(4), (5, 1, 1))
    transforms[:, :3, :3] = right
    transforms[:, :3, 3] = [7.0, -8.0, 9.0]
    transforms[1, :3, 0] *= -1  # left-handed
    transforms[2, :3, 1] *= 1.1  # stretched
    transforms[3, 3, 0] = 0.1  # another last row
    transforms[4, 3, 3] = 2.0
    assert is_rigid(transforms, 1e-3).tolist() == [True, False, False, False, False]
