"""The sheet that a figure is drawn on: its layers, its labels' room, and the SVG."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import chain
from xml.sax.saxutils import escape

import numpy as np

from service.figures.drawing.placing import TakenRoom
from service.figures.drawing.solids import Camera, numbers
from service.figures.drawing.style import Theme, style_sheet
from service.figures.geometry.view import View
from service.kinematics.transforms import Numbers

# The room for the mechanism in pixels: its width, height and longest distance. Lengths and names
# are drawn around it.
PHONE_ROOM = (300.0, 330.0, 400.0)
LARGE_ROOM = (460.0, 430.0, 540.0)
# The room for a whole figure on a phone, which shows it almost as large, so that it is legible.
_WIDEST, _HIGHEST = 352.0, 404.0
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
        over = np.array(self._box[2:]) - [_WIDEST, _HIGHEST]
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
