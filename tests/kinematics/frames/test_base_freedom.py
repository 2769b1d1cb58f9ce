"""Test how each joint axis restricts the choice of a base frame."""

import numpy as np
from dh_grader.kinematics import Matrices, rot_x
from dh_grader.kinematics.frame_choice import BaseFreedom, TargetKind

from tests.kinematics.constructions import trans

SAMPLES = 2
ROWS = np.array([[0.5, 0.0, 0.3, 0.2]])[..., None].repeat(SAMPLES, axis=-1)
WRITTEN = np.array([0.5, 0.0, 0.8, 1.1])[:, None].repeat(SAMPLES, axis=-1)


def at(frame: Matrices) -> Matrices:
    return np.broadcast_to(frame, (SAMPLES, 4, 4))


def test_a_revolute_joint_leaves_a_turn_and_a_slide_along_its_axis() -> None:
    freedom = BaseFreedom.on_first_axis(prismatic=False, samples=SAMPLES)
    assert freedom.turn
    assert not freedom.is_used_up
    same_line = freedom.at_next(at(trans(0, 0, 0.4)), TargetKind.REVOLUTE, 1.0)
    assert same_line.turn
    assert same_line.slide is not None
    beside = freedom.at_next(at(trans(0.4, 0, 0)), TargetKind.REVOLUTE, 1.0)
    assert not beside.turn
    assert beside.slide is not None  # offsets along parallel axes still add up
    across = freedom.at_next(at(trans(0.4, 0, 0) @ rot_x(1.0)), TargetKind.REVOLUTE, 1.0)
    assert across.is_used_up


def test_a_prismatic_joint_leaves_the_place_of_the_frame_free() -> None:
    freedom = BaseFreedom.on_first_axis(prismatic=True, samples=SAMPLES)
    assert freedom.anywhere
    turning = freedom.at_next(at(rot_x(1.0)), TargetKind.REVOLUTE, 1.0)
    assert not turning.anywhere
    assert turning.slide is not None


def test_the_slide_is_chosen_to_match_the_written_length() -> None:
    freedom = BaseFreedom.on_first_axis(prismatic=False, samples=SAMPLES)
    beyond = ROWS.copy()
    beyond[:, 2] -= 1.0
    [(rows, distance)] = freedom.use_up(ROWS, beyond, WRITTEN)
    np.testing.assert_allclose(rows[0, 2], WRITTEN[2])
    np.testing.assert_allclose(distance, -0.5)


def test_the_turn_is_chosen_to_match_the_written_angle() -> None:
    freedom = BaseFreedom.on_first_axis(prismatic=False, samples=SAMPLES)
    np.testing.assert_array_equal(freedom.with_written_angle(ROWS, WRITTEN)[0, 3], WRITTEN[3])
    np.testing.assert_array_equal(BaseFreedom().with_written_angle(ROWS, WRITTEN), ROWS)
