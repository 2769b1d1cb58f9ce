"""A serial arm from a URDF file: its joints, their axes, and a DH table for them."""

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Final
from xml.parsers import expat

import numpy as np

from dh_grader.importing.exercise_text import Snaps
from dh_grader.kinematics import (
    ALPHA,
    COLUMNS,
    THETA,
    Convention,
    Matrices,
    Numbers,
    Table,
    inverse,
    pose,
    rot_x,
    rot_y,
    rot_z,
)
from dh_grader.regex import regex
from dh_grader.translations import say

# --- Read a serial robot arm from a URDF file: its joints, their places and their axes


MOST_BYTES: Final = 2**20
_MOST_LINKS: Final = 200
_MOST_ELEMENTS: Final = 20_000
_DEEPEST: Final = 40
_MOST_JOINTS: Final = 10
_NUMBER: Final = regex(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,2})?")
_TURNING: Final = ("revolute", "continuous")
_SHOWN: Final = 60
_MOST_ENDS: Final = 5
_LONGEST_TEXT: Final = 200


class UnusableUrdfError(ValueError):
    """The file has no arm that can become an exercise; the message says why."""


@dataclass(frozen=True, slots=True)
class UrdfJoint:
    """A joint of the arm: its name, its type, and its axis in the joint's own frame."""

    name: str
    prismatic: bool
    before: Matrices
    """The constant transform from the frame of the joint before."""
    axis: Numbers


@dataclass(frozen=True, slots=True)
class Arm:
    """A serial chain of joints from a base link to a tip link."""

    base: str
    tip: str
    joints: tuple[UrdfJoint, ...]
    after: Matrices
    """The constant transform from the frame of the last joint to the tip."""

    @property
    def structure(self) -> str:
        """A letter for each joint: R for a revolute joint, P for a prismatic joint."""
        return "".join("P" if joint.prismatic else "R" for joint in self.joints)

    def pose(self, values: Numbers) -> Matrices:
        """Return the pose of the tip in the base link at these values of the joint variables."""
        pose = np.eye(4)
        for joint, value in zip(self.joints, values, strict=True):
            pose = pose @ joint.before @ _motion(joint, float(value))
        return np.asarray(pose @ self.after)


def _motion(joint: UrdfJoint, value: float) -> Matrices:
    motion = np.eye(4)
    if joint.prismatic:
        motion[:3, 3] = value * joint.axis
        return motion
    x, y, z = joint.axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    motion[:3, :3] += math.sin(value) * cross + (1 - math.cos(value)) * (cross @ cross)
    return motion


@dataclass(slots=True)
class _Joint:
    name: str
    kind: str
    parent: str = ""
    child: str = ""
    xyz: str = "0 0 0"
    rpy: str = "0 0 0"
    axis: str = "1 0 0"
    follows: bool = False


@dataclass(slots=True)
class _Collector:
    links: list[str] = field(default_factory=list)
    joints: list[_Joint] = field(default_factory=list)
    _path: list[str] = field(default_factory=list)
    _elements: int = 0

    def doctype(self, *_declaration: object) -> None:
        raise UnusableUrdfError(say("the file has a DOCTYPE; a URDF needs none"))

    def start(self, tag: str, attributes: Mapping[str, str]) -> None:
        self._elements += 1
        if self._elements > _MOST_ELEMENTS or len(self._path) > _DEEPEST:
            raise UnusableUrdfError(
                say("the file has more than {most} elements or is too deep", most=_MOST_ELEMENTS)
            )
        # Many makers leave a property behind that nothing uses.
        is_template = "xacro" in tag and tag != "xacro:property"
        if is_template or any("${" in value or "$(" in value for value in attributes.values()):
            raise UnusableUrdfError(
                say(
                    "the file is a xacro template; expand it first: xacro arm.urdf.xacro > arm.urdf"
                )
            )
        if not self._path and tag != "robot":
            raise UnusableUrdfError(
                say("the file begins with <{tag}>, not with <robot>", tag=tag[:_SHOWN])
            )
        self._path.append(tag)
        match self._path:
            case ["robot", "link"]:
                self.links.append(attributes.get("name", ""))
                if len(self.links) > _MOST_LINKS:
                    raise UnusableUrdfError(
                        say("the file has more than {most} links", most=_MOST_LINKS)
                    )
            case ["robot", "joint"]:
                self.joints.append(_Joint(attributes.get("name", ""), attributes.get("type", "")))
            case ["robot", "joint", part]:
                self._joint_part(self.joints[-1], part, attributes)

    def _joint_part(self, joint: _Joint, part: str, attributes: Mapping[str, str]) -> None:
        match part:
            case "parent":
                joint.parent = attributes.get("link", "")
            case "child":
                joint.child = attributes.get("link", "")
            case "origin":
                joint.xyz = attributes.get("xyz", joint.xyz)
                joint.rpy = attributes.get("rpy", joint.rpy)
            case "axis":
                joint.axis = attributes.get("xyz", joint.axis)
            case "mimic":
                joint.follows = True

    def end(self, _tag: str) -> None:
        self._path.pop()


