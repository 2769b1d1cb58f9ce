"""Build a robot from the words of its statement, without the tested code."""

import re
from collections.abc import Mapping

import numpy as np

from tests.importing.urdf_texts import quaternion, turned

JOINT = re.compile(
    r"- Joint \d (turns about the axis through \((?P<point>[^)]+)\), |slides )(?P<way>.+)\."
)
TOOL = re.compile(
    r"origin of \{[\de]\} is at \((?P<point>[^)]+)\), (?:x\d|its x axis) points (?P<x>.+) and "
    r"(?:z\d|its z axis) points (?P<z>along \([^)]+\)|[^.(]+)\."
)
TILTED = re.compile(r"(\d+)° from (-?)([xyz]0) towards (-?)([xyz]0)")
WAYS = {"x0": [1.0, 0, 0], "y0": [0, 1.0, 0], "z0": [0, 0, 1.0]}


def way(words: str) -> np.ndarray:
    """Return the direction that the words describe."""
    if found := re.fullmatch(r"along \((.+)\)", words):
        return np.array([float(each) for each in found[1].split(", ")])
    if found := TILTED.fullmatch(words):
        angle = np.radians(float(found[1]))
        start, end = (np.array(WAYS[found[k + 1]]) * (-1 if found[k] else 1) for k in (2, 4))
        return np.asarray(np.cos(angle) * start + np.sin(angle) * end)
    prefix, _, name = words.rpartition(" ")
    return np.array(WAYS[name]) * (-1 if prefix == "opposite to" else 1)


def point(words: str, lengths: Mapping[str, float]) -> np.ndarray:
    """Return the point that the words describe."""
    coordinates = []
    for text in words.split(", "):
        terms = re.findall(r"([+-]?) ?([a-z]\d+|[\d.]+)", text)
        coordinates.append(
            sum(
                (-1 if sign == "-" else 1) * (lengths[term] if term in lengths else float(term))
                for sign, term in terms
            )
        )
    return np.array(coordinates)


def pose(statement: str, lengths: Mapping[str, float], values: np.ndarray) -> list[np.ndarray]:
    tool = TOOL.search(statement.replace("\n", " "))
    assert tool
    place, x, z = point(tool["point"], lengths), way(tool["x"]), way(tool["z"])
    joints = list(JOINT.finditer(statement))
    for joint, value in reversed(list(zip(joints, values, strict=True))):
        direction = way(joint["way"])
        if joint["point"] is None:
            place = place + value * direction
            continue
        foot = point(joint["point"], lengths)
        turn = quaternion(list(direction), value)
        place = foot + turned(turn, list(place - foot))
        x, z = turned(turn, list(x)), turned(turn, list(z))
    return [place, x, z]
