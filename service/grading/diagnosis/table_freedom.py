"""Tables whose joints have lost a degree of freedom that the robot has.

Two joints that turn about one line, or slide along one direction, do the work of one; so does any
other set of joint screws that depend on each other. What the reference shares is no loss.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Exercise, Joint
from service.grading.feedback import Finding
from service.grading.joint_motion import changes
from service.grading.report import Severity
from service.grading.samples import Samples
from service.kinematics.chain import Table
from service.kinematics.dh import Convention
from service.kinematics.jacobian import Screws, coincident, dependent, rank, space_jacobian
from service.kinematics.tolerances import SAME_SCREW

# How many samples of each half stand for a generic configuration.
FEW = 2


@dataclass(frozen=True, slots=True)
class _Arm:
    """Joints with the rows that they have in a table, and their screws ``(samples, 6, joints)``.

    Lengths are measured in the exercise's typical length.
    """

    joints: tuple[Joint, ...]
    rows: tuple[int, ...]
    screws: Screws

    def directions(self, i: int) -> NDArray[np.float64]:
        """The axis of a joint, ``(samples, 3)``."""
        return self.screws[:, 3:, i] if self.joints[i].prismatic else self.screws[:, :3, i]


def lost_freedom(
    values: Table,
    joint_rows: Sequence[int | None],
    convention: Convention,
    exercise: Exercise,
    samples: Samples,
) -> tuple[Finding, ...]:
    """The joints of a table that get in each other's way, or move nothing.

    ``values`` is the student's table ``(rows, 4, SAMPLES)`` in ``convention``, NaN where a cell
    could not be read: then nothing can be said. ``joint_rows`` names the row of each of the robot's
    joints; one without a row is left out.
    """
    table = samples.subset_of(values, FEW)
    if not np.isfinite(table).all():
        return ()
    held = [(j, row) for j, row in enumerate(joint_rows) if row is not None]
    idle = [j for j, row in held if np.abs(changes(table[row])).max() < SAME_SCREW]
    moving = [(j, row) for j, row in held if j not in idle]
    still = (_without_effect([exercise.robot.joints[j] for j in idle]),) if idle else ()
    if len(moving) < 2:
        return still
    written = _arm(table, convention, moving, exercise)
    if rank(written.screws) == len(moving):
        return still
    subset = samples.subset(FEW)
    reference = exercise.robot.tables[exercise.robot.convention]
    own = reference.values(subset.values, subset.count)
    intended = _arm(own, reference.convention, [(j, j) for j, _ in moving], exercise)
    shared = _shared_axes(written, intended, convention)
    # A joint that moves nothing may also leave lengths at 0 that would keep the others apart.
    return (*still, *shared) if still or shared else _lost_rank(written, intended)


def _arm(
    table: Table, convention: Convention, rows: Sequence[tuple[int, int]], exercise: Exercise
) -> _Arm:
    joints = tuple(exercise.robot.joints[j] for j, _ in rows)
    places = tuple(row for _, row in rows)
    screws = space_jacobian(table, convention, places, [joint.prismatic for joint in joints])
    screws[:, 3:] /= np.where([joint.prismatic for joint in joints], 1.0, exercise.length_scale)
    return _Arm(joints, places, screws)


def _shared_axes(written: _Arm, intended: _Arm, convention: Convention) -> tuple[Finding, ...]:
    """A message for each axis that joints share: they are one joint several times."""
    joined = np.triu(coincident(written.screws) & ~coincident(intended.screws))
    found, told = [], set[int]()
    for i, others in enumerate(joined):
        together = [i, *np.flatnonzero(others).tolist()]
        if len(together) > 1 and not told.intersection(together):
            told.update(together)
            found.append(_one_axis(together, written, intended, convention))
    return tuple(found)


def _lost_rank(written: _Arm, intended: _Arm) -> tuple[Finding, ...]:
    left = rank(written.screws)
    possible = left if left == len(written.joints) else rank(intended.screws)
    if left >= possible:
        return ()
    return (_fewer_ways(_names(written, dependent(written.screws)), left, possible),)


def _names(arm: _Arm, involved: NDArray[np.bool_]) -> list[str]:
    return [
        str(joint.index) for joint, is_in in zip(arm.joints, involved, strict=True) if is_in
    ] or [str(joint.index) for joint in arm.joints]


def _one_axis(
    together: list[int], written: _Arm, intended: _Arm, convention: Convention
) -> Finding:
    """Joints were given one axis."""
    first, last = together[0], together[-1]
    if written.joints[first].prismatic:
        motion = "slide along one and the same direction"
    else:
        motion = "turn about one and the same line"
    named = _listed([str(written.joints[k].index) for k in together])
    between = _rows_between(first, last, written, convention)
    if len(together) > 2:
        return Finding(
            "lost_freedom",
            f"Joints {named} {motion}, so the arm has lost degrees of freedom: check a and α of "
            f"{between}.",
        )
    parallel, right = _lie(intended.directions(first), intended.directions(last))
    return Finding(
        "lost_freedom",
        f"Joints {named} {motion}, so the arm has lost a degree of freedom: check "
        f"{'a' if parallel else 'α'} of {between}.",
        f"The axes of these joints are {right}.",
    )


def _lie(one: NDArray[np.float64], other: NDArray[np.float64]) -> tuple[bool, str]:
    """Whether two axes ``(samples, 3)`` are parallel throughout, and how they lie, in words."""
    if np.abs(np.cross(one, other)).max() < SAME_SCREW:
        return True, "parallel, but apart"
    cosines = np.abs(np.sum(one * other, axis=-1))
    if np.ptp(cosines) > SAME_SCREW:
        return False, "not parallel"
    angle = np.degrees(np.arccos(min(cosines[0], 1.0)))
    return False, "at right angles" if cosines[0] < SAME_SCREW else f"at an angle of {angle:.4g}°"


def _rows_between(i: int, j: int, written: _Arm, convention: Convention) -> str:
    """The rows whose a and α lead from the one joint's axis to the other's.

    In a standard table they begin with the first joint's own row; in a modified one they end with
    the second's.
    """
    joints = (
        written.joints[i:j] if convention is Convention.STANDARD else written.joints[i + 1 : j + 1]
    )
    labels = [str(joint.index) for joint in joints]
    return f"row {labels[0]}" if len(labels) == 1 else f"rows {_listed(labels)}"


def _without_effect(joints: Sequence[Joint]) -> Finding:
    """A joint was left out of the table's formulas."""
    names = [str(joint.index) for joint in joints]
    variables = _listed([joint.variable for joint in joints])
    is_one = len(names) == 1
    return Finding(
        "lost_freedom",
        f"{'Joint' if is_one else 'Joints'} {_listed(names)} {'moves' if is_one else 'move'} "
        f"nothing: {'its row contains' if is_one else 'their rows contain'} no joint variable.",
        f"Where {variables} {'changes' if is_one else 'change'}, the arm moves.",
        severity=Severity.WARNING,
    )


def _fewer_ways(names: list[str], left: int, possible: int) -> Finding:
    """Joints were placed so that one of them can do nothing that the others cannot do as well."""
    return Finding(
        "lost_freedom",
        f"The axes of joints {_listed(names)} lie so that the arm has only {left} degrees of "
        f"freedom in place of {possible}: check a and α between these joints.",
    )


def _listed(words: Sequence[str]) -> str:
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)
