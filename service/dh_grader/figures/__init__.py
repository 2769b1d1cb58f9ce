"""The figure of a robot: a labelled drawing of its mechanism and of its frames."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from dh_grader.catalogue import Exercise, Joint, Variable
from dh_grader.catalogue.robot import Reference
from dh_grader.figures.drawing import (
    LARGE_ROOM,
    PHONE_ROOM,
    Caption,
    DrawnFrames,
    Label,
    Sheet,
    Theme,
    camera_for,
    dimension,
    frame_axes,
    frame_label,
    frame_names,
    mechanism_solids,
    name_label,
    named,
    sliding_arrow,
    sum_label,
    turning_arrow,
)
from dh_grader.figures.mechanism import (
    JOINT_LENGTH,
    JOINT_RADIUS,
    Configuration,
    GivenFrames,
    MovableMechanism,
    NamedLength,
    View,
    as_samples,
    best_view,
    drawing_numbers,
    given_frames,
    mechanism_of,
    named_lengths,
    path_of,
    table_frames_of,
    with_named_base,
)
from dh_grader.figures.solids import Camera
from dh_grader.kinematics import Numbers

# The length of frame axes as a share of the mechanism's size: of base and tool, of many frames.
_FRAME: Final = 0.24
_MANY: Final = 0.18
# How often a figure is drawn again, each time smaller, until it fits on a phone.
_TRIES: Final = 4
# The least share of its first size to which the mechanism shrinks.
_LEAST: Final = 0.55


@dataclass(frozen=True, slots=True)
class Subject:
    """The subject of a figure: a robot, its symbols, and a title for the text alternative.

    With ``directed``, arrows show the joints' positive directions.
    """

    # ``name`` is part of ids inside the SVG. Lengths that ``statement`` gives as numbers have
    # labels.
    name: str
    title: str
    reference: Reference
    variables: tuple[Variable, ...]
    directed: bool = True
    view: View | None = None
    statement: str = ""
    frames: DrawnFrames | None = None

    @property
    def joints(self) -> tuple[Joint, ...]:
        """The robot's joints."""
        return self.reference.joints


def exercise_figure(exercise: Exercise, theme: Theme = Theme.AUTO) -> str:
    """Return the drawing for students: the robot and the given frames, without answers.

    Raises LookupError if the exercise has no robot.
    """
    subject = subject_of(exercise)
    given = with_named_base(given_frames(exercise), exercise.statement)
    # The statement speaks of the base frame's y axis; those of other frames follow from x and z.
    axes = ["xyz" if number == 0 else "xz" for number in given.numbers]
    return figure(replace(subject, frames=_at_home_of(exercise, given, axes)), theme)


def subject_of(exercise: Exercise) -> Subject:
    """Return the subject of the drawing for students. Raises LookupError without a robot."""
    if exercise.reference is None:
        raise LookupError(f"exercise {exercise.id!r} has no robot to draw")
    seen = exercise.view
    return Subject(
        # Ids inside the SVG have no "~", which separates the seed of a variant.
        exercise.id.replace("~", "-"),
        exercise.title,
        exercise.reference,
        exercise.variables,
        directed=all(getattr(part, "directions", "given") == "given" for part in exercise.parts),
        view=None if seen is None else View(seen.azimuth, seen.elevation),
        statement=exercise.statement,
    )


def reference_figure(exercise: Exercise, theme: Theme = Theme.AUTO) -> str:
    """Return the drawing with the frames of the reference table, for tutors only.

    Raises LookupError if the exercise has no robot with a table.
    """
    # The frames are an answer.
    frames = table_frames_of(exercise.robot)
    axes = ["xyz"] * len(frames.labels)
    drawn = _at_home_of(exercise, frames, axes)
    return figure(replace(subject_of(exercise), frames=drawn), theme, large=True)


def _at_home_of(exercise: Exercise, frames: GivenFrames, axes: Sequence[str]) -> DrawnFrames:
    values = as_samples(drawing_numbers(exercise.variables), 1)
    return DrawnFrames(frames.at(values, 1)[:, 0], frames.labels, axes, braces=True)


