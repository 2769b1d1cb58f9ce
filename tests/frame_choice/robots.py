"""Robots with their correct tables, and an exercise file for each."""

# Sources: planar RRR, RRRP, spatial RRR from Robotic Fundamentals (UMFM4X-15-M), Forward
# Kinematics; planar RR, Stanford arm, SCARA, cylindrical arm, spherical wrist and Cartesian arm
# from Spong, Hutchinson, Vidyasagar, Robot Modeling and Control, chapter 3; Baxter's left arm with
# its published lengths; the PUMA 560 from Craig, Introduction to Robotics, section 3.7. The skew
# RPR, the PRRP and the tilted RP are invented: axes at angles that are no multiple of 90 degrees,
# prismatic joints at both ends, a base frame that is not on the first axis.

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from dh_grader.catalogue import Exercise, load_exercise

TextRow = tuple[str, str, str, str]

STANDARD = "standard"
MODIFIED = "modified"
CONVENTIONS = (STANDARD, MODIFIED)
COLUMNS = ("a", "alpha", "d", "theta")
A, ALPHA, D, THETA = range(4)


@dataclass(frozen=True)
class Policy:
    """What a student may choose: the base frame, the end-effector frame, and joint directions."""

    name: str
    base: bool = False
    tool: bool = False
    directions: bool = False


GIVEN = Policy("given")
POLICIES = (
    GIVEN,
    Policy("free base", base=True),
    Policy("free tool", tool=True),
    Policy("free base, tool", base=True, tool=True),
    Policy("free directions", directions=True),
    Policy("free base, directions", base=True, directions=True),
    Policy("free tool, directions", tool=True, directions=True),
    Policy("all free", base=True, tool=True, directions=True),
)


@dataclass(frozen=True)
class Robot:
    """A robot and its correct table, as formulas."""

    name: str
    structure: str
    convention: str
    joints: tuple[str, ...]
    rows: tuple[TextRow, ...]
    lengths: tuple[str, ...]
    first: int = 1
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict, hash=False)

    def column(self, joint: int) -> int:
        """Return the column of a joint's variable, counted from 0."""
        return D if self.structure[joint] == "P" else THETA

    def range(self, symbol: str) -> tuple[float, float]:
        # Return the range for random values of a length; it depends on the robot.
        usual = ((0.2, 1.0), (0.1, 0.4), (0.5, 2.5))[len(self.name) % 3]
        return self.ranges.get(symbol, usual)

    def labels(self, rows: int) -> list[str]:
        joints = len(self.joints)
        return [str(self.first + i) if i < joints else "e" for i in range(rows)]


def _robot(
    name: str,
    structure: str,
    convention: str,
    joints: str,
    lengths: str,
    *rows: str,
    first: int = 1,
) -> Robot:
    cells = tuple((a, alpha, d, theta) for a, alpha, d, theta in (row.split() for row in rows))
    return Robot(
        name, structure, convention, tuple(joints.split()), cells, tuple(lengths.split()), first
    )


STANFORD_ROWS = (
    "0  pi/2 d2 theta2",
    "0     0 d3      0",
    "0 -pi/2  0 theta4",
    "0  pi/2  0 theta5",
    "0     0 d6 theta6",
)
STANFORD_JOINTS = "theta1 theta2 d3 theta4 theta5 theta6"

