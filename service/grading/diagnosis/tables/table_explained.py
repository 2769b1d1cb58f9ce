"""The findings on a wrong table as a whole."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from service.catalogue.parts.dh_table import DhTableSpec
from service.expressions import Symbol
from service.grading.diagnosis.tables.whole_table import WrongTable, explaining
from service.grading.feedback import Finding
from service.grading.judging.own_frames.nearest.few_cells import frames_from_reference
from service.grading.judging.own_frames.nearest.nearest_table import in_convention
from service.grading.judging.own_frames.reference import reference_values
from service.grading.judging.own_frames.row_roles import Role, freedom_of
from service.grading.judging.own_frames.validity import valid_tables
from service.grading.judging.own_frames.written_table import (
    WrittenTable,
    written_table,
)
from service.grading.judging.table import Judgement, departures_of, judged_by_intended
from service.grading.misconception import Explained
from service.grading.numerics.comparison import Match, difference
from service.grading.numerics.tolerances import INTENDED_CELL, INTENDED_POSE
from service.grading.part import Grading
from service.grading.reading.tables.table import IS_ANGLE, table_values, values_of
from service.kinematics.chain import Table
from service.kinematics.dh import Convention
from service.kinematics.transforms import Numbers

_OF_UNIT = frozenset({"degrees_as_radians", "radians_as_degrees"})

# If more lengths are in wrong cells, the search for two exchanged ones is not reliable.
MAX_LENGTHS = 4

# Samples of each half that are enough to compare dozens of tables.
TABLE_SAMPLES = 3


@dataclass(frozen=True, slots=True)
class _Intended:
    # The slips that are corrected in the table.
    findings: tuple[Finding, ...]
    # (rows, 4, SAMPLES), or None if it needs other rows than the student wrote.
    table: Table | None
    # The cells (rows, 4) that differ from the student's table.
    changed: NDArray[np.bool_]
    # How far its frames are from the reference's frames.
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
    """Return the findings that explain a whole wrong table, and a judgement that fits them.

    Pairs of misconceptions are tried only if ``combine`` is true.
    """
    # Misconceptions that would make the whole table correct are compared with the cells that were
    # found wrong. If none of them fits, there are no findings and the judgement is unchanged.
    values = values_of([role.row for role in roles if role.row is not None])
    if len(values) < len(roles) or not np.isfinite(values).all():
        return (), judgement
    exchanges = tuple(_exchanges(judgement, roles, grading))
    case = _wrong_table(part, roles, convention, values, exchanges, grading)
    found = explaining(case, combine=combine)
    intended: list[_Intended] = []
    wrong = judgement.matches < Match.ROUNDED
    for repaired in found:
        intended.append(_intended(repaired, case.written, roles, grading))
        findings, table = intended[-1].findings, intended[-1].table
        if table is not None and not np.array_equal(intended[-1].changed, wrong):
            # A table that is right in the other convention is no coincidence of single cells.
            if _is_other_convention(intended[-1], judgement):
                break
            continue
        if table is None or _OF_UNIT.intersection(finding.code for finding in findings):
            # Converted numbers are rounded, so they do not show the frames.
            return findings, replace(judgement, findings=())
        # The student's frames are those of the table without the slip.
        chosen = judged_by_intended(table, roles, convention, grading).findings
        return findings, replace(judgement, findings=chosen)
    nearest = min(intended, key=lambda each: each.departures, default=None)
    if nearest is None or nearest.table is None:
        return (), judgement
    is_nearer = nearest.departures < judgement.departures
    if not (is_nearer or _is_other_convention(nearest, judgement)):
        return (), judgement
    return nearest.findings, judged_by_intended(nearest.table, roles, convention, grading)


def _is_other_convention(intended: _Intended, judgement: Judgement) -> bool:
    codes = [finding.code for finding in intended.findings]
    return codes == ["other_convention"] and intended.departures <= judgement.departures


def _wrong_table(
    part: DhTableSpec,
    roles: tuple[Role, ...],
    convention: Convention,
    values: Table,
    exchanges: tuple[tuple[str, str, Table], ...],
    grading: Grading,
) -> WrongTable:
    exercise, samples = grading.exercise, grading.samples
    table = exercise.robot.tables.get(convention)
    reference = None if table is None else reference_values(table, samples)
    written = written_table(values, convention, reference, exercise.robot.joints, samples)
    written = replace(written, exchanges=exchanges)
    freedom, subset = freedom_of(part), samples.subset(TABLE_SAMPLES)

    def valid(tables: Numbers, convention: Convention) -> NDArray[np.bool_]:
        return valid_tables(tables, roles, convention, freedom, exercise, subset, INTENDED_POSE)

    return WrongTable(written, written.subset(TABLE_SAMPLES), valid)


def _exchanges(
    judgement: Judgement, roles: Sequence[Role], grading: Grading
) -> Iterator[tuple[str, str, Table]]:
    # How the table changes if two lengths in wrong cells are exchanged.
    by_name = grading.exercise.vocabulary.by_name
    lengths: set[str] = set()
    for i, column in np.argwhere(judgement.matches < Match.ROUNDED).tolist():
        row = judgement.rows[i].row
        expression = None if row is None else row.expressions[column]
        if expression is not None:
            lengths.update(name for name in expression.symbols if _is_length(by_name.get(name)))
    if not 2 <= len(lengths) <= MAX_LENGTHS:
        return
    rows = [role.row for role in roles if role.row is not None]
    written = table_values(rows, grading.samples)
    for one, other in combinations(sorted(lengths), 2):
        exchanged = grading.samples.renamed({one: other, other: one})
        yield one, other, table_values(rows, exchanged) - written


def _is_length(symbol: Symbol | None) -> bool:
    return symbol is not None and symbol.kind == "length" and symbol.joint is None


def _intended(
    repaired: Explained, written: WrittenTable, roles: tuple[Role, ...], grading: Grading
) -> _Intended:
    table = in_convention(repaired.answer, written.convention)
    if table is None:
        nothing = np.zeros(written.values.shape[:2], np.bool_)
        return _Intended(repaired.findings, None, nothing, np.inf)
    error = np.abs(difference(table, written.values, IS_ANGLE[:, None])).max(axis=-1)
    frames = frames_from_reference(table, roles, written.convention, grading)
    departures = departures_of(frames, grading)
    return _Intended(repaired.findings, table, error > INTENDED_CELL, departures)
