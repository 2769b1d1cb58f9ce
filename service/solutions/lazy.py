"""Answers that need no knowledge; their points show whether the marking is fair."""

# In these answers, every joint turns about the z axis or slides along it by its variable; all other
# entries are 0.

from collections.abc import Sequence

from service.catalogue import Exercise, Joint

_Rows = list[list[str]]

IDENTITY: _Rows = [["1" if i == j else "0" for j in range(4)] for i in range(4)]


def motion(joints: Sequence[Joint]) -> _Rows:
    """Return the homogeneous transform of joints that all turn about or slide along the z axis."""
    angle = " + ".join(joint.variable for joint in joints if not joint.prismatic)
    distance = " + ".join(joint.variable for joint in joints if joint.prismatic)
    rows = [list(row) for row in IDENTITY]
    if angle:
        rows[0][:2] = f"cos({angle})", f"-sin({angle})"
        rows[1][:2] = f"sin({angle})", f"cos({angle})"
    rows[2][3] = distance or "0"
    return rows


def poses(exercise: Exercise, size: int) -> list[_Rows]:
    """Return the poses that a lazy student would write: the identity, and all joints moved."""
    # ``size`` is 3 (rotations) or 4.
    of_joints = [motion(exercise.joints)] if exercise.joints else []
    return [[row[:size] for row in rows[:size]] for rows in (IDENTITY, *of_joints)]
