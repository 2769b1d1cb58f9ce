"""Draw on a sheet: a mechanism, frames, dimension lines, and labels that find room.

What is drawn is computed in ``mechanism.py`` and ``table_figure.py``.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from itertools import chain, pairwise
from typing import Final, NamedTuple
from xml.sax.saxutils import escape

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from dh_grader.expressions.characters import LETTERS
from dh_grader.expressions.printing import stem_and_index
from dh_grader.figures.mechanism import (
    GRIPPER_LENGTH,
    JOINT_LENGTH,
    JOINT_RADIUS,
    Configuration,
    MovableMechanism,
    View,
)
from dh_grader.figures.solids import (
    Camera,
    Solid,
    back_to_front,
    box,
    cylinder,
    gripper,
    ground,
    numbers,
    perpendicular,
    points_text,
    polyline,
    rod,
)
from dh_grader.kinematics import Matrices, Numbers
from dh_grader.regex import regex

# --- The light and dark colours of figures, as style sheets inside the SVG


class Theme(StrEnum):
    """The colours of a figure: light, dark, or those of the reader's system. Printed: light."""

    AUTO = "auto"
    LIGHT = "light"
    DARK = "dark"


_LIGHT: Final = {
    "paper": "#ffffff", "ink": "#1c2430", "rod": "#d5dae1", "turning": "#7fb0e6",
    "turning-light": "#e9f3fd", "cap": "#d3e6f9", "side0": "#fbe9c6", "side1": "#f3d596",
    "side2": "#e2b964", "ground": "#eef0f3", "soft": "#5d6877", "axis": "#7b8696",
    "motion": "#7a2fb0", "chain": "#8e44ad", "x": "#c62828", "y": "#1f7a34", "z": "#1d4fc4",
}  # fmt: skip
_DARK: Final = {
    "paper": "#12161d", "ink": "#e8ecf2", "rod": "#465061", "turning": "#2f5f96",
    "turning-light": "#6da3dd", "cap": "#4a7fb9", "side0": "#c99a44", "side1": "#a67c31",
    "side2": "#7f5e22", "ground": "#232a35", "soft": "#a7b2c2", "axis": "#8b97a8",
    "motion": "#d8a5ff", "chain": "#d19cf0", "x": "#ff8080", "y": "#6fd68a", "z": "#8ab4ff",
}  # fmt: skip
_SHAPES: Final = """\
text{font:italic 17px "STIX Two Text","Latin Modern Roman",Cambria,Georgia,"Times New Roman",serif;\
text-anchor:middle;stroke-width:4px;stroke-linejoin:round;paint-order:stroke}
.number{font-size:13.3px}
.index{font-size:13.3px;font-style:normal}
.sign{font-style:normal}
polyline{fill:none}
.rim,.rod{stroke-linejoin:round}
.turning,.cap,.sliding,.ground{stroke-width:1.3px;stroke-linejoin:round}
.hatch{stroke-width:1.1px}
.edge{stroke-width:2px}
.grip-rim,.grip{stroke-linecap:round;stroke-linejoin:round}
.axis{stroke-width:1px;stroke-dasharray:11 3 2 3}
.witness{stroke-width:.7px}
.leader{stroke-width:.8px}
.dimension{stroke-width:.9px}
.motion{stroke-width:1.7px}
.motion-halo{stroke-width:4px}
.frame{stroke-width:2.2px}
.frame-halo{stroke-width:4.4px}
.origin{stroke-width:1.4px}
.chain{stroke-width:2.6px;stroke-linejoin:round;stroke-linecap:round}
"""


def style_sheet(theme: Theme) -> str:
    """Return the style sheet of a figure."""
    if theme is Theme.DARK:
        return _SHAPES + _colours(_DARK) + _only("print", _LIGHT)
    if theme is Theme.LIGHT:
        return _SHAPES + _colours(_LIGHT)
    dark = _only("screen and (prefers-color-scheme:dark)", _DARK)
    return _SHAPES + _colours(_LIGHT) + dark


