"""Find the valid table that is nearest to a table with a slip."""

from dataclasses import replace

import numpy as np
import pytest
from dh_grader.kinematics import Numbers, identity, rot_x, standard_link
from dh_grader.kinematics.frame_choice import (
    MOVED,
    TURNED_OVER,
    WRONG_CELL,
    RowConstants,
    Target,
    TargetKind,
    departure,
    nearest_table,
)

from tests.kinematics.constructions import trans

SAMPLES = 3
RNG = np.random.default_rng(3)
LENGTHS = RNG.uniform(0.2, 0.9, (4, 4, SAMPLES))
ANGLES = np.array([0.0, np.pi / 2, -np.pi / 2, 0.0])


def arm() -> Numbers:
    # Return four rows from base to tool with general lengths and right angles between axes.
    rows = LENGTHS.copy()
    rows[:, 1], rows[:, 3] = ANGLES[:, None], 0.3
    rows[0] = 0.0
    return rows


TARGETS = [
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
    match = nearest_table(constants(rows), TARGETS, 1.0)
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
    match = nearest_table(written, TARGETS, 1.0)
    assert match.cost == pytest.approx(TURNED_OVER)
    assert match.joint_signs == [1, -1, 1, 1]


def test_each_difference_of_a_frame_has_a_cost() -> None:
    poses = np.stack([identity((SAMPLES,)), rot_x(np.full(SAMPLES, np.pi))])
    moved = np.broadcast_to(trans(0, 0, 0.2), (1, SAMPLES, 4, 4))
    costs = departure(np.concatenate([poses, moved]), 1.0)
    np.testing.assert_allclose(costs, [0, TURNED_OVER, MOVED])
