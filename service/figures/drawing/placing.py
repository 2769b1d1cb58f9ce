"""Keep track of the taken room in a picture, and find the best place for each label.

All lengths are in pixels, x to the right and y down. Placing is deterministic.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from service.figures.drawing.names import SIZE, Label
from service.kinematics.transforms import Numbers

# A label farther than this from what it names gets a line that leads there.
_NEXT_TO = 16.0
# The minimum gap between two labels.
_APART = 3.0
# Half the height of a label: letters with their indices.
HALF_HEIGHT = 0.56 * SIZE
_TURNS = np.radians([-35, 35, 145, -145, 0, 180, 90, -90, 65, -65, 115, -115])
# Points spread over a rectangle from -1 to 1.
_SPREAD = np.array([(x, y) for y in (-1.0, 0.0, 1.0) for x in (-1.0, -0.5, 0.0, 0.5, 1.0)])
# Places around a point; labels are wider than high.
_AROUND = np.stack([1.25 * np.cos(_TURNS), np.sin(_TURNS)], axis=-1)


@dataclass(frozen=True, slots=True)
class Rectangle:
    """The room of a label: its centre, half its width and half its height."""

    x: float
    y: float
    half_width: float
    half_height: float

    @classmethod
    def of(cls, label: Label, x: float, y: float) -> "Rectangle":
        """Return the room of a label centred at the point (x, y)."""
        return cls(x, y, label.width / 2 + 1, HALF_HEIGHT * label.size / SIZE)

    def overlaps(self, other: "Rectangle", apart: float = 0.0) -> bool:
        """True if two rectangles overlap, or if the gap between them is less than ``apart``."""
        across = self.half_width + other.half_width + apart
        upright = self.half_height + other.half_height + apart
        return abs(self.x - other.x) < across and abs(self.y - other.y) < upright

    def leader(self, points: Numbers) -> Numbers | None:
        """Return the line ``(2, 2)`` from the nearest of ``points`` to the label.

        Return None if the label is next to that point.
        """
        half, centre = (self.half_width, self.half_height), np.array([self.x, self.y])
        near = np.clip(points, centre - half, centre + half)
        gaps = np.linalg.norm(near - points, axis=1)
        k = int(gaps.argmin())
        return np.array([points[k], near[k]]) if gaps[k] > _NEXT_TO else None

    def holds_any(self, points: Numbers) -> bool:
        """True if the rectangle contains one of the points ``(points, 2)``."""
        offset = np.abs(points - (self.x, self.y))
        return bool((offset < (self.half_width, self.half_height)).all(axis=1).any())

    @property
    def points(self) -> Numbers:
        """Fifteen pixel positions, spread over the rectangle, ``(15, 2)``."""
        return np.asarray(_SPREAD * (self.half_width, self.half_height) + (self.x, self.y))


class _Strokes(NamedTuple):
    # ``low`` and ``high`` are the corners of the rectangle around each stroke.
    starts: Numbers
    ends: Numbers
    radii: Numbers
    weights: Numbers
    steps: Numbers
    squares: Numbers
    low: Numbers
    high: Numbers

    @classmethod
    def of(cls, starts: Numbers, ends: Numbers, radii: Numbers, weights: Numbers) -> "_Strokes":
        steps = ends - starts
        squares = np.maximum((steps**2).sum(axis=1), 1e-12)
        low = np.minimum(starts, ends) - radii[:, None]
        high = np.maximum(starts, ends) + radii[:, None]
        return cls(starts, ends, radii, weights, steps, squares, low, high)

    def near(self, points: Numbers, clearance: float) -> "_Strokes":
        low, high = points.min(axis=0) - clearance, points.max(axis=0) + clearance
        near = ((self.low <= high) & (self.high >= low)).all(axis=1)
        return _Strokes(*(each[near] for each in self))


@dataclass(slots=True)
class TakenRoom:
    """The taken room in a picture: strokes (lines with a width) and the rectangles of labels.

    With ``hasty``, labels avoid only each other.
    """

    # Avoiding strokes, too, would be most of the work. A stroke has a radius and a weight.
    hasty: bool = False
    _starts: list[Numbers] = field(default_factory=list)
    _ends: list[Numbers] = field(default_factory=list)
    _radii: list[float] = field(default_factory=list)
    _weights: list[float] = field(default_factory=list)
    labels: list[Rectangle] = field(default_factory=list)
    _arrays: "_Strokes | None" = None

    def take_line(self, points: Numbers, radius: float, weight: float = 1.0) -> None:
        """Mark the room along a line ``(points, 2)`` as taken."""
        for start, end in pairwise(points):
            self._starts.append(start)
            self._ends.append(end)
            self._radii.append(radius)
            self._weights.append(weight)
        self._arrays = None

    def _strokes(self) -> "_Strokes":
        if self._arrays is None:
            lists = (self._starts, self._ends, self._radii, self._weights)
            self._arrays = _Strokes.of(*map(np.array, lists))
        return self._arrays

    @property
    def ends(self) -> list[Numbers]:
        """The ends of all strokes."""
        return [np.array([start, end]) for start, end in zip(self._starts, self._ends, strict=True)]

    def crowding(self, points: Numbers, clearance: float) -> float:
        """Return how crowded the points ``(points, 2)`` are; 0 if no stroke is near."""
        if not self._starts:
            return 0.0
        near = self._strokes().near(points, clearance)
        if not len(near.starts):
            return 0.0
        offset = points[:, None] - near.starts
        share = np.clip((offset * near.steps).sum(axis=-1) / near.squares, 0.0, 1.0)
        distance = np.linalg.norm(offset - share[..., None] * near.steps, axis=-1)
        lacking = np.clip(1 - (distance - near.radii) / clearance, 0.0, 1.5)
        return float((lacking * near.weights).max(axis=1).sum())

    def covered(self, line: Numbers) -> int:
        """Count the labels that a line ``(points, 2)`` would cover."""
        (left, top), (right, bottom) = line.min(axis=0), line.max(axis=0)
        return sum(
            label.holds_any(line)
            for label in self.labels
            if left - label.half_width < label.x < right + label.half_width
            and top - label.half_height < label.y < bottom + label.half_height
        )

    def crossings(self, line: Numbers) -> int:
        """Count the labels and the main strokes that a line ``(points, 2)`` crosses."""
        # Main strokes have at least the weight 1.
        written = self.covered(line)
        if not self._starts:
            return written
        strokes = self._strokes()
        starts, ends, weights = strokes.starts, strokes.ends, strokes.weights
        first, last = line[0], line[-1]
        # Two segments cross if each has its ends on both sides of the other.
        parted = _turn(first, last, starts) * _turn(first, last, ends) < 0
        parting = _turn(starts, ends, first) * _turn(starts, ends, last) < 0
        return written + int((parted & parting & (weights >= 1)).sum())

    def place(
        self, label: Label, wanted: Iterable[Numbers], named: Numbers | None = None
    ) -> Rectangle:
        """Return the best free place for a label, and mark it as taken.

        Earlier points in ``wanted`` are better. ``named`` are the points that the label names.
        """
        # The place never overlaps another label: if all wanted places overlap labels, the label is
        # placed farther away. Places far from ``named`` are worse, because they need a line to
        # these points, especially if this line covers other labels.
        best: tuple[float, Rectangle] | None = None
        size = Rectangle.of(label, 0.0, 0.0)
        for rank, point in enumerate(_farther(list(wanted))):
            if best is not None and best[0] <= 0.08 * rank:
                break
            place = replace(size, x=float(point[0]), y=float(point[1]))
            if any(place.overlaps(other, _APART) for other in self.labels):
                continue
            penalty = 0.08 * rank + (0.0 if self.hasty else self.crowding(place.points, 5.0))
            if best is not None and penalty >= best[0]:
                continue
            leader = None if named is None or self.hasty else place.leader(named)
            if leader is not None:
                penalty += 0.5 + 4.0 * self.covered(np.linspace(leader[0], leader[1], 12))
            if best is None or penalty < best[0]:
                best = (penalty, place)
        assert best is not None
        self.labels.append(best[1])
        return best[1]


def _turn(start: Numbers, end: Numbers, point: Numbers) -> Numbers:
    # Positive for points left of the line, and negative right of it.
    (x, y), (u, v) = (end - start).T, (point - start).T
    return np.asarray(x * v - y * u)


def around(point: Numbers, near: float) -> list[Numbers]:
    """Return points around a point, the nearest first."""
    return [*np.concatenate([point + near * growth * _AROUND for growth in (1.0, 1.3, 1.7, 2.2)])]


def _farther(wanted: list[Numbers]) -> Iterator[Numbers]:
    yield from wanted
    for i in range(2, 60):
        yield from around(wanted[0], 12.0 * i)[:12]
