"""The mechanism that a picture shows: joints on their axes, links between them, base and tool.

It has numbers and places only; ``drawing.py`` and a 3D view draw them.
"""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from dh_grader.catalogue import Exercise, Joint, Variable
from dh_grader.catalogue.robot import (
    TRIALS,
    Reference,
    ReferenceTable,
    Robot,
    ScrewRobot,
    trial_values,
)
from dh_grader.expressions.evaluate import SymbolValues
from dh_grader.kinematics import (
    A,
    Convention,
    D,
    Matrices,
    Numbers,
    exponential,
    frames,
    inverse,
    moved,
)

# --- The mechanism that a picture shows: joints on their axes, links between them, base and tool
#
# A joint may be drawn anywhere on its axis. Joints are moved along their axes until none of them
# hides a neighbour. The mechanism is built from the joint axes and the path between them, once for
# given lengths, and then moves with the joints. It does not depend on the frames of a table.


# The sizes of drawn parts, as shares of ``MovableMechanism.size``.
JOINT_LENGTH, JOINT_RADIUS = 0.15, 0.046
GRIPPER_LENGTH = 0.09
_CLEARANCE = 0.035
# Candidates for that size, as shares of the path's extent. The largest that has room is used.
_SIZES = (1.2, 1.1, 1.0, 0.9, 0.8, 0.7, 0.6, 0.5)
_SAME = 1e-7
_NOTHING = 1e-5


@dataclass(frozen=True, slots=True)
class Configuration:
    """The mechanism at some joint values; points ``(3,)`` and unit vectors in the base frame.

    Each link is a line ``(corners, 3)``. Link 0 leads from the base to the first joint.
    """

    # There is one more link than joints: link i leads from joint i to the next, the last one to the
    # tool. Two corners may coincide at some value of a prismatic joint.
    centres: Numbers
    axes: Numbers
    links: tuple[Numbers, ...]
    base: Numbers
    base_normal: Numbers
    tool: Numbers
    tool_direction: Numbers


@dataclass(frozen=True, slots=True)
class MovableMechanism:
    """The mechanism with all joint variables 0, which can be moved.

    ``corners`` has the points of each body, the base first. ``centres`` has the middle of each
    joint.
    """

    # A joint's middle moves with the body before the joint. ``extent`` is the size of the whole
    # mechanism, ``size`` the size of its parts.
    reference: Reference
    lengths: Mapping[str, float]
    extent: float
    size: float
    corners: tuple[Numbers, ...]
    centres: Numbers
    base_normal: Numbers
    tool_direction: Numbers

    @property
    def joints(self) -> tuple[Joint, ...]:
        """The robot's joints."""
        return self.reference.joints

    def at(self, amounts: Numbers) -> list[Configuration]:
        """Return the mechanism at values of the joint variables, ``(configurations, joints)``."""
        count = len(amounts)
        values = as_samples(self.lengths, count) | {
            joint.variable: amounts[:, i] for i, joint in enumerate(self.joints)
        }
        bodies = motions(self.reference, values, count)
        axes = axis_directions(moved(bodies[:-1], self.reference.screws(values, count)))
        carried = [
            _moved(body, corners) for body, corners in zip(bodies, self.corners, strict=True)
        ]
        centres = np.stack(
            [_moved(body, c[None])[:, 0] for body, c in zip(bodies, self.centres, strict=False)]
        )
        directions = bodies[-1, :, :3, :3] @ self.tool_direction
        return [
            Configuration(
                centres=centres[:, s],
                axes=axes[:, s],
                links=tuple(_links([points[s] for points in carried], centres[:, s])),
                base=carried[0][s, 0],
                base_normal=self.base_normal,
                tool=carried[-1][s, -1],
                tool_direction=directions[s],
            )
            for s in range(count)
        ]


def _links(carried: Sequence[Numbers], centres: Numbers) -> Iterator[Numbers]:
    # The points of the link's body, between the middles of its joints.
    starts, ends = [carried[0][:0], *centres[:, None]], [*centres[:, None], carried[-1][:0]]
    for start, points, end in zip(starts, carried, ends, strict=True):
        yield np.concatenate([start, points, end])


def as_samples(numbers: Mapping[str, float], count: int) -> dict[str, Numbers]:
    """Return each number as an array of length ``count``, for evaluating formulas."""
    return {name: np.full(count, number) for name, number in numbers.items()}


