"""Check generated robots: build each robot again from its statement."""

import re
import xml.etree.ElementTree as ET
from itertools import combinations
from math import cos, sin, sqrt

import numpy as np
from dh_grader.authoring import lazy_shares
from dh_grader.catalogue import Exercise
from dh_grader.figures import exercise_figure
from dh_grader.grading.grade import Submission, grade
from dh_grader.kinematics import Convention
from dh_grader.solutions import solve
from dh_grader.variants.robots import PracticeId, robot_exercise

from tests.importing.statement_reader import JOINT, TOOL, point, pose, way

SVG = "{http://www.w3.org/2000/svg}"
Segment = tuple[np.ndarray, np.ndarray]


def drawn(level: int, number: int, convention: Convention = Convention.STANDARD) -> Exercise:
    """Return a generated robot."""
    return robot_exercise(PracticeId(level, convention, number))


def cells(exercise: Exercise) -> list[list[str]]:
    """Return the cells of the table as text."""
    table = exercise.robot.tables[exercise.robot.convention]
    return [[cell.text() for cell in row] for row in table.rows]


def asked(exercise: Exercise) -> Convention:
    [convention] = exercise.conventions
    return convention


def symbol_values(exercise: Exercise, rng: np.random.Generator) -> dict[str, float]:
    """Return a number for every symbol, in its range."""
    return {each.name: rng.uniform(each.low, each.high) for each in exercise.variables}


def tip(exercise: Exercise, values: dict[str, float]) -> np.ndarray:
    reached = np.eye(4)
    for row in exercise.robot.tables[exercise.robot.convention].rows:
        a, alpha, d, theta = (
            float(np.asarray(cell.evaluate({k: np.array([v]) for k, v in values.items()})).flat[0])
            for cell in row
        )
        x = np.array([
            [1, 0, 0, a],
            [0, cos(alpha), -sin(alpha), 0],
            [0, sin(alpha), cos(alpha), 0],
            [0, 0, 0, 1],
        ])  # fmt: skip
        z = np.array([
            [cos(theta), -sin(theta), 0, 0],
            [sin(theta), cos(theta), 0, 0],
            [0, 0, 1, d],
            [0, 0, 0, 1],
        ])  # fmt: skip
        reached = reached @ (z @ x if asked(exercise) is Convention.STANDARD else x @ z)
    return reached


def is_the_robot_of_its_statement(exercise: Exercise, seed: int) -> bool:
    """True if the statement and the table describe the same robot."""
    rng = np.random.default_rng([seed, 11])
    for _ in range(3):
        values = symbol_values(exercise, rng)
        joints = np.array([values[joint.variable] for joint in exercise.joints])
        place, x, z = pose(exercise.statement, values, joints)
        reached = tip(exercise, values)
        if not (
            np.allclose(place, reached[:3, 3], atol=1e-6)
            and np.allclose(x, reached[:3, 0], atol=1e-6)
            and np.allclose(z, reached[:3, 2], atol=1e-6)
        ):
            return False
    return True


def form(exercise: Exercise) -> tuple[object, ...]:
    # Return axes and tool at home as numbers. They are equal if robots differ only in lengths.
    #
    # For this, the n-th length that the statement names gets the value √(n + 1).
    words = exercise.statement
    names = re.findall(r"(?<![\w.{])(?:[adh]\d+|\d+\.\d+|[1-9]\d*)(?![\w.}°])", words)
    sizes = {name: sqrt(i + 2) for i, name in enumerate(dict.fromkeys(names))}
    found: list[object] = []
    for joint in JOINT.finditer(words):
        along = way(joint["way"])
        moment = np.zeros(3)
        if joint["point"] is not None:
            moment = np.cross(point(joint["point"], sizes), along)
        found += [joint["point"] is None, *(np.round([*along, *moment], 6) + 0.0).tolist()]
    tool = TOOL.search(words)
    assert tool
    ends = [point(tool["point"], sizes), way(tool["x"]), way(tool["z"])]
    return (*found, *(np.round(np.concatenate(ends), 6) + 0.0).tolist())


def share(exercise: Exercise, answer: object) -> float:
    """Return the fraction of the exercise's points that an answer earns."""
    report = grade(exercise, Submission({"table": answer}))
    return report.points / report.max_points


def model_share(exercise: Exercise, *, solved: bool) -> float:
    if solved:
        return share(exercise, solve(exercise).parts[0].answer)
    rows = [dict(zip(("a", "alpha", "d", "theta"), row, strict=True)) for row in cells(exercise)]
    return share(exercise, {"rows": rows})


def lazy_share(exercise: Exercise) -> float:
    return max(lazy_shares(exercise).values())


def segments(exercise: Exercise) -> list[Segment]:
    # Return the robot at home as line segments, with each length in the middle of its range.
    table = exercise.robot.tables[Convention.STANDARD]
    middle = {
        each.name: 0.0 if each.kind == "angle" else (each.low + each.high) / 2
        for each in exercise.variables
    }
    middle |= {joint.variable: 0.3 for joint in exercise.joints if joint.prismatic}
    numbers = table.values({name: np.array([value]) for name, value in middle.items()}, 1)[..., 0]
    frame, found = np.eye(4), []
    for a, alpha, d, theta in numbers:
        turn = np.array([
            [cos(theta), -sin(theta) * cos(alpha), sin(theta) * sin(alpha)],
            [sin(theta), cos(theta) * cos(alpha), -cos(theta) * sin(alpha)],
            [0, sin(alpha), cos(alpha)],
        ])  # fmt: skip
        start = frame[:3, 3]
        elbow = start + d * frame[:3, 2]
        end = elbow + a * frame[:3, :3] @ np.array([cos(theta), sin(theta), 0])
        both = ((start, elbow), (elbow, end))
        found += [(one, two) for one, two in both if not np.allclose(one, two)]
        moved = np.eye(4)
        moved[:3, :3], moved[:3, 3] = frame[:3, :3] @ turn, end
        frame = moved
    return found


def nearest_links(exercise: Exercise) -> float:
    """Return the least distance (m) between links that are not neighbours."""
    shares = np.linspace(0, 1, 41)[:, None]
    points = [start + shares * (end - start) for start, end in segments(exercise)]
    gaps = [
        float(np.linalg.norm(points[i][:, None] - points[j], axis=-1).min())
        for i, j in combinations(range(len(points)), 2)
        if j > i + 1
    ]
    return min(gaps, default=1.0)


def overlapping_labels(exercise: Exercise) -> list[tuple[str, str]]:
    """Return the labels of the figure that overlap."""
    boxes = []
    for text in ET.fromstring(exercise_figure(exercise)).iter(f"{SVG}text"):
        size = 13 if "number" in text.attrib["class"] else 17
        parts = [(each.text or "", each.get("class")) for each in text]
        wide = sum(len(part) * (13 if kind == "index" else size) / 2 for part, kind in parts)
        name = "".join(text.itertext())
        boxes.append((float(text.attrib["x"]), float(text.attrib["y"]), wide, name))
    return [
        (name, its)
        for (x, y, wide, name), (u, v, other, its) in combinations(boxes, 2)
        if abs(x - u) < (wide + other) / 2 and abs(y - v) < 11
    ]
