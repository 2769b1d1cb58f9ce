"""Arrows that show how a joint moves: around its axis, or along it."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from service.figures.drawing.dimensions import arrowhead
from service.figures.drawing.placing import TakenRoom, around
from service.figures.drawing.solids import Camera, perpendicular, polyline
from service.kinematics.transforms import Numbers

_HEAD = 8.0


@dataclass(frozen=True, slots=True)
class MotionArrow:
    """An arrow in the picture, ``(points, 2)``; with ``both``, the arrow has a head at each end."""

    line: Numbers
    both: bool

    @property
    def middle(self) -> Numbers:
        """The middle point of the arrow."""
        return np.asarray(self.line[len(self.line) // 2])

    @property
    def beside(self) -> list[Numbers]:
        """Possible places for the name of the joint variable, the best first."""
        outwards = np.sign(self.line[-1] - self.line[0]) * [16.0, 4.0]
        ends = [self.line[-1] + outwards, self.line[0] - outwards]
        near = around(self.middle, 15.0)
        return [*near[:12], *ends, *near[12:]]

    def svg(self) -> Iterator[str]:
        """Yield the SVG of the arrow's line and heads."""
        line = self.line
        yield polyline(line, "motion-halo")
        yield polyline(line, "motion")
        ends = [(line[-1], line[-3])] + ([(line[0], line[2])] if self.both else [])
        for tip, before in ends:
            step = tip - before
            direction = step / max(float(np.linalg.norm(step)), 1e-9)
            yield arrowhead(tip + 0.5 * _HEAD * direction, direction, "motion-head", _HEAD)


def turning_arrow(
    camera: Camera, centre: Numbers, axis: Numbers, offset: float, radius: float,
    room: TakenRoom, *, both: bool,
) -> MotionArrow:  # fmt: skip
    """Return an arc around the joint's axis, at the less crowded end of the joint."""
    # The arc is on the viewer's side.
    front = perpendicular(axis, camera.towards)
    aside = np.cross(axis, front)
    angles = np.radians(np.linspace(-95, 70, 24))
    arc = radius * (np.cos(angles)[:, None] * front + np.sin(angles)[:, None] * aside)
    lines = [
        camera.seen(centre + end * offset * axis + arc) for end in _nearer_end_first(camera, axis)
    ]

    def penalty(line: Numbers) -> float:
        crossed = sum(map(room.crossings, sliding_window_view(line[::4], 2, axis=0).mT))
        return room.crowding(line, 5.0) + 3.0 * room.covered(line) + crossed

    return MotionArrow(min(lines, key=penalty), both)


def _nearer_end_first(camera: Camera, axis: Numbers) -> tuple[float, float]:
    return (1.0, -1.0) if axis @ camera.towards >= 0 else (-1.0, 1.0)


def sliding_arrow(
    camera: Camera, centre: Numbers, axis: Numbers, half: float, offset: float,
    room: TakenRoom, *, both: bool,
) -> MotionArrow:  # fmt: skip
    """Return a straight arrow next to the joint, on its less crowded side in the picture."""
    # If the arrow would cross an axis, a part or a name there, it is moved along the joint axis or
    # away from the joint.
    aside = np.cross(perpendicular(axis, camera.towards), axis)
    steps = np.linspace(-half, half, 9)[:, None] * axis

    def beside(reach: float, along: float) -> list[Numbers]:
        middle = centre + along * half * axis
        return [camera.seen(middle + side * offset * aside + steps) for side in (reach, -reach)]

    def crossings(line: Numbers) -> int:
        # The heads make the arrow longer.
        return room.crossings(1.3 * line - 0.3 * line.mean(axis=0))

    best = min(beside(1, 0), key=lambda line: room.crowding(line, 7.0))
    for reach in (1, 1.6, 2.2, 3):
        if crossings(best):
            others = [line for along in (0, 1, -1) for line in beside(reach, along)]
            freest = sorted(others, key=lambda line: room.crowding(line, 7.0))
            best = min([best, *freest], key=crossings)
    return MotionArrow(best, both)