def figure(subject: Subject, theme: Theme = Theme.AUTO, *, large: bool = False) -> str:
    """Return the drawing as SVG: joints, links, frames, names of lengths and of joint variables.

    The drawing fits on a phone, unless ``large`` is True.
    """
    numbers = drawing_numbers(subject.variables)
    mechanism = mechanism_of(subject.reference, numbers)
    shown = _at_home(mechanism, numbers)
    view = subject.view or best_view(shown, mechanism.extent)
    room = LARGE_ROOM if large else PHONE_ROOM
    camera = camera_for(np.concatenate([*shown.links, shown.base[None]]), view, room)
    least = _LEAST * camera.scale
    lengths = named_lengths(subject.reference, subject.variables, subject.statement)
    measured = list(_measured(subject, lengths, numbers))
    labelled = {length.names[0] for length in lengths if len(length.names) == 1}

    def drawn(camera: Camera) -> tuple[Sheet, list[str]]:
        sheet = Sheet(camera, mechanism.size)
        solids = mechanism_solids(sheet, shown, mechanism, subject.name)
        frames = subject.frames
        if frames is not None:
            length = (_FRAME if len(frames.labels) < 3 else _MANY) * mechanism.size
            sheet.above += frame_axes(camera, frames, length, sheet.room)
        _dimensions(sheet, shown, measured)
        _motions(sheet, shown, subject, labelled)
        if frames is not None:
            sheet.above += frame_names(camera, frames, sheet.room)
        return sheet, solids

    sheet, solids = drawn(camera)
    for _ in range(_TRIES):
        smaller = max(sheet.camera.scale / sheet.excess, least)
        if large or smaller >= sheet.camera.scale:
            break
        sheet, solids = drawn(Camera(camera.rotation, smaller))
    caption = Caption(subject.name, subject.title, _description(subject, lengths))
    return sheet.svg(solids, caption, theme)


def default_view(mechanism: MovableMechanism, numbers: Mapping[str, float]) -> View:
    """Return the view of a mechanism that is used if the author has chosen none."""
    return best_view(_at_home(mechanism, numbers), mechanism.extent)


def _at_home(mechanism: MovableMechanism, numbers: Mapping[str, float]) -> Configuration:
    [shown] = mechanism.at(np.array([[numbers[joint.variable] for joint in mechanism.joints]]))
    return shown


def _measured(
    subject: Subject, lengths: Sequence[NamedLength], numbers: Mapping[str, float]
) -> Iterator[tuple[Numbers, Label]]:
    corners = path_of(subject.reference, as_samples(numbers, 1), 1).corners[:, 0]
    for length in lengths:
        yield corners[[length.start, length.end]], sum_label(length.names)


def _dimensions(
    sheet: Sheet, shown: Configuration, measured: Iterable[tuple[Numbers, Label]]
) -> None:
    steps = np.concatenate([np.diff(link, axis=0) for link in shown.links])
    sides = np.concatenate([np.eye(3), shown.axes, steps])
    for ends, label in measured:
        aside = _aside(ends[1] - ends[0], sides)
        drawing = dimension(sheet.camera, ends, label, sheet.size, aside, sheet.room)
        sheet.below += drawing.below
        sheet.above += drawing.above


def _aside(step: Numbers, directions: Numbers) -> Numbers:
    # Unit vectors perpendicular to ``step``, in the plane of ``step`` and a direction.
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


def _motions(sheet: Sheet, shown: Configuration, subject: Subject, labelled: set[str]) -> None:
    # An arrow has one head if the positive directions are known, else two. A variable that labels a
    # length has no second label.
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
        if joint.variable not in labelled:
            label = name_label(joint.variable)
            sheet.above += named(label, arrow.beside, arrow.line, "variable", sheet.room)


def _description(subject: Subject, lengths: Sequence[NamedLength]) -> str:
    # The text describes the picture without an answer.
    kinds = [
        f"{name_label(joint.variable).text} {'slides' if joint.prismatic else 'turns'}"
        for joint in subject.joints
    ]
    words = f"The mechanism from its base to its tool, joint by joint: {', '.join(kinds)}."
    if lengths:
        named = ", ".join(sum_label(length.names).text for length in lengths)
        words += f" Lengths marked: {named}."
    if subject.frames is not None and subject.frames.labels:
        words += f" Frames drawn: {frame_label(subject.frames.labels).text}."
    return f"{words} All joint angles are 0."
