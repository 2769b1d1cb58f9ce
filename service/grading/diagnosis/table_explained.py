"""What is to be said of a wrong table as a whole."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from service.catalogue.parts.dh_table import DhTableSpec
from service.grading.comparison import Match, difference
from service.grading.diagnosis.table_freedom import lost_freedom
from service.grading.diagnosis.whole_table import (
    Explanation,
    WrittenTable,
    explanations,
    written_table,
)
from service.grading.feedback import Finding
from service.grading.judging.own_frames.few_cells import frames_from_reference
from service.grading.judging.own_frames.reference import reference_values
from service.grading.judging.own_frames.row_roles import Role, freedom_of
from service.grading.judging.own_frames.validity import valid_tables
from service.grading.judging.own_frames.wrong_convention_or_unit import in_convention
from service.grading.judging.table import Judgement, departures_of, judged_by_intended
from service.grading.part import Grading
from service.grading.reading.table import IS_ANGLE, values_of
from service.grading.report import Severity
from service.grading.tolerances import INTENDED_CELL, INTENDED_POSE
from service.kinematics.chain import Table
from service.kinematics.dh import Convention
from service.kinematics.transforms import Numbers

# Enough samples to tell tables apart that are tried by the dozen.
FEW = 3


@dataclass(frozen=True, slots=True)
class _Meant:
    """What a table was meant to be: ``(rows, 4, SAMPLES)``, None where that takes other rows.

    ``changed`` are the cells in which that differs from what was handed in, ``(rows, 4)``;
    ``departures`` is what its frames cost.
    """

    findings: tuple[Finding, ...]
    table: Table | None
    changed: NDArray[np.bool_]
    departures: float


def explained(
    part: DhTableSpec,
    roles: tuple[Role, ...],
    convention: Convention,
    judgement: Judgement,
    grading: Grading,
    *,
    combine: bool,
) -> tuple[tuple[Finding, ...], Judgement]:
    """What explains the whole of a wrong table at once, and the judgement that goes with it.

    An explanation must not contradict what is said of the cells. So it stands if its cells are
    those that were found wrong; or else if it takes the table nearer to the reference's frames than
    the judgement did: then the cells are judged by it.
    """
    values = values_of([role.row for role in roles if role.row is not None])
    if len(values) < len(roles) or not np.isfinite(values).all():
        return (), judgement
    table, found = _explanations(part, roles, convention, values, grading, combine=combine)
    meant = [_meant(explanation, table, roles, grading) for explanation in found]
    wrong = judgement.matches < Match.ROUNDED
    agreeing = [each for each in meant if each.table is None or np.array_equal(each.changed, wrong)]
    if agreeing:
        return _told(agreeing), judgement
    nearer = min(meant, key=lambda each: each.departures, default=None)
    if nearer is None or nearer.table is None or nearer.departures >= judgement.departures:
        return (), judgement
    return _told([nearer]), judged_by_intended(nearer.table, roles, convention, grading)


def _explanations(
    part: DhTableSpec,
    roles: tuple[Role, ...],
    convention: Convention,
    values: Table,
    grading: Grading,
    *,
    combine: bool,
) -> tuple[WrittenTable, list[Explanation]]:
    """The table taken apart, and the misconceptions that explain it."""
    robot, samples = grading.exercise.robot, grading.samples
    reference = robot.tables.get(convention)
    own = None if reference is None else reference_values(reference, samples)
    table = written_table(values, convention, own, robot.joints, samples)
    freedom, subset = freedom_of(part), samples.subset(FEW)

    def valid(tables: Numbers, convention: Convention) -> NDArray[np.bool_]:
        return valid_tables(
            tables, roles, convention, freedom, grading.exercise, subset, INTENDED_POSE
        )

    return table, explanations(table.subset(FEW), valid, combine=combine)


def _meant(
    explanation: Explanation, table: WrittenTable, roles: tuple[Role, ...], grading: Grading
) -> _Meant:
    meant = in_convention(explanation.repaired(table), table.convention)
    if meant is None:
        nothing = np.zeros(table.values.shape[:2], np.bool_)
        return _Meant(explanation.findings, None, nothing, np.inf)
    off = np.abs(difference(meant, table.values, IS_ANGLE[:, None])).max(axis=-1)
    apart = frames_from_reference(meant, roles, table.convention, grading)
    return _Meant(explanation.findings, meant, off > INTENDED_CELL, departures_of(apart, grading))


def _told(meant: Sequence[_Meant]) -> tuple[Finding, ...]:
    """Of several explanations with one code the first."""
    told: dict[str, Finding] = {}
    for each in meant:
        for finding in each.findings:
            told.setdefault(finding.code, finding)
    if "other_convention" in told:
        # To be one row off is the same thing seen from the other side.
        told.pop("link_columns_shifted", None)
    return tuple(told.values())


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
