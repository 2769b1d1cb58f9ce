"""Test which frames a table may choose."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from dh_grader.kinematics import (
    Matrices,
    Numbers,
    compound,
    identity,
    inverse,
    is_unreachable,
    rot_x,
    rot_y,
    rot_z,
    standard_link,
    z_links,
)
from dh_grader.kinematics.frame_choice import (
    MOVED,
    TURNED_OVER,
    WRONG_CELL,
    AxisRelation,
    BaseFreedom,
    RowConstants,
    Target,
    TargetKind,
    align_axes,
    axis_relations,
    candidate_rows,
    departure,
    joint_signs_of,
    match_as_written,
    match_tables,
    nearest_table,
    reversed_cells,
    reversed_rows,
    reversed_targets,
    written_or,
)

from tests.kinematics.constructions import trans

# --- Move the axes of an arm onto those of its moved copy

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


# --- Test how each joint axis restricts the choice of a base frame

BASE_FREEDOM_SAMPLES = 2
ROWS = np.array([[0.5, 0.0, 0.3, 0.2]])[..., None].repeat(BASE_FREEDOM_SAMPLES, axis=-1)
WRITTEN = np.array([0.5, 0.0, 0.8, 1.1])[:, None].repeat(BASE_FREEDOM_SAMPLES, axis=-1)


def at(frame: Matrices) -> Matrices:
    return np.broadcast_to(frame, (BASE_FREEDOM_SAMPLES, 4, 4))


def test_a_revolute_joint_leaves_a_turn_and_a_slide_along_its_axis() -> None:
    freedom = BaseFreedom.on_first_axis(prismatic=False, samples=BASE_FREEDOM_SAMPLES)
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
    freedom = BaseFreedom.on_first_axis(prismatic=True, samples=BASE_FREEDOM_SAMPLES)
    assert freedom.anywhere
    turning = freedom.at_next(at(rot_x(1.0)), TargetKind.REVOLUTE, 1.0)
    assert not turning.anywhere
    assert turning.slide is not None


def test_the_slide_is_chosen_to_match_the_written_length() -> None:
    freedom = BaseFreedom.on_first_axis(prismatic=False, samples=BASE_FREEDOM_SAMPLES)
    beyond = ROWS.copy()
    beyond[:, 2] -= 1.0
    [(rows, distance)] = freedom.use_up(ROWS, beyond, WRITTEN)
    np.testing.assert_allclose(rows[0, 2], WRITTEN[2])
    np.testing.assert_allclose(distance, -0.5)


def test_the_turn_is_chosen_to_match_the_written_angle() -> None:
    freedom = BaseFreedom.on_first_axis(prismatic=False, samples=BASE_FREEDOM_SAMPLES)
    np.testing.assert_array_equal(freedom.with_written_angle(ROWS, WRITTEN)[0, 3], WRITTEN[3])
    np.testing.assert_array_equal(BaseFreedom().with_written_angle(ROWS, WRITTEN), ROWS)


# --- Every proposed table row leads to the intended axis or frame

CANDIDATE_ROWS_SAMPLES = 4
RNG = np.random.default_rng(11)
A = RNG.uniform(0.2, 0.9, CANDIDATE_ROWS_SAMPLES)
D = RNG.uniform(0.2, 0.9, CANDIDATE_ROWS_SAMPLES)
NOTHING = np.full((4, CANDIDATE_ROWS_SAMPLES), np.nan)
TARGETS: dict[AxisRelation, Matrices] = {
    AxisRelation.SKEW: standard_link(
        A, np.full(CANDIDATE_ROWS_SAMPLES, 0.7), D, np.full(CANDIDATE_ROWS_SAMPLES, 0.4)
    )[None],
    AxisRelation.PARALLEL: standard_link(
        A, np.full(CANDIDATE_ROWS_SAMPLES, np.pi), D, np.full(CANDIDATE_ROWS_SAMPLES, 0.4)
    )[None],
    AxisRelation.COINCIDENT: standard_link(0 * A, 0 * A, D, np.full(CANDIDATE_ROWS_SAMPLES, 0.4))[
        None
    ],
}
RELATIONS = pytest.mark.parametrize("relation", TARGETS)


def reached(rows: Numbers, target: Matrices) -> Matrices:
    return np.asarray(inverse(target)[:, None] @ standard_link(*np.moveaxis(rows, 2, 0)))


@RELATIONS
def test_the_relation_of_the_axes_is_recognised(relation: AxisRelation) -> None:
    assert axis_relations(TARGETS[relation], 1.0) == relation


def test_axes_4_milliradians_apart_are_not_parallel() -> None:
    target = rot_x(np.full((1, CANDIDATE_ROWS_SAMPLES), 0.004))
    assert axis_relations(target, 1.0) == AxisRelation.SKEW


@RELATIONS
@pytest.mark.parametrize(
    "written", [NOTHING, RNG.uniform(-1, 1, (4, CANDIDATE_ROWS_SAMPLES))], ids=["no", "yes"]
)
def test_every_candidate_puts_z_on_the_line(relation: AxisRelation, written: Numbers) -> None:
    target = TARGETS[relation]
    frames = reached(candidate_rows(target, written, TargetKind.REVOLUTE, 1.0), target)
    np.testing.assert_allclose(np.abs(frames[..., 2, 2]), 1, atol=1e-12)
    np.testing.assert_allclose(frames[..., :2, 3], 0, atol=1e-12)


@RELATIONS
def test_every_candidate_for_a_prismatic_joint_is_parallel_to_it(relation: AxisRelation) -> None:
    target, written = TARGETS[relation], RNG.uniform(-1, 1, (4, CANDIDATE_ROWS_SAMPLES))
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
    written = np.full((4, CANDIDATE_ROWS_SAMPLES), 0.123)
    rows = candidate_rows(TARGETS[AxisRelation.PARALLEL], written, TargetKind.REVOLUTE, 1.0)
    assert {0.123, D[0]} == set(rows[0, :, 2, 0])


def test_one_row_leads_to_the_tool() -> None:
    target = TARGETS[AxisRelation.SKEW]
    rows = candidate_rows(target, NOTHING, TargetKind.TOOL, 1.0)
    assert rows.shape == (1, 1, 4, CANDIDATE_ROWS_SAMPLES)
    np.testing.assert_allclose(
        rows[0, 0],
        [A, np.full(CANDIDATE_ROWS_SAMPLES, 0.7), D, np.full(CANDIDATE_ROWS_SAMPLES, 0.4)],
    )
    assert not is_unreachable(target, 1.0).any()


@pytest.mark.parametrize(
    "offset", [rot_y(0.1), rot_z(0.3) @ trans(0, 0.2, 0)], ids=["DH1 fails", "DH2 fails"]
)
def test_no_row_leads_to_a_frame_that_breaks_a_dh_condition(offset: Matrices) -> None:
    target = np.broadcast_to(offset, (1, CANDIDATE_ROWS_SAMPLES, 4, 4))
    assert is_unreachable(target, 1.0).all()


def test_an_open_tool_and_a_fixed_frame_take_the_row_as_written() -> None:
    target, written = TARGETS[AxisRelation.SKEW], RNG.uniform(-1, 1, (4, CANDIDATE_ROWS_SAMPLES))
    for kind in (TargetKind.OPEN, TargetKind.FIXED):
        rows = candidate_rows(target, written, kind, 1.0)
        np.testing.assert_array_equal(rows[0, 0], written)


def test_the_other_value_is_used_if_nothing_was_written() -> None:
    np.testing.assert_array_equal(written_or(np.array([1.0, np.nan]), np.array([5.0, 6.0])), [1, 6])


# --- A valid table in other frames matches the reference; a table of a different robot does not

# The identities are from the documentation.

Rows = Sequence[tuple[float, float, float, float]]

PI = np.pi
# Rows (a, α, d, θ) from base to tool: two parallel axes, a third one across them, and the tool.
REFERENCE: Rows = [(0, 0, 0, 0), (0.5, 0, 0.2, 0), (0.4, PI / 2, 0, 0), (0.1, 0, 0.3, 0)]
SIGNS = np.array([0, 1, 1, 1])
KINDS = [TargetKind.REVOLUTE, TargetKind.REVOLUTE, TargetKind.REVOLUTE, TargetKind.TOOL]


def rows_of(table: Rows) -> Numbers:
    return np.repeat(np.array(table, dtype=np.float64)[..., None], SAMPLES, axis=-1)


CHAIN_MATCH_TARGETS = [
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
    valid, poses = match_tables(rows_of(table)[None], np.array([signs]), CHAIN_MATCH_TARGETS, 1.0)
    assert valid.tolist() == [name in EQUIVALENT]
    assert poses.shape == (4, 1, SAMPLES, 4, 4)


def test_the_relative_poses_are_those_of_the_other_frames() -> None:
    table, signs = EQUIVALENT["z1 turned over"]
    _, poses = match_tables(rows_of(table)[None], np.array([signs]), CHAIN_MATCH_TARGETS, 1.0)
    np.testing.assert_allclose(poses[1, 0, 0], rot_x(PI), atol=1e-12)
    assert [int(joint_signs_of(pose)[0]) for pose in poses] == [1, -1, 1, 1]


def test_free_directions_allow_both_signs() -> None:
    rows = rows_of(REFERENCE)[None]
    assert not match_tables(rows, np.array([[0, 1, -1, 1]]), CHAIN_MATCH_TARGETS, 1.0)[0].any()
    assert match_tables(rows, np.zeros((1, 4), np.int_), CHAIN_MATCH_TARGETS, 1.0)[0].all()


def test_the_base_may_have_another_pose() -> None:
    start = np.broadcast_to(trans(0, 0, 0.3), (SAMPLES, 4, 4))
    table = [(0, 0, -0.3, 0), *REFERENCE[1:]]
    signs = SIGNS[None]
    assert match_tables(rows_of(table)[None], signs, CHAIN_MATCH_TARGETS, 1.0, start=start)[0].all()


def written(*, wrong: bool) -> list[RowConstants]:
    yes, no = np.ones(4, np.bool_), np.zeros(4, np.bool_)
    wrong_regardless = np.array([False, False, wrong, False])
    return [
        RowConstants(row, yes, wrong_regardless, no, np.zeros(4), 3 if sign else None, int(sign))
        for row, sign in zip(rows_of(REFERENCE), SIGNS, strict=True)
    ]


def test_a_table_with_a_cell_wrong_in_any_frames_does_not_match() -> None:
    match = match_as_written(written(wrong=False), CHAIN_MATCH_TARGETS, 1.0)
    assert match is not None
    assert match.cost == 0
    assert match.joint_signs == [1, 1, 1, 1]
    np.testing.assert_array_equal(match.rows, rows_of(REFERENCE))
    assert match_as_written(written(wrong=True), CHAIN_MATCH_TARGETS, 1.0) is None


# --- Find the valid table that is nearest to a table with a slip

FRAME_CHOICE_RNG = np.random.default_rng(3)
LENGTHS = FRAME_CHOICE_RNG.uniform(0.2, 0.9, (4, 4, SAMPLES))
ANGLES = np.array([0.0, np.pi / 2, -np.pi / 2, 0.0])


def arm() -> Numbers:
    # Return four rows from base to tool with general lengths and right angles between axes.
    rows = LENGTHS.copy()
    rows[:, 1], rows[:, 3] = ANGLES[:, None], 0.3
    rows[0] = 0.0
    return rows


FRAME_CHOICE_TARGETS = [
    Target(kind, standard_link(*row))
    for kind, row in zip([TargetKind.REVOLUTE] * 3 + [TargetKind.TOOL], arm(), strict=True)
]


def constants(rows: Numbers) -> list[RowConstants]:
    yes, no = np.ones(4, np.bool_), np.zeros(4, np.bool_)
    return [
        RowConstants(row, yes, no, no, np.zeros(4), 3 if i else None, 1 if i else 0)
        for i, row in enumerate(rows)
    ]


@pytest.mark.parametrize("cell", [(1, 0), (1, 2), (2, 0), (2, 1), (2, 2), (3, 0), (3, 3)])
def test_one_wrong_cell_costs_one_and_is_repaired(cell: tuple[int, int]) -> None:
    rows = arm()
    rows[cell] += 0.37
    match = nearest_table(constants(rows), FRAME_CHOICE_TARGETS, 1.0)
    assert match.cost == pytest.approx(WRONG_CELL)
    turns = match.rows - arm()
    turns[:, [1, 3]] -= 2 * np.pi * np.round(turns[:, [1, 3]] / (2 * np.pi))
    np.testing.assert_allclose(turns, 0, atol=1e-9)


def test_other_frames_cost_little() -> None:
    rows = arm()
    rows[1, 1] += np.pi  # z of the next frame turned over
    rows[2, 1] -= np.pi
    rows[2, [2, 3]] *= -1
    written = constants(rows)
    written[2] = replace(written[2], joint_sign=-1)
    match = nearest_table(written, FRAME_CHOICE_TARGETS, 1.0)
    assert match.cost == pytest.approx(TURNED_OVER)
    assert match.joint_signs == [1, -1, 1, 1]


def test_each_difference_of_a_frame_has_a_cost() -> None:
    poses = np.stack([identity((SAMPLES,)), rot_x(np.full(SAMPLES, np.pi))])
    moved = np.broadcast_to(trans(0, 0, 0.2), (1, SAMPLES, 4, 4))
    costs = departure(np.concatenate([poses, moved]), 1.0)
    np.testing.assert_allclose(costs, [0, TURNED_OVER, MOVED])


# --- The product of a reversed chain of transforms is the inverse


def cells_of(table: Rows) -> Numbers:
    return np.repeat(np.array(table, dtype=np.float64)[..., None], SAMPLES, axis=-1)


def reversed_chain_rows_of(table: Rows) -> list[RowConstants]:
    first = np.array([False, False, True, True])
    return [
        RowConstants(
            cells,
            ~(first & (i == 0)),
            np.zeros(4, np.bool_),
            first & (i == 0),
            np.zeros(4),
            3 if i else None,
            1 if i else 0,
        )
        for i, cells in enumerate(cells_of(table))
    ]


REVERSED_CHAIN_TARGETS = [
    Target(kind, standard_link(*row)) for kind, row in zip(KINDS, cells_of(REFERENCE), strict=True)
]
OFFSETS = z_links(cells_of(REFERENCE)[1:])


def seen_from_tool(table: Rows) -> tuple[float, Numbers]:
    targets = reversed_targets(REVERSED_CHAIN_TARGETS, OFFSETS)
    match = nearest_table(reversed_rows(reversed_chain_rows_of(table)), targets, 0.5)
    return match.cost, -reversed_cells(match.rows)


def test_the_reversed_rows_give_the_inverse_product() -> None:
    cells = cells_of(REFERENCE)
    backwards = np.array([row.written for row in reversed_rows(reversed_chain_rows_of(REFERENCE))])
    product = compound(standard_link(*np.moveaxis(backwards, 1, 0)))
    np.testing.assert_allclose(
        product, inverse(compound(standard_link(*np.moveaxis(cells, 1, 0)))), atol=1e-12
    )
    np.testing.assert_array_equal(-reversed_cells(backwards), cells)


def test_the_reference_is_valid_from_its_tool() -> None:
    backwards = np.array([row.written for row in reversed_rows(reversed_chain_rows_of(REFERENCE))])
    targets = reversed_targets(REVERSED_CHAIN_TARGETS, OFFSETS)
    valid, poses = match_tables(backwards[None], np.array([[0, 1, 1, 1]]), targets, 0.5)
    assert valid[0]
    np.testing.assert_allclose(poses[:, 0] - np.eye(4), 0, atol=1e-12)


def test_another_base_is_valid_from_the_tool() -> None:
    cost, _ = seen_from_tool([(0, 0, 0, 0), (0.5, 0, 0.9, 1.1), *REFERENCE[2:]])
    assert cost < 1


def test_a_wrong_length_is_the_only_wrong_cell_from_the_tool() -> None:
    cost, rows = seen_from_tool([*REFERENCE[:2], (0.7, PI / 2, 0, 0), REFERENCE[3]])
    assert 1 <= cost < 2
    error = rows - cells_of(REFERENCE)
    error[:, [1, 3]] -= 2 * PI * np.round(error[:, [1, 3]] / (2 * PI))
    np.testing.assert_allclose(error, 0, atol=1e-12)
