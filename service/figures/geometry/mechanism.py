"""The mechanism that a picture shows: joints on their axes, links between them, base and tool.

A joint may be drawn anywhere on its axis. Joints are moved along their axes until none of them
hides a neighbour.
"""

# The mechanism is built from the joint axes and the path between them, once for given lengths, and
# then moves with the joints. It does not depend on the frames of a table.

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Joint
from service.catalogue.robots.screw_robot import Reference
from service.expressions.evaluation.samples import SymbolValues
from service.figures.geometry.path import ChainPath, axis_directions, motions, path_of
from service.kinematics.screws import moved
from service.kinematics.transforms import Matrices, Numbers, inverse

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


def _largest_track(path: ChainPath, screws: Numbers, joints: Sequence[Joint]) -> "_Track":
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
        path: ChainPath,
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
