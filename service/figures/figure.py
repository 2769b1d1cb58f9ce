"""The figure of a robot: its mechanism as a labelled drawing, with frames only where asked for."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain
from typing import Final
from xml.sax.saxutils import escape

import numpy as np

from service.catalogue import Exercise, Joint, Variable
from service.catalogue.screw_robot import Reference
from service.figures.dimensions import dimension
from service.figures.frame_axes import frame_axes
from service.figures.lengths import NamedLength, named_lengths
from service.figures.mechanism import (
    GRIPPER_LENGTH,
    JOINT_LENGTH,
    JOINT_RADIUS,
    Configuration,
    MovableMechanism,
    mechanism_of,
    one_by_one,
)
from service.figures.motion_arrows import sliding_arrow, turning_arrow
from service.figures.names import Label, name_label, sum_label
from service.figures.path import path_of
from service.figures.placing import TakenRoom, around
from service.figures.solids import (
    Camera,
    Solid,
    box,
    cylinder,
    gripper,
    ground,
    in_order,
    numbers,
    polyline,
    rod,
)
from service.figures.style import Theme, style_sheet
from service.figures.symbol_numbers import drawing_numbers
from service.figures.view import View, best_view
from service.kinematics.transforms import Matrices, Numbers

# The room of the mechanism itself, in pixels; lengths and names stand around it.
_WIDTH, _HEIGHT, _LARGEST = 460.0, 430.0, 540.0
_MARGIN = 14.0
_BOX_WIDTH = 1.05 * JOINT_RADIUS
_ROD: Final = 0.036
_AXIS_BEYOND: Final = 0.11


@dataclass(slots=True)
class _Sheet:
    """A figure being drawn: what stands on it in layers, and the room that is left."""

    camera: Camera
    size: float
    room: TakenRoom = field(default_factory=TakenRoom)
    below: list[str] = field(default_factory=list)
    above: list[str] = field(default_factory=list)
    points: list[Numbers] = field(default_factory=list)

    @property
    def unit(self) -> float:
        """The size of the mechanism's parts in pixels."""
        return self.size * self.camera.scale

    def take(self, points: Numbers, radius: float, weight: float = 1.0) -> None:
        """Note that a line of the picture is drawn here."""
        self.room.take_line(points, radius, weight)
        self.points += [points - radius, points + radius]


@dataclass(frozen=True, slots=True)
class Subject:
    """What is drawn: a robot, its symbols, and words for whoever does not see it.

    ``name`` is part of ids inside the SVG. ``directed`` says that the joints' positive directions
    are known to whoever looks. ``frames`` ``(frames, 4, 4)`` are drawn with the names x, y and z
    and the indices ``labels``.
    """

    name: str
    title: str
    reference: Reference
    variables: tuple[Variable, ...]
    directed: bool = True
    view: View | None = None
    frames: Matrices | None = None
    labels: tuple[str, ...] = ()

    @property
    def joints(self) -> tuple[Joint, ...]:
        """The robot's joints."""
        return self.reference.joints


def exercise_figure(exercise: Exercise, theme: Theme = Theme.AUTO) -> str:
    """The drawing that a student sees: no frames, no numbers, no answer.

    Raises LookupError where the exercise has no robot.
    """
    return figure(subject_of(exercise), theme)


def subject_of(exercise: Exercise) -> Subject:
    """The robot of an exercise as a student may see it. Raises LookupError where it has none."""
    if exercise.reference is None:
        raise LookupError(f"exercise {exercise.id!r} has no robot to draw")
    seen = exercise.view
    return Subject(
        exercise.id,
        exercise.title,
        exercise.reference,
        exercise.variables,
        directed=all(getattr(part, "directions", "given") == "given" for part in exercise.parts),
        view=None if seen is None else View(seen.azimuth, seen.elevation),
    )


def reference_figure(exercise: Exercise, theme: Theme = Theme.AUTO) -> str:
    """The drawing with the frames of the reference's own table: for tutors, an answer.

    Raises LookupError where the exercise has no robot by its table.
    """
    robot, subject = exercise.robot, subject_of(exercise)
    numbers = one_by_one(drawing_numbers(exercise.variables), 1)
    first = robot.joints[0].index - 1
    frames = robot.all_frames(numbers, 1)[:, 0]
    labels = tuple(str(first + i) for i in range(len(frames)))
    return figure(replace(subject, frames=frames, labels=labels), theme)


