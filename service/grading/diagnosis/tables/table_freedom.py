"""Tables whose joints have fewer degrees of freedom than the robot."""

# Two joints that turn about one line, or slide along one direction, move the arm like a single
# joint. More generally, the arm loses a degree of freedom if joint screws are linearly dependent,
# but independent in the reference.

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Exercise, Joint
from service.grading.feedback import Finding
from service.grading.judging.own_frames.row_roles import Role
from service.grading.misconception import register
from service.grading.numerics.joint_motion import changes
from service.grading.numerics.samples import Samples
from service.grading.part import Grading
from service.grading.reading.tables.table import StudentTable, values_of
from service.kinematics.chain import THETA, D, Table
from service.kinematics.dh import Convention
from service.kinematics.jacobian import Screws, coincident, dependent, rank, space_jacobian
from service.kinematics.tolerances import SAME_SCREW
from service.translations import Sentence, listed, say

# The samples of each half at which the rank is computed.
POSTURES = 2
# Lengths over this multiple of the typical length make a numerical rank meaningless.
TOO_LONG = 300.0
_LOST = register(
    of=StudentTable,
    code="lost_freedom",
    rule="joint_variable",
    means="some joints share an axis or depend on each other, so the arm has fewer degrees of "
    "freedom than the robot; the message itself costs no points",
    example=("planar-rrr-drawn", "table", {"2/a": "0"}),
    unlike={"1/theta": "q2"},
)


@dataclass(frozen=True, slots=True)
class _Arm:
    joints: tuple[Joint, ...]
    # (samples, 6, joints), in units of the typical length.
    screws: Screws

    def directions(self, i: int) -> NDArray[np.float64]:
        return self.screws[:, 3:, i] if self.joints[i].prismatic else self.screws[:, :3, i]


def freedom_lost(
    roles: tuple[Role, ...], convention: Convention, grading: Grading
) -> tuple[Finding, ...]:
    """Return findings on joints that share an axis or whose motions depend on each other."""
    present = [role for role in roles if role.row is not None]
    joints = grading.exercise.robot.joints
    where = [next((i for i, role in enumerate(present) if role.joint is j), None) for j in joints]
    if None in where:
        return ()
    values = values_of([role.row for role in present if role.row])
    return lost_freedom(values, where, convention, grading.exercise, grading.samples)


def lost_freedom(
    values: Table,
    joint_rows: Sequence[int | None],
    convention: Convention,
    exercise: Exercise,
    samples: Samples,
) -> tuple[Finding, ...]:
    """Return findings on joints that share an axis or whose motions depend on each other.

    ``values`` is the student's table ``(rows, 4, SAMPLES)``. ``joint_rows`` is the row of each
    joint of the robot.
    """
    # NaN is an unreadable cell; joints with the row None are left out. The result is empty if a
    # cell is unreadable or extremely large, or if a joint variable is missing.
    table = samples.subset_of(values, POSTURES)
    if not np.isfinite(table).all():
        return ()
    present = [(j, row) for j, row in enumerate(joint_rows) if row is not None]
    own = [D if joint.prismatic else THETA for joint in exercise.robot.joints]
    if any(np.abs(changes(table[row, own[j]])).max() < SAME_SCREW for j, row in present):
        # This joint has no variable; that alone may be why other joints depend on each other.
        return ()
    written = _arm(table, convention, present, exercise)
    if rank(written.screws) == len(present) or np.abs(written.screws).max() > TOO_LONG:
        return ()
    subset = samples.subset(POSTURES)
    reference = exercise.robot.tables[exercise.robot.convention]
    right = reference.values(subset.values, subset.count)
    intended = _arm(right, reference.convention, [(j, j) for j, _ in present], exercise)
    return _shared_axes(written, intended, convention) or _lost_rank(written, intended, convention)


def _arm(
    table: Table, convention: Convention, rows: Sequence[tuple[int, int]], exercise: Exercise
) -> _Arm:
    joints = tuple(exercise.robot.joints[j] for j, _ in rows)
    prismatic = [joint.prismatic for joint in joints]
    screws = space_jacobian(table, convention, tuple(row for _, row in rows), prismatic)
    screws[:, 3:] /= np.where(prismatic, 1.0, exercise.length_scale)
    return _Arm(joints, screws)


