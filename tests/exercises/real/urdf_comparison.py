"""Compare a robot's table with a URDF file, without the tested code."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
from dh_grader.catalogue import Exercise
from dh_grader.kinematics import Convention
from numpy.typing import NDArray

Numbers = NDArray[np.float64]
POSES = 100


@dataclass(frozen=True)
class Difference:
    """The largest difference between the poses of a table and of a URDF file."""

    # The comparison ignores that table and file may use other base and tool frames. `base_apart`
    # and `tool_apart` are the distances (in mm) between these frames.
    millimetres: float
    degrees: float
    base_apart: float
    tool_apart: float


def difference(
    exercise: Exercise,
    convention: Convention,
    file: Path,
    signs: Sequence[int],
    zeros: Sequence[float],
    tip: str,
) -> Difference:
    """Compare a table with a URDF file at random joint values."""
    # `zeros` are the file's joint values at the home configuration of the exercise.
    names = [joint.variable for joint in exercise.joints]
    values = np.random.default_rng(29).uniform(-np.pi, np.pi, (len(names), POSES))
    of_file = np.array(signs)[:, None] * values + np.radians(zeros)[:, None]
    by_table = table_poses(exercise, convention, dict(zip(names, values, strict=True)))
    base, poses, tool = fitted(by_table, file_poses(file, tip, of_file))
    reached = base @ poses @ tool
    turns = np.swapaxes(reached[:, :3, :3], 1, 2) @ by_table[:, :3, :3] - np.eye(3)
    return Difference(
        1000 * float(np.linalg.norm(reached[:, :3, 3] - by_table[:, :3, 3], axis=1).max()),
        float(np.degrees(np.linalg.norm(turns, axis=(1, 2)) / np.sqrt(2)).max()),
        1000 * float(np.linalg.norm(base[:3, 3])),
        1000 * float(np.linalg.norm(tool[:3, 3])),
    )


def table_poses(
    exercise: Exercise, convention: Convention, values: Mapping[str, Numbers]
) -> Numbers:
    """Return the poses computed from the table."""
    found = np.broadcast_to(np.eye(4), (POSES, 4, 4))
    for row in exercise.robot.tables[convention].rows:
        a, alpha, d, theta = (
            np.broadcast_to(np.asarray(cell.evaluate(values), float), (POSES,)) for cell in row
        )
        x = moved(turned([1, 0, 0], alpha), a[:, None] * [1, 0, 0])
        z = moved(turned([0, 0, 1], theta), d[:, None] * [0, 0, 1])
        found = found @ (z @ x if convention is Convention.STANDARD else x @ z)
    return found


def joints_to(file: Path, tip: str) -> list[ElementTree.Element]:
    """Return the joints from the root of a URDF file to a link."""
    joints = ElementTree.parse(file).getroot().findall("joint")
    above = {link.get("link"): joint for joint in joints for link in joint.findall("child")}
    path: list[ElementTree.Element] = []
    link: str | None = tip
    while link in above:
        path.insert(0, above[link])
        link = next(parent.get("link") for parent in path[0].findall("parent"))
    return path


def file_poses(file: Path, tip: str, values: Numbers) -> Numbers:
    """Return the poses of the link ``tip`` from a URDF file."""
    found, left = np.broadcast_to(np.eye(4), (POSES, 4, 4)), list(values)
    for joint in joints_to(file, tip):
        origin, axis = joint.find("origin"), joint.find("axis")
        here = np.zeros((POSES, 3)) + words(origin, "xyz", "0 0 0")
        turn = np.eye(3)
        for way, angle in zip(np.eye(3)[::-1], words(origin, "rpy", "0 0 0")[::-1], strict=True):
            turn = turn @ turned(way, np.array([angle]))[0]
        found = found @ moved(np.broadcast_to(turn, (POSES, 3, 3)), here)
        if joint.get("type") != "fixed":
            assert joint.get("type") in ("revolute", "continuous")
            about = words(axis, "xyz", "1 0 0")
            still = np.zeros((POSES, 3))
            found = found @ moved(turned(about / np.linalg.norm(about), left.pop(0)), still)
    assert not left
    return found


def words(element: ElementTree.Element | None, name: str, default: str) -> Numbers:
    text = default if element is None else element.get(name, default)
    return np.array([float(word) for word in text.split()])


def turned(axis: Sequence[float] | Numbers, angles: Numbers) -> Numbers:
    """Return the rotations about a unit vector, by Rodrigues' formula."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    sines, cosines = np.sin(angles)[:, None, None], np.cos(angles)[:, None, None]
    return np.asarray(np.eye(3) + sines * cross + (1 - cosines) * (cross @ cross))


def moved(rotations: Numbers, places: Numbers) -> Numbers:
    """Return the transforms with these rotations and positions."""
    found = np.zeros((len(rotations), 4, 4))
    found[:, :3, :3], found[:, :3, 3], found[:, 3, 3] = rotations, places, 1
    return found


def fitted(reference: Numbers, poses: Numbers) -> tuple[Numbers, Numbers, Numbers]:
    # Find the constant transforms for which `base @ poses @ tool` is closest to `reference`.
    #
    # Return `base`, `poses` (unchanged) and `tool`.
    a = reference @ np.linalg.inv(reference[0])
    b = poses @ np.linalg.inv(poses[0])
    u, _, v = np.linalg.svd(turning_axes(a).T @ turning_axes(b))
    base = np.eye(4)
    base[:3, :3] = u @ np.diag([1, 1, np.linalg.det(u @ v)]) @ v
    left = (a[:, :3, :3] - np.eye(3)).reshape(-1, 3)
    right = (b[:, :3, 3] @ base[:3, :3].T - a[:, :3, 3]).reshape(-1)
    base[:3, 3] = np.linalg.lstsq(left, right, rcond=None)[0]
    tools = np.linalg.inv(base @ poses) @ reference
    tool = np.eye(4)
    u, _, v = np.linalg.svd(tools[:, :3, :3].mean(axis=0))
    tool[:3, :3] = u @ np.diag([1, 1, np.linalg.det(u @ v)]) @ v
    tool[:3, 3] = tools[:, :3, 3].mean(axis=0)
    return base, poses, tool


def turning_axes(poses: Numbers) -> Numbers:
    # Return the axis of each turn; its length is twice the sine of the turn's angle.
    r = poses[:, :3, :3]
    return np.stack(
        [r[:, 2, 1] - r[:, 1, 2], r[:, 0, 2] - r[:, 2, 0], r[:, 1, 0] - r[:, 0, 1]], axis=1
    )
