"""Test the oracle, which decides whether two tables describe the same robot."""

import math

import numpy as np
import pytest

from tests.frame_choice.edits import random_edit
from tests.frame_choice.generator import reassignment
from tests.frame_choice.oracle import is_equivalent
from tests.frame_choice.repairs import can_repair, repairing_cells
from tests.frame_choice.robots import (
    GIVEN,
    MODIFIED,
    POLICIES,
    ROBOTS,
    STANDARD,
    A,
    D,
    Policy,
    Robot,
    conventions,
)
from tests.frame_choice.trials import equivalent
from tests.together import together

BY_NAME = {robot.name: robot for robot in ROBOTS}
SCARA, STANFORD, RRRP = BY_NAME["SCARA"], BY_NAME["Stanford"], BY_NAME["RRRP"]
FREE_BASE, FREE_TOOL, FREE_ENDS, FREE_DIRECTIONS = POLICIES[1:5]
ALL_FREE = POLICIES[-1]
RRRP_MODIFIED = (
    ("0", "0", "l1", "q1"),
    ("l2", "0", "0", "q2"),
    ("l3", "pi", "l4", "q3"),
    ("0", "0", "q4", "0"),
)


def with_cell(robot: Robot, row: int, column: int, text: str) -> list[list[str]]:
    rows = [list(cells) for cells in robot.rows]
    rows[row][column] = text
    return rows


@together("policy", POLICIES)
@together("robot", ROBOTS)
def test_the_reference_is_valid(robot: Robot, policy: Policy) -> None:
    assert is_equivalent(robot, policy, robot.rows, robot.convention)


def test_the_modified_table_of_the_lecture_is_valid() -> None:
    assert is_equivalent(RRRP, GIVEN, RRRP_MODIFIED, MODIFIED)
    assert not is_equivalent(RRRP, GIVEN, RRRP_MODIFIED, STANDARD)


@pytest.mark.parametrize(
    ("robot", "rows"),
    [
        # x1 flipped
        (SCARA, {0: ("-a1", "0", "0", "theta1+pi"), 1: ("a2", "pi", "0", "theta2-pi")}),
        # z1 flipped
        (STANFORD, {0: ("0", "pi/2", "0", "theta1"), 1: ("0", "-pi/2", "-d2", "-theta2")}),
        # origin 1 slid along z1, parallel to z0 and z2
        (RRRP, {0: ("l2", "0", "l1+0.3", "q1"), 1: ("l3", "pi", "-0.3", "q2")}),
        # x3 turned about z3, which lies on z2
        (SCARA, {2: ("0", "0", "d3", "0.7"), 3: ("0", "0", "d4", "theta4-0.7")}),
    ],
)
def test_the_identities_of_frame_choice(
    robot: Robot, rows: dict[int, tuple[str, str, str, str]]
) -> None:
    table = [list(rows.get(i, row)) for i, row in enumerate(robot.rows)]
    if robot is STANFORD:  # the flip goes on: α1 and α2 turn by π, x stays
        table[0][1] = "pi/2"
    assert is_equivalent(robot, GIVEN, table, STANDARD)
    # half of a compensated change is none
    first = min(rows)
    half = [list(row) for row in robot.rows]
    half[first] = list(rows[first])
    assert not is_equivalent(robot, GIVEN, half, STANDARD)


def test_what_each_policy_frees() -> None:
    slid = with_cell(STANFORD, 0, D, "0.4")  # frame 0 slid along the first axis
    longer = with_cell(STANFORD, 5, D, "0.4")  # another end-effector frame
    turned = with_cell(STANFORD, 3, 3, "-theta4")  # the other way round
    wrong = with_cell(STANFORD, 1, D, "d6")  # another mechanism
    valid = {
        GIVEN: (False, False, False),
        FREE_BASE: (True, False, False),
        FREE_TOOL: (False, True, False),
        FREE_ENDS: (True, True, False),
        FREE_DIRECTIONS: (False, False, True),
        ALL_FREE: (True, True, True),
    }
    for policy, expected in valid.items():
        tables = (slid, longer, turned)
        found = tuple(is_equivalent(STANFORD, policy, table, STANDARD) for table in tables)
        assert found == expected, policy
        assert not is_equivalent(STANFORD, policy, wrong, STANDARD)


def test_a_mirrored_mechanism_is_another_one() -> None:
    # Both ends are free; one mechanism is planar, the other is spatial.
    for name in ("skew RPR", "Baxter 7R"):
        robot = BY_NAME[name]
        mirrored = [
            [a, f"-({alpha})", f"-({d})" if i == 0 else d, theta]
            for i, (a, alpha, d, theta) in enumerate(robot.rows)
        ]
        assert not is_equivalent(robot, FREE_ENDS, mirrored, robot.convention)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("robot", ROBOTS, ids=lambda robot: robot.name)
def test_drawn_tables_are_valid_and_differ(robot: Robot) -> None:
    rng = np.random.default_rng(5)
    seen = set()
    for policy in POLICIES:
        for convention in conventions(robot, policy):
            for _ in range(1):
                table, _ = reassignment(robot, policy, convention, rng)
                assert equivalent(table), table.texts
                seen.add(str(table.texts))
    assert len(seen) > 5


@pytest.mark.long
def test_the_cells_that_repair_a_table() -> None:
    # The closed form and least squares find the same cells.
    shared = with_cell(RRRP, 1, D, "0.3")  # d1, d2, d3 lie on parallel axes
    assert repairing_cells(RRRP, shared, STANDARD) == {(0, D), (1, D), (2, D), (3, D)}
    alone = with_cell(STANFORD, 1, A, "0.3")
    assert repairing_cells(STANFORD, alone, STANDARD) == {(1, A), (2, A)}
    rng = np.random.default_rng(6)
    robot = BY_NAME["skew RPR"]
    table, _ = reassignment(robot, GIVEN, STANDARD, rng)
    edit = random_edit(table, rng)
    wrong = table.edited(edit.row, edit.column, edit.cell).texts
    found = repairing_cells(robot, wrong, STANDARD)
    for row in range(len(wrong)):
        for column in range(4):
            is_found = can_repair(robot, GIVEN, wrong, STANDARD, [(row, column)])
            assert is_found == ((row, column) in found), (wrong, row, column)


def test_forward_kinematics_of_the_planar_arm() -> None:
    # x = a1 c1 + a2 c12, y = a1 s1 + a2 s12 (Spong, Hutchinson, Vidyasagar, eq. 3.11).
    from tests.frame_choice.kinematics import cell_values, forward

    values = {"a1": 0.5, "a2": 0.3, "theta1": 0.4, "theta2": 0.9}
    arrays = {name: np.asarray(value) for name, value in values.items()}
    pose = forward(cell_values(BY_NAME["planar RR"].rows, arrays), STANDARD)
    assert pose[0, 3] == pytest.approx(0.5 * math.cos(0.4) + 0.3 * math.cos(1.3))
    assert pose[1, 3] == pytest.approx(0.5 * math.sin(0.4) + 0.3 * math.sin(1.3))
