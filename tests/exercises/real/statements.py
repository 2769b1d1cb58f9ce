"""Read the joint axes and the tool frame from a real robot's statement."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from dh_grader.catalogue import Exercise
from numpy.typing import NDArray

Vector = NDArray[np.float64]

# A direction: along an axis of the base, or against it. If the student may choose the positive
# direction, the statement says "parallel to".
_WAY = r"(along|opposite to|parallel to) ([xyz])0?\b"
_JOINT = re.compile(
    rf"- Joint \d (?:turns about the axis through \((?P<point>[^)]+)\), |slides ){_WAY}"
)
_TOOL = re.compile(
    r"origin of \{\w\} is at \((?P<point>[^)]+)\), (?:x\d|its x axis) points "
    rf"{_WAY} and (?:z\d|its z axis) points {_WAY}"
)
_TERM = re.compile(r"([+-]?) ?([a-z]\d|\d+(?:\.\d+)?)")


@dataclass(frozen=True)
class HomeAxis:
    """A joint axis when all joint variables are 0."""

    # `point` is None if the joint slides. `signed` is False if the student may choose the positive
    # direction.
    point: Vector | None
    direction: Vector
    signed: bool


@dataclass(frozen=True)
class Home:
    """A robot whose joint variables are all 0."""

    # `tool` is `(origin, x, z)`, or None if the statement does not say where the tool frame is.
    axes: tuple[HomeAxis, ...]
    tool: tuple[Vector, Vector, Vector] | None


def home_of(exercise: Exercise, numbers: Mapping[str, float]) -> Home:
    words = " ".join(exercise.statement.split())
    tool = _TOOL.search(words)
    frame = None
    if tool:
        frame = (
            _point(tool["point"], numbers),
            _way(*tool.groups()[1:3]),
            _way(*tool.groups()[3:]),
        )
    return Home(tuple(_axes(words, numbers)), frame)


def _axes(words: str, numbers: Mapping[str, float]) -> Iterator[HomeAxis]:
    for found in _JOINT.finditer(words):
        place, prefix, axis = found.groups()
        point = None if place is None else _point(place, numbers)
        yield HomeAxis(point, _way(prefix, axis), prefix != "parallel to")


def _point(words: str, numbers: Mapping[str, float]) -> Vector:
    return np.array(
        [
            sum(
                (-1 if sign == "-" else 1) * (numbers[term] if term in numbers else float(term))
                for sign, term in _TERM.findall(text)
            )
            for text in words.split(", ")
        ]
    )


def _way(prefix: str, axis: str) -> Vector:
    sign = -1 if prefix == "opposite to" else 1
    return np.asarray(sign * np.eye(3)["xyz".index(axis)])
