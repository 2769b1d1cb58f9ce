"""The pictures of the four DH parameters: two frames, and the lengths and angles between them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Final

import numpy as np

from service.figures.drawing.dimensions import arrowhead
from service.figures.drawing.motion_arrows import MotionArrow
from service.figures.drawing.names import Label
from service.figures.drawing.placing import around
from service.figures.drawing.sheet import Caption, Sheet
from service.figures.drawing.solids import Camera, polyline
from service.figures.drawing.style import Theme
from service.figures.geometry.view import View
from service.grading.report import RuleName
from service.hints.rules import RULES
from service.kinematics.dh import Convention
from service.kinematics.transforms import Numbers
from service.translations import ENGLISH, Language, told

# The drawn parameters; pixels for each unit of length.
_LENGTH, _TWIST, _OFFSET, _ANGLE = 1.6, np.radians(40), 1.0, np.radians(55)
_SCALE: Final = 92.0
_ARROW: Final = 0.85
_VIEW: Final = View(-62.0, 22.0)
_SYMBOLS: Final = {"a": "a", "alpha": "α", "d": "d", "theta": "θ"}


@dataclass(frozen=True, slots=True)
class _Scene:
    # Two frames, the corner of the path between them, and the indices of the parameters.
    # The columns of ``before`` and ``after`` are x, z and the origin. The path has two straight
    # pieces, a and d, which meet at the corner.
    before: Numbers
    after: Numbers
    corner: Numbers
    indices: dict[str, str]

    @property
    def x(self) -> Numbers:
        """The x axis, along which a is measured, and about which α is measured."""
        return (self.after if self.is_standard else self.before)[:, 0]

    @property
    def is_standard(self) -> bool:
        return self.indices["a"] == "i"

    def length(self, name: str) -> Numbers:
        """Return the two end points of the length a or d, as an array ``(2, 3)``."""
        ends = [self.before[:, 2], self.corner, self.after[:, 2]]
        first = (name == "d") == self.is_standard
        return np.array(ends[:2] if first else ends[1:])

    def angle(self, name: str) -> tuple[Numbers, Numbers, Numbers, Numbers]:
        """Return the arc of the angle α or θ: centre, axis, first direction and last direction."""
        column = 0 if name == "theta" else 1
        axis = (
            self.x if name == "alpha" else (self.before if self.is_standard else self.after)[:, 1]
        )
        centre = self.corner
        if name == "alpha" and self.is_standard:
            centre = self.after[:, 2]
        return centre, axis, self.before[:, column], self.after[:, column]


@cache
def rule_picture(
    name: RuleName, convention: Convention, theme: Theme, language: Language = ENGLISH
) -> str:
    """Return the picture of a rule as SVG, with a text alternative.

    Raises KeyError if the rule has no picture.
    """
    rule = RULES[name]
    if not rule.pictured:
        raise KeyError(name)
    scene = _scene(convention)
    camera = Camera.of(_VIEW, _SCALE)
    sheet = Sheet(camera, 1.0)
    _axes(sheet, scene)
    for parameter in rule.pictured:
        _parameter(sheet, scene, parameter)
    _names(sheet, scene, rule.pictured)
    title, description = (
        told(text, language.translation) for text in (rule.title, rule.stated(convention))
    )
    caption = Caption(f"rule-{name}", title, description)
    return sheet.svg((), caption, theme)


def _scene(convention: Convention) -> _Scene:
    x, z, origin = np.eye(3)[0], np.eye(3)[2], np.zeros(3)
    before = np.stack([x, z, origin], axis=1)
    if convention is Convention.STANDARD:
        corner = _OFFSET * z
        x_after = _turned(x, z, _ANGLE)
        z_after = _turned(z, x_after, _TWIST)
        end = corner + _LENGTH * x_after
        indices = dict.fromkeys(_SYMBOLS, "i")
    else:
        corner = _LENGTH * x
        z_after = _turned(z, x, _TWIST)
        x_after = _turned(x, z_after, _ANGLE)
        end = corner + _OFFSET * z_after
        indices = {"a": "i−1", "alpha": "i−1", "d": "i", "theta": "i"}
    return _Scene(before, np.stack([x_after, z_after, end], axis=1), corner, indices)


def _turned(vector: Numbers, axis: Numbers, angle: float | Numbers) -> Numbers:
    across = np.cross(axis, vector)
    return np.asarray(
        np.multiply.outer(np.cos(angle), vector) + np.multiply.outer(np.sin(angle), across)
    )


def _axes(sheet: Sheet, scene: _Scene) -> None:
    for frame in (scene.before, scene.after):
        ends = np.array([scene.corner, frame[:, 2]])
        along = (ends - frame[:, 2]) @ frame[:, 1]
        reach = np.array([[along.min() - 0.5], [along.max() + 1.25]])
        line = sheet.camera.seen(frame[:, 2] + reach * frame[:, 1])
        sheet.take(line, 1.0, 0.5)
        sheet.below.append(polyline(line, "axis"))
    way = sheet.camera.seen(np.array([scene.before[:, 2], scene.corner, scene.after[:, 2]]))
    sheet.below.append(polyline(way, "dimension"))
    for frame in (scene.before, scene.after):
        for letter, column in (("z", 1), ("x", 0)):
            line = _arrow(sheet.camera, frame, column)
            sheet.take(line, 2.5)
            sheet.below += [polyline(line, f"frame frame-{letter}"), _head(line, f"head-{letter}")]


def _arrow(camera: Camera, frame: Numbers, column: int) -> Numbers:
    return camera.seen(np.array([frame[:, 2], frame[:, 2] + _ARROW * frame[:, column]]))


def _head(line: Numbers, kind: str) -> str:
    ahead = (line[1] - line[0]) / np.linalg.norm(line[1] - line[0])
    return arrowhead(line[1] + 4 * ahead, ahead, kind, 8.0)


def _parameter(sheet: Sheet, scene: _Scene, name: str) -> None:
    if name in ("a", "d"):
        first, last = scene.length(name)
        line = sheet.camera.seen(np.linspace(first, last, 9))
    else:
        centre, axis, first, last = scene.angle(name)
        size = _ANGLE if name == "theta" else _TWIST
        radius = 0.62 if name == "theta" else 0.7
        line = sheet.camera.seen(centre + radius * _turned(first, axis, np.linspace(0, size, 24)))
        for direction in (first, last):
            leg = sheet.camera.seen(np.array([centre, centre + 1.15 * radius * direction]))
            sheet.take(leg, 1.0, 0.4)
            sheet.below.append(polyline(leg, "witness"))
    sheet.take(line, 3.0)
    sheet.above += MotionArrow(line, both=False).svg()


def _names(sheet: Sheet, scene: _Scene, pictured: Sequence[str]) -> None:
    for name, kind, wanted, line in _labels(sheet.camera, scene, pictured):
        place = sheet.room.place(name, wanted, line)
        sheet.above.append(name.svg(place.x, place.y, kind))


def _labels(
    camera: Camera, scene: _Scene, pictured: Sequence[str]
) -> Iterator[tuple[Label, str, list[Numbers], Numbers]]:
    for frame, index in ((scene.before, "i−1"), (scene.after, "i")):
        for letter, column in (("z", 1), ("x", 0)):
            line = _arrow(camera, frame, column)
            label = Label(((letter, index),))
            yield label, f"name-{letter}", list(around(line[1], 17.0)), line[1:]
    for name in pictured:
        if name in ("a", "d"):
            middle = camera.seen(scene.length(name).mean(axis=0))
        else:
            centre, axis, first, _ = scene.angle(name)
            half = (_ANGLE if name == "theta" else _TWIST) / 2
            middle = camera.seen(centre + 0.85 * _turned(first, axis, half))
        label = Label(((_SYMBOLS[name], scene.indices[name]),))
        yield label, "variable", list(around(middle, 15.0)), middle[None]
