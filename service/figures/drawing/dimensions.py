"""Dimension lines: a line next to a piece of the mechanism, with the name of its length."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from service.figures.drawing.names import Label
from service.figures.drawing.placing import Rectangle, TakenRoom
from service.figures.drawing.solids import Camera, points_text, polyline
from service.kinematics.transforms import Numbers

# The possible distances of a dimension line from its piece, as shares of the mechanism's extent.
_DISTANCES = (0.12, 0.16, 0.21, 0.27, 0.34, 0.42)
_HEAD = 7.0
# Shorter lines have their arrowheads outside.
_SHORT = 26.0
_PLAIN_ANGLE = 0.5


class Drawing(NamedTuple):
    """The SVG of a dimension line, in two layers: under and over the mechanism."""

    below: list[str]
    above: list[str]


@dataclass(frozen=True, slots=True)
class _Line:
    # A dimension line in the picture.
    # Its ends, the ends of the measured piece, and its penalty. The line with the lowest penalty is
    # drawn.
    ends: Numbers
    measured: Numbers
    penalty: float


def dimension(
    camera: Camera, ends: Numbers, label: Label, extent: float, sides: Numbers, room: TakenRoom
) -> Drawing:
    """Draw a dimension line for the piece between ``ends``, and mark its room as taken.

    ``sides`` ``(n, 3)`` are n directions in which the line may be moved away from the piece.
    """
    # ``ends`` is ``(2, 3)``.
    line = min(_lines(camera, ends, extent, sides, room), key=lambda each: each.penalty)
    room.take_line(line.ends, 2.0, 1.0)
    for measured, end in zip(line.measured, line.ends, strict=True):
        room.take_line(np.array([measured, end]), 1.0, 0.4)
    place = room.place(label, _beside(line, label))
    above = [*_drawn(line), label.svg(place.x, place.y, "length")]
    return Drawing([_witness(*ends) for ends in zip(line.measured, line.ends, strict=True)], above)


def _lines(
    camera: Camera, ends: Numbers, extent: float, sides: Numbers, room: TakenRoom
) -> Iterator[_Line]:
    measured = camera.seen(ends)
    flat = measured[1] - measured[0]
    for side in sides:
        offset = camera.seen(side)
        size = float(np.linalg.norm(offset) * np.linalg.norm(flat))
        angle = abs(flat[0] * offset[1] - flat[1] * offset[0]) / max(size, 1e-9)
        shown = float(np.linalg.norm(offset)) / camera.scale
        if angle < 0.25 or shown < 0.3:
            continue
        for rank, distance in enumerate(_DISTANCES):
            moved = measured + distance * extent * offset
            points = np.linspace(moved[0], moved[1], 15)
            penalty = room.crowding(points, 11.0) + 0.6 * rank + 3.0 * room.covered(points)
            for start, end in zip(measured, moved, strict=True):
                # Near the piece, the witness lines are hidden, so check only their outer part.
                witness = np.linspace(start, end, 12)
                penalty += 0.3 * room.crowding(witness[8:], 4.0) + 3.0 * room.covered(witness)
            penalty += 4.0 * max(0.0, _PLAIN_ANGLE - angle) + 1.5 * max(0.0, 0.7 - shown)
            # Of two equal sides, prefer the one farther from the middle, where the arm is.
            middle = moved.mean(axis=0)
            penalty -= 0.0005 * float(np.linalg.norm(middle))
            yield _Line(moved, measured, penalty)


def _beside(line: _Line, label: Label) -> Iterator[Numbers]:
    # First on the side away from the piece.
    flat = line.ends[1] - line.ends[0]
    flat = flat / max(float(np.linalg.norm(flat)), 1e-9)
    aside = np.array([-flat[1], flat[0]])
    away = line.ends.mean(axis=0) - line.measured.mean(axis=0)
    if aside @ away < 0:
        aside = -aside
    room = Rectangle.of(label, 0.0, 0.0)
    near = abs(aside[0]) * room.half_width + abs(aside[1]) * room.half_height + 7.5
    for step in (0.5, 0.35, 0.65):
        for side in (near, -near):
            point = line.ends[0] + step * (line.ends[1] - line.ends[0])
            yield point + side * aside


def _witness(measured: Numbers, end: Numbers) -> str:
    # From the piece to slightly beyond its dimension line.
    step = end - measured
    size = max(float(np.linalg.norm(step)), 1e-9)
    return polyline(np.array([measured + 5 * step / size, end + 4 * step / size]), "witness")


def _drawn(line: _Line) -> Iterator[str]:
    flat = line.ends[1] - line.ends[0]
    size = max(float(np.linalg.norm(flat)), 1e-9)
    flat = flat / size
    if size >= _SHORT:
        yield polyline(line.ends, "dimension")
        yield arrowhead(line.ends[1], flat, "dimension-head")
        yield arrowhead(line.ends[0], -flat, "dimension-head")
    else:
        tails = np.array([line.ends[0] - 16 * flat, line.ends[1] + 16 * flat])
        yield polyline(tails, "dimension")
        yield arrowhead(line.ends[0], flat, "dimension-head")
        yield arrowhead(line.ends[1], -flat, "dimension-head")


def arrowhead(tip: Numbers, direction: Numbers, kind: str, size: float = _HEAD) -> str:
    """Return the SVG of an arrowhead that points along the unit vector ``direction``."""
    aside = np.array([-direction[1], direction[0]])
    back = tip - size * direction
    points = np.array([tip, back + 0.36 * size * aside, back - 0.36 * size * aside])
    return f'<polygon class="{kind}" points="{points_text(points)}"/>'