def distinct(points: Numbers) -> Numbers:
    """Return the points ``(points, 3)`` of a line without consecutive duplicates."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return np.asarray(points[np.concatenate([[True], steps > _SAME])])


def _moved(body: Matrices, points: Numbers) -> Numbers:
    turned = points @ np.swapaxes(body[..., :3, :3], -1, -2)
    return np.asarray(turned + body[..., None, :3, 3])


def mechanism_of(reference: Reference, numbers: Mapping[str, float]) -> MovableMechanism:
    """Return the mechanism that can be moved.

    ``numbers`` has the value of every symbol: each length and each joint variable.
    """
    # With these joint values, no drawn joint should hide another joint.
    values: SymbolValues = as_samples(numbers, 1)
    path = path_of(reference, values, 1)
    bodies = motions(reference, values, 1)[:, 0]
    screws = moved(bodies[:-1], reference.screws(values, 1)[:, 0])
    track = _largest_track(path, screws, reference.joints)
    at = track.placed()
    marks = [-np.inf, *at, np.inf]
    corners = tuple(
        _moved(inverse(bodies[i]), track.corners_between(first, last))
        for i, (first, last) in enumerate(pairwise(marks))
    )
    centres = [_moved(inverse(bodies[i]), track.point(s)[None])[0] for i, s in enumerate(at)]
    variables = {joint.variable for joint in reference.joints}
    return MovableMechanism(
        reference=reference,
        lengths={name: number for name, number in numbers.items() if name not in variables},
        extent=track.extent,
        size=track.size,
        corners=corners,
        centres=np.array(centres),
        base_normal=track.base_normal,
        tool_direction=bodies[-1, :3, :3].T @ track.arrival,
    )


def _largest_track(path: "ChainPath", screws: Numbers, joints: Sequence[Joint]) -> "_Track":
    # If possible, the first joint stands on the ground at the origin. A column below the origin
    # would suggest a length that the robot does not have.
    tracks = [
        _Track.of(path, screws, joints, share, sunk=sunk)
        for share in _SIZES
        for sunk in (False, True)
    ]
    return next((track for track in tracks if track.has_room), tracks[-1])


@dataclass(frozen=True, slots=True)
class _Track:
    """The chain's path, and the stretches of the path on which each joint may be drawn."""

    # The path is extended to the ground.
    # ``reached`` is the length of the path up to each corner. ``first`` and ``last`` are the ends
    # of each joint's stretch, and ``own`` has the ends of the piece along the joint's axis. All
    # these ends are given as lengths of the path up to them.
    corners: Numbers
    reached: Numbers
    first: Numbers
    last: Numbers
    own: Numbers
    slides: tuple[bool, ...]
    extent: float
    size: float
    base_normal: Numbers

    @classmethod
    def of(
        cls,
        path: "ChainPath",
        screws: Numbers,
        joints: Sequence[Joint],
        share: float,
        *,
        sunk: bool,
    ) -> "_Track":
        corners = path.corners[:, 0]
        extent = float(np.linalg.norm(np.ptp(corners, axis=0)))
        # A robot without lengths must be drawn, too.
        extent = extent if extent > _NOTHING else 1.0
        size = share * extent
        directions = axis_directions(screws)
        pieces = [path.joints.index(i) for i in range(len(joints))]
        lines = [
            (corners[piece] if joint.prismatic else np.cross(screw[:3], screw[3:]), direction)
            for piece, joint, screw, direction in zip(
                pieces, joints, screws, directions, strict=True
            )
        ]
        foot, normal = _foot(corners, pieces[0], lines[0], size, sunk=sunk)
        corners = np.concatenate([foot[None], corners])
        pieces = [piece + 1 for piece in pieces]
        reached = np.concatenate(
            [[0.0], np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1))]
        )
        stretches = []
        for i, (point, direction) in enumerate(lines):
            on_line = np.linalg.norm(np.cross(corners - point, direction), axis=1) < _SAME * extent
            # Beyond its neighbours' pieces, a piece is on this joint's axis only by chance.
            low = pieces[i - 1] if i else 0
            high = pieces[i + 1] + 1 if i + 1 < len(pieces) else len(corners) - 1
            first = last = pieces[i]
            last += 1
            while first > low and on_line[first - 1]:
                first -= 1
            while last < high and on_line[last + 1]:
                last += 1
            stretches.append((reached[first], reached[last]))
        if not sunk and stretches[0][1] - reached[1] < _SAME < reached[1]:
            # The first joint has no room above the origin: its middle is there.
            stretches[0] = (reached[1], reached[1])
        first_last = np.array(stretches)
        return cls(
            corners=corners,
            reached=reached,
            first=first_last[:, 0],
            last=first_last[:, 1],
            own=np.array([(reached[piece], reached[piece + 1]) for piece in pieces]),
            slides=tuple(joint.prismatic for joint in joints),
            extent=extent,
            size=size,
            base_normal=normal,
        )

    def point(self, s: float) -> Numbers:
        # ``s`` is the length of the path up to the point.
        return np.array([np.interp(s, self.reached, column) for column in self.corners.T])

    def corners_between(self, first: float, last: float) -> Numbers:
        inside = (self.reached > first + _SAME) & (self.reached < last - _SAME) & self.bent
        inside[-1] = last == np.inf
        return self.corners[inside]

    @property
    def bent(self) -> NDArray[np.bool_]:
        # Corners where the path begins or bends; of coincident corners, only one.
        kept = np.flatnonzero(np.concatenate([[True], np.diff(self.reached) > _SAME]))
        steps = np.diff(self.corners[kept], axis=0)
        steps /= np.linalg.norm(steps, axis=1, keepdims=True)
        turns = np.linalg.norm(np.cross(steps[:-1], steps[1:]), axis=1) > _SAME
        found = np.zeros(len(self.corners), dtype=np.bool_)
        found[kept[1:-1][turns]] = True
        found[0] = True
        return found

    @property
    def arrival(self) -> Numbers:
        line = distinct(self.corners)
        step = line[-1] - line[-2] if len(line) > 1 else self.base_normal
        return np.asarray(step / np.linalg.norm(step))

    @property
    def _across(self) -> NDArray[np.bool_]:
        # A link reaches these joints from the side.
        only = np.where(np.ptp([self.first, self.last], axis=0) > _SAME, -np.inf, self.last)
        before = np.concatenate([[-np.inf], only[:-1]])
        return np.asarray(self.first > self.own[:, 0] - _SAME) & (before < self.own[:, 0] - _SAME)

    @property
    def _halves(self) -> tuple[Numbers, Numbers]:
        # Along the path, before and after the joint's middle.
        extended = self.last - self.first > _SAME
        length, side = JOINT_LENGTH / 2 * self.size, 1.3 * JOINT_RADIUS * self.size
        after = np.where(extended, length, side)
        return np.where(self._across, side, after), after

    @property
    def _apart(self) -> Numbers:
        # The minimum distance between the middles of neighbouring joints along the path.
        before, after = self._halves
        return np.asarray(after[:-1] + before[1:] + _CLEARANCE * self.size)

    @property
    def has_room(self) -> bool:
        at = np.array(self.placed())
        to_tool = self.reached[-1] - at[-1] - self._halves[1][-1] - GRIPPER_LENGTH * self.size
        return bool((np.diff(at) > self._apart - _SAME).all() and to_tool > -_SAME)

    def placed(self) -> list[float]:
        # Near the preferred place, clear of the other joints.
        apart = self._apart
        low, high = self.first.copy(), self.last.copy()
        low[0] = max(low[0], min(JOINT_LENGTH / 2 * self.size, high[0]))
        high[-1] = max(high[-1] - GRIPPER_LENGTH * self.size - self._halves[1][-1], low[-1])
        for i, gap in enumerate(apart):
            low[i + 1] = min(max(low[i + 1], low[i] + gap), high[i + 1])
        for i in range(len(apart) - 1, -1, -1):
            high[i] = max(min(high[i], high[i + 1] - apart[i]), low[i])
        at: list[float] = []
        for i, wanted in enumerate(self._wanted(low[0])):
            if at:
                low[i] = min(max(low[i], at[-1] + apart[i - 1]), high[i])
            at.append(float(min(max(wanted, low[i]), high[i])))
        return at

    def _wanted(self, lowest: float) -> Iterator[float]:
        # If the first joint is revolute, it is on the ground. A prismatic joint is where its
        # displacement begins. Any other revolute joint is where its own piece begins if a link
        # arrives from the side, else in the middle of its piece.
        for i, (start, end) in enumerate(self.own):
            if i == 0 and not self.slides[0]:
                yield lowest
            else:
                yield start if self.slides[i] or self._across[i] else (start + end) / 2