def _only(medium: str, palette: Mapping[str, str]) -> str:
    return f"@media {medium}{{\n{_colours(palette)}}}\n"


def _colours(of: Mapping[str, str]) -> str:
    # No CSS variables: some programs ignore them.
    ink, soft, paper = of["ink"], of["soft"], of["paper"]
    rules = {
        ".paper": f"fill:{paper}",
        "text": f"fill:{ink};stroke:{paper}",
        ".rim": f"stroke:{ink}",
        ".rod": f"stroke:{of['rod']}",
        ".turning,.cap,.sliding": f"stroke:{ink}",
        ".cap": f"fill:{of['cap']}",
        ".shade": f"stop-color:{of['turning']}",
        ".light": f"stop-color:{of['turning-light']}",
        ".side0": f"fill:{of['side0']}",
        ".side1": f"fill:{of['side1']}",
        ".side2": f"fill:{of['side2']}",
        ".ground": f"fill:{of['ground']};stroke:{soft}",
        ".hatch": f"stroke:{soft}",
        ".edge": f"stroke:{ink}",
        ".grip-rim": f"stroke:{ink}",
        ".grip": f"stroke:{of['rod']}",
        ".point": f"fill:{ink}",
        ".axis": f"stroke:{of['axis']}",
        ".witness,.dimension,.leader": f"stroke:{soft}",
        ".dimension-head": f"fill:{soft}",
        ".motion": f"stroke:{of['motion']}",
        ".chain": f"stroke:{of['chain']}",
        ".motion-halo,.frame-halo": f"stroke:{paper}",
        ".origin": f"fill:{ink};stroke:{paper}",
        ".motion-head,.variable": f"fill:{of['motion']}",
    }
    for axis in "xyz":
        rules[f".frame-{axis}"] = f"stroke:{of[axis]}"
        rules[f".head-{axis},.name-{axis}"] = f"fill:{of[axis]}"
    return "".join(f"{chosen}{{{rule}}}\n" for chosen, rule in rules.items())


# --- Labels for names of symbols: θ with index 1 for theta1, and the room that a label needs


# The font size in pixels; the size of an index as a share of it, and how much it is lowered.
SIZE: Final = 17.0
_INDEX: Final = 0.78
_DROP: Final = 0.24

# Widths of italic letters in serif fonts, as shares of the font size; other characters are widest.
_WIDTHS: Final = {
    **dict.fromkeys("ijlt1,. ", 0.34),
    **dict.fromkeys("{}", 0.5),
    **dict.fromkeys("acdeghknopqrsuvxyzbfθφψαβγδω023456789", 0.56),
    **dict.fromkeys("+−=", 0.72),
}
_WIDEST: Final = 0.86
# Signs, numbers and names of frames are upright.
_UPRIGHT: Final = regex(r"[ +,]*|[0-9.]+|\{.*")


@dataclass(frozen=True, slots=True)
class Label:
    """A text of pairs (stem, index). The index of a sign is empty: ``(("θ", "1"), ("+", ""))``."""

    runs: tuple[tuple[str, str], ...]

    @property
    def size(self) -> float:
        """The font size in pixels. Numbers, which are long, are as small as an index."""
        return SIZE * (_INDEX if self.runs[0][0][0].isdigit() else 1.0)

    @property
    def text(self) -> str:
        """The plain text, such as θ1 + d2."""
        return "".join(stem + index for stem, index in self.runs)

    @property
    def width(self) -> float:
        """An estimate of the label's width in pixels, rather too large than too small."""
        return self.size * sum(_width(stem) + _INDEX * _width(index) for stem, index in self.runs)

    def svg(self, x: float, y: float, kind: str) -> str:
        """Return the SVG text centred at the point (x, y), with the class ``kind``."""
        parts, lowered = [], False
        for stem, index in self.runs:
            back = f' dy="{-_DROP * SIZE:.1f}"' if lowered else ""
            style = ' class="sign"' if _UPRIGHT.fullmatch(stem) else ""
            parts.append(f"<tspan{style}{back}>{escape(stem)}</tspan>")
            lowered = bool(index)
            if index:
                parts.append(
                    f'<tspan class="index" dy="{_DROP * SIZE:.1f}">{escape(index)}</tspan>'
                )
        middle = y + 0.3 * self.size
        kind += " number" if self.size < SIZE else ""
        return f'<text class="{kind}" x="{x:.1f}" y="{middle:.1f}">{"".join(parts)}</text>'


