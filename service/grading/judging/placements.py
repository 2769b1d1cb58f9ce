"""Judge the frames that a student places on the joint axes, with all joint variables 0."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Final

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Exercise
from service.catalogue.parts.frames import FRAME_CELLS
from service.catalogue.robots.robot import at_home
from service.grading.numerics.comparison import Match, entry_matches, rounding_slack
from service.grading.numerics.samples import Samples
from service.grading.numerics.tolerances import EXACT_VALUE
from service.grading.reading.entry import entry_values
from service.grading.reading.lists.frame_list import Direction, StudentFrame
from service.kinematics.chain import THETA, D, Table, joint_frames
from service.kinematics.dh import Convention
from service.kinematics.frames.placement import (
    AskedFrame,
    AxisLine,
    RightPlace,
    asked_frames,
    axis_across,
    frame_of,
    home_rows,
    largest,
    right_places,
    z_line,
)
from service.kinematics.tolerances import NO_ROTATION
from service.kinematics.transforms import Matrices, Numbers, cross, identity

# The most sliding joints whose axes are tried both as moved and as drawn: 16 ways.
_MOST_MOVED: Final = 4
AXIS, Z, ORIGIN, X = 0, 1, slice(2, 5), 5


@dataclass(frozen=True, slots=True)
class FramesAtHome:
    """The frames to be placed and the given frames, with all joint variables 0."""

    # ``joints`` are the numbers of the frames' joints. ``base`` and ``tool`` are ``(SAMPLES, 4,
    # 4)``.
    convention: Convention
    asked: tuple[AskedFrame, ...]
    joints: tuple[int, ...]
    base: Matrices
    tool: Matrices
    length_scale: float


@dataclass(frozen=True, slots=True)
class PlacedFrame:
    """A placed frame in numbers, with the rounding errors of z, origin and x.

    A value that was not read is None or NaN.
    """

    axis: int | None
    z: Numbers | None
    z_slack: float
    origin: Numbers
    origin_slack: float
    x: Numbers | None
    x_slack: float

    @property
    def point(self) -> Numbers | None:
        """The origin ``(SAMPLES, 3)``, None unless all coordinates were read."""
        return self.origin.T if np.isfinite(self.origin).all() else None


@dataclass(frozen=True, slots=True)
class JudgedFrames:
    """The correct places of the frames, and the comparison result of each cell ``(frames, 6)``."""

    places: list[RightPlace]
    found: NDArray[np.int_]

    @property
    def wrong(self) -> int:
        """The number of wrong cells."""
        return int((self.found == Match.DIFFERENT).sum())


def home_samples(exercise: Exercise, samples: Samples) -> Samples:
    """Return the samples, with the value 0 for every joint variable."""
    return samples.cached(
        "home", lambda: Samples(at_home(exercise.joints, samples.values, samples.count))
    )


def home_robot(exercise: Exercise, convention: Convention, samples: Samples) -> FramesAtHome:
    """Return the frames to be placed on the exercise's robot."""

    def compute() -> FramesAtHome:
        robot, home = exercise.robot, home_samples(exercise, samples)
        reached = robot.all_frames(home.values, samples.count)
        on_axes = joint_frames(reached, robot.convention)[: len(robot.joints)]
        has_tool_row = len(robot.tables[convention].rows) > len(robot.joints)
        base = identity((samples.count,))
        asked = asked_frames(
            [z_line(frame) for frame in on_axes],
            [joint.prismatic for joint in robot.joints],
            convention,
            base,
            reached[-1],
            has_tool_row=has_tool_row,
        )
        joints = tuple(robot.joints[frame.joint].index for frame in asked)
        scale = exercise.length_scale
        return FramesAtHome(convention, asked, joints, base, reached[-1], scale)

    return samples.cached(("home_robot", convention), compute)


def placed_frame(frame: StudentFrame, home: Samples) -> PlacedFrame:
    """Return a frame in numbers, at samples with all joint variables 0."""
    slacks = [
        rounding_slack(entry.expression, home) if entry.expression else 0.0
        for entry in frame.origin
    ]
    return PlacedFrame(
        frame.axis.number,
        *_direction(frame.z, home),
        entry_values(frame.origin, ("length",) * 3, home),
        sum(slacks),
        *_direction(frame.x, home),
    )


def _direction(direction: Direction, home: Samples) -> tuple[Numbers | None, float]:
    values = direction.values(home)
    if values is None:
        return None, 0.0
    with np.errstate(invalid="ignore", over="ignore"):
        length = np.linalg.norm(values, axis=-1, keepdims=True)
        values = np.where(length > NO_ROTATION, values, np.nan) / np.maximum(length, NO_ROTATION)
    slacks = (rounding_slack(e.expression, home) for e in direction.entries if e.expression)
    shortest = float(np.nan_to_num(length, nan=1.0, posinf=1.0).min())
    return values, sum(slacks) / max(shortest, NO_ROTATION)


def ways_to_judge(
    robot: FramesAtHome,
    placed: Sequence[PlacedFrame],
    written: Sequence[StudentFrame] | None,
    home: Samples,
) -> list[JudgedFrames]:
    """Judge placed frames in several ways, because the axis of a sliding joint has no fixed place.

    ``written`` are the student's entries.
    """
    # The axis of a sliding joint has no fixed place. The first way puts each sliding axis through
    # the origin that the student chose, if the rules allow that. If cells are then wrong, the other
    # ways leave some sliding axes where the figure draws them, or put one sliding axis where the
    # neighbouring frames need it. So one wrong origin need not make another frame wrong.
    everywhere = (True,) * len(robot.asked)
    first = _judged(robot, placed, written, home, everywhere)
    moved = [i for i, place in enumerate(first.places) if place.own is not robot.asked[i].own]
    ways = [first]
    if not first.wrong:
        return ways
    chosen = moved[:_MOST_MOVED]
    for choice in list(product((True, False), repeat=len(chosen)))[1:]:
        may_move = list(everywhere)
        for i, each in zip(chosen, choice, strict=True):
            may_move[i] = each
        ways.append(_judged(robot, placed, written, home, may_move))
    needed = {i: _axis_by_others(i, robot, placed, place) for i, place in enumerate(first.places)}
    ways += [
        _judged(robot, placed, written, home, everywhere, {i: axis})
        for i, axis in needed.items()
        if axis is not None
    ]
    return ways


