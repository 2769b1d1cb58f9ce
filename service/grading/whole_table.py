"""What is to be said of a wrong table as a whole."""

import numpy as np
from numpy.typing import NDArray

from service.catalogue import DhTableSpec
from service.grading.compare import Numbers
from service.grading.diagnosis.freedom import lost_freedom
from service.grading.diagnosis.tables import TOLERANCE, explanations, written_table
from service.grading.findings import Finding
from service.grading.frames.mechanism import reference_values
from service.grading.frames.roles import Role
from service.grading.frames.validity import valid_tables
from service.grading.judgement import freedom_of
from service.grading.protocol import Grading
from service.grading.report import Severity
from service.grading.tables import values_of
from service.kinematics.dh import Convention

# Enough samples to tell tables apart that are tried by the dozen.
FEW = 3


def beliefs(
    roles: tuple[Role, ...],
    convention: Convention,
    part: DhTableSpec,
    grading: Grading,
    *,
    combine: bool,
) -> tuple[Finding, ...]:
    """What explains the whole of a wrong table at once."""
    robot, samples = grading.exercise.robot, grading.samples
    rows = [role.row for role in roles if role.row is not None]
    if len(rows) < len(roles):
        return ()
    values = values_of(rows)
    if not np.isfinite(values).all():
        return ()
    reference = robot.tables.get(convention)
    few = samples.few(FEW)
    expected = None if reference is None else reference_values(reference, few)
    table = written_table(values, convention, expected, robot.joints, samples).at_few(FEW)
    freedom = freedom_of(part)

    def valid(tables: Numbers, convention: Convention) -> NDArray[np.bool_]:
        return valid_tables(tables, roles, convention, freedom, grading.exercise, few, TOLERANCE)

    return explanations(table, valid, combine=combine)


def freedom_lost(
    roles: tuple[Role, ...], convention: Convention, grading: Grading
) -> tuple[Finding, ...]:
    """Joints of the written table that share an axis or have no effect."""
    held = [role for role in roles if role.row is not None]
    joints = grading.exercise.robot.joints
    where = [next((i for i, role in enumerate(held) if role.joint is j), None) for j in joints]
    if None in where:
        return ()
    values = values_of([role.row for role in held if role.row])
    found = lost_freedom(values, where, convention, grading.exercise, grading.samples)
    # A joint without variable is told of in its own cell.
    return tuple(finding for finding in found if finding.severity is Severity.ERROR)
