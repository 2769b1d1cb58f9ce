"""Compute the correct answer to a part of an exercise in numbers."""

import numpy as np

from service.catalogue import Exercise, PartSpec, grid_values
from service.catalogue.part import PosePartSpec
from service.catalogue.robots.robot import Robot, at_home
from service.grading.judging.own_frames.reference import tool_pose
from service.grading.numerics.samples import SAMPLES, Samples
from service.grading.part import Grading
from service.kinematics.transforms import Matrices, Numbers, inverse


def formula_values(part: PartSpec, grading: Grading) -> Numbers | None:
    """Return the values of the part's formulas in the exercise file, or None."""
    # ``(rows, columns, SAMPLES)``. Without formulas, the correct answer follows from the robot.
    grid = grading.exercise.formulas.get(part.id)
    return None if grid is None else grid_values(grid, grading.samples.values, SAMPLES)


def given_values(part: PartSpec, grading: Grading) -> Numbers:
    """Return the values of the part's formulas. Raises LookupError if the part has no formulas."""
    values = formula_values(part, grading)
    if values is None:
        raise LookupError(f"part {part.id!r} has no formulas")
    return values


def robot_pose(part: PosePartSpec, exercise: Exercise, samples: Samples) -> Matrices:
    """Return the expected pose ``(SAMPLES, 4, 4)``. Raises LookupError if there is no robot."""
    robot = exercise.reference
    if robot is None:
        raise LookupError(f"exercise {exercise.id!r} has no robot")
    if isinstance(robot, Robot) and is_whole_chain(part, exercise):
        return tool_pose(exercise, samples)
    values = samples.values
    if part.home:
        values = at_home(robot.joints, values, SAMPLES)
    pose = robot.frame(part.to, values, SAMPLES)
    if part.start == "base":
        return pose
    return inverse(robot.frame(part.start, values, SAMPLES)) @ pose


def asked_pose(part: PosePartSpec, grading: Grading) -> Matrices:
    """Return the expected pose ``(SAMPLES, 4, 4)``, from the robot or from an earlier answer."""
    # The student's chain must have both frames that the part asks for.
    chain, exercise, samples = grading.student_chain, grading.exercise, grading.samples
    if chain is None or not grading.following:
        return robot_pose(part, exercise, samples)
    tool = len(chain.frames) - 1

    def place(frame: int | str) -> int:
        if isinstance(frame, str):
            return {"base": 0, "tool": tool}[frame]
        return frame - exercise.joints[0].index + 1

    start, to = place(part.start), place(part.to)
    if max(start, to) > tool:
        return robot_pose(part, exercise, samples)
    frames = chain.frames
    if part.home:
        frames = chain.frames_at(Samples(at_home(exercise.joints, samples.values, SAMPLES)))
    return np.asarray(inverse(frames[start]) @ frames[to])


def is_whole_chain(part: PosePartSpec, exercise: Exercise) -> bool:
    """True if the part asks for the pose of the tool in the base frame at all joint values."""
    return (
        exercise.reference is not None
        and exercise.formulas.get(part.id) is None
        and (part.start, part.to, part.home) == ("base", "tool", False)
    )


def as_entries(matrices: Matrices) -> Numbers:
    """Move the samples of matrices to the last axis: ``(..., rows, columns, SAMPLES)``."""
    return np.moveaxis(matrices, -3, -1)
