"""Where a student's frames are valid but not the reference's: told, so that nobody wonders."""

from collections.abc import Sequence
from itertools import compress

import numpy as np

from service.catalogue import Exercise, Joint
from service.grading.feedback import Finding
from service.grading.report import Severity
from service.kinematics.chain_match import SAME
from service.kinematics.dh import Convention
from service.kinematics.transforms import Matrices


def choices(
    apart: Matrices, joints: Sequence[Joint], convention: Convention, exercise: Exercise
) -> tuple[Finding, ...]:
    """One message for each frame that departs from the reference's.

    ``apart`` ``(joints, samples, 4, 4)`` are the student's frames on the axes in the reference's.
    """
    away = np.abs(apart - np.eye(4)).max(axis=1)
    away[:, :3, 3] /= exercise.length_scale
    departs = away.max(axis=(1, 2)) > SAME
    findings = []
    for pose, joint in zip(apart[departs], compress(joints, departs), strict=True):
        frame = joint.index - 1 if convention is Convention.STANDARD else joint.index
        told = _told(pose, frame, joint, exercise.length_scale)
        if told:
            findings.append(
                Finding(
                    "own_frame_choice",
                    f"You {' and '.join(told)}; that is a valid choice.",
                    severity=Severity.INFO,
                )
            )
    return tuple(findings)


def _told(pose: Matrices, frame: int, joint: Joint, length_scale: float) -> list[str]:
    told = []
    rotation, origin = pose[:, :3, :3], pose[:, :3, 3]
    if (rotation[:, 2, 2] < 0).all():
        told.append(f"turned z{frame} over")
    if np.abs(rotation[:, 1, 0]).max() > SAME:
        told.append(f"turned x{frame} about z{frame}")
    elif (rotation[:, 0, 0] < 0).all():
        told.append(f"let x{frame} point the other way")
    if np.abs(origin[:, :2]).max() > SAME * length_scale:
        told.append(f"moved the axis of the sliding joint {joint.index} sideways")
    elif np.abs(origin[:, 2]).max() > SAME * length_scale:
        told.append(f"put origin {frame} elsewhere on z{frame}")
    return told