def name_label(name: str) -> Label:
    """Return the label of one symbol."""
    return Label((_run(name),))


def frame_label(labels: Sequence[str]) -> Label:
    """Return the label of frames at one place: {3}, {4}."""
    return Label(((", ".join(f"{{{label}}}" for label in labels), ""),))


def sum_label(names: Sequence[str]) -> Label:
    """Return the label of a sum of symbols."""
    return _joined(map(_run, names), " + ")


def list_label(names: Sequence[str]) -> Label:
    """Return the label of several names for one thing, separated by commas."""
    return _joined(map(_run, names), ", ")


def _joined(runs: Iterable[tuple[str, str]], sign: str) -> Label:
    found: list[tuple[str, str]] = []
    for run in runs:
        found += [(sign, ""), run] if found else [run]
    return Label(tuple(found))


def _run(name: str) -> tuple[str, str]:
    if name[0].isdigit():
        return name, ""
    stem, index = stem_and_index(name)
    return LETTERS.get(stem, stem), index


def _width(text: str) -> float:
    return sum(_WIDTHS.get(character, _WIDEST) for character in text)


# --- Keep track of the taken room in a picture, and find the best place for each label
#
# All lengths are in pixels, x to the right and y down. Placing is deterministic.


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


# --- Arrows that show how a joint moves: around its axis, or along it


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
            yield arrowhead(
                tip + 0.5 * _HEAD * direction,
                direction,
                "motion-head",
                _HEAD,
            )


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


# --- The sheet that a figure is drawn on: its layers, its labels' room, and the SVG


# The room for the mechanism in pixels: its width, height and longest distance. Lengths and names
# are drawn around it.
PHONE_ROOM = (300.0, 330.0, 400.0)
LARGE_ROOM = (460.0, 430.0, 540.0)
# The room for a whole figure on a phone, which shows it almost as large, so that it is legible.
_SHEET_WIDEST, _HIGHEST = 352.0, 404.0
_MARGIN = 6.0


@dataclass(frozen=True, slots=True)
class Caption:
    """A text alternative of a figure. ``name`` is part of ids inside the SVG."""

    name: str
    title: str
    description: str


@dataclass(slots=True)
class Sheet:
    """A figure while it is drawn: the SVG of its layers, and the taken room."""

    camera: Camera
    size: float
    room: TakenRoom = field(default_factory=TakenRoom)
    below: list[str] = field(default_factory=list)
    above: list[str] = field(default_factory=list)
    points: list[Numbers] = field(default_factory=list)

    @property
    def unit(self) -> float:
        """The size of the mechanism's parts, in pixels."""
        return self.size * self.camera.scale

    def take(self, points: Numbers, radius: float, weight: float = 1.0) -> None:
        """Mark the room along a line as taken; the figure will be large enough for the line."""
        self.room.take_line(points, radius, weight)
        self.points += [points - radius, points + radius]

    @property
    def _box(self) -> tuple[float, float, float, float]:
        # Left, top, width, height.
        labels = self.room.labels
        corners = [np.array([[r.x - r.half_width, r.y - r.half_height]]) for r in labels]
        corners += [np.array([[r.x + r.half_width, r.y + r.half_height]]) for r in labels]
        taken = np.concatenate([*self.room.ends, *self.points, *corners])
        low, high = taken.min(axis=0) - _MARGIN, taken.max(axis=0) + _MARGIN
        low = np.floor(low)
        width, height = np.ceil(high - low).tolist()
        return float(low[0]), float(low[1]), width, height

    @property
    def excess(self) -> float:
        """The factor by which the mechanism must shrink to fit on a phone; 1 if the figure fits."""
        # Labels do not shrink with the mechanism.
        drawn = np.ptp(np.concatenate(self.points), axis=0)
        over = np.array(self._box[2:]) - [_SHEET_WIDEST, _HIGHEST]
        factors = 1.01 * drawn / np.maximum(drawn - over, drawn / 2)
        return float(np.where(over > 0, factors, 1.0).max())

    def svg(self, solids: Sequence[str], caption: Caption, theme: Theme) -> str:
        """Return the whole figure, as large as its content; ``solids`` are the middle layer."""
        left, top, width, height = self._box
        body = "\n".join(chain(self.below, solids, self.above))
        return f"""\
<svg xmlns="http://www.w3.org/2000/svg" role="img" aria-labelledby="{caption.name}-title \
{caption.name}-desc" viewBox="{numbers(left, top, width, height)}" \
width="{numbers(width)}" height="{numbers(height)}">
<title id="{caption.name}-title">{escape(caption.title)}</title>
<desc id="{caption.name}-desc">{escape(caption.description)}</desc>
<style>{style_sheet(theme)}</style>
<rect class="paper" x="{numbers(left)}" y="{numbers(top)}" width="{numbers(width)}" \
height="{numbers(height)}"/>
{body}
</svg>
"""


