"""A valid table in other frames matches the reference; a table of a different robot does not."""

# The identities are from the documentation.

from collections.abc import Sequence

import numpy as np
import pytest
from dh_grader.kinematics import Numbers, rot_x, standard_link
from dh_grader.kinematics.frame_choice import (
    RowConstants,
    Target,
    TargetKind,
    joint_signs_of,
    match_as_written,
    match_tables,
)

from tests.kinematics.constructions import trans

Rows = Sequence[tuple[float, float, float, float]]

SAMPLES = 3
PI = np.pi
# Rows (a, α, d, θ) from base to tool: two parallel axes, a third one across them, and the tool.
REFERENCE: Rows = [(0, 0, 0, 0), (0.5, 0, 0.2, 0), (0.4, PI / 2, 0, 0), (0.1, 0, 0.3, 0)]
SIGNS = np.array([0, 1, 1, 1])
KINDS = [TargetKind.REVOLUTE, TargetKind.REVOLUTE, TargetKind.REVOLUTE, TargetKind.TOOL]


def rows_of(table: Rows) -> Numbers:
    return np.repeat(np.array(table, dtype=np.float64)[..., None], SAMPLES, axis=-1)


TARGETS = [
    Target(kind, standard_link(*row)) for kind, row in zip(KINDS, rows_of(REFERENCE), strict=True)
]
EQUIVALENT: dict[str, tuple[Rows, tuple[int, ...]]] = {
    "the reference": (REFERENCE, (0, 1, 1, 1)),
    "x1 the other way": (
        [(0, 0, 0, 0), (-0.5, 0, 0.2, PI), (0.4, PI / 2, 0, -PI), (0.1, 0, 0.3, 0)],
        (0, 1, 1, 1),
    ),
    "z1 turned over": (
        [(0, 0, 0, 0), (0.5, PI, 0.2, 0), (0.4, -PI / 2, 0, 0), (0.1, 0, 0.3, 0)],
        (0, 1, -1, 1),
    ),
    "origin 1 elsewhere": (
        [(0, 0, 0, 0), (0.5, 0, 0.9, 0), (0.4, PI / 2, -0.7, 0), (0.1, 0, 0.3, 0)],
        (0, 1, 1, 1),
    ),
}
OTHERS: dict[str, tuple[Rows, tuple[int, ...]]] = {
    "half of a compensated change": (
        [(0, 0, 0, 0), (0.5, 0, 0.9, 0), (0.4, PI / 2, 0, 0), (0.1, 0, 0.3, 0)],
        (0, 1, 1, 1),
    ),
    "the variable's sign not turned": (EQUIVALENT["z1 turned over"][0], (0, 1, 1, 1)),
    "a number missing": (
        [(0, 0, 0, 0), (np.nan, 0, 0.2, 0), (0.4, PI / 2, 0, 0), (0.1, 0, 0.3, 0)],
        (0, 1, 1, 1),
    ),
}


@pytest.mark.parametrize("name", [*EQUIVALENT, *OTHERS])
def test_a_table_is_valid_if_it_describes_the_same_mechanism(name: str) -> None:
    table, signs = (EQUIVALENT | OTHERS)[name]
    valid, poses = match_tables(rows_of(table)[None], np.array([signs]), TARGETS, 1.0)
    assert valid.tolist() == [name in EQUIVALENT]
    assert poses.shape == (4, 1, SAMPLES, 4, 4)


def test_the_relative_poses_are_those_of_the_other_frames() -> None:
    table, signs = EQUIVALENT["z1 turned over"]
    _, poses = match_tables(rows_of(table)[None], np.array([signs]), TARGETS, 1.0)
    np.testing.assert_allclose(poses[1, 0, 0], rot_x(PI), atol=1e-12)
    assert [int(joint_signs_of(pose)[0]) for pose in poses] == [1, -1, 1, 1]


def test_free_directions_allow_both_signs() -> None:
    rows = rows_of(REFERENCE)[None]
    assert not match_tables(rows, np.array([[0, 1, -1, 1]]), TARGETS, 1.0)[0].any()
    assert match_tables(rows, np.zeros((1, 4), np.int_), TARGETS, 1.0)[0].all()


def test_the_base_may_have_another_pose() -> None:
    start = np.broadcast_to(trans(0, 0, 0.3), (SAMPLES, 4, 4))
    table = [(0, 0, -0.3, 0), *REFERENCE[1:]]
    signs = SIGNS[None]
    assert match_tables(rows_of(table)[None], signs, TARGETS, 1.0, start=start)[0].all()


def written(*, wrong: bool) -> list[RowConstants]:
    yes, no = np.ones(4, np.bool_), np.zeros(4, np.bool_)
    wrong_regardless = np.array([False, False, wrong, False])
    return [
        RowConstants(row, yes, wrong_regardless, no, np.zeros(4), 3 if sign else None, int(sign))
        for row, sign in zip(rows_of(REFERENCE), SIGNS, strict=True)
    ]


def test_a_table_with_a_cell_wrong_in_any_frames_does_not_match() -> None:
    match = match_as_written(written(wrong=False), TARGETS, 1.0)
    assert match is not None
    assert match.cost == 0
    assert match.joint_signs == [1, 1, 1, 1]
    np.testing.assert_array_equal(match.rows, rows_of(REFERENCE))
    assert match_as_written(written(wrong=True), TARGETS, 1.0) is None