def _foot(
    corners: Numbers, piece: int, line: tuple[Numbers, Numbers], size: float, *, sunk: bool
) -> tuple[Numbers, Numbers]:
    # If the first joint has no room on its axis between the origin and the first link, the ground
    # is below the origin: by half the length of the joint, or, if ``sunk``, by its whole length, so
    # that another joint has room at the origin. The ground is above an arm that hangs down from it.
    up = np.array([0.0, 0.0, 1.0])
    origin = corners[0]
    point, direction = line
    on_axis = np.linalg.norm(np.cross(origin - point, direction)) < _SAME * size
    room = np.linalg.norm(corners[piece + 1] - origin) if on_axis else np.inf
    if room > (JOINT_LENGTH + _CLEARANCE) * size:
        return origin, up
    depth = (JOINT_LENGTH + 0.1 if sunk else JOINT_LENGTH / 2) * size
    along = direction * np.sign(direction @ up) if abs(direction @ up) > 0.7 else up
    leaving = np.diff(distinct(corners), axis=0)[:1]
    if (leaving @ along < -0.7 * np.linalg.norm(leaving, axis=-1)).any():
        along = -along
    return origin - depth * along, along


# --- The numbers that a figure uses for symbols


# The displacement of a prismatic joint as a share of its range: less than half, so that there is
# room to slide both ways.
_EXTENDED = 0.4