def _axis_by_others(
    i: int, robot: FramesAtHome, placed: Sequence[PlacedFrame], place: RightPlace
) -> AxisLine | None:
    # The axis is moved to where the student's x axes meet it. None if the student's origin is on
    # the axis as drawn, or if no x axis determines where the axis is.
    asked, own = robot.asked[i], placed[i]
    if not asked.slides or own.point is None:
        return None
    if asked.own.distance(own.point) <= EXACT_VALUE * robot.length_scale + own.origin_slack:
        return None
    lines = list(asked.must_meet)
    for other, frame in zip(robot.asked, placed, strict=True):
        if other.neighbour_frame == i and frame.x is not None and frame.point is not None:
            lines.append(AxisLine(frame.x, frame.point))
    if not lines:
        return None
    if own.x is not None and not place.relation.has_one_normal:
        lines.append(AxisLine(own.x, place.neighbour.point))
    if not all(np.isfinite(line.direction).all() for line in lines):
        return None
    return axis_across(asked.own, lines, own.point)


def _judged(
    robot: FramesAtHome,
    placed: Sequence[PlacedFrame],
    written: Sequence[StudentFrame] | None,
    home: Samples,
    may_move: Sequence[bool],
    axes: Mapping[int, AxisLine] | None = None,
) -> JudgedFrames:
    scale = robot.length_scale
    tolerances = [EXACT_VALUE * scale + frame.origin_slack for frame in placed]
    points = [frame.point for frame in placed]
    places = right_places(robot.asked, points, robot.convention, tolerances, scale, may_move, axes)
    found = np.full((len(placed), len(FRAME_CELLS)), int(Match.UNDEFINED))
    for i, (frame, place) in enumerate(zip(placed, places, strict=True)):
        if frame.axis is not None:
            right = frame.axis == robot.joints[i]
            found[i, AXIS] = int(Match.EXACT if right else Match.DIFFERENT)
        if frame.z is not None:
            off = largest(cross(frame.z, place.own.direction))
            found[i, Z] = _match(off, frame.z_slack)
        expressions = [None] * 3 if written is None else [e.expression for e in written[i].origin]
        at_origin = entry_matches(expressions, frame.origin, place.origin.T, scale, home)
        is_read = np.isfinite(frame.origin).all(axis=-1)
        found[i, ORIGIN] = np.where(is_read, at_origin, int(Match.UNDEFINED))
        if frame.x is not None:
            found[i, X] = _match(x_error(frame.x, place), frame.x_slack)
    return JudgedFrames(places, found)


def x_error(x: Numbers, place: RightPlace) -> float:
    """Return the sine of the angle between a unit vector x and the nearest correct x direction."""
    if place.x is None:
        return float(np.nan_to_num(np.abs((x * place.own.direction).sum(axis=-1)), nan=1).max())
    return largest(cross(x, place.x))


def _match(error: float, slack: float) -> int:
    if error <= EXACT_VALUE:
        return int(Match.EXACT)
    return int(Match.ROUNDED if error <= EXACT_VALUE + slack else Match.DIFFERENT)


def lazy_frames(robot: FramesAtHome) -> list[PlacedFrame]:
    """Return an answer that needs no geometry: all frames are equal to the base frame."""
    # The joint numbers are correct.
    count = len(robot.base)
    z, x = (np.tile(np.eye(3)[i], (count, 1)) for i in (2, 0))
    return [PlacedFrame(joint, z, 0.0, np.zeros((3, count)), 0.0, x, 0.0) for joint in robot.joints]


def known_frames(robot: FramesAtHome, home: Samples) -> NDArray[np.bool_]:
    """Return a mask ``(frames, 6)`` of the cells that need geometry."""
    # In these cells, frames that are all placed at the base frame are wrong.
    everywhere = (True,) * len(robot.asked)
    judged = _judged(robot, lazy_frames(robot), None, home, everywhere)
    return np.asarray(judged.found == Match.DIFFERENT)


def table_of_frames(
    robot: FramesAtHome, placed: Sequence[PlacedFrame], exercise: Exercise, samples: Samples
) -> Table:
    """Return the DH table ``(rows, 4, samples)`` that follows from correct frames."""
    # If the z axis of a frame is opposite to its joint's axis, the joint variable has a minus sign.
    frames = [robot.base]
    senses = {0: np.ones(len(robot.base))} if robot.convention is Convention.STANDARD else {}
    for asked, frame in zip(robot.asked, placed, strict=True):
        assert frame.z is not None
        assert frame.x is not None
        frames.append(frame_of(frame.z, frame.origin.T, frame.x))
        senses[asked.joint] = np.sign((frame.z * asked.own.direction).sum(axis=-1))
    frames.append(robot.tool)
    table = home_rows(frames, robot.convention)
    for i, joint in enumerate(exercise.joints):
        # The last frame of a modified table without a fixed row is the tool's.
        sense = senses.get(i, np.ones(len(robot.base)))
        table[i, D if joint.prismatic else THETA] += sense * samples.values[joint.variable]
    return table
