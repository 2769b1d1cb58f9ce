"""Move the axes of an arm onto those of its moved copy."""

import numpy as np
import pytest
from dh_grader.kinematics import Matrices, rot_x, rot_z
from dh_grader.kinematics.frame_choice import align_axes

from tests.kinematics.constructions import trans

SAMPLES = 3
MOTION = trans(0.4, -1.1, 0.7) @ rot_z(0.9) @ rot_x(-2.0)
UP = np.eye(4)
# The joint frames of each arm, and True for prismatic joints.
ARMS: dict[str, tuple[list[Matrices], list[bool]]] = {
    "skew axes": ([UP, trans(0.3, 0, 0) @ rot_x(0.8), trans(0, 0.5, 0.2)], [False] * 3),
    "parallel axes": ([UP, trans(0.3, 0, 0), trans(0.3, 0.4, 0)], [False] * 3),
    "one line": ([UP, trans(0, 0, 0.5)], [False] * 2),
    "a sliding first axis": (
        [UP, trans(9.0, 0, 0) @ rot_x(1.2), trans(0.2, 0, 0)],
        [True, False, False],
    ),
    "two sliding axes": ([UP, rot_x(1.2)], [True, True]),
}


@pytest.mark.parametrize("name", ARMS)
def test_aligned_axes_coincide_with_the_axes_of_the_moved_arm(name: str) -> None:
    joints, slides = ARMS[name]
    source = np.repeat(np.array(joints)[:, None], SAMPLES, axis=1)
    target = MOTION @ source
    sliding = np.array(slides)
    moved = align_axes(source, target, sliding) @ source
    np.testing.assert_allclose(moved[..., :3, 2], target[..., :3, 2], atol=1e-9)
    error = (moved - target)[~sliding, :, :3, 3]
    distance = np.cross(error, target[~sliding, :, :3, 2])
    np.testing.assert_allclose(distance, 0, atol=1e-9)