def drawing_numbers(variables: Iterable[Variable]) -> dict[str, float]:
    """Return a number for every symbol, to draw the robot with extended prismatic joints.

    A link parameter gets the middle of its range, a joint angle 0.
    """
    # A prismatic joint at 0 would be invisible.
    return {variable.name: _number(variable) for variable in variables}


def _number(variable: Variable) -> float:
    if variable.joint is not None and variable.kind == "angle":
        return 0.0
    share = 0.5 if variable.joint is None else _EXTENDED
    return float(f"{variable.low + share * (variable.high - variable.low):.3g}")


# --- Find the lengths in a figure that have a name: a symbol, a sum or a number


_EXACT = 1e-9


@dataclass(frozen=True, slots=True)
class NamedLength:
    """A piece of the chain's path whose length is the sum of the symbols ``names``.

    ``start`` and ``end`` are indices of corners of ``ChainPath``.
    """

    start: int
    end: int
    names: tuple[str, ...]


def named_lengths(
    reference: Reference, variables: tuple[Variable, ...], statement: str = ""
) -> list[NamedLength]:
    """Return the stretches whose length is a sum of symbols, or a number in the statement."""
    # Students know all symbols of an exercise, so the names reveal nothing.
    turning = {joint.variable for joint in reference.joints if not joint.prismatic}
    values = {
        name: np.zeros(TRIALS) if name in turning else trial
        for name, trial in trial_values(variables).items()
    }
    path = path_of(reference, values, TRIALS)
    lengths = [variable for variable in variables if variable.kind == "length"]
    # A sum begins with the constant symbols: l4 + q4.
    names = [each.name for each in sorted(lengths, key=lambda each: each.joint or 0)]
    terms = np.array([*(values[name] for name in names), np.ones(TRIALS)]).T
    numbers = _decimals(statement)
    found = []
    for i, step in enumerate(np.diff(path.corners, axis=0)):
        share = _sum_of(step, terms)
        if share is not None:
            whole = tuple(name for name, each in zip(names, share, strict=False) if each)
            found.append(NamedLength(i, i + 1, whole))
        elif number := _stated(step, numbers):
            found.append(NamedLength(i, i + 1, (number,)))
    return found


def _decimals(statement: str) -> dict[str, float]:
    return {found: float(found) for found in re.findall(r"(?<![\w.])\d+\.\d+", statement)}


def _stated(step: Numbers, numbers: Mapping[str, float]) -> str | None:
    # Only for a piece of constant length.
    length = np.linalg.norm(step, axis=1)
    return next((text for text, n in numbers.items() if np.abs(length - n).max() < _EXACT), None)


