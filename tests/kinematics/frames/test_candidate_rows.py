"""Every proposed table row leads to the intended axis or frame."""

import numpy as np
import pytest
from dh_grader.kinematics import (
    Matrices,
    Numbers,
    inverse,
    is_unreachable,
    rot_x,
    rot_y,
    rot_z,
    standard_link,
)
from dh_grader.kinematics.frame_choice import (
    AxisRelation,
    TargetKind,
    axis_relations,
    candidate_rows,
    written_or,
)

from tests.kinematics.constructions import trans

SAMPLES = 4
RNG = np.random.default_rng(11)
A = RNG.uniform(0.2, 0.9, SAMPLES)
D = RNG.uniform(0.2, 0.9, SAMPLES)
NOTHING = np.full((4, SAMPLES), np.nan)
TARGETS: dict[AxisRelation, Matrices] = {
    AxisRelation.SKEW: standard_link(A, np.full(SAMPLES, 0.7), D, np.full(SAMPLES, 0.4))[None],
    AxisRelation.PARALLEL: standard_link(A, np.full(SAMPLES, np.pi), D, np.full(SAMPLES, 0.4))[
        None
    ],
    AxisRelation.COINCIDENT: standard_link(0 * A, 0 * A, D, np.full(SAMPLES, 0.4))[None],
}
RELATIONS = pytest.mark.parametrize("relation", TARGETS)


def reached(rows: Numbers, target: Matrices) -> Matrices:
    return np.asarray(inverse(target)[:, None] @ standard_link(*np.moveaxis(rows, 2, 0)))


@RELATIONS
def test_the_relation_of_the_axes_is_recognised(relation: AxisRelation) -> None:
    assert axis_relations(TARGETS[relation], 1.0) == relation


def test_axes_4_milliradians_apart_are_not_parallel() -> None:
    target = rot_x(np.full((1, SAMPLES), 0.004))
    assert axis_relations(target, 1.0) == AxisRelation.SKEW


@RELATIONS
@pytest.mark.parametrize("written", [NOTHING, RNG.uniform(-1, 1, (4, SAMPLES))], ids=["no", "yes"])
def test_every_candidate_puts_z_on_the_line(relation: AxisRelation, written: Numbers) -> None:
    target = TARGETS[relation]
    frames = reached(candidate_rows(target, written, TargetKind.REVOLUTE, 1.0), target)
    np.testing.assert_allclose(np.abs(frames[..., 2, 2]), 1, atol=1e-12)
    np.testing.assert_allclose(frames[..., :2, 3], 0, atol=1e-12)


@RELATIONS
def test_every_candidate_for_a_prismatic_joint_is_parallel_to_it(relation: AxisRelation) -> None:
    target, written = TARGETS[relation], RNG.uniform(-1, 1, (4, SAMPLES))
    rows = candidate_rows(target, written, TargetKind.PRISMATIC, 1.0)
    frames = reached(rows, target)
    np.testing.assert_allclose(np.abs(frames[..., 2, 2]), 1, atol=1e-12)
    as_written = np.abs(rows[0, :, [0, 2]] - written[[0, 2], None]).max(axis=(0, 2))
    assert (as_written == 0).any()  # the axis may be where the written row puts it


@RELATIONS
def test_both_directions_of_z_and_the_reference_s_own_row_are_offered(
    relation: AxisRelation,
) -> None:
    target = TARGETS[relation]
    rows = candidate_rows(target, NOTHING, TargetKind.REVOLUTE, 1.0)
    frames = reached(rows, target)[0, :, 0]
    assert set(np.sign(frames[:, 2, 2])) == {1.0, -1.0}
    assert (np.abs(frames - np.eye(4)).max(axis=(1, 2)) < 1e-9).any()


def test_the_written_offset_is_kept_between_parallel_axes() -> None:
    written = np.full((4, SAMPLES), 0.123)
    rows = candidate_rows(TARGETS[AxisRelation.PARALLEL], written, TargetKind.REVOLUTE, 1.0)
    assert {0.123, D[0]} == set(rows[0, :, 2, 0])


def test_one_row_leads_to_the_tool() -> None:
    target = TARGETS[AxisRelation.SKEW]
    rows = candidate_rows(target, NOTHING, TargetKind.TOOL, 1.0)
    assert rows.shape == (1, 1, 4, SAMPLES)
    np.testing.assert_allclose(rows[0, 0], [A, np.full(SAMPLES, 0.7), D, np.full(SAMPLES, 0.4)])
    assert not is_unreachable(target, 1.0).any()


@pytest.mark.parametrize(
    "offset", [rot_y(0.1), rot_z(0.3) @ trans(0, 0.2, 0)], ids=["DH1 fails", "DH2 fails"]
)
def test_no_row_leads_to_a_frame_that_breaks_a_dh_condition(offset: Matrices) -> None:
    target = np.broadcast_to(offset, (1, SAMPLES, 4, 4))
    assert is_unreachable(target, 1.0).all()


def test_an_open_tool_and_a_fixed_frame_take_the_row_as_written() -> None:
    target, written = TARGETS[AxisRelation.SKEW], RNG.uniform(-1, 1, (4, SAMPLES))
    for kind in (TargetKind.OPEN, TargetKind.FIXED):
        rows = candidate_rows(target, written, kind, 1.0)
        np.testing.assert_array_equal(rows[0, 0], written)


def test_the_other_value_is_used_if_nothing_was_written() -> None:
    np.testing.assert_array_equal(written_or(np.array([1.0, np.nan]), np.array([5.0, 6.0])), [1, 6])
