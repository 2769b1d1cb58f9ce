"""The rules for placing frames on joint axes, and the DH rows between the frames.

The z axis of a frame is along its joint's axis. The x axis crosses the neighbouring axis at a right
angle.

Source: Spong, Hutchinson, Vidyasagar, *Robot Modeling and Control*, §3.2.2; Craig, *Introduction to
Robotics*, §3.4.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import pairwise

import numpy as np

from dh_grader.kinematics import (
    PARALLEL,
    Convention,
    Matrices,
    Numbers,
    cross,
    identity,
    inverse,
    row,
)

# The neighbouring axis is the z axis of the previous frame in the standard convention, and of the
# next frame in the modified convention. So the origin is at the foot of the common normal; parallel
# axes leave the origin free. All arrays are batched: directions and points are (L, 3).


class AxisPosition(StrEnum):
    """The relative position of two axes."""

    # Skew or crossing axes have one common normal, others many.

    SKEW = "skew"
    CROSSING = "crossing"
    PARALLEL = "parallel"
    SAME = "same"

    @property
    def has_one_normal(self) -> bool:
        """True if the axes have only one common normal."""
        return self in (AxisPosition.SKEW, AxisPosition.CROSSING)


@dataclass(frozen=True, slots=True)
class AxisLine:
    """An axis: its unit direction and one of its points, ``(samples, 3)`` each."""

    direction: Numbers
    point: Numbers

    def nearest(self, points: Numbers) -> Numbers:
        """Return the point of the axis that is nearest to each of ``points``."""
        along = _dot(points - self.point, self.direction)
        return np.asarray(self.point + along[:, None] * self.direction)

    def distance(self, points: Numbers) -> float:
        """Return the largest distance of any of ``points`` from the axis."""
        return largest(points - self.nearest(points))

    def through(self, points: Numbers) -> "AxisLine":
        """Return the parallel axis through ``points``."""
        return AxisLine(self.direction, points)


def z_line(frame: Matrices) -> AxisLine:
    """Return the z axis of a frame ``(samples, 4, 4)``."""
    return AxisLine(frame[:, :3, 2], frame[:, :3, 3])


def x_line(frame: Matrices) -> AxisLine:
    """Return the x axis of a frame ``(samples, 4, 4)``."""
    return AxisLine(frame[:, :3, 0], frame[:, :3, 3])


def axis_relation(neighbour: AxisLine, own: AxisLine, length_scale: float) -> AxisPosition:
    """Return the relative position of two axes."""
    # Distances are compared with length_scale.
    normal = cross(neighbour.direction, own.direction)
    if largest(normal) > PARALLEL:
        gap = _dot(own.point - neighbour.point, _unit(normal))
        apart = float(np.abs(gap).max()) > PARALLEL * length_scale
        return AxisPosition.SKEW if apart else AxisPosition.CROSSING
    apart = neighbour.distance(own.point) > PARALLEL * length_scale
    return AxisPosition.PARALLEL if apart else AxisPosition.SAME


def normal_direction(neighbour: AxisLine, own: AxisLine, relation: AxisPosition) -> Numbers | None:
    """Return the unit direction of the common normal; None if the axes are the same line."""
    if relation.has_one_normal:
        return _unit(cross(neighbour.direction, own.direction))
    if relation is AxisPosition.SAME:
        return None
    return _unit(own.point - neighbour.nearest(own.point))


def normal_foot(neighbour: AxisLine, own: AxisLine) -> Numbers:
    """Return the point where the common normal of two axes meets the axis ``own``."""
    # The axes must not be parallel.
    normal = cross(neighbour.direction, own.direction)
    between = cross(own.point - neighbour.point, neighbour.direction)
    along = _dot(between, normal) / _dot(normal, normal)
    return np.asarray(own.point + along[:, None] * own.direction)


@dataclass(frozen=True, slots=True)
class AskedFrame:
    """A frame that the student must place, and the axes that its place depends on."""

    # The index of the joint whose axis is the frame's z axis.
    joint: int
    # The frame's z axis.
    own: AxisLine
    # The axis that the frame's x axis must cross.
    neighbour: AxisLine
    # The asked frame whose z axis is neighbour; None for the axis of a given frame.
    neighbour_frame: int | None
    slides: bool
    # The axis of a joint that slides may lie anywhere, as long as it meets these lines.
    must_meet: tuple[AxisLine, ...] = ()


def asked_frames(
    axes: Sequence[AxisLine],
    slides: Sequence[bool],
    convention: Convention,
    base: Matrices,
    tool: Matrices,
    *,
    has_tool_row: bool,
) -> tuple[AskedFrame, ...]:
    """Return the frames that the student must place, between the base and the tool frame."""
    # axes are the joint axes. has_tool_row is true if a fixed row leads to the tool, so that the
    # last joint's frame of a modified table is not the tool frame.
    n = len(axes)
    if convention is Convention.STANDARD:
        return tuple(
            AskedFrame(
                joint=j,
                own=axes[j],
                neighbour=axes[j - 1],
                neighbour_frame=j - 2 if j > 1 else None,
                slides=slides[j],
                must_meet=(x_line(tool),) if j == n - 1 else (),
            )
            for j in range(1, n)
        )
    count = n if has_tool_row else n - 1
    return tuple(
        AskedFrame(
            joint=j,
            own=axes[j],
            neighbour=axes[j + 1] if j + 1 < n else z_line(tool),
            neighbour_frame=j + 1 if j + 1 < count else None,
            slides=slides[j],
            must_meet=(x_line(base),) if j == 0 else (),
        )
        for j in range(count)
    )


@dataclass(frozen=True, slots=True)
class RightPlace:
    """The correct origin and x direction of a frame."""

    # The neighbouring axis is as the student chose it.

    own: AxisLine
    neighbour: AxisLine
    relation: AxisPosition
    # The correct origin nearest to the chosen origin.
    origin: Numbers
    # A correct x direction; its opposite is correct, too. None if every direction perpendicular to
    # z is correct.
    x: Numbers | None


def right_places(
    frames: Sequence[AskedFrame],
    origins: Sequence[Numbers | None],
    convention: Convention,
    tolerances: Sequence[float],
    length_scale: float,
    may_move: Sequence[bool] | None = None,
    axes: Mapping[int, AxisLine] | None = None,
) -> list[RightPlace]:
    """Return the correct origin and x direction of each frame, given its chosen origin."""
    # may_move is false for sliding joints whose axis must be taken as drawn; axes maps indices of
    # frames to axes that are known. The axis of a sliding joint moves to the chosen origin if the
    # origin is farther from the axis than the frame's tolerance, and if the rules hold for the
    # moved axis.
    found: list[RightPlace | None] = [None] * len(frames)
    # The neighbour's axis must be known first.
    standard = convention is Convention.STANDARD
    order = range(len(frames)) if standard else reversed(range(len(frames)))
    for i in order:
        frame, origin = frames[i], origins[i]
        beside = None if frame.neighbour_frame is None else found[frame.neighbour_frame]
        neighbour = frame.neighbour if beside is None else beside.own
        own = (axes or {}).get(i, frame.own)
        if (
            origin is not None
            and own is frame.own
            and frame.slides
            and (may_move is None or may_move[i])
            and own.distance(origin) > tolerances[i]
        ):
            moved = own.through(origin)
            if _may_lie(moved, neighbour, frame.must_meet, tolerances[i], length_scale):
                own = moved
        relation = axis_relation(neighbour, own, max(length_scale, tolerances[i] / PARALLEL))
        if relation.has_one_normal:
            place = normal_foot(neighbour, own)
        else:
            place = own.nearest(np.zeros_like(own.point) if origin is None else origin)
        x = normal_direction(neighbour, own, relation)
        found[i] = RightPlace(own, neighbour, relation, place, x)
    return [each for each in found if each is not None]


def axis_across(axis: AxisLine, lines: Sequence[AxisLine], near: Numbers) -> AxisLine:
    """Return the parallel to ``axis`` that meets all ``lines`` and is nearest to ``near``."""
    # If no parallel meets all lines, return the parallel with the least distances from the lines.
    across = np.stack([_unit(cross(axis.direction, line.direction)) for line in lines], axis=1)
    apart = np.stack([line.point - near for line in lines], axis=1)
    across = np.nan_to_num(across)
    distances = (apart * across).sum(axis=-1, keepdims=True)
    return axis.through(near + (np.linalg.pinv(across, rcond=PARALLEL) @ distances)[..., 0])


def _may_lie(
    moved: AxisLine,
    neighbour: AxisLine,
    must_meet: Sequence[AxisLine],
    tolerance: float,
    length_scale: float,
) -> bool:
    relation = axis_relation(neighbour, moved, length_scale)
    if relation.has_one_normal and largest(normal_foot(neighbour, moved) - moved.point) > tolerance:
        return False
    for line in must_meet:
        across = cross(line.direction, moved.direction)
        if float(np.abs(_dot(moved.point - line.point, _unit(across))).max()) > tolerance:
            return False
    return True


def frame_of(z: Numbers, origin: Numbers, x: Numbers) -> Matrices:
    """Return the frame ``(samples, 4, 4)`` with these z and x axes and this origin."""
    # z and x need no unit length. If x is rounded, the frame's x is made perpendicular to z.
    frame = identity((len(z),))
    z = _unit(z)
    x = _unit(x - _dot(x, z)[:, None] * z)
    frame[:, :3, 0], frame[:, :3, 1], frame[:, :3, 2] = x, cross(z, x), z
    frame[:, :3, 3] = origin
    return frame


def home_rows(frames: Sequence[Matrices], convention: Convention) -> Numbers:
    """Return the DH rows ``(rows, 4, samples)`` between frames at the home pose."""
    return np.stack(
        [row(inverse(before) @ after, convention) for before, after in pairwise(frames)]
    )


def largest(vectors: Numbers) -> float:
    """Return the length of the longest of the given vectors."""
    # NaN counts as infinite.
    return float(np.nan_to_num(np.linalg.norm(vectors, axis=-1), nan=np.inf).max())


def _dot(one: Numbers, other: Numbers) -> Numbers:
    return np.asarray((one * other).sum(axis=-1))


def _unit(vectors: Numbers) -> Numbers:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))