def _sum_of(step: Numbers, terms: Numbers) -> Numbers | None:
    # A 0 or 1 for each term, so that the sum is the piece's length; None if impossible.
    length = np.linalg.norm(step, axis=1)
    solved = np.linalg.lstsq(terms, length, rcond=None)[0]
    share = np.asarray(np.round(solved), dtype=np.float64)
    exact = np.abs(terms @ share - length).max() < _EXACT
    plain = share.any() and not share[-1] and set(share.tolist()) <= {0.0, 1.0}
    return share if exact and plain else None


# --- The chain as a path of straight pieces from the base frame to the tool
#
# A piece is along the axis of a joint, or across from one axis to the next.
#
# A table gives both kinds: Z_i is along an axis, X_i is across (``kinematics.chain``). For a robot
# with screw axes, the path follows the common normals between the axes.


# Two directions are parallel if their cross product is shorter.
PARALLEL = 1e-9


@dataclass(frozen=True, slots=True)
class ChainPath:
    """The corners ``(k + 1, samples, 3)`` of a path with ``k`` pieces.

    ``joints`` has, for each piece, the joint whose axis it follows, or None.
    """

    # The index counts from 0; None is a piece from one axis to the next.
    corners: Numbers
    joints: tuple[int | None, ...]


def motions(reference: Reference, values: SymbolValues, samples: int) -> Matrices:
    """Return each body's motion from its home position, ``(joints + 1, samples, 4, 4)``.

    Body 0 is the base; joints 1 to i move body i.
    """
    # The motion is e^{[S_1]q_1} … e^{[S_i]q_i}.
    screws = reference.screws(values, samples)
    moved_by = [np.broadcast_to(np.eye(4), (samples, 4, 4))]
    for joint, screw in zip(reference.joints, screws, strict=True):
        amount = np.broadcast_to(values[joint.variable], (samples,))
        moved_by.append(moved_by[-1] @ exponential(screw, amount))
    return np.stack(moved_by)


def axis_directions(screws: Numbers) -> Numbers:
    """Return the directions ``(..., 3)`` of the screw axes ``(..., 6)`` of joints."""
    omega = screws[..., :3]
    turns = np.linalg.norm(omega, axis=-1, keepdims=True) > PARALLEL
    return np.where(turns, omega, screws[..., 3:])


def path_of(reference: Reference, values: SymbolValues, samples: int) -> ChainPath:
    """Return the path of a robot at values of all its symbols and joint variables."""
    if isinstance(reference, Robot):
        return table_path(reference.tables[reference.convention], values, samples)
    return _screw_path(reference, values, samples)


def table_path(table: ReferenceTable, values: SymbolValues, samples: int) -> ChainPath:
    """Return the path of a table."""
    # Pieces of a fixed row do not count as along a joint axis.
    return path_of_rows(table.values(values, samples), table.convention, len(table.joints))


def path_of_rows(rows: Numbers, convention: Convention, joints: int) -> ChainPath:
    """Return the path of a table in numbers, ``(rows, 4, samples)``."""
    reached = frames(rows, convention)
    corners, along = [reached[0, :, :3, 3]], list[int | None]()
    for i, row in enumerate(rows):
        before, after = reached[i], reached[i + 1]
        if convention is Convention.STANDARD:
            between = before[:, :3, 3] + row[D, :, None] * before[:, :3, 2]
        else:
            between = before[:, :3, 3] + row[A, :, None] * before[:, :3, 0]
        corners += [between, after[:, :3, 3]]
        joint = i if i < joints else None
        along += [joint, None] if convention is Convention.STANDARD else [None, joint]
    return ChainPath(np.stack(corners), tuple(along))


def _screw_path(robot: ScrewRobot, values: SymbolValues, samples: int) -> ChainPath:
    bodies = motions(robot, values, samples)
    screws = moved(bodies[:-1], robot.screws(values, samples))
    tool = robot.frame("tool", values, samples)[:, :3, 3]
    slides = [joint.prismatic for joint in robot.joints]
    corners = [_corners(screws[:, s], slides, tool[s]) for s in range(samples)]
    along = [place for joint in range(len(slides)) for place in (None, joint)]
    return ChainPath(np.stack(corners, axis=1), (*along, None))


