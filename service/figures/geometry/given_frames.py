"""The frames that an exercise gives, such as the base and tool frames."""

from dataclasses import dataclass, replace

import numpy as np

from service.catalogue import Exercise
from service.catalogue.robots.robot import ReferenceTable, Robot
from service.catalogue.robots.screw_robot import ScrewRobot
from service.expressions.evaluation.samples import SymbolValues
from service.kinematics.chain import frames
from service.kinematics.dh import Convention
from service.kinematics.transforms import Matrices


@dataclass(frozen=True, slots=True)
class GivenFrames:
    """Frames of a robot, with their numbers and labels."""

    # ``numbers`` count them from the base frame, which is 0; -1 is the tool. ``labels`` are their
    # indices: "0" for {0}, or "s" and "b" for a robot with screw axes.
    source: ReferenceTable | ScrewRobot
    numbers: tuple[int, ...]
    labels: tuple[str, ...]

    def at(self, values: SymbolValues, samples: int) -> Matrices:
        """Return the poses of the frames in the base frame, ``(frames, samples, 4, 4)``."""
        if isinstance(self.source, ScrewRobot):
            names = ["base" if number == 0 else "tool" for number in self.numbers]
            poses = [self.source.frame(name, values, samples) for name in names]
            return np.array(poses).reshape(-1, samples, 4, 4)
        table = self.source
        found = frames(table.values(values, samples), table.convention)
        return np.asarray(found[list(self.numbers)])


def given_frames(exercise: Exercise) -> GivenFrames:
    """Return the frames that the exercise gives. Raises LookupError without a robot.

    Frames that the student may choose are left out.
    """
    # The frames between base and tool are also left out if parts ask for frames in different
    # conventions.
    robot = exercise.reference
    if robot is None:
        raise LookupError(f"exercise {exercise.id!r} has no robot")
    free = {
        name
        for part in exercise.parts
        for name in ("base", "tool", "frames")
        if getattr(part, name, "given") == "free"
    }
    if isinstance(robot, ScrewRobot):
        return _chosen(robot, ("s", "b"), free | {"frames"})
    conventions = {part.convention for part in exercise.parts if hasattr(part, "convention")}
    table = robot.tables[robot.convention]
    if len(conventions) == 1:
        [convention] = conventions
        table = robot.tables.get(convention, table)
    if len(conventions) != 1 or conventions != {table.convention}:
        free |= {"frames"}
    return _chosen(table, frame_labels(table), free)


def with_named_base(given: GivenFrames, statement: str) -> GivenFrames:
    """Return the frames together with the base frame if the statement names it."""
    # The base frame may be free, but the statement's coordinates are those of one choice of it.
    label = "s" if isinstance(given.source, ScrewRobot) else frame_labels(given.source)[0]
    if 0 in given.numbers or f"{{{label}}}" not in statement:
        return given
    return replace(given, numbers=(0, *given.numbers), labels=(label, *given.labels))


def table_frames_of(robot: Robot, convention: Convention | None = None) -> GivenFrames:
    """Return all frames of a robot's table in a convention, by default the author's."""
    table = robot.tables[convention or robot.convention]
    return _chosen(table, frame_labels(table), set())


def frame_labels(table: ReferenceTable) -> tuple[str, ...]:
    """Return the labels of a table's frames."""
    # The base frame has the first joint's number minus 1; the other frames have the row labels.
    return (str(table.joints[0].index - 1), *table.labels)


def _chosen(
    source: ReferenceTable | ScrewRobot, labels: tuple[str, ...], free: set[str]
) -> GivenFrames:
    last = len(labels) - 1
    numbers = [
        number
        for number in range(last + 1)
        if ("base" if number == 0 else "tool" if number == last else "frames") not in free
    ]
    return GivenFrames(
        source,
        tuple(-1 if number == last else number for number in numbers),
        tuple(labels[number] for number in numbers),
    )