ROBOTS = (
    _robot("planar RR", "RR", STANDARD, "theta1 theta2", "a1 a2", "a1 0 0 theta1", "a2 0 0 theta2"),
    _robot(
        "planar RRR",
        "RRR",
        MODIFIED,
        "q1 q2 q3",
        "l1 l2 l3",
        " 0 0 0 q1",
        "l1 0 0 q2",
        "l2 0 0 q3",
        "l3 0 0  0",
    ),
    _robot(
        "planar RRR standard",
        "RRR",
        STANDARD,
        "q1 q2 q3",
        "l1 l2 l3",
        "l1 0 0 q1",
        "l2 0 0 q2",
        "l3 0 0 q3",
    ),
    _robot(
        "RRRP",
        "RRRP",
        STANDARD,
        "q1 q2 q3 q4",
        "l1 l2 l3 l4",
        "l2  0 l1 q1",
        "l3 pi  0 q2",
        " 0  0 l4 q3",
        " 0  0 q4  0",
    ),
    _robot(
        "spatial RRR",
        "RRR",
        STANDARD,
        "theta1 theta2 theta3",
        "R L1 L2",
        " R pi/2 0 theta1",
        "L1    0 0 theta2",
        "L2    0 0 theta3",
    ),
    _robot(
        "Stanford", "RRPRRR", STANDARD, STANFORD_JOINTS, "d2 d6", "0 -pi/2 0 theta1", *STANFORD_ROWS
    ),
    _robot(
        "Stanford d1",
        "RRPRRR",
        STANDARD,
        STANFORD_JOINTS,
        "d1 d2 d6",
        "0 -pi/2 d1 theta1",
        *STANFORD_ROWS,
    ),
    _robot(
        "SCARA",
        "RRPR",
        STANDARD,
        "theta1 theta2 d3 theta4",
        "a1 a2 d4",
        "a1  0  0 theta1",
        "a2 pi  0 theta2",
        " 0  0 d3      0",
        " 0  0 d4 theta4",
    ),
    _robot(
        "cylindrical RPP",
        "RPP",
        STANDARD,
        "theta1 d2 d3",
        "d1",
        "0     0 d1 theta1",
        "0 -pi/2 d2      0",
        "0     0 d3      0",
    ),
    _robot(
        "spherical wrist",
        "RRR",
        STANDARD,
        "theta4 theta5 theta6",
        "d6",
        "0 -pi/2  0 theta4",
        "0  pi/2  0 theta5",
        "0     0 d6 theta6",
        first=4,
    ),
    _robot(
        "Cartesian PPP",
        "PPP",
        STANDARD,
        "d1 d2 d3",
        "",
        "0 -pi/2 d1     0",
        "0 -pi/2 d2 -pi/2",
        "0     0 d3     0",
    ),
    _robot(
        "Baxter 7R",
        "RRRRRRR",
        STANDARD,
        "theta1 theta2 theta3 theta4 theta5 theta6 theta7",
        "",
        "0.069 -pi/2 0.27035 theta1",
        "0 pi/2 0 theta2+pi/2",
        "0.069 -pi/2 0.36435 theta3",
        "0 pi/2 0 theta4",
        "0.010 -pi/2 0.37429 theta5",
        "0 pi/2 0 theta6",
        "0 0 0.229525 theta7",
    ),
    _robot(
        "skew RPR",
        "RPR",
        STANDARD,
        "q1 q2 q3",
        "l1 l2 l3 h",
        "l1  pi/3  h q1",
        "l2 -pi/4 q2 pi/6",
        "l3  pi/2 h/2 q3",
    ),
    _robot(
        "PRRP",
        "PRRP",
        STANDARD,
        "d1 theta2 theta3 d4",
        "a1 a2 a3",
        "a1 pi/2 d1      0",
        "a2    0  0 theta2",
        "a3 pi/2  0 theta3",
        " 0    0 d4   pi/2",
    ),
    _robot(
        "PUMA 560",
        "RRRRRR",
        MODIFIED,
        "theta1 theta2 theta3 theta4 theta5 theta6",
        "a2 a3 d3 d4",
        " 0     0  0 theta1",
        " 0 -pi/2  0 theta2",
        "a2     0 d3 theta3",
        "a3 -pi/2 d4 theta4",
        " 0  pi/2  0 theta5",
        " 0 -pi/2  0 theta6",
    ),
    _robot(
        "tilted RP",
        "RP",
        MODIFIED,
        "q1 q2",
        "l0 l1 l2",
        "l0 pi/6 0 q1",
        "l1 pi/2 q2 0",
        "l2    0  0 0",
    ),
)


def exercise_text(robot: Robot, policy: Policy) -> str:
    """Return an exercise file that asks for a robot's table."""
    rows = "\n".join(f"    {list(row)}," for row in robot.rows)
    lengths = "\n".join(
        f'{name} = {{ kind = "length", description = "length", range = {list(robot.range(name))}}}'
        for name in robot.lengths
    )
    word = {True: "free", False: "given"}
    return f"""
title = "{robot.name}"
source = "tests"
statement = "{robot.name}, {policy.name}"

[robot]
structure = "{robot.structure}"
convention = "{robot.convention}"
joints = {list(robot.joints)}
table = [
{rows}
]

[symbols]
{lengths}

[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
points = {4 * len(robot.rows)}
convention = "either"
frames = "free"
base = "{word[policy.base]}"
tool = "{word[policy.tool]}"
directions = "{word[policy.directions]}"
"""


@cache
def exercise(robot: Robot, policy: Policy) -> Exercise:
    """Return the compiled exercise of a robot."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "frame-choice.toml"
        file.write_text(exercise_text(robot, policy), encoding="utf-8")
        return load_exercise(file)


def conventions(robot: Robot, policy: Policy) -> tuple[str, ...]:
    # Return the conventions of the robot's tables; a standard table needs z0 on axis 1.
    begins_elsewhere = robot.convention == MODIFIED and robot.rows[0][:2] != ("0", "0")
    return (MODIFIED,) if begins_elsewhere and not policy.base else CONVENTIONS