def figure(subject: Subject, theme: Theme = Theme.AUTO) -> str:
    """The drawing as SVG: joints, links, names of lengths and of joint variables."""
    numbers = drawing_numbers(subject.variables)
    mechanism = mechanism_of(subject.reference, numbers)
    shown = _at_home(mechanism, numbers)
    view = subject.view or best_view(shown, mechanism.extent)
    sheet = _Sheet(_camera(shown, view), mechanism.size)
    solids = _solids(sheet, shown, mechanism, subject.name)
    if subject.frames is not None:
        drawn = frame_axes(
            sheet.camera, subject.frames, subject.labels, 0.3 * mechanism.size, sheet.room
        )
        sheet.above += drawn
    lengths = named_lengths(subject.reference, subject.variables)
    _dimensions(sheet, shown, _measured(subject, lengths, numbers))
    told = {length.names[0] for length in lengths if len(length.names) == 1}
    _motions(sheet, shown, subject, told)
    return _document(sheet, solids, subject, theme, _description(subject, lengths))


def plainest_view(mechanism: MovableMechanism, numbers: Mapping[str, float]) -> View:
    """The view that a figure of the mechanism has where its author has not chosen one."""
    return best_view(_at_home(mechanism, numbers), mechanism.extent)


def _at_home(mechanism: MovableMechanism, numbers: Mapping[str, float]) -> Configuration:
    [shown] = mechanism.at(np.array([[numbers[joint.variable] for joint in mechanism.joints]]))
    return shown


def _camera(shown: Configuration, view: View) -> Camera:
    """The camera that has the whole mechanism in the room for it."""
    points = np.concatenate([*shown.links, shown.base[None]])
    width, height = np.ptp(Camera.of(view, 1.0).seen(points), axis=0)
    longest = float(np.linalg.norm(np.ptp(points, axis=0)))
    scale = min(_WIDTH / max(width, 1e-9), _HEIGHT / max(height, 1e-9), _LARGEST / longest)
    return Camera.of(view, scale)


def _solids(
    sheet: _Sheet, shown: Configuration, mechanism: MovableMechanism, name: str
) -> list[str]:
    """The SVG of ground, links, joints and gripper, in the order in which they hide each other."""
    camera, size = sheet.camera, sheet.size
    half, radius = JOINT_LENGTH / 2 * size, JOINT_RADIUS * size
    solids: list[Solid] = []
    for i, (joint, centre, axis) in enumerate(
        zip(mechanism.joints, shown.centres, shown.axes, strict=True)
    ):
        if joint.prismatic:
            solids.append(box(camera, centre, axis, half, _BOX_WIDTH * size))
        else:
            solids.append(cylinder(camera, centre, axis, half, radius, f"{name}-{i + 1}"))
        ends = centre + np.array([[-1.0], [1.0]]) * (half + _AXIS_BEYOND * size / 2) * axis
        sheet.below.append(polyline(camera.seen(ends), "axis"))
        sheet.take(camera.seen(ends), 1.0, 0.6)
        inner = centre + np.array([[-1.0], [1.0]]) * half * axis
        sheet.take(camera.seen(inner), (1.3 if joint.prismatic else 1.0) * radius * camera.scale)
    reach = GRIPPER_LENGTH * size
    for i, corners in enumerate(shown.links):
        line = corners if i + 1 < len(shown.links) else _shortened(corners, reach)
        if len(line) > 1:
            drawn = _clear_of_joints(line, i, shown, mechanism)
            solids.append(rod(camera, drawn, _ROD * sheet.unit))
            sheet.take(camera.seen(line), _ROD * sheet.unit / 2)
    grip = gripper(camera, shown.tool, shown.tool_direction, reach, 0.42 * _ROD * sheet.unit)
    sheet.take(camera.seen(grip.spine), grip.radius)
    floor = ground(camera, shown.base, shown.base_normal, 0.13 * size)
    width = floor.radius * camera.seen(camera.rotation[0]) / camera.scale
    for down in (-0.02, 0.05):
        middle = camera.seen(shown.base - down * size * shown.base_normal)
        sheet.take(np.array([middle - width, middle + width]), 0.06 * sheet.unit)
    ordered = in_order(camera, [*solids, grip])
    return [floor.svg, *(solid.svg for solid in ordered)]


def _shortened(corners: Numbers, by: float) -> Numbers:
    """The line without its last stretch, as long as ``by``."""
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
    """The line of a link from the surface of the joint before it to that of the one behind it."""
    first, last = line[0], line[-1]
    if link > 0:
        first = _surface(line[0], line[1], shown, link - 1, mechanism)
    if link < len(mechanism.joints):
        last = _surface(line[-1], line[-2], shown, link, mechanism)
    return np.concatenate([first[None], line[1:-1], last[None]])


def _surface(
    start: Numbers, towards: Numbers, shown: Configuration, joint: int, mechanism: MovableMechanism
) -> Numbers:
    """Where a line from the middle of a joint leaves it; a little inside."""
    step = towards - start
    length = float(np.linalg.norm(step))
    direction = step / length
    along = abs(float(direction @ shown.axes[joint]))
    across = float(np.sqrt(max(1.0 - along**2, 0.0)))
    radius = _BOX_WIDTH if mechanism.joints[joint].prismatic else JOINT_RADIUS
    inside = min(JOINT_LENGTH / 2 / max(along, 1e-9), 0.9 * radius / max(across, 1e-9))
    return np.asarray(start + min(inside * mechanism.size, 0.5 * length) * direction)


