"""Generate random robots and valid frames on their axes, without the tested code."""

# Nothing here uses the geometry of the program: the frames come from plain products of rotations,
# the common normals from linear equations, and the oracle only tests the two conditions of a DH
# row.

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

Vector = NDArray[np.float64]
EXACT = 1e-7
TWISTS = (0.0, 90.0, -90.0, 180.0, 0.0, 90.0, 30.0, -137.0)
LENGTHS = (0.0, 0.0, 0.4, 0.25, -0.3)


@dataclass(frozen=True)
class Arm:
    """A robot as rows of numbers."""

    structure: str
    convention: str
    rows: tuple[tuple[float, float, float, float], ...]

    @property
    def names(self) -> list[str]:
        return [f"{'d' if kind == 'P' else 'q'}{i + 1}" for i, kind in enumerate(self.structure)]

    @property
    def text(self) -> str:
        lines = []
        for i, (a, alpha, d, theta) in enumerate(self.rows):
            cells = [f"{a!r}", f"{alpha!r}deg", f"{d!r}", f"{theta!r}deg"]
            if i < len(self.structure):
                column = 2 if self.structure[i] == "P" else 3
                cells[column] = f"{self.names[i]} + {cells[column]}"
            lines.append(str(cells).replace("'", '"'))
        return f"""
title = "Random"
source = "none"
statement = "Nothing to see."
[robot]
structure = "{self.structure}"
convention = "{self.convention}"
joints = {str(self.names).replace("'", '"')}
table = [{", ".join(lines)}]
[[parts]]
id = "frames"
kind = "frames"
title = "Frames"
points = 24
convention = "{self.convention}"
[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
points = 24
convention = "{self.convention}"
frames = "free"
"""


def drawn_arm(rng: Generator) -> Arm:
    """Return a random robot with two to six joints."""
    count = int(rng.integers(2, 7))
    structure = "".join(rng.choice(["R", "R", "R", "P"], count))
    convention = str(rng.choice(["standard", "modified"]))
    has_tool_row = convention == "modified" and bool(rng.random() < 0.5)

    def row() -> tuple[float, float, float, float]:
        a, d = rng.choice(LENGTHS, 2).tolist()
        return a, float(rng.choice(TWISTS)), d, float(rng.choice([0.0, 90.0, 0.0, 35.0]))

    return Arm(structure, convention, tuple(row() for _ in range(count + has_tool_row)))


def turn(axis: int, degrees: float) -> Vector:
    """Return the homogeneous rotation about a base axis."""
    one, other = (axis + 1) % 3, (axis + 2) % 3
    angle = np.radians(degrees)
    matrix = np.eye(4)
    matrix[one, one] = matrix[other, other] = np.cos(angle)
    matrix[other, one], matrix[one, other] = np.sin(angle), -np.sin(angle)
    return matrix


def shift(axis: int, length: float) -> Vector:
    """Return the homogeneous translation along a base axis."""
    matrix = np.eye(4)
    matrix[axis, 3] = length
    return matrix


@dataclass(frozen=True)
class Line:
    """A line: a point and a unit direction."""

    point: Vector
    direction: Vector


@dataclass(frozen=True)
class Home:
    """A robot at home (all joint variables are 0): its joint axes and its end frames."""

    arm: Arm
    axes: tuple[Line, ...]
    tool: Vector

    @property
    def asked(self) -> list[int]:
        count = len(self.arm.rows) - 1
        first = 1 if self.arm.convention == "standard" else 0
        return [first + i for i in range(count)]


def home_of(arm: Arm) -> Home:
    """Return the robot at home (all joint variables are 0)."""
    frame, axes = np.eye(4), []
    for i, (a, alpha, d, theta) in enumerate(arm.rows):
        z, x = turn(2, theta) @ shift(2, d), shift(0, a) @ turn(0, alpha)
        on_axis = frame if arm.convention == "standard" else frame @ x @ z
        if i < len(arm.structure):
            axes.append(Line(on_axis[:3, 3], on_axis[:3, 2]))
        frame = frame @ z @ x if arm.convention == "standard" else frame @ x @ z
    return Home(arm, tuple(axes), frame)


@dataclass(frozen=True)
class Placed:
    """A placed frame: joint number, z, origin and x."""

    joint: int
    z: Vector
    origin: Vector
    x: Vector

    @property
    def posted(self) -> dict[str, Any]:
        return {
            "axis": self.joint,
            "z": self.z.tolist(),
            "origin": self.origin.tolist(),
            "x": self.x.tolist(),
        }


def unit(vector: Vector) -> Vector:
    return np.asarray(vector / np.linalg.norm(vector))