def _corners(screws: Numbers, slides: Sequence[bool], tool: Numbers) -> Numbers:
    # Across to each axis, along it, and at last to the tool. The axis of a prismatic joint has no
    # fixed place, so it goes through the point reached so far.
    directions = axis_directions(screws)
    points = np.cross(screws[:, :3], screws[:, 3:])
    here = np.zeros(3)
    corners = [here]
    for i, direction in enumerate(directions):
        point = here if slides[i] else points[i]
        here = point + direction * (direction @ (here - point))
        corners.append(here)
        if i + 1 == len(directions):
            target = tool
        elif slides[i + 1]:
            target = here
        else:
            target = _nearest(here, direction, points[i + 1], directions[i + 1])
        here = here + direction * (direction @ (target - here))
        corners.append(here)
    return np.stack([*corners, tool])


def _nearest(point: Numbers, direction: Numbers, other: Numbers, its_direction: Numbers) -> Numbers:
    # ``point`` if the lines are parallel.
    normal = np.cross(direction, its_direction)
    if np.linalg.norm(normal) < PARALLEL:
        return point
    across = np.cross(its_direction, normal)
    distance = ((other - point) @ across) / (direction @ across)
    return np.asarray(point + direction * distance)


# --- The direction from which a figure is seen, in parallel projection with z0 upwards


_AZIMUTHS = (-60, 30, -50, 40, -40, 50, -30, 60, -70, 20, -20, 70, 120, -150, 130, -140, 150, -120)
_ELEVATIONS = (25, 30, 20, 35, 15)
_SAME_DIRECTION = 1e-6


@dataclass(frozen=True, slots=True)
class View:
    """The direction to the viewer: degrees about z0 from x0, and degrees above the x0-y0 plane."""

    azimuth: float
    elevation: float

    @property
    def rotation(self) -> Numbers:
        """The rotation ``(3, 3)``; its rows are the directions right, up and to the viewer."""
        a, e = np.radians([self.azimuth, self.elevation])
        right = [-np.sin(a), np.cos(a), 0.0]
        towards = [np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)]
        return np.array([right, np.cross(towards, right), towards])


def best_view(shown: Configuration, extent: float) -> View:
    """Return the clearest view of the mechanism."""
    # Of equally clear views, the first. In a clear view, no joint axis points at the viewer, no
    # link is much foreshortened, different directions look different, distinct points are apart,
    # and the arm extends to the right.
    views = [View(azimuth, elevation) for elevation in _ELEVATIONS for azimuth in _AZIMUTHS]
    rotations = np.array([view.rotation for view in views])
    steps = np.concatenate([np.diff(link, axis=0) for link in shown.links])
    lengths = np.linalg.norm(steps, axis=1, keepdims=True)
    seen = lengths[:, 0] > 0.02 * extent
    steps = steps[seen] / lengths[seen]
    directions = _different(np.concatenate([shown.axes, steps]), _parallel)
    flat = _flat(directions, rotations)
    sizes = np.maximum(np.linalg.norm(flat, axis=-1), _SAME_DIRECTION)
    i, j = np.triu_indices(len(directions), 1)
    crossed = np.abs(flat[:, i, 0] * flat[:, j, 1] - flat[:, i, 1] * flat[:, j, 0])
    angles = crossed / (sizes[:, i] * sizes[:, j])

    points = _different(
        np.concatenate([shown.centres, *shown.links]),
        lambda points, point: np.linalg.norm(points - point, axis=1) < 0.02 * extent,
    )
    i, j = np.triu_indices(len(points), 1)
    gaps = np.linalg.norm(np.diff(_flat(points, rotations)[:, [i, j]], axis=1)[:, 0], axis=-1)
    apart = np.maximum(np.linalg.norm(points[i] - points[j], axis=-1), 0.1 * extent)
    rightwards = _flat((shown.tool - shown.base)[None], rotations)[:, 0, 0]
    clarity = (
        2.0 * np.minimum(sizes.min(axis=1), 0.75)
        + 1.2 * angles.min(axis=1, initial=0.55)
        + 1.2 * (gaps / apart).min(axis=1, initial=0.5)
        + 0.5 * np.minimum(gaps / extent, 0.3).mean(axis=1)
        + 0.4 * np.clip(3 * rightwards / extent, -1.0, 1.0)
    )
    return views[int(clarity.argmax())]


