"""Draw frames with the names of their axes: x red, y green, z blue."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from service.figures.drawing.dimensions import arrowhead
from service.figures.drawing.names import SIZE, Label, frame_label, list_label
from service.figures.drawing.placing import Rectangle, TakenRoom, around
from service.figures.drawing.solids import Camera, numbers, polyline
from service.kinematics.transforms import Matrices, Numbers

_SAME = 1e-6
_HEAD = 8.0


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