def _shared_axes(written: _Arm, intended: _Arm, convention: Convention) -> tuple[Finding, ...]:
    joined = np.triu(coincident(written.screws) & ~coincident(intended.screws))
    findings, done = [], set[int]()
    for i, others in enumerate(joined):
        together = [i, *np.flatnonzero(others).tolist()]
        if len(together) > 1 and not done.intersection(together):
            done.update(together)
            findings.append(_one_axis(together, written, intended, convention))
    return tuple(findings)


def _lost_rank(written: _Arm, intended: _Arm, convention: Convention) -> tuple[Finding, ...]:
    if rank(written.screws) >= rank(intended.screws):
        return ()
    involved = dependent(written.screws)
    if involved.sum() < 2:
        # A single joint cannot be dependent: the samples disagree, so all joints are named.
        involved = np.ones_like(involved)
    names = [str(joint.index) for joint, yes in zip(written.joints, involved, strict=True) if yes]
    first, *_, last = np.flatnonzero(involved).tolist()
    finding = _LOST.finding(
        say(
            "The axes of joints {joints} leave the arm fewer degrees of freedom than the robot "
            "has: check a and α of {rows}.",
            joints=listed(names),
            rows=_rows_between(first, last, written, convention),
        ),
    )
    return (finding,)


def _one_axis(
    together: list[int], written: _Arm, intended: _Arm, convention: Convention
) -> Finding:
    first, last = together[0], together[-1]
    slide = written.joints[first].prismatic
    named = listed([str(written.joints[k].index) for k in together])
    rows = _rows_between(first, last, written, convention)
    if len(together) > 2:
        return _LOST.finding(_lost_degrees(named, rows, slide=slide))
    parallel, right = _lie(intended.directions(first), intended.directions(last))
    return _LOST.finding(_lost_degree(named, "a" if parallel else "α", rows, slide=slide), right)


def _lost_degree(joints: str, column: str, rows: str, *, slide: bool) -> Sentence:
    if slide:
        return say(
            "Joints {joints} slide along one and the same direction, so the arm has lost a degree "
            "of freedom: check {column} of {rows}.",
            joints=joints,
            column=column,
            rows=rows,
        )
    return say(
        "Joints {joints} turn about one and the same line, so the arm has lost a degree of "
        "freedom: check {column} of {rows}.",
        joints=joints,
        column=column,
        rows=rows,
    )


def _lost_degrees(joints: str, rows: str, *, slide: bool) -> Sentence:
    if slide:
        return say(
            "Joints {joints} slide along one and the same direction, so the arm has lost degrees "
            "of freedom: check a and α of {rows}.",
            joints=joints,
            rows=rows,
        )
    return say(
        "Joints {joints} turn about one and the same line, so the arm has lost degrees of "
        "freedom: check a and α of {rows}.",
        joints=joints,
        rows=rows,
    )


def _lie(one: NDArray[np.float64], other: NDArray[np.float64]) -> tuple[bool, Sentence]:
    # True if two axes (samples, 3) are parallel, and a sentence on their directions.
    if np.abs(np.cross(one, other)).max() < SAME_SCREW:
        return True, say("The axes of these joints are parallel, but apart.")
    cosines = np.abs(np.sum(one * other, axis=-1))
    if np.ptp(cosines) > SAME_SCREW:
        return False, say("The axes of these joints are not parallel.")
    if cosines[0] < SAME_SCREW:
        return False, say("The axes of these joints are at right angles.")
    angle = np.degrees(np.arccos(min(cosines[0], 1.0)))
    return False, say("The axes of these joints are at an angle of {angle}°.", angle=f"{angle:.4g}")


def _rows_between(i: int, j: int, written: _Arm, convention: Convention) -> str:
    # The rows whose a and α lead from the axis of joint i to that of joint j.
    # In a standard row, a and α come after its joint; in a modified one, before it.
    shift = int(convention is Convention.MODIFIED)
    labels = [str(joint.index) for joint in written.joints[i + shift : j + shift]]
    if len(labels) == 1:
        return say("row {row}", row=labels[0])
    return say("rows {rows}", rows=listed(labels))
