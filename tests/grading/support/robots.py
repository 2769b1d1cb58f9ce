"""Four reference tables, copied from textbooks."""

# Twists are in whole degrees; joint variables have the textbook's star. A Spelling writes a table
# as a student may write it.
#
# Sources: planar RRR and RRRP from Robotic Fundamentals (UMFM4X-15-M), Forward Kinematics, Examples
# 1 and 2; Stanford arm and SCARA from Spong, Hutchinson, Vidyasagar, Robot Modeling and Control,
# pp. 91-93.

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

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
