"""A table of zeros and joint variables earns little."""

import pytest

from tests.frame_choice.oracle import is_equivalent
from tests.frame_choice.robots import (
    GIVEN,
    MODIFIED,
    POLICIES,
    ROBOTS,
    STANDARD,
    Policy,
    Robot,
    conventions,
    exercise,
)
from tests.frame_choice.trials import grade_rows

LAZY_SHARE = 0.25
RPR = Robot(
    "RPR with an offset",
    "RPR",
    STANDARD,
    ("q1", "q2", "q3"),
    (("0", "0", "p", "q1"), ("0", "pi/2", "q2+0.22", "0"), ("0", "0", "0", "q3")),
    ("p",),
)
PRRR = Robot(
    "PRRR with an odd twist",
    "PRRR",
    MODIFIED,
    ("q1", "q2", "q3", "q4"),
    (
        ("0", "0", "q1", "0"),
        ("0", "0", "0.41", "q2+3*pi/4"),
        ("0", "pi/4", "0.07", "q3"),
        ("0", "0", "0.34", "q4"),
    ),
    (),
)
# The last axis is reversed, so the modified table has a row after the last joint.
WITH_LAST_ROW = [
    ["0", "0", "p", "q1 + pi/6"],
    ["0", "pi", "-0.22 - q2", "pi/6"],
    ["0", "pi/2", "0", "-q3"],
    ["0", "pi", "0", "0"],
]


@pytest.mark.long
@pytest.mark.parametrize("policy", POLICIES, ids=lambda policy: policy.name)
def test_a_lazy_table_earns_at_most_a_quarter(policy: Policy) -> None:
    for robot in (RPR, PRRR, *ROBOTS):
        for convention in conventions(robot, policy):
            rows = [["0"] * 4 for _ in robot.joints]
            for i, variable in enumerate(robot.joints):
                rows[i][robot.column(i)] = variable
            report = grade_rows(exercise(robot, policy), rows, convention)
            if not is_equivalent(robot, policy, rows, convention):
                earned = report.points / report.max_points
                assert earned <= LAZY_SHARE, f"{robot.name}, {convention}"


def test_a_slip_in_a_table_that_needs_a_row_more_costs_no_more_than_its_cell() -> None:
    compiled = exercise(RPR, GIVEN)
    right = grade_rows(compiled, WITH_LAST_ROW, MODIFIED)
    assert right.points == right.max_points
    slipped = [list(row) for row in WITH_LAST_ROW]
    slipped[1][0] = "0.33"
    wrong = grade_rows(compiled, slipped, MODIFIED)
    lost = {row.label: row.max_points - row.points for row in wrong.rows}
    # The robot has two cells that are worth a unit each.
    assert 0 < sum(lost.values()) < wrong.max_points / 2
    assert {label for label, points in lost.items() if points} == {"2"}
    assert not wrong.feedback


@pytest.mark.long
def test_a_guessed_row_more_earns_nothing() -> None:
    compiled = exercise(RPR, GIVEN)
    guessed = [["0", "0", "0", "q1"], ["0", "0", "q2", "0"], ["0", "0", "0", "q3"]]
    lazy = grade_rows(compiled, guessed, MODIFIED)
    for row in (["0", "pi", "0", "0"], ["0.3", "pi/2", "0", "0"]):
        more = grade_rows(compiled, [*guessed, row], MODIFIED)
        assert more.points <= lazy.points
