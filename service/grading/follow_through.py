"""Marks for an answer that follows from an earlier answer of the student's own.

An early slip must not cost every later part. A part that follows from another one is judged by the
student's own answer there where the reference says that it is wrong; but only an answer that is
good enough to carry it, so that a trivial table cannot buy easy marks.
"""

from collections.abc import Callable

import numpy as np

from service.catalogue import PartSpec
from service.grading.feedback import Finding
from service.grading.joint_motion import changes
from service.grading.part import Grading, StudentChain
from service.grading.report import PartReport, Severity
from service.grading.samples import HALF, SAMPLES, Samples
from service.grading.tolerances import DEPENDS_ON_JOINTS, JOINT_STEP, NO_MOTION
from service.kinematics.jacobian import rank
from service.kinematics.transforms import Matrices, Numbers, inverse


def can_follow_through(
    part: PartSpec, earlier: PartReport, chain: StudentChain, grading: Grading
) -> bool:
    """Whether an earlier answer is good enough to carry the part that follows from it.

    It must have earned its share of the points, and describe an arm that moves in as many ways as
    the robot: one that has lost a freedom makes all that follows too easy.
    """
    if earlier.points < part.follows_from * earlier.max_points:
        return False

    def reference_tool(samples: Samples) -> Matrices | None:
        robot = grading.exercise.reference
        return None if robot is None else robot.frame("tool", samples.values, SAMPLES)

    return _freedom(chain.tool_at, grading) >= _freedom(reference_tool, grading)


def _freedom(tool_at: Callable[[Samples], Matrices | None], grading: Grading) -> int:
    """In how many ways the joints move a pose: the rank of its Jacobian, by small differences.

    The pose need not be rigid, so its Jacobian has all twelve entries, ``(HALF, 12, joints)``.
    """
    columns = []
    for joint in grading.exercise.joints:
        moved = tool_at(_nudged(grading.samples, joint.variable))
        if moved is None or np.isnan(moved).any():
            return 0
        twist = inverse(moved[:HALF]) @ moved[HALF:] - np.eye(4)
        columns.append(twist[:, :3].reshape(HALF, -1) / JOINT_STEP)
    return rank(np.stack(columns, axis=-1), NO_MOTION)


def _nudged(samples: Samples, variable: str) -> Samples:
    """Samples whose second half differs from the first in one joint only."""
    values = {name: np.tile(numbers[:HALF], 2) for name, numbers in samples.values.items()}
    values[variable][HALF:] += JOINT_STEP
    return Samples(values)


def stands_still(values: Numbers) -> bool:
    """Whether all values ``(..., SAMPLES)`` are known and none changes with the joints."""
    return bool((np.abs(changes(values)) <= DEPENDS_ON_JOINTS).all())


STANDS_STILL = Finding(
    "no_joint_variable",
    "No joint variable has any effect in this answer, so it describes an arm that cannot move: it "
    "earns nothing.",
)


def follows_from(earlier: PartSpec) -> Finding:
    """The message to a student who earned the points by following through."""
    return Finding(
        "follow_through",
        f"This is not the robot's, but it follows from your own answer to {earlier.title!r}: it "
        f"earns its points.",
        severity=Severity.INFO,
    )
