"""Draw the frames of a table with the names of their axes: x red, y green, z blue. For tutors."""

from collections.abc import Sequence

import numpy as np

from service.figures.drawing.dimensions import arrowhead
from service.figures.drawing.names import SIZE, Label, list_label
from service.figures.drawing.placing import Rectangle, TakenRoom, around
from service.figures.drawing.solids import Camera, polyline
from service.kinematics.transforms import Matrices, Numbers

_SAME = 1e-6
_HEAD = 8.0


def frame_axes(
    camera: Camera, frames: Matrices, labels: Sequence[str], length: float, room: TakenRoom
) -> list[str]:
    """Return the SVG of the axes of frames ``(frames, 4, 4)``, and mark their room as taken.

    Each axis is as long as ``length``. Coincident axes are drawn once, with all their names.
    """
    origins = np.repeat(frames[:, :3, 3], 3, axis=0)
    steps = length * np.swapaxes(frames[:, :3, :3], 1, 2).reshape(-1, 3)
    both = np.hstack([origins, steps])
    same = np.abs(both[:, None] - both).max(axis=-1) < _SAME * length
    found: dict[int, list[str]] = {}
    for k in range(len(both)):
        name = f"{'xyz'[k % 3]}{labels[k // 3]}"
        known = next((each for each in found if same[k, each]), k)
        found.setdefault(known, []).append(name)
    drawn: list[str] = []
    tips = []
    for k, names in found.items():
        axis = "xyz"[k % 3]
        line = camera.seen(np.array([origins[k], origins[k] + steps[k]]))
        room.take_line(line, 2.0)
        drawn.append(polyline(line, f"frame frame-{axis}"))
        step = line[1] - line[0]
        size = float(np.linalg.norm(step))
        ahead = step / max(size, _SAME)
        if size > _HEAD:
            tip = line[1] + 0.5 * _HEAD * ahead
            drawn.append(arrowhead(tip, ahead, f"head-{axis}", _HEAD))
        tips.append((line[1], ahead, axis, list_label(names)))
    for tip, ahead, axis, label in tips:
        place = room.place(label, [_beyond(tip, ahead, label), *around(tip, 0.9 * SIZE)])
        drawn.append(label.svg(place.x, place.y, f"name-{axis}"))
    return drawn


def _beyond(tip: Numbers, ahead: Numbers, label: Label) -> Numbers:
    """Return the place for a label right in front of an arrow's tip."""
    room = Rectangle.of(label, 0.0, 0.0)
    near = abs(ahead[0]) * room.half_width + abs(ahead[1]) * room.half_height + 0.7 * _HEAD
    return np.asarray(tip + near * ahead)
