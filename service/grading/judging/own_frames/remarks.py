"""Remarks on frames that are valid but differ from the reference frames."""

from itertools import compress
from typing import Final

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Exercise, Joint
from service.grading.feedback import Finding
from service.grading.report import Severity
from service.kinematics.dh import Convention
from service.kinematics.tolerances import SAME_POSE
from service.kinematics.transforms import Matrices
from service.translations import Sentence, paragraph, say

OWN_FRAME_CHOICE: Final = "own_frame_choice"
_IDENTITY: Final = np.eye(4)


def remarks_on(
    relative_poses: Matrices,
    convention: Convention,
    exercise: Exercise,
    rows_right: NDArray[np.bool_] | None = None,
) -> tuple[Finding, ...]:
    """Return a finding (message) for each frame that differs from the reference frame.

    A frame that differs because of a wrong row gets no finding.
    """
    # ``relative_poses`` ``(joints, samples, 4, 4)`` are the student's frames on the joint axes, as
    # seen from the reference's frames. ``rows_right`` ``(joints, 2)`` says, for each axis, whether
    # the rows before and after it are correct.
    error = np.abs(relative_poses - _IDENTITY)
    error[..., :3, 3] /= exercise.length_scale
    departs = error.reshape(len(error), -1).max(axis=1) > SAME_POSE
    if rows_right is not None:
        departs = _chosen(departs, rows_right)
    findings = []
    joints = compress(exercise.robot.joints, departs)
    for pose, joint in zip(relative_poses[departs], joints, strict=True):
        frame = joint.index - 1 if convention is Convention.STANDARD else joint.index
        departures = _departures(pose, frame, joint, exercise.length_scale)
        if departures:
            hint = paragraph(*departures)
            findings.append(Finding(OWN_FRAME_CHOICE, hint, severity=Severity.INFO))
    return tuple(findings)


def _chosen(departs: NDArray[np.bool_], rows_right: NDArray[np.bool_]) -> NDArray[np.bool_]:
    runs = np.cumsum(~departs)
    implied = runs[departs & ~rows_right.all(axis=1)]
    return departs & ~np.isin(runs, implied)


def _departures(pose: Matrices, frame: int, joint: Joint, length_scale: float) -> list[Sentence]:
    departures = []
    x, z = f"x{frame}", f"z{frame}"
    rotation, origin = pose[:, :3, :3], pose[:, :3, 3]
    if (rotation[:, 2, 2] < 0).all():
        departures.append(
            say("You let {axis} point the opposite way; that is a valid choice.", axis=z)
        )
    if np.abs(rotation[:, 1, 0]).max() > SAME_POSE:
        departures.append(say("You turned {x} about {z}; that is a valid choice.", x=x, z=z))
    elif (rotation[:, 0, 0] < 0).all():
        departures.append(
            say("You let {axis} point the opposite way; that is a valid choice.", axis=x)
        )
    if np.abs(origin[:, :2]).max() > SAME_POSE * length_scale:
        departures.append(
            say(
                "You moved the axis of the sliding joint {joint} sideways; that is a valid choice.",
                joint=joint.index,
            )
        )
    elif np.abs(origin[:, 2]).max() > SAME_POSE * length_scale:
        departures.append(
            say(
                "You put origin {frame} elsewhere on {axis}; that is a valid choice.",
                frame=frame,
                axis=z,
            )
        )
    return departures
