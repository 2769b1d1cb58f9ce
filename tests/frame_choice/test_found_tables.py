"""Tables that were once graded wrongly, with the correct verdict."""

import pytest

from tests.frame_choice.oracle import is_equivalent
from tests.frame_choice.robots import MODIFIED, POLICIES, ROBOTS, STANDARD, Robot, exercise
from tests.frame_choice.trials import grade_rows

RPP = Robot(
    "numeric RPP",
    "RPP",
    STANDARD,
    ("theta1", "d2", "d3"),
    (("0", "0", "0", "theta1"), ("0.5", "0", "d2", "0"), ("0.7", "0", "d3", "-40*pi/180")),
    (),
)
ROBOT = {robot.name: robot for robot in (*ROBOTS, RPP)}
POLICY = {policy.name: policy for policy in POLICIES}

VALID = [
    (
        "tilted RP",
        STANDARD,
        "free base",
        ("l1 | -pi/2 | -l2 | q1", "l2 | pi | -q2 | 0"),
    ),
    (
        "Stanford d1",
        STANDARD,
        "all free",
        (
            "0 | -pi/2 | -d1 | theta1 - pi",
            "d6 - 0.57 | pi/2 | d2 | theta2",
            "d6 - 0.57 | pi | -d3 | pi",
            "0 | pi/2 | 0 | -theta4 + pi",
            "0 | pi/2 | 0 | -theta5 - pi",
            "0 | 0 | 0 | -theta6 + pi",
        ),
    ),
    (
        "cylindrical RPP",
        STANDARD,
        "free base",
        (
            "-1.41421356237*d1 | 0 | -d1 + 0.19 | -theta1 + 3*pi/4",
            "-2*d1 | pi/2 | -d2 - 0.52 | 3*pi/4",
            "-d1 | -pi | -d3 + d1 | pi",
        ),
    ),
    (
        "cylindrical RPP",
        MODIFIED,
        "free base, tool",
        (
            "0 | 0 | -d1 + 0.19 | -theta1",
            "0 | 0 | -d2 - 0.19 | 0",
            "0.7 | pi/2 | d3 - 0.49 | 0",
            "d1 | 0 | 0 | 0",
        ),
    ),
    (
        "planar RR",
        STANDARD,
        "free base, directions",
        ("a1 | 0 | 0 | theta1", "a2 | 0 | 0 | -theta2"),
    ),
]
INVALID = [
    (
        "numeric RPP",
        STANDARD,
        "free base",
        ("0 | 0 | 0 | theta1", "0.5 | 0 | d2 | 0", "0.7 | 0 | d3 | -0.87"),
    ),
    (
        "Cartesian PPP",
        MODIFIED,
        "given",
        (
            "0.17 | pi | -d1 + 0.21 | -pi",
            "0.38 | -pi/2 | d2 - 0.15 | -pi/2",
            "1.01 | -pi/2 | -d3 - 0.63 | 2.95624470359",
            "-0.8139410298 | pi | -0.42 | -0.18534795",
        ),
    ),
    (
        "cylindrical RPP",
        MODIFIED,
        "given",
        (
            "0 | pi | -d1 - 0.13 | -theta1 - atan2(-0.69, d1 - 0.27) - pi",
            "-sqrt((d1 - 0.27)^2 + 0.69^2) | 0 | -d2 + 0.13 | atan2(-0.69, d1 - 0.27) + pi",
            "0.04 | pi/2 | d3 + 0.69 | 0",
            "-d1 + 0.23 | -0.63 | 0 | 0",
        ),
    ),
    (
        "cylindrical RPP",
        STANDARD,
        "free base",
        ("d1 | 0 | d1 | theta1", "-d1 | -pi/2 | d2 | -pi/2", "0 | 0 | d3 | 0"),
    ),
    (
        "RRRP",
        MODIFIED,
        "free directions",
        (
            "0 | pi | -l1 + 0.68 | q1 - pi",
            "-l2 | 0 | -0.24 | -q2",
            "-l3 | pi | 0.44 | q3 - pi",
            "l1 - 0.34 | 0 | q4 - l4 | 0",
            "0.34 | pi | 0 | 0",
        ),
    ),
]
Case = tuple[str, str, str, tuple[str, ...]]


def judged(case: Case) -> tuple[bool, bool]:
    name, convention, policy, lines = case
    robot = ROBOT[name]
    rows = [[cell.strip() for cell in text.split("|")] for text in lines]
    report = grade_rows(exercise(robot, POLICY[policy]), rows, convention)
    return (
        is_equivalent(robot, POLICY[policy], rows, convention),
        report.points == report.max_points,
    )


@pytest.mark.parametrize("case", VALID, ids=lambda case: " ".join(case[:3]))
def test_valid_tables_get_full_marks(case: Case) -> None:
    assert judged(case) == (True, True)


@pytest.mark.parametrize("case", INVALID, ids=lambda case: " ".join(case[:3]))
def test_wrong_tables_do_not_get_full_marks(case: Case) -> None:
    assert judged(case) == (False, False)
