"""Robots for tests, and their tables."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from dh_grader.catalogue import Exercise
from dh_grader.grading import PartReport, Submission, Verdict, grade

# --- Four reference tables, copied from textbooks

# Twists are in whole degrees; joint variables have the textbook's star. A Spelling writes a table
# as a student may write it.
#
# Sources: planar RRR and RRRP from Robotic Fundamentals (UMFM4X-15-M), Forward Kinematics, Examples
# 1 and 2; Stanford arm and SCARA from Spong, Hutchinson, Vidyasagar, Robot Modeling and Control,
# pp. 91-93.

COLUMNS = ("a", "alpha", "d", "theta")
ANGLES = ("alpha", "theta")

Row = tuple[str, str, str, str]
AngleUnit = Literal["radians", "degrees"]


@dataclass(frozen=True)
class Robot:
    """A textbook robot: its exercise, its table and its letters."""

    exercise: str
    joints: tuple[str, ...]
    lengths: tuple[str, ...]
    labels: tuple[str, ...]
    rows: tuple[Row, ...]


PLANAR_RRR = Robot(
    "planar-rrr",
    ("q1", "q2", "q3"),
    ("l1", "l2", "l3"),
    ("1", "2", "3", "e"),
    (
        ("0", "0", "0", "q1*"),
        ("l1", "0", "0", "q2*"),
        ("l2", "0", "0", "q3*"),
        ("l3", "0", "0", "0"),
    ),
)
RRRP = Robot(
    "rrrp",
    ("q1", "q2", "q3", "q4"),
    ("l1", "l2", "l3", "l4"),
    ("1", "2", "3", "4"),
    (
        ("l2", "0", "l1", "q1*"),
        ("l3", "180", "0", "q2*"),
        ("0", "0", "l4", "q3*"),
        ("0", "0", "q4*", "0"),
    ),
)
SCARA = Robot(
    "scara",
    ("theta1", "theta2", "d3", "theta4"),
    ("a1", "a2", "d4"),
    ("1", "2", "3", "4"),
    (
        ("a1", "0", "0", "theta1*"),
        ("a2", "180", "0", "theta2*"),
        ("0", "0", "d3*", "0"),
        ("0", "0", "d4", "theta4*"),
    ),
)
STANFORD = Robot(
    "stanford-arm",
    ("theta1", "theta2", "d3", "theta4", "theta5", "theta6"),
    ("d2", "d6"),
    ("1", "2", "3", "4", "5", "6"),
    (
        ("0", "-90", "0", "theta1*"),
        ("0", "90", "d2", "theta2*"),
        ("0", "0", "d3*", "0"),
        ("0", "-90", "0", "theta4*"),
        ("0", "90", "0", "theta5*"),
        ("0", "0", "d6", "theta6*"),
    ),
)
ROBOTS = (PLANAR_RRR, RRRP, SCARA, STANFORD)


@dataclass(frozen=True)
class Spelling:
    """A way to write a table."""

    name: str
    angle_unit: AngleUnit
    twist: Callable[[int], str]
    turning: str = ""
    sliding: str = ""

    def rows(self, robot: Robot) -> list[Row]:
        return [
            (a, self.twist(int(alpha)), _named(d, self.sliding), _named(theta, self.turning))
            for a, alpha, d, theta in robot.rows
        ]


def _named(cell: str, pattern: str) -> str:
    name = cell.removesuffix("*")
    if name == cell:
        return cell
    return pattern.replace("#", name[-1]) if pattern else name


def in_pi(degrees: int) -> str:
    return {-90: "-pi/2", 0: "0", 90: "pi/2", 180: "pi"}[degrees]


def with_unit(degrees: int) -> str:
    return f"{degrees}deg"


EXACT = Spelling("with pi", "radians", in_pi)
SPELLINGS = (
    EXACT,
    Spelling("with a unit", "radians", with_unit, "q#", "q#"),
    Spelling("bare degrees", "degrees", str, "theta#", "d#"),
    Spelling("pi where degrees are set", "degrees", in_pi, "q#", "q#"),
    Spelling("marked joints", "radians", lambda turn: f"{turn}°", "θ#*", "d#*"),
    Spelling("the other way round", "radians", lambda turn: f"{turn - 360}deg", "θ_#", "q_#"),
    Spelling("LaTeX", "radians", lambda turn: rf"{turn}^\circ", r"\theta_{#}", "d_{#}"),
)


# --- An exercise about the SCARA arm, in four parts

SCARA_EXERCISE = """
title = "SCARA"
source = "SHV, pp. 91-93"
statement = "As in the book."

