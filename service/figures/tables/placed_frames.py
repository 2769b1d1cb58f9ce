"""The frames that a student places on joint axes, right or wrong, to be drawn on the robot."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from service.catalogue import Exercise
from service.catalogue.parts.frames import FRAME_CELLS, FramesSpec, frame_labels
from service.catalogue.robots.robot import at_home
from service.expressions import AngleUnit
from service.figures.tables.table_frames import LARGEST, CellWithoutNumber
from service.grading.feedback import reading_error
from service.grading.numerics.samples import SAMPLES, Samples
from service.grading.reading.entry import Entry, Reader, entry_values
from service.grading.reading.lists.frame_list import StudentFrame, read_frames
from service.grading.report import Verdict
from service.grading.work_budget import WorkBudget
from service.kinematics.tolerances import NO_ROTATION
from service.kinematics.transforms import Matrices, Numbers, inverse


@dataclass(frozen=True, slots=True)
class PlacedFrames:
    """The frames that can be drawn, ``(configurations, frames, 4, 4)``, and their labels.

    If a frame was begun but cannot be drawn, ``left_out`` has the cell that prevents drawing it.
    """

    labels: tuple[str, ...]
    frames: Matrices
    left_out: tuple[CellWithoutNumber, ...]


def placed_frames(
    answer: object,
    part: FramesSpec,
    exercise: Exercise,
    numbers: Mapping[str, float],
    amounts: Numbers,
    budget: WorkBudget,
    angle_unit: AngleUnit = "radians",
) -> PlacedFrames:
    """Return placed frames at values of the joint variables, ``(configurations, joints)``.

    ``numbers`` has a number for every symbol. Raises UnreadableAnswerError if the answer has no
    rows.
    """
    # The frames are written with all joint variables 0, and move with their links.
    values = {name: np.full(SAMPLES, number) for name, number in numbers.items()}
    home = Samples(at_home(exercise.joints, values, SAMPLES))
    labels = frame_labels(exercise.robot, part.convention)
    reader = Reader.of(exercise, home, angle_unit, budget)
    motions = _link_motions(exercise, numbers, amounts)
    drawn, left_out = {}, []
    for i, written in enumerate(read_frames(answer, labels, reader)):
        if not _is_begun(written):
            continue
        found = _frame(labels[i], written, home)
        if isinstance(found, CellWithoutNumber):
            left_out.append(found)
        else:
            drawn[labels[i]] = motions[i] @ found
    frames = np.stack(list(drawn.values()), axis=1) if drawn else np.empty((len(amounts), 0, 4, 4))
    return PlacedFrames(tuple(drawn), frames, tuple(left_out))


def _is_begun(frame: StudentFrame) -> bool:
    if frame.axis.number is not None or frame.z.name or frame.x.name:
        return True
    return any(entry.verdict is not Verdict.MISSING for _, entry in _entries(frame))


def _entries(frame: StudentFrame) -> Iterator[tuple[str, Entry]]:
    # A direction such as +y has no entries.
    yield FRAME_CELLS[0], frame.axis.entry
    yield from (("z", entry) for entry in frame.z.entries)
    yield from zip(FRAME_CELLS[2:5], frame.origin, strict=True)
    yield from (("x", entry) for entry in frame.x.entries)


def _frame(label: str, frame: StudentFrame, home: Samples) -> Matrices | CellWithoutNumber:
    # x is drawn as it is written, even if it is not perpendicular to z.
    for cell, entry in _entries(frame):
        if cell != FRAME_CELLS[0] and not entry.readable:
            finding = entry.findings[0] if entry.findings else _NO_NUMBER
            return CellWithoutNumber(label, cell, finding)
    drawn = np.eye(4)
    for column, cell, direction in ((2, "z", frame.z), (0, "x", frame.x)):
        values = direction.values(home)
        length = 0.0 if values is None else float(np.linalg.norm(values[0]))
        if values is None or not NO_ROTATION < length < np.inf:
            return CellWithoutNumber(label, cell, _NO_NUMBER)
        drawn[:3, column] = values[0] / length
    origin = entry_values(frame.origin, ("length",) * 3, home)[:, 0]
    for cell, value in zip(FRAME_CELLS[2:5], origin, strict=True):
        if not abs(value) <= LARGEST:
            return CellWithoutNumber(label, cell, _NO_NUMBER)
    drawn[:3, 3] = origin
    drawn[:3, 1] = np.cross(drawn[:3, 2], drawn[:3, 0])
    across = float(np.linalg.norm(drawn[:3, 1]))
    if across <= NO_ROTATION:
        return CellWithoutNumber(label, "x", _PARALLEL)
    drawn[:3, 1] /= across
    return drawn


def _link_motions(exercise: Exercise, numbers: Mapping[str, float], amounts: Numbers) -> Matrices:
    # ``(links, configurations, 4, 4)``. Link i is moved by joints 1 to i.
    count = len(amounts)
    still = {name: np.full(count, number) for name, number in numbers.items()}
    moving = still | {joint.variable: amounts[:, i] for i, joint in enumerate(exercise.joints)}
    robot = exercise.robot
    reached = robot.all_frames(moving, count)[1:]
    return np.asarray(
        reached @ inverse(robot.all_frames(at_home(exercise.joints, still, count), count)[1:])
    )


_NO_NUMBER: Final = reading_error("undefined", "This has no value, or one too large to draw.")
_PARALLEL: Final = reading_error("undefined", "x and z are parallel, so they make no frame.")
