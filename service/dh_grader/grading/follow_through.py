"""Points for an answer that is computed correctly from an earlier wrong answer.

One early mistake must not make every later answer wrong.
"""

from collections.abc import Callable, Sequence

import numpy as np

from dh_grader.catalogue import PartSpec
from dh_grader.expressions import Kind
from dh_grader.grading.grading import Grading, StudentChain
from dh_grader.grading.numbers import (
    HALF,
    MOVES,
    NO_MOTION,
    NOT_RIGID,
    SAME_AXIS,
    SAMPLES,
    Samples,
    changes,
)
from dh_grader.grading.report import Finding, Severity
from dh_grader.kinematics import (
    Matrices,
    Numbers,
    exponential,
    inverse,
    is_rigid,
    rank,
    sliding_axis,
    turning_axis,
)
from dh_grader.translations import say

# So if the answer to a part is wrong, it is also judged by the student's earlier answer instead of
# the reference. The earlier answer must be good enough, so that a trivial table does not earn easy
# points later.


_Quantities = Sequence[Kind] | Sequence[Sequence[Kind]]


# The step by which a joint is moved, in radians or in the exercise's typical length.
STEPS = (0.4, 1.1)

ToolAt = Callable[[Samples], Matrices]


def can_carry(chain: StudentChain, grading: Grading) -> bool:
    """True if later answers may be judged by this answer instead of by the reference solution.

    The answer must be an arm with the joints and the degrees of freedom of the robot.
    """
    # It must be a rigid chain. Each joint must turn about, or slide along, one axis by its own
    # variable. Other arms may make later parts much easier.
    robot = grading.exercise.reference
    if robot is None or not is_rigid(chain.frames, NOT_RIGID).all():
        return False
    student = _jacobian(chain.tool_at, grading)
    reference = _jacobian(lambda samples: robot.frame("tool", samples.values, SAMPLES), grading)
    if student is None or reference is None:
        return False
    return rank(student, NO_MOTION) >= rank(reference, NO_MOTION)


def _jacobian(tool_at: ToolAt, grading: Grading) -> Numbers | None:
    # The axes of all joints, (HALF, 6, joints); the unit is the typical length. None if a joint
    # does not turn about, or slide along, one axis.
    found = []
    for i in range(len(grading.exercise.joints)):
        # An axis depends neither on its own joint's variable nor on those of later joints.
        near, far = (_axis(tool_at, i, step, grading, later=step is STEPS[1]) for step in STEPS)
        if near is None or far is None or np.abs(near - far).max() > SAME_AXIS:
            return None
        found.append(near)
    return np.stack(found, axis=-1)


def _axis(tool_at: ToolAt, i: int, step: float, grading: Grading, *, later: bool) -> Numbers | None:
    # The axis (HALF, 6) of joint i in the base frame. None if a small motion of the joint does not
    # move the tool about or along one axis. With later, the later joints have other values.
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
    # NaN fails this comparison.
    return axis if max(error, np.abs(length - 1).max()) < SAME_AXIS else None


def stands_still(values: Numbers, quantities: _Quantities, grading: Grading) -> bool:
    """True if no joint changes any entry ``(rows, columns, SAMPLES)`` of an answer."""
    # quantities are the quantities of the columns, or the quantity of all entries. An answer with
    # an unreadable entry (NaN) counts as moving.
    scales = np.where(np.array(quantities) == "length", grading.exercise.length_scale, 1.0)
    motion = np.abs(changes(values)).max(axis=-1)
    return bool(np.isfinite(motion).all() and (motion < MOVES * scales).all())


STANDS_STILL = Finding(
    "no_joint_variable",
    say(
        "No joint variable has any effect in this answer, so it describes an arm that cannot move: "
        "it earns nothing."
    ),
)


def follows_from(earlier: PartSpec, *, is_right: bool) -> Finding:
    """Return the message that an answer was graded on the basis of an earlier answer."""
    # The earlier answer is_right if it differs from the reference only by its choice of frames or
    # by rounding.
    title = repr(earlier.title)
    if is_right:
        hint = say("This was graded by your answer to {part}, which is right.", part=title)
    else:
        hint = say(
            "This earns its points, for it follows from your answer to {part}. That answer is "
            "wrong: check it first.",
            part=title,
        )
    return Finding("follow_through", hint, severity=Severity.INFO)
