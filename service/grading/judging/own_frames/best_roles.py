"""Choose which joint each submitted row belongs to."""

from collections.abc import Sequence
from dataclasses import replace

from service.catalogue import Joint
from service.catalogue.parts.dh_table import DhTableSpec
from service.grading.judging.own_frames.nearest.few_cells import NearestTable
from service.grading.judging.own_frames.nearest.nearest_table import nearest_for_roles
from service.grading.judging.own_frames.rounding.rounded_angles import with_exact_angles
from service.grading.judging.own_frames.rounding.rounded_cells import (
    with_rounded_cells,
    with_true_numbers,
)
from service.grading.judging.own_frames.row_roles import FrameFreedom, Role, freedom_of, roles_of
from service.grading.part import Grading
from service.grading.reading.tables.table import StudentRow
from service.kinematics.dh import Convention
from service.kinematics.frames.frame_choice import WRONG_CELL


def best_roles(
    part: DhTableSpec, rows: tuple[StudentRow, ...], convention: Convention, grading: Grading
) -> tuple[tuple[Role, ...], NearestTable]:
    """Return each row with its joint, and the nearest table that describes the robot."""
    freedom = freedom_of(part)
    roles, nearest = _best_as_written(rows, convention, freedom, grading)
    return roles, with_rounded_cells(nearest, convention, freedom, grading)


def _best_as_written(
    rows: tuple[StudentRow, ...], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> tuple[tuple[Role, ...], NearestTable]:
    joints = grading.exercise.robot.joints
    roles = roles_in(rows, convention, grading)
    roles = with_true_numbers(roles, convention, freedom, grading)
    nearest = nearest_with_tool_row(roles, convention, freedom, grading)
    if nearest.cost < WRONG_CELL:
        return roles, nearest
    other, price = None, 0.0
    if len(nearest.roles) < len(rows):
        # The row of zeros that was left out may belong to a joint.
        other = roles_in(rows, convention, grading, expected_rows=len(rows))
    elif len(rows) == len(joints) and len(rows) < usual_rows(convention, grading):
        # The missing row need not be the last.
        other, price = roles_in(rows, convention, grading, in_order=False), WRONG_CELL
    elif len(rows) > len(joints):
        # A joint's row may look like a fixed row because its variable is wrong.
        other = roles_in(rows, convention, grading, in_order=True)
    if other is None or _pairing(other) == _pairing(roles):
        return roles, nearest
    found = nearest_for_roles(other, convention, freedom, grading)
    lost = min(found.lost, nearest.lost)
    if found.cost + price < nearest.cost:
        return other, replace(found, lost=lost)
    return roles, replace(nearest, lost=lost)


def roles_in(
    rows: tuple[StudentRow, ...],
    convention: Convention,
    grading: Grading,
    expected_rows: int | None = None,
    *,
    in_order: bool | None = None,
) -> tuple[Role, ...]:
    """Return each submitted row with its joint, and with rounded angles made exact."""
    # ``in_order`` is true if the rows are in the order of the joints, None if unknown.
    expected_rows = expected_rows or usual_rows(convention, grading)
    rows = without_idle_rows(rows, expected_rows)
    joints = grading.exercise.robot.joints
    roles = roles_of(rows, joints, grading.samples, expected_rows, in_order=in_order)
    return with_exact_angles(roles, grading.exercise, grading.samples)


def nearest_with_tool_row(
    roles: tuple[Role, ...], convention: Convention, freedom: FrameFreedom, grading: Grading
) -> NearestTable:
    """Return the valid table nearest to the rows, which may lack the row of the tool."""
    nearest = nearest_for_roles(roles, convention, freedom, grading)
    if nearest.cost < WRONG_CELL or len(roles) >= usual_rows(convention, grading):
        return nearest
    longer = nearest_for_roles((*roles, Role(None, None)), convention, freedom, grading)
    is_longer = longer.cost + WRONG_CELL <= nearest.cost
    return replace(longer if is_longer else nearest, lost=min(longer.lost, nearest.lost))


def without_idle_rows(rows: tuple[StudentRow, ...], expected_rows: int) -> tuple[StudentRow, ...]:
    """Return the rows without extra rows at the end that move nothing."""
    while len(rows) > expected_rows and rows[-1].is_zero:
        rows = rows[:-1]
    return rows


def rows_of_mechanism(
    rows: tuple[StudentRow, ...], convention: Convention, grading: Grading
) -> list[int]:
    """Return the indices of the rows that belong to the robot, without extra rows."""
    # The choice depends only on the joint variables in the rows, not on what is correct.
    usual, joints = usual_rows(convention, grading), grading.exercise.robot.joints
    if len(rows) <= usual:
        return list(range(len(rows)))
    roles = [role for role in roles_of(rows, joints, grading.samples, usual) if role.row]
    last = max((i for i, role in enumerate(roles) if role.joint), default=-1)
    of_joints = [i for i, role in enumerate(roles) if role.joint]
    return [*of_joints, *range(last + 1, len(roles))[: usual - len(joints)]]


def usual_rows(convention: Convention, grading: Grading) -> int:
    """Return the number of rows that a table of this robot usually has."""
    robot = grading.exercise.robot
    reference = robot.tables.get(convention)
    return len(robot.joints if reference is None else reference.rows)


def _pairing(roles: Sequence[Role]) -> list[tuple[Joint | None, bool]]:
    return [(role.joint, role.row is None) for role in roles]