def _collected(data: bytes) -> _Collector:
    if len(data) > MOST_BYTES:
        raise UnusableUrdfError(say("the file is larger than {most} KiB", most=MOST_BYTES // 2**10))
    collector = _Collector()
    # Without namespaces, because many files use prefixes such as drake: that they do not declare.
    parser = expat.ParserCreate()
    parser.StartDoctypeDeclHandler = collector.doctype
    parser.StartElementHandler = collector.start
    parser.EndElementHandler = collector.end
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        raise UnusableUrdfError(
            say("the file is not well-formed XML: {reason}", reason=str(error))
        ) from None
    except (LookupError, ValueError) as error:
        if isinstance(error, UnusableUrdfError):
            raise
        raise UnusableUrdfError(say("the file has an unknown text encoding")) from None
    return collector


def tips(data: bytes) -> list[str]:
    """Return the links that may be the tip of an arm."""
    # They are the links at which a chain can end.
    return _ends(_collected(data))


def _ends(collected: _Collector) -> list[str]:
    parents = {joint.parent for joint in collected.joints}
    return [link for link in collected.links if link not in parents]


def read_urdf(
    data: bytes, tip: str, base: str | None = None, *, snaps: Snaps | None = None
) -> tuple[Arm, Arm]:
    """Return the arm from ``base`` to ``tip`` twice: with rounded numbers repaired, and unchanged.

    ``snaps`` lists the repairs.
    Without ``base``, the arm begins at the root of the tree. Raises UnusableUrdfError.
    """
    collected = _collected(data)
    for name in (tip, base):
        if name is not None and name not in collected.links:
            ends = ", ".join(each[:_SHOWN] for each in _ends(collected)[:_MOST_ENDS])
            reason = say(
                "the file has no link {link!r}; its tree ends at: {ends}",
                link=name[:_SHOWN],
                ends=ends,
            )
            raise UnusableUrdfError(reason)
    path = _path(collected, tip, base)
    first = path[0].parent if path else tip
    return _arm(path, first, tip, snaps or Snaps()), _arm(path, first, tip, None)


def _path(collected: _Collector, tip: str, base: str | None) -> list[_Joint]:
    before: dict[str, _Joint] = {}
    for joint in collected.joints:
        if joint.child in before:
            raise UnusableUrdfError(
                say("two joints move the link {link!r}: a closed loop", link=joint.child[:_SHOWN])
            )
        before[joint.child] = joint
    path: list[_Joint] = []
    link = tip
    while link != base and link in before:
        path.append(before[link])
        link = path[-1].parent
        if len(path) > _MOST_LINKS:
            raise UnusableUrdfError(say("the links form a closed loop"))
    if base is not None and link != base:
        raise UnusableUrdfError(
            say(
                "the link {link!r} is not on the way to {tip!r}",
                link=base[:_SHOWN],
                tip=tip[:_SHOWN],
            )
        )
    return path[::-1]


def _arm(path: list[_Joint], base: str, tip: str, snaps: Snaps | None) -> Arm:
    fixed = np.eye(4)
    joints = []
    for joint in path:
        fixed = fixed @ _origin(joint, snaps)
        if joint.kind == "fixed":
            continue
        if joint.kind not in (*_TURNING, "prismatic"):
            raise UnusableUrdfError(
                say(
                    "the joint {joint!r} is of type {kind!r}; only revolute, continuous, prismatic "
                    "and fixed joints can be imported",
                    joint=joint.name[:_SHOWN],
                    kind=joint.kind[:_SHOWN],
                )
            )
        if joint.follows:
            raise UnusableUrdfError(
                say(
                    "the joint {joint!r} follows another joint (mimic); a DH table has independent "
                    "joints only",
                    joint=joint.name[:_SHOWN],
                )
            )
        joints.append(UrdfJoint(joint.name, joint.kind == "prismatic", fixed, _axis(joint, snaps)))
        fixed = np.eye(4)
    if not 1 <= len(joints) <= _MOST_JOINTS:
        raise UnusableUrdfError(
            say(
                "between {base!r} and {tip!r} are {count} moving joints; an exercise has 1 to "
                "{most}",
                base=base[:_SHOWN],
                tip=tip[:_SHOWN],
                count=len(joints),
                most=_MOST_JOINTS,
            )
        )
    return Arm(base, tip, tuple(joints), fixed)


def _origin(joint: _Joint, snaps: Snaps | None) -> Matrices:
    xyz, rpy = (list(_numbers(joint, text)) for text in (joint.xyz, joint.rpy))
    name = joint.name[:_SHOWN]
    if snaps is None:
        lengths, (roll, pitch, yaw) = [*map(float, xyz)], map(float, rpy)
    else:
        place = say("joint {joint!r}, xyz", joint=name)
        lengths = [snaps.length(place, text) for text in xyz]
        place = say("joint {joint!r}, rpy", joint=name)
        roll, pitch, yaw = (snaps.angle(place, float(text), text) for text in rpy)
    origin = rot_z(yaw) @ rot_y(pitch) @ rot_x(roll)
    origin[:3, 3] = lengths
    return np.asarray(origin)


def _axis(joint: _Joint, snaps: Snaps | None) -> Numbers:
    axis = np.array([float(text) for text in _numbers(joint, joint.axis)])
    length = float(np.linalg.norm(axis))
    if not length > 0:
        raise UnusableUrdfError(
            say("the axis of joint {joint!r} has no direction", joint=joint.name[:_SHOWN])
        )
    if snaps is None:
        return axis / length
    return snaps.direction(say("joint {joint!r}, axis", joint=joint.name[:_SHOWN]), axis / length)


def _numbers(joint: _Joint, text: str) -> Iterator[str]:
    words = text.split() if len(text) <= _LONGEST_TEXT else []
    if len(words) != 3 or not all(_NUMBER.fullmatch(word) for word in words):
        raise UnusableUrdfError(
            say(
                "the joint {joint!r} has {text!r} in place of three numbers",
                joint=joint.name[:_SHOWN],
                text=text[:_SHOWN],
            )
        )
    if any(abs(float(word)) > 1e6 for word in words):
        raise UnusableUrdfError(
            say("the joint {joint!r} has a number over a million", joint=joint.name[:_SHOWN])
        )
    yield from words


# --- The joint axes of an arm at home, in the coordinates of its base link


PARALLEL = 1e-6
# Axes that are less than this apart, in radians, but not parallel, are a maker's rounding: their
# common normal is hundreds of metres long.
_NEARLY = 2e-3


class UnclearAxesError(ValueError):
    """Two axes are nearly parallel; the message says which."""


@dataclass(frozen=True, slots=True)
class HomeAxis:
    """A joint axis: a point, a unit vector along it, and the joint's type."""

    point: Numbers
    direction: Numbers
    prismatic: bool

    def through(self, point: Numbers) -> "HomeAxis":
        """Return the axis moved so that it passes through ``point``."""
        return HomeAxis(point, self.direction, self.prismatic)

    def nearest(self, point: Numbers) -> Numbers:
        """Return the point of the axis that is nearest to ``point``."""
        along = float((point - self.point) @ self.direction)
        return np.asarray(self.point + along * self.direction)

    def parallel_to(self, direction: Numbers) -> bool:
        """True if the axis is parallel or antiparallel to ``direction``."""
        return float(np.linalg.norm(np.cross(self.direction, direction))) < PARALLEL


def home_axes(arm: Arm) -> tuple[list[HomeAxis], Matrices]:
    """Return the joint axes and the pose of the tip when all joint variables are 0."""
    pose = np.eye(4)
    axes = []
    for joint in arm.joints:
        pose = pose @ joint.before
        axes.append(HomeAxis(pose[:3, 3].copy(), pose[:3, :3] @ joint.axis, joint.prismatic))
    for i, (first, second) in enumerate(pairwise(axes), 1):
        apart = float(np.linalg.norm(np.cross(first.direction, second.direction)))
        if PARALLEL <= apart < _NEARLY:
            raise UnclearAxesError(
                say(
                    "the axes of joints {first} and {second} are nearly parallel ({angle}° apart); "
                    "write exact angles in the file",
                    first=i,
                    second=i + 1,
                    angle=f"{np.degrees(apart):.4f}",
                )
            )
    tip = pose @ arm.after
    return _sliding_axes_moved(axes, tip[:3, 3]), np.asarray(tip)


def _sliding_axes_moved(axes: list[HomeAxis], tip: Numbers) -> list[HomeAxis]:
    """Move each sliding axis to the next axis, which saves lengths in the table."""
    # Only the direction of a sliding axis matters.
    moved = list(axes)
    for i in reversed(range(len(axes))):
        if not axes[i].prismatic:
            continue
        if i + 1 == len(axes):
            moved[i] = axes[i].through(tip)
        elif moved[i + 1].parallel_to(axes[i].direction):
            moved[i] = axes[i].through(moved[i + 1].nearest(axes[i].point))
        else:
            moved[i] = axes[i].through(common_normal(axes[i], moved[i + 1])[1])
    return moved


def common_normal(first: HomeAxis, second: HomeAxis) -> tuple[Numbers, Numbers]:
    """Return both ends of the common normal of two axes, which must not be parallel."""
    normal = np.cross(first.direction, second.direction)
    between = second.point - first.point
    squared = float(normal @ normal)
    along_first = float(np.cross(between, second.direction) @ normal) / squared
    along_second = float(np.cross(between, first.direction) @ normal) / squared
    return (
        np.asarray(first.point + along_first * first.direction),
        np.asarray(second.point + along_second * second.direction),
    )


# --- Make a standard DH table from joint axes, by the rules that are taught
#
# z_{i-1} is along the axis of joint i, in its positive direction. x_i is along the common normal.
# On parallel axes d_i = 0.
#
# If the sign of x_i is free, the sign with fewer offsets is chosen.


_NONE = 1e-9


@dataclass(frozen=True, slots=True)
class Placed:
    """A standard table of constants ``(joints, 4)``, and the poses of both ends of the arm.

    ``base`` is the pose of frame {0} in the base link, and ``tool`` is the pose of the tip in the
    last frame.
    """

    # A pose is the identity if its two frames are the same.

    table: Table
    base: Matrices
    tool: Matrices


def placed(axes: list[HomeAxis], tip: Matrices, snaps: Snaps | None = None) -> Placed:
    """Return the DH table of an arm with these joint axes and this pose of the tip.

    Angles that inexact axes leave inexact are snapped; ``snaps`` lists them.
    """
    base = _base_frame(axes[0])
    frame, rows = base, []
    for before, axis in pairwise(axes):
        row, frame = _row(frame, *_normal(before, axis, frame), axis.direction)
        rows.append(row)
    row, frame = _last_row(frame, tip)
    rows.append(row)
    table, snaps = np.array(rows), snaps or Snaps()
    for i, row in enumerate(table):
        for j in (ALPHA, THETA):
            place = say("row {row}, column {column}", row=i + 1, column=COLUMNS[j])
            row[j] = snaps.angle(place, float(row[j]))
    return Placed(table, base, inverse(frame) @ tip)


def _base_frame(axis: HomeAxis) -> Matrices:
    # Return frame {0}.
    # Its origin is the point of the axis that is nearest to the base link. Its x axis is as near as
    # possible to the x axis of the base link.
    x = np.eye(3)[int(axis.parallel_to(np.eye(3)[0]))]
    x = x - (x @ axis.direction) * axis.direction
    return _frame(axis.nearest(np.zeros(3)), x / np.linalg.norm(x), axis.direction)


def _frame(origin: Numbers, x: Numbers, z: Numbers) -> Matrices:
    frame = np.eye(4)
    frame[:3, 0], frame[:3, 1], frame[:3, 2], frame[:3, 3] = x, np.cross(z, x), z, origin
    return frame


def _normal(before: HomeAxis, axis: HomeAxis, frame: Matrices) -> tuple[Numbers, Numbers]:
    if not axis.parallel_to(before.direction):
        foot, origin = common_normal(before, axis)
        between = origin - foot
        crossed = np.cross(before.direction, axis.direction)
    else:
        origin = axis.nearest(frame[:3, 3])
        between = origin - before.nearest(origin)
        crossed = frame[:3, 0]
    long = float(np.linalg.norm(between)) > _NONE
    x = between if long else crossed
    return x / np.linalg.norm(x), origin


def _row(frame: Matrices, x: Numbers, origin: Numbers, z: Numbers) -> tuple[Numbers, Matrices]:
    choices = []
    for sign in (1.0, -1.0):
        here = _frame(origin, sign * x, z)
        row = _parameters(frame, here)
        a, alpha, _, theta = row
        cost = (abs(theta) > _NONE) + 0.4 * (a < -_NONE) + 0.2 * (alpha < -_NONE)
        choices.append((cost, row, here))
    _, row, here = min(choices, key=lambda choice: choice[0])
    return row, here


def _parameters(before: Matrices, here: Matrices) -> Numbers:
    between = inverse(before) @ here
    theta = np.arctan2(between[1, 0], between[0, 0])
    alpha = np.arctan2(between[2, 1], between[2, 2])
    a = between[0, 3] * np.cos(theta) + between[1, 3] * np.sin(theta)
    return np.array([a, _half_turn_positive(alpha), between[2, 3], _half_turn_positive(theta)])


def _half_turn_positive(angle: float) -> float:
    return np.pi if abs(angle + np.pi) < _NONE else float(angle)


def _last_row(frame: Matrices, tip: Matrices) -> tuple[Numbers, Matrices]:
    axis, origin = frame[:3, 2], tip[:3, 3]
    along = (origin - frame[:3, 3]) @ axis
    off = origin - frame[:3, 3] - along * axis
    if np.linalg.norm(off) > _NONE:
        x = off / np.linalg.norm(off)
    elif np.linalg.norm(np.cross(axis, tip[:3, 2])) < PARALLEL:
        x = tip[:3, 0] - (tip[:3, 0] @ axis) * axis
        x = x / np.linalg.norm(x)
    else:
        x = np.cross(axis, tip[:3, 2])
        x = x / np.linalg.norm(x)
    z = tip[:3, 2]
    if abs(z @ x) > PARALLEL:
        z = axis
    choices = [_frame(origin, sign * x, z) for sign in (1.0, -1.0)]
    here = max(choices, key=lambda choice: float(choice[:3, 0] @ tip[:3, 0]))
    return _parameters(frame, here), here


def greatest_difference(
    placed_arm: Placed,
    structure: str,
    exact_pose: Callable[[Numbers], Matrices],
    samples: int = 100,
) -> tuple[float, float]:
    """Return the greatest differences in position and in angle between the table and the robot.

    Their poses are compared at random values of the joint variables.
    """
    values = np.random.default_rng(1).uniform(-np.pi, np.pi, (samples, len(structure)))
    lengths, angles = [], []
    for each in values:
        table = placed_arm.table.copy()
        for i, letter in enumerate(structure):
            table[i, 2 if letter == "P" else 3] += each[i]
        reached = placed_arm.base @ pose(table, Convention.STANDARD) @ placed_arm.tool
        expected = exact_pose(each)
        lengths.append(float(np.linalg.norm(reached[:3, 3] - expected[:3, 3])))
        turn = reached[:3, :3].T @ expected[:3, :3]
        # The norm of R - 1 is exact for small angles; the arc cosine of its trace is not.
        angles.append(float(np.linalg.norm(turn - np.eye(3)) / np.sqrt(2)))
    return max(lengths), max(angles)