def _measured(
    subject: Subject, lengths: Sequence[NamedLength], numbers: Mapping[str, float]
) -> Iterator[tuple[Numbers, Label]]:
    """The ends ``(2, 3)`` of each length that has a name, and the name."""
    corners = path_of(subject.reference, one_by_one(numbers, 1), 1).corners[:, 0]
    for length in lengths:
        yield corners[[length.start, length.end]], sum_label(length.names)


def _dimensions(
    sheet: _Sheet, shown: Configuration, measured: Iterable[tuple[Numbers, Label]]
) -> None:
    """Draw the dimension lines."""
    steps = np.concatenate([np.diff(link, axis=0) for link in shown.links])
    sides = np.concatenate([np.eye(3), shown.axes, steps])
    for ends, label in measured:
        aside = _aside(ends[1] - ends[0], sides)
        drawing = dimension(sheet.camera, ends, label, sheet.size, aside, sheet.room)
        sheet.below += drawing.below
        sheet.above += drawing.above


def _aside(step: Numbers, directions: Numbers) -> Numbers:
    """The unit vectors at right angles to a piece that lie in a plane with a known direction."""
    along = step / np.linalg.norm(step)
    found: list[Numbers] = []
    for direction in directions:
        across = direction - along * (along @ direction)
        size = float(np.linalg.norm(across))
        if size > 0.05 * float(np.linalg.norm(direction)):
            unit = across / size
            if all(np.linalg.norm(unit - other) > 1e-3 for other in found):
                found += [unit, -unit]
    return np.array(found)


def _motions(sheet: _Sheet, shown: Configuration, subject: Subject, told: set[str]) -> None:
    """Draw how each joint moves, with the name of its variable where no length has told it.

    Only where the positive directions are known has an arrow one head alone.
    """
    both = not subject.directed
    half, radius = JOINT_LENGTH / 2 * sheet.size, JOINT_RADIUS * sheet.size
    arrows = []
    for joint, centre, axis in zip(subject.joints, shown.centres, shown.axes, strict=True):
        if joint.prismatic:
            arrow = sliding_arrow(
                sheet.camera, centre, axis, half, 1.9 * radius, sheet.room, both=both
            )
        else:
            arrow = turning_arrow(
                sheet.camera, centre, axis, half + 0.55 * radius, 1.6 * radius,
                sheet.room, both=both,
            )  # fmt: skip
        sheet.take(arrow.line, 2.0)
        sheet.above += arrow.svg()
        arrows.append((joint, arrow))
    for joint, arrow in arrows:
        if joint.variable not in told:
            label = name_label(joint.variable)
            place = sheet.room.place(label, around(arrow.middle, 15.0))
            sheet.above.append(label.svg(place.x, place.y, "variable"))


def _document(
    sheet: _Sheet, solids: Sequence[str], subject: Subject, theme: Theme, description: str
) -> str:
    """The whole SVG, as large as what stands on it."""
    labels = sheet.room.labels
    corners = [np.array([[r.x - r.half_width, r.y - r.half_height]]) for r in labels]
    corners += [np.array([[r.x + r.half_width, r.y + r.half_height]]) for r in labels]
    taken = np.concatenate([*sheet.room.ends, *sheet.points, *corners])
    low, high = taken.min(axis=0) - _MARGIN, taken.max(axis=0) + _MARGIN
    left, top, width, height = (float(v) for v in (*np.floor(low), *np.ceil(high - np.floor(low))))
    body = "\n".join(chain(sheet.below, solids, sheet.above))
    return f"""\
<svg xmlns="http://www.w3.org/2000/svg" role="img" aria-labelledby="{subject.name}-title \
{subject.name}-desc" viewBox="{numbers(left, top, width, height)}" \
width="{numbers(width)}" height="{numbers(height)}">
<title id="{subject.name}-title">{escape(subject.title)}</title>
<desc id="{subject.name}-desc">{escape(description)}</desc>
<style>{style_sheet(theme)}</style>
<rect class="paper" x="{numbers(left)}" y="{numbers(top)}" width="{numbers(width)}" \
height="{numbers(height)}"/>
{body}
</svg>
"""


def _description(subject: Subject, lengths: Sequence[NamedLength]) -> str:
    """The picture in words, for whoever does not see it: what it shows, and no answer."""
    kinds = [
        f"{name_label(joint.variable).text} {'slides' if joint.prismatic else 'turns'}"
        for joint in subject.joints
    ]
    words = f"The mechanism from its base to its tool, joint by joint: {', '.join(kinds)}."
    if lengths:
        named = ", ".join(sum_label(length.names).text for length in lengths)
        words += f" Lengths marked: {named}."
    return f"{words} All joint angles are 0."
