"""Answers that need no knowledge; their points show whether the marking is fair."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

from dh_grader.catalogue import Exercise, Joint
from dh_grader.catalogue.kinds import (
    FRAME_CELLS,
    DhRowSpec,
    DhTableSpec,
    EulerAnglesSpec,
    FindSlipSpec,
    FramesSpec,
    LinkTransformsSpec,
    MatrixSpec,
    PositionSpec,
    RotationSpec,
    ScrewAxesSpec,
    TransformSpec,
    VectorSpec,
    frame_labels,
)
from dh_grader.grading.kinds.tables import slip_of
from dh_grader.kinematics import COLUMNS, Convention
from dh_grader.learning import as_rows

# --- Answers that need no knowledge; their points show whether the marking is fair


# In these answers, every joint turns about the z axis or slides along it by its variable; all other
# entries are 0.


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


def lazy_vector(part: VectorSpec, _exercise: Exercise) -> list[object]:
    """Return the answer that needs no knowledge: all components are 0."""
    return [["0"] * len(part.components)]


def lazy_transform(_part: TransformSpec, exercise: Exercise) -> list[object]:
    """Return the identity, and the transform of an arm whose joints all have the same axis."""
    return [*poses(exercise, 4)]


def lazy_screw_axes(part: ScrewAxesSpec, exercise: Exercise) -> list[object]:
    """Return two answers: every axis is the z axis of the base frame, and every axis is zero."""
    kinds = [joint.prismatic for joint in exercise.joints]
    prismatic = kinds if part.expected is None else [False] * len(part.expected)
    axes = [["0"] * 5 + ["1"] if slides else [*"001000"] for slides in prismatic]
    return [axes, [["0"] * 6] * len(axes)]


def lazy_rotation(_part: RotationSpec, exercise: Exercise) -> list[object]:
    """Return the identity, and the rotation of an arm whose joints all have the same axis."""
    return [*poses(exercise, 3)]


def lazy_position(part: PositionSpec, _exercise: Exercise) -> list[object]:
    """Return the answer that needs no knowledge: all coordinates are 0."""
    return [["0"] * len(part.coordinates)]


def lazy_matrix(part: MatrixSpec, _exercise: Exercise) -> list[object]:
    """Return two matrices: one of zeros, and one with 1 on the diagonal and 0 elsewhere."""
    rows, columns = len(part.quantities), len(part.quantities[0])
    zeros = [["0"] * columns for _ in range(rows)]
    ones = [["1" if i == j else "0" for j in range(columns)] for i in range(rows)]
    return [zeros, ones]


def lazy_link_transforms(part: LinkTransformsSpec, exercise: Exercise) -> list[object]:
    """Return the motion of each joint, and the identity for each row without a joint."""
    table = exercise.robot.tables[part.convention]
    fixed = len(table.rows) - len(table.joints)
    return [[*(motion([joint]) for joint in table.joints), *[IDENTITY] * fixed]]


def lazy_frames(part: FramesSpec, exercise: Exercise) -> list[object]:
    """Return frames on the correct joints that are all equal to the base frame."""
    standard = part.convention is Convention.STANDARD
    joints = [joint.index for joint in exercise.joints][int(standard) :]
    labels = frame_labels(exercise.robot, part.convention)
    rows = [
        dict(zip(FRAME_CELLS, [str(joint), "+z", "0", "0", "0", "+x"], strict=True))
        for joint, _ in zip(joints, labels, strict=False)
    ]
    return [rows]


def lazy_find_slip(part: FindSlipSpec, exercise: Exercise) -> list[object]:
    """Return the given table unchanged, with no cell marked."""
    return [{"table": {"rows": as_rows(slip_of(part, exercise).texts)}}]


def lazy_euler_angles(_part: EulerAnglesSpec, _exercise: Exercise) -> list[object]:
    """Return the answer that needs no knowledge: three zeros."""
    return [["0"] * 3]


def lazy_dh_table(part: DhTableSpec, exercise: Exercise) -> list[object]:
    """Return a table with the joint variables in their columns and 0 elsewhere."""
    robot, asked = exercise.robot, part.convention
    convention = asked if isinstance(asked, Convention) else robot.convention
    named = {"convention": convention.value} if asked == "either" else {}
    return [{"rows": robot.tables[convention].lazy_rows, **named}]


def lazy_dh_row(_part: DhRowSpec, _exercise: Exercise) -> list[object]:
    """Return a row of zeros, which needs no knowledge."""
    # "No row" is not included, because this guess may be right.
    return [dict.fromkeys(COLUMNS, "0")]


# The functions that return answers that need no knowledge.
LAZY: Final[Mapping[str, Callable[[Any, Exercise], list[object]]]] = {
    "dh_row": lazy_dh_row,
    "dh_table": lazy_dh_table,
    "euler_angles": lazy_euler_angles,
    "find_slip": lazy_find_slip,
    "frames": lazy_frames,
    "link_transforms": lazy_link_transforms,
    "matrix": lazy_matrix,
    "position": lazy_position,
    "rotation": lazy_rotation,
    "screw_axes": lazy_screw_axes,
    "transform": lazy_transform,
    "vector": lazy_vector,
}