def camera_for(points: Numbers, view: View, room: tuple[float, float, float]) -> Camera:
    """Return the camera whose scale fits all points ``(points, 3)`` into the room."""
    width, height = np.ptp(Camera.of(view, 1.0).seen(points), axis=0)
    longest = float(np.linalg.norm(np.ptp(points, axis=0)))
    wide, high, far = room
    scale = min(wide / max(width, 1e-9), high / max(height, 1e-9), far / longest)
    return Camera.of(view, scale)


# --- Draw a mechanism: ground, links, joints and gripper, from the farthest to the nearest


_BOX_WIDTH = 1.05 * JOINT_RADIUS
_ROD: Final = 0.036
_AXIS_BEYOND: Final = 0.11


def mechanism_solids(
    sheet: Sheet, shown: Configuration, mechanism: MovableMechanism, name: str
) -> list[str]:
    """Return the SVG of the whole mechanism, and mark its room on the sheet as taken."""
    size = sheet.size
    solids = [
        joint_solid(sheet, centre, axis, f"{name}-{i + 1}", slides=joint.prismatic)
        for i, (joint, centre, axis) in enumerate(
            zip(mechanism.joints, shown.centres, shown.axes, strict=True)
        )
    ]
    reach = GRIPPER_LENGTH * size
    for i, corners in enumerate(shown.links):
        line = corners if i + 1 < len(shown.links) else _shortened(corners, reach)
        if len(line) > 1:
            solids.append(link_solid(sheet, line, _clear_of_joints(line, i, shown, mechanism)))
    width = 0.42 * _ROD * sheet.unit
    grip = gripper(sheet.camera, shown.tool, shown.tool_direction, reach, width)
    sheet.take(sheet.camera.seen(grip.spine), grip.radius)
    floor = ground_solid(sheet, shown.base, shown.base_normal)
    return [floor.svg, *(solid.svg for solid in back_to_front(sheet.camera, [*solids, grip]))]


def joint_solid(sheet: Sheet, centre: Numbers, axis: Numbers, fill: str, *, slides: bool) -> Solid:
    """Return the solid of a joint, and draw the joint axis behind it."""
    camera, size = sheet.camera, sheet.size
    half, radius = JOINT_LENGTH / 2 * size, JOINT_RADIUS * size
    ends = centre + np.array([[-1.0], [1.0]]) * (half + _AXIS_BEYOND * size / 2) * axis
    sheet.below.append(polyline(camera.seen(ends), "axis"))
    sheet.take(camera.seen(ends), 1.0, 0.6)
    inner = centre + np.array([[-1.0], [1.0]]) * half * axis
    sheet.take(camera.seen(inner), (1.3 if slides else 1.0) * radius * camera.scale)
    if slides:
        return box(camera, centre, axis, half, _BOX_WIDTH * size)
    return cylinder(camera, centre, axis, half, radius, fill)


