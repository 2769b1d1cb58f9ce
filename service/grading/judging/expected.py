"""What a part expects, in numbers: from the robot's frames, or from the part's own formulas."""

import numpy as np

from service.catalogue import Exercise, grid_values
from service.catalogue.parts.euler_angles import EulerAnglesSpec
from service.catalogue.parts.position import PositionSpec
from service.catalogue.parts.rotation import RotationSpec
from service.catalogue.parts.transform import TransformSpec
from service.catalogue.robot import Robot, at_home
from service.catalogue.variables import SymbolValues
from service.grading.judging.own_frames.reference import tool_pose
from service.grading.part import Grading
from service.grading.samples import SAMPLES, Samples
from service.kinematics.transforms import Matrices, Numbers, inverse

PoseSpec = TransformSpec | RotationSpec | PositionSpec | EulerAnglesSpec


def own_values(part_id: str, exercise: Exercise, samples: Samples) -> Numbers | None:
    """The numbers of the formulas that the part's file gives, ``(rows, columns, SAMPLES)``.

    None where it gives none: then the robot tells.
    """
    grid = exercise.formulas.get(part_id)
    return None if grid is None else grid_values(grid, samples.values, SAMPLES)


def robot_pose(part: PoseSpec, exercise: Exercise, samples: Samples) -> Matrices:
    """The pose ``(SAMPLES, 4, 4)`` of the robot that the part asks for. Raises LookupError."""
    robot = exercise.reference
    if robot is None:
        raise LookupError(f"exercise {exercise.id!r} has no robot")
    if isinstance(robot, Robot) and is_whole_chain(part, exercise):
        return tool_pose(exercise, samples)
    values: SymbolValues = samples.values
    if part.home:
        values = at_home(robot.joints, values, SAMPLES)
    pose = robot.frame(part.to, values, SAMPLES)
    if part.start == "base":
        return pose
    return inverse(robot.frame(part.start, values, SAMPLES)) @ pose


def asked_pose(part: PoseSpec, grading: Grading) -> Matrices:
    """The pose ``(SAMPLES, 4, 4)`` that the part asks for: of the robot, or of the student's chain.

    An own chain has the frames that its answer has; what asks for one that it has not is held
    against the robot.
    """
    own = grading.source
    if own is None or not grading.following or part.home:
        return robot_pose(part, grading.exercise, grading.samples)
    places = {"base": 0, "tool": len(own.frames) - 1}
    start, to = (places.get(str(frame), frame) for frame in (part.start, part.to))
    if not (isinstance(start, int) and isinstance(to, int) and max(start, to) < len(own.frames)):
        return robot_pose(part, grading.exercise, grading.samples)
    return np.asarray(inverse(own.frames[start]) @ own.frames[to])


def is_whole_chain(part: PoseSpec, exercise: Exercise) -> bool:
    """Whether the part asks for the pose of the tool in the base frame, wherever the joints are."""
    return (
        exercise.reference is not None
        and exercise.formulas.get(part.id) is None
        and (part.start, part.to, part.home) == ("base", "tool", False)
    )


def as_entries(matrices: Matrices) -> Numbers:
    """``(SAMPLES, rows, columns)`` as ``(rows, columns, SAMPLES)``."""
    return np.moveaxis(matrices, 0, -1)