def _flat(points: Numbers, rotations: Numbers) -> Numbers:
    # ``(points, 3)`` becomes ``(views, points, 2)``.
    return np.asarray((points @ np.swapaxes(rotations, 1, 2))[..., :2])


def _parallel(directions: Numbers, direction: Numbers) -> NDArray[np.bool_]:
    return np.asarray(np.linalg.norm(np.cross(directions, direction), axis=1) < _SAME_DIRECTION)


def _different(rows: Numbers, alike: Callable[[Numbers, Numbers], NDArray[np.bool_]]) -> Numbers:
    kept = rows[:1]
    for row in rows[1:]:
        if not alike(kept, row).any():
            kept = np.concatenate([kept, row[None]])
    return kept


# --- The frames that an exercise gives, such as the base and tool frames


@dataclass(frozen=True, slots=True)
class GivenFrames:
    """Frames of a robot, with their numbers and labels."""

    # ``numbers`` count them from the base frame, which is 0; -1 is the tool. ``labels`` are their
    # indices: "0" for {0}, or "s" and "b" for a robot with screw axes.
    source: ReferenceTable | ScrewRobot
    numbers: tuple[int, ...]
    labels: tuple[str, ...]

    def at(self, values: SymbolValues, samples: int) -> Matrices:
        """Return the poses of the frames in the base frame, ``(frames, samples, 4, 4)``."""
        if isinstance(self.source, ScrewRobot):
            names = ["base" if number == 0 else "tool" for number in self.numbers]
            poses = [self.source.frame(name, values, samples) for name in names]
            return np.array(poses).reshape(-1, samples, 4, 4)
        table = self.source
        found = frames(table.values(values, samples), table.convention)
        return np.asarray(found[list(self.numbers)])


def given_frames(exercise: Exercise) -> GivenFrames:
    """Return the frames that the exercise gives. Raises LookupError without a robot.

    Frames that the student may choose are left out.
    """
    # The frames between base and tool are also left out if parts ask for frames in different
    # conventions.
    robot = exercise.reference
    if robot is None:
        raise LookupError(f"exercise {exercise.id!r} has no robot")
    free = {
        name
        for part in exercise.parts
        for name in ("base", "tool", "frames")
        if getattr(part, name, "given") == "free"
    }
    if isinstance(robot, ScrewRobot):
        return _chosen(robot, ("s", "b"), free | {"frames"})
    conventions = {part.convention for part in exercise.parts if hasattr(part, "convention")}
    table = robot.tables[robot.convention]
    if len(conventions) == 1:
        [convention] = conventions
        table = robot.tables.get(convention, table)
    if len(conventions) != 1 or conventions != {table.convention}:
        free |= {"frames"}
    return _chosen(table, frame_labels(table), free)


def with_named_base(given: GivenFrames, statement: str) -> GivenFrames:
    """Return the frames together with the base frame if the statement names it."""
    # The base frame may be free, but the statement's coordinates are those of one choice of it.
    label = "s" if isinstance(given.source, ScrewRobot) else frame_labels(given.source)[0]
    if 0 in given.numbers or f"{{{label}}}" not in statement:
        return given
    return replace(given, numbers=(0, *given.numbers), labels=(label, *given.labels))


def table_frames_of(robot: Robot, convention: Convention | None = None) -> GivenFrames:
    """Return all frames of a robot's table in a convention, by default the author's."""
    table = robot.tables[convention or robot.convention]
    return _chosen(table, frame_labels(table), set())


def frame_labels(table: ReferenceTable) -> tuple[str, ...]:
    """Return the labels of a table's frames."""
    # The base frame has the first joint's number minus 1; the other frames have the row labels.
    return (str(table.joints[0].index - 1), *table.labels)


def _chosen(
    source: ReferenceTable | ScrewRobot, labels: tuple[str, ...], free: set[str]
) -> GivenFrames:
    last = len(labels) - 1
    numbers = [
        number
        for number in range(last + 1)
        if ("base" if number == 0 else "tool" if number == last else "frames") not in free
    ]
    return GivenFrames(
        source,
        tuple(-1 if number == last else number for number in numbers),
        tuple(labels[number] for number in numbers),
    )