def link_solid(sheet: Sheet, line: Numbers, drawn: Numbers) -> Solid:
    """Return the solid of a link with the corners ``drawn``, and mark its room as taken."""
    # The room is along ``line``.
    sheet.take(sheet.camera.seen(line), _ROD * sheet.unit / 2)
    return rod(sheet.camera, drawn, _ROD * sheet.unit)


def ground_solid(sheet: Sheet, base: Numbers, normal: Numbers) -> Solid:
    """Return the solid of the ground under a robot, and mark its room as taken."""
    camera = sheet.camera
    floor = ground(camera, base, normal, 0.13 * sheet.size)
    width = floor.radius * camera.seen(camera.rotation[0]) / camera.scale
    for down in (-0.02, 0.05):
        middle = camera.seen(base - down * sheet.size * normal)
        sheet.take(np.array([middle - width, middle + width]), 0.06 * sheet.unit)
    return floor


def _shortened(corners: Numbers, by: float) -> Numbers:
    line = corners
    while len(line) > 1:
        last = line[-1] - line[-2]
        length = float(np.linalg.norm(last))
        if length > by:
            return np.concatenate([line[:-1], line[-1:] - by / length * last])
        by, line = by - length, line[:-1]
    return line


def _clear_of_joints(
    line: Numbers, link: int, shown: Configuration, mechanism: MovableMechanism
) -> Numbers:
    # Between the surfaces of the joints at the link's two ends.
    first, last = line[0], line[-1]
    if link > 0:
        first = _surface(line[0], line[1], shown, link - 1, mechanism)
    if link < len(mechanism.joints):
        last = _surface(line[-1], line[-2], shown, link, mechanism)
    return np.concatenate([first[None], line[1:-1], last[None]])


def _surface(
    start: Numbers, towards: Numbers, shown: Configuration, joint: int, mechanism: MovableMechanism
) -> Numbers:
    # Slightly inside a joint, where a line from the joint's middle leaves it.
    step = towards - start
    length = float(np.linalg.norm(step))
    if length == 0:  # two joints in one place, where a short wrist has no room for both
        return start
    direction = step / length
    along = abs(float(direction @ shown.axes[joint]))
    across = float(np.sqrt(max(1.0 - along**2, 0.0)))
    radius = _BOX_WIDTH if mechanism.joints[joint].prismatic else JOINT_RADIUS
    inside = min(JOINT_LENGTH / 2 / max(along, 1e-9), 0.9 * radius / max(across, 1e-9))
    return np.asarray(start + min(inside * mechanism.size, 0.5 * length) * direction)


# --- Draw frames with the names of their axes: x red, y green, z blue


_SAME = 1e-6


@dataclass(frozen=True, slots=True)
class DrawnFrames:
    """Frames ``(frames, 4, 4)``, their indices, and the letters of the axes to draw for each frame.

    If ``braces`` is set, each origin has its frame's name, such as {0}.
    """

    poses: Matrices
    labels: Sequence[str]
    axes: Sequence[str]
    braces: bool = False


@dataclass(slots=True)
class _Axis:
    # An axis in the picture, with the names of coincident axes.
    line: Numbers
    letter: str
    names: list[str]

    @property
    def ahead(self) -> Numbers:
        step = self.line[1] - self.line[0]
        return np.asarray(step / max(float(np.linalg.norm(step)), _SAME))


