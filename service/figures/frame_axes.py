"""The frames of a table in a figure: x red, y green, z blue, with their names. For tutors."""

from collections.abc import Sequence

import numpy as np

from service.figures.dimensions import arrowhead
from service.figures.names import SIZE, list_label
from service.figures.placing import TakenRoom, around
from service.figures.solids import Camera, polyline
from service.kinematics.transforms import Matrices, Numbers

_SAME = 1e-6
_HEAD = 8.0


def frame_axes(
    camera: Camera, frames: Matrices, labels: Sequence[str], length: float, room: TakenRoom
) -> list[str]:
    """The SVG of the axes of frames ``(frames, 4, 4)``, as long as ``length``; their room is taken.

    Axes that coincide are drawn once, with all their names.
    """
    found: list[tuple[Numbers, Numbers, str, list[str]]] = []
    for frame, label in zip(frames, labels, strict=True):
        for i, axis in enumerate("xyz"):
            origin, direction = frame[:3, 3], frame[:3, i]
            for known_origin, known_direction, _, names in found:
                apart = np.abs([known_origin - origin, (known_direction - direction) * length])
                if apart.max() < _SAME * length:
                    names.append(f"{axis}{label}")
                    break
            else:
                found.append((origin, direction, axis, [f"{axis}{label}"]))
    drawn: list[str] = []
    tips = []
    for origin, direction, axis, names in found:
        line = camera.seen(np.array([origin, origin + length * direction]))
        room.take_line(line, 2.0)
        tips.append((line[1], axis, names))
        drawn.append(polyline(line, f"frame frame-{axis}"))
        step = line[1] - line[0]
        size = float(np.linalg.norm(step))
        if size > _HEAD:
            tip = line[1] + 0.5 * _HEAD * step / size
            drawn.append(arrowhead(tip, step / size, f"head-{axis}", _HEAD))
    for tip, axis, names in tips:
        place = room.place(list_label(names), around(tip, 0.9 * SIZE))
        drawn.append(list_label(names).svg(place.x, place.y, f"name-{axis}"))
    return drawn
