"""Marks for an answer that follows from an earlier answer of the student's own.

An early slip must not cost every later part. A part that follows from another one is judged by the
student's own answer there where the reference says that it is wrong; but only an answer that is
good enough to carry it, so that a trivial table cannot buy easy marks.
"""

from collections.abc import Callable, Sequence

import numpy as np

from service.catalogue import PartSpec
from service.expressions import Kind
from service.grading.feedback import Finding
from service.grading.numerics.joint_motion import changes
from service.grading.numerics.samples import HALF, SAMPLES, Samples
from service.grading.numerics.tolerances import MOVES, NO_MOTION, NOT_RIGID, SAME_AXIS
from service.grading.part import Grading, StudentChain
from service.grading.report import Severity
from service.kinematics.jacobian import rank
from service.kinematics.screws import exponential, sliding_axis, turning_axis
from service.kinematics.transforms import Matrices, Numbers, inverse, is_rigid

_Quantities = Sequence[Kind] | Sequence[Sequence[Kind]]


# By how much a joint is moved: in radians, or in the exercise's typical length.
STEPS = (0.4, 1.1)

ToolAt = Callable[[Samples], Matrices]


def can_carry(chain: StudentChain, grading: Grading) -> bool:
    """Whether an answer is an arm that later parts may follow from.

    It must be a rigid chain in which each joint moves as its kind does, about or along one axis, by
    its own variable; and it must move in as many ways as the robot. All that follows from another
    arm may be much easier.
    """
    robot = grading.exercise.reference
    if robot is None or not is_rigid(chain.frames, NOT_RIGID).all():
        return False
    student = _jacobian(chain.tool_at, grading)
    reference = _jacobian(lambda samples: robot.frame("tool", samples.values, SAMPLES), grading)
    if student is None or reference is None:
        return False
    return rank(student, NO_MOTION) >= rank(reference, NO_MOTION)


def _jacobian(tool_at: ToolAt, grading: Grading) -> Numbers | None:
    """The axes of all joints, ``(HALF, 6, joints)``; None where one does not move as its kind does.

    Lengths are in the exercise's typical length.
    """
    found = []
    for i in range(len(grading.exercise.joints)):
        # An axis stays where it is however far its joint moves, and wherever the later joints are.
        near, far = (_axis(tool_at, i, step, grading, later=step is STEPS[1]) for step in STEPS)
        if near is None or far is None or np.abs(near - far).max() > SAME_AXIS:
            return None
        found.append(near)
    return np.stack(found, axis=-1)


def _axis(tool_at: ToolAt, i: int, step: float, grading: Grading, *, later: bool) -> Numbers | None:
    """The axis ``(HALF, 6)`` in the base frame that joint ``i`` moves the tool about or along.

    None where its displacement is not the ``step`` about or along one axis. With ``later`` the
    joints after it stand elsewhere.
    """
    scale, joints = grading.exercise.length_scale, grading.exercise.joints
    values = {name: np.tile(numbers[:HALF], 2) for name, numbers in grading.samples.values.items()}
    for joint in joints[i + 1 :] if later else ():
        values[joint.variable] = np.tile(grading.samples.values[joint.variable][HALF:], 2)
    prismatic = joints[i].prismatic
    values[joints[i].variable][HALF:] += step * scale if prismatic else step
    poses = tool_at(Samples(values)).copy()
    poses[:, :3, 3] /= scale
    displacement = poses[HALF:] @ inverse(poses[:HALF])
    axis = sliding_axis(displacement, step) if prismatic else turning_axis(displacement, step)
    error = np.abs(exponential(axis, step) - displacement).max()
    length = np.linalg.norm(axis[:, 3:] if prismatic else axis[:, :3], axis=-1)
    # NaN is not smaller than anything.
    return axis if max(error, np.abs(length - 1).max()) < SAME_AXIS else None


def stands_still(values: Numbers, quantities: _Quantities, grading: Grading) -> bool:
    """Whether the joints move no entry ``(rows, columns, SAMPLES)`` of an answer that was read.

    ``quantities`` are those of the columns, or of all entries. Nobody knows how an entry moves that
    was not read.
    """
    scales = np.where(np.array(quantities) == "length", grading.exercise.length_scale, 1.0)
    motion = np.abs(changes(values)).max(axis=-1)
    return bool(np.isfinite(motion).all() and (motion < MOVES * scales).all())


STANDS_STILL = Finding(
    "no_joint_variable",
    "No joint variable has any effect in this answer, so it describes an arm that cannot move: it "
    "earns nothing.",
)


def follows_from(earlier: PartSpec) -> Finding:
    """The message to a student who earned the points by following through."""
    return Finding(
        "follow_through",
        f"This earns its points, for it follows from your answer to {earlier.title!r}. That answer "
        f"is wrong: check it first.",
        severity=Severity.INFO,
    )