def frame_axes(camera: Camera, drawn: DrawnFrames, length: float, room: TakenRoom) -> list[str]:
    """Return the SVG of the axes of frames, and mark their room as taken.

    Each axis is as long as ``length``. Coincident axes are drawn once, with all their names.
    """
    axes = _axes(camera, drawn, length)
    svg: list[str] = []
    for axis in axes:
        room.take_line(axis.line, 2.5)
        svg.append(polyline(axis.line, "frame-halo"))
    for axis in axes:
        svg.append(polyline(axis.line, f"frame frame-{axis.letter}"))
        if float(np.linalg.norm(axis.line[1] - axis.line[0])) > _HEAD:
            tip = axis.line[1] + 0.5 * _HEAD * axis.ahead
            svg.append(arrowhead(tip, axis.ahead, f"head-{axis.letter}", _HEAD))
    for axis in axes:
        label, tip = list_label(axis.names), axis.line[1]
        wanted = [_beyond(tip, axis.ahead, label), *around(tip, 0.9 * SIZE)]
        svg += named(label, wanted, axis.line[1:], f"name-{axis.letter}", room)
    return svg


def frame_names(camera: Camera, drawn: DrawnFrames, room: TakenRoom) -> list[str]:
    """Return the SVG of the origins of frames with their names: {0}."""
    svg: list[str] = []
    if not drawn.braces:
        return svg
    together: list[tuple[Numbers, list[str]]] = []
    for pose, label in zip(drawn.poses, drawn.labels, strict=True):
        at = camera.seen(pose[:3, 3])
        known = next((each for point, each in together if np.linalg.norm(point - at) < 0.5), None)
        if known is None:
            together.append((at, [label]))
        else:
            known.append(label)
    for at, labels in together:
        x, y = at
        svg.append(f'<circle class="origin" cx="{numbers(x)}" cy="{numbers(y)}" r="3"/>')
        name = frame_label(labels)
        svg += named(name, around(at, 1.15 * SIZE), at[None], "frame-name", room)
    return svg


def named(
    label: Label, wanted: Sequence[Numbers], points: Numbers, kind: str, room: TakenRoom
) -> Iterator[str]:
    """Yield the SVG of a label, and of a line from the label to distant ``points``."""
    place = room.place(label, wanted, points)
    leader = place.leader(points)
    if leader is not None:
        room.take_line(leader, 1.0, 0.6)
        yield polyline(leader, "leader")
    yield label.svg(place.x, place.y, kind)


def _axes(camera: Camera, drawn: DrawnFrames, length: float) -> list[_Axis]:
    # Coincident axes are drawn as z or x rather than as y.
    found: list[tuple[Numbers, _Axis]] = []
    for letter in "zxy":
        for pose, label, letters in zip(drawn.poses, drawn.labels, drawn.axes, strict=True):
            if letter not in letters:
                continue
            step = length * pose[:3, "xyz".index(letter)]
            place = np.concatenate([pose[:3, 3], step])
            name = f"{letter}{label}" if label.isdigit() else f"{letter}_{label}"
            same = (axis for at, axis in found if np.abs(at - place).max() < _SAME * length)
            known = next(same, None)
            if known is None:
                line = camera.seen(np.array([pose[:3, 3], pose[:3, 3] + step]))
                found.append((place, _Axis(line, letter, [name])))
            else:
                known.names.append(name)
    return [axis for _, axis in found]


def _beyond(tip: Numbers, ahead: Numbers, label: Label) -> Numbers:
    # Right in front of an arrow's tip.
    room = Rectangle.of(label, 0.0, 0.0)
    near = abs(ahead[0]) * room.half_width + abs(ahead[1]) * room.half_height + 0.7 * _HEAD
    return np.asarray(tip + near * ahead)


# --- Dimension lines: a line next to a piece of the mechanism, with the name of its length


# The possible distances of a dimension line from its piece, as shares of the mechanism's extent.
_DISTANCES = (0.12, 0.16, 0.21, 0.27, 0.34, 0.42)
_SMALL_HEAD = 7.0
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


def arrowhead(tip: Numbers, direction: Numbers, kind: str, size: float = _SMALL_HEAD) -> str:
    """Return the SVG of an arrowhead that points along the unit vector ``direction``."""
    aside = np.array([-direction[1], direction[0]])
    back = tip - size * direction
    points = np.array([tip, back + 0.36 * size * aside, back - 0.36 * size * aside])
    return f'<polygon class="{kind}" points="{points_text(points)}"/>'