[robot]
structure = "RRPR"
convention = "standard"
joints = ["theta1", "theta2", "d3", "theta4"]
table = [
    ["a1", "0", "0", "theta1"],
    ["a2", "180deg", "0", "theta2"],
    ["0", "0", "d3", "0"],
    ["0", "0", "d4", "theta4"],
]

[symbols]
a1 = { kind = "length", description = "link 1" }
a2 = { kind = "length", description = "link 2" }
d4 = { kind = "length", description = "tool" }

[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
points = 8
convention = "standard"
frames = "free"

[[parts]]
id = "links"
kind = "link_transforms"
title = "Link transforms"
points = 8
convention = "standard"
frames = "free"
follows = "table"

[[parts]]
id = "pose"
kind = "transform"
title = "Pose"
points = 8
follows = "links"

[[parts]]
id = "position"
kind = "position"
title = "Position"
points = 3
follows = "pose"
"""

TABLE: list[Row] = [
    ("a1", "0", "0", "q1"),
    ("a2", "pi", "0", "q2"),
    ("0", "0", "d3", "0"),
    ("0", "0", "d4", "q4"),
]
# The printed form of A_i (SHV, eq. 3.10), filled in by hand.
A1 = [["c1", "-s1", "0", "a1*c1"], ["s1", "c1", "0", "a1*s1"], ["0", "0", "1", "0"], list("0001")]
A2 = [["c2", "s2", "0", "a2*c2"], ["s2", "-c2", "0", "a2*s2"], ["0", "0", "-1", "0"], list("0001")]
A3 = [list("1000"), list("0100"), ["0", "0", "1", "d3"], list("0001")]
A4 = [["c4", "-s4", "0", "0"], ["s4", "c4", "0", "0"], ["0", "0", "1", "d4"], list("0001")]
LINKS = [A1, A2, A3, A4]
IDENTITY = [list("1000"), list("0100"), list("0010"), list("0001")]


def a2_with(length: str) -> list[list[str]]:
    return [[cell.replace("a2", length) for cell in row] for row in A2]


def pose_with(length: str) -> list[list[str]]:
    turn = "q1 + q2 - q4"
    return [
        [f"cos({turn})", f"sin({turn})", "0", f"a1*c1 + {length}*c12"],
        [f"sin({turn})", f"-cos({turn})", "0", f"a1*s1 + {length}*s12"],
        ["0", "0", "-1", "-d3 - d4"],
        list("0001"),
    ]


def table(rows: Sequence[Sequence[str]]) -> dict[str, Any]:
    return {"rows": [dict(zip(("a", "alpha", "d", "theta"), row, strict=True)) for row in rows]}


def graded(exercise: Exercise, **answers: object) -> dict[str, PartReport]:
    return {part.part: part for part in grade(exercise, Submission(answers)).parts}


def wrong_cells(part: PartReport) -> set[tuple[str, str]]:
    return {
        (row.label, cell.label)
        for row in part.rows
        for cell in row.cells
        if cell.verdict is not Verdict.CORRECT
    }


# --- The spherical wrist with its joints 4 to 6: link transforms and screw axes

# Spong, Hutchinson, Vidyasagar, Robot Modeling and Control, spherical wrist of Figure 3.8.
WRIST_A4 = "[c4, 0, -s4, 0; s4, 0, c4, 0; 0, -1, 0, 0; 0, 0, 0, 1]"
A5 = "[c5, 0, s5, 0; s5, 0, -c5, 0; 0, 1, 0, 0; 0, 0, 0, 1]"
A6 = "[c6, -s6, 0, 0; s6, c6, 0, 0; 0, 0, 1, d6; 0, 0, 0, 1]"

WRIST = """
title = "Wrist"
source = "a test"
statement = "A wrist."
feedback = "full"
[robot]
structure = "RRR"
convention = "standard"
joints = ["theta4", "theta5", "theta6"]
table = [["0", "-90deg", "0", "theta4"], ["0", "90deg", "0", "theta5"], ["0", "0", "d6", "theta6"]]
[symbols]
d6 = { kind = "length", range = [0.1, 0.4], description = "length" }
[[parts]]
id = "links"
kind = "link_transforms"
title = "Links"
prompt = "Give them."
points = 6
convention = "standard"
[[parts]]
id = "screws"
kind = "screw_axes"
title = "Screws"
prompt = "Give them."
points = 6
frame = "space"
"""