def feet(one: Line, other: Line) -> tuple[Vector, Vector, Vector]:
    # Return the point of each line on their common normal, and the direction of the normal.
    normal = unit(np.cross(one.direction, other.direction))
    solved = np.linalg.solve(
        np.column_stack([one.direction, -other.direction, normal]), other.point - one.point
    )
    return (
        one.point + solved[0] * one.direction,
        other.point + solved[1] * other.direction,
        normal,
    )


def drawn_frames(home: Home, rng: Generator) -> list[Placed]:
    """Return random valid frames for a robot."""
    standard = home.arm.convention == "standard"
    asked = home.asked
    lines = dict(enumerate(home.axes))
    placed: dict[int, Placed] = {}
    for joint in asked if standard else reversed(asked):
        beside = joint - 1 if standard else joint + 1
        neighbour = lines.get(beside) or Line(home.tool[:3, 3], home.tool[:3, 2])
        own = lines[joint]
        parallel = np.linalg.norm(np.cross(own.direction, neighbour.direction)) < EXACT
        is_last = joint == (len(home.axes) - 1 if standard else 0)
        if home.arm.structure[joint] == "P" and not is_last and rng.random() < 0.5:
            if parallel:
                point = rng.uniform(-1, 1, 3)
            else:
                normal = unit(np.cross(own.direction, neighbour.direction))
                point = neighbour.point + rng.uniform(-1, 1) * neighbour.direction
                point = point + rng.choice([0.0, rng.uniform(0.1, 1)]) * normal
            own = Line(point, own.direction)
        if not parallel:
            _, origin, x = feet(neighbour, own)
        else:
            origin = own.point + rng.uniform(-1, 1) * own.direction
            across = origin - neighbour.point
            x = across - (across @ own.direction) * own.direction
            if np.linalg.norm(x) < EXACT:
                x = np.cross(own.direction, rng.normal(size=3))
        lines[joint] = Line(origin, own.direction)
        sense = rng.choice([-1.0, 1.0], 2) * rng.choice([1.0, 0.5, 3.0], 2)
        placed[joint] = Placed(joint + 1, sense[0] * own.direction, origin, sense[1] * unit(x))
    return [placed[joint] for joint in asked]


def broken(home: Home, frames: list[Placed], rng: Generator) -> tuple[int, list[Placed]]:
    """Break one rule; return the index of the wrong frame, and all frames."""
    i = int(rng.integers(len(frames)))
    frame = frames[i]
    z, x = unit(frame.z), unit(frame.x)
    y = np.cross(z, x)
    slip = int(rng.integers(5))
    size = float(rng.choice([-1, 1]) * rng.uniform(0.1, 0.6))
    if slip == 0:
        others = [k for k in range(len(home.axes) + 2) if k != frame.joint]
        frame = replace(frame, joint=int(rng.choice(others)))
    elif slip == 1:
        angle = rng.uniform(0.2, 2.9)
        frame = replace(frame, z=np.cos(angle) * z + np.sin(angle) * unit(rng.choice([-1, 1]) * y))
    elif slip == 2:
        frame = replace(frame, origin=frame.origin + size * [x, y, z][int(rng.integers(3))])
    elif slip == 3:
        angle = rng.uniform(0.2, 2.9)
        frame = replace(frame, x=np.cos(angle) * x + np.sin(angle) * y)
    else:
        frame = replace(frame, x=unit(x + size * z))
    return i, [*frames[:i], frame, *frames[i + 1 :]]


def is_valid(home: Home, frames: list[Placed]) -> bool:
    """True if the frames follow the DH rules."""
    for joint, frame in zip(home.asked, frames, strict=True):
        axis, z, x = home.axes[joint], unit(frame.z), unit(frame.x)
        if frame.joint != joint + 1 or abs(x @ z) > EXACT:
            return False
        if np.linalg.norm(np.cross(z, axis.direction)) > EXACT:
            return False
        beside = np.cross(frame.origin - axis.point, axis.direction)
        if home.arm.structure[joint] == "R" and np.linalg.norm(beside) > EXACT:
            return False
    base = Placed(0, np.array([0.0, 0, 1]), np.zeros(3), np.array([1.0, 0, 0]))
    tool = Placed(0, home.tool[:3, 2], home.tool[:3, 3], home.tool[:3, 0])
    chain = [base, *frames, tool]
    for before, after in pairwise(chain):
        of_z, of_x = (before, after) if home.arm.convention == "standard" else (after, before)
        z, x = unit(of_z.z), unit(of_x.x)
        if abs(x @ z) > EXACT:
            return False
        if abs((of_x.origin - of_z.origin) @ np.cross(z, x)) > EXACT:
            return False
    return True
