"""The formulas of a table: its cells, its equivalent in the other convention, and its pose."""

from collections.abc import Sequence
from dataclasses import dataclass

from service.expressions import Expression, ExpressionError, read, reading_cost
from service.figures.tables.pose_terms import LongPoseError, pose_texts
from service.figures.tables.scope import DrawingScope
from service.grading.diagnosis.formulas.formula_rewriting import nodes
from service.grading.reading.tables.table import StudentTable
from service.grading.work_budget import WorkBudget
from service.kinematics.chain import ALPHA, A, Row, modified_rows, standard_rows
from service.kinematics.dh import Convention

_ZERO_TEXT = "0"


@dataclass(frozen=True, slots=True)
class RowInFormulas:
    """A row of a table. Its label is its number, "b" for the base or "e" for the tool."""

    label: str
    cells: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class TableFormulas:
    """The formulas of a table.

    ``converted`` is an equivalent table in the other convention. ``pose`` has the entries ``(4,
    4)`` of the last frame's pose in the base frame.
    """

    # A cell that is unreadable or too long to print is None in ``cells``; then the other fields are
    # empty. ``pose`` is empty if its entries are too long.
    cells: tuple[tuple[Expression | None, ...], ...]
    converted: tuple[RowInFormulas, ...] = ()
    pose: tuple[tuple[Expression, ...], ...] = ()


def table_formulas(
    written: StudentTable, convention: Convention, scope: DrawingScope, budget: WorkBudget
) -> TableFormulas:
    """Return the formulas of a table, as far as the budget allows."""
    cells = tuple(
        tuple(cell if cell and _may_print(cell, budget) else None for cell in row.expressions)
        for row in written.rows
    )
    rows = [(a, alpha, d, theta) for a, alpha, d, theta in cells if a and alpha and d and theta]
    if not rows or len(rows) < len(cells):
        return TableFormulas(cells)
    zero = read(_ZERO_TEXT, scope.vocabulary)
    return TableFormulas(
        cells,
        # Its cells are copies of the table's, so printing them costs nothing extra.
        _converted(rows, convention, zero),
        _pose(rows, convention, zero, scope, budget),
    )


def _may_print(formula: Expression, budget: WorkBudget) -> bool:
    return budget.charge_printing(sum(1 for _ in nodes(formula.tree)))


def _converted(
    rows: Sequence[Row[Expression]], convention: Convention, zero: Expression
) -> tuple[RowInFormulas, ...]:
    # There is an extra fixed row if a and α need one.
    count = len(rows)
    if convention is Convention.STANDARD:
        found = modified_rows(rows, zero)
        labels = [*map(str, range(1, count + 1)), "e"]
        # The last row is for the tool. Leave it out if it is empty.
        kept = found if _has_x(found[-1]) else found[:-1]
    else:
        found = standard_rows(rows, zero)
        labels = [*map(str, range(1, count + 1))]
        kept = found
        if _has_x(rows[0]):
            labels = ["b", *labels]
            kept = [(*rows[0][:2], zero, zero), *found]
    return tuple(RowInFormulas(label, row) for label, row in zip(labels, kept, strict=False))


def _has_x(row: Row[Expression]) -> bool:
    return any(row[i].text() != _ZERO_TEXT for i in (A, ALPHA))


def _pose(
    rows: Sequence[Row[Expression]],
    convention: Convention,
    zero: Expression,
    scope: DrawingScope,
    budget: WorkBudget,
) -> tuple[tuple[Expression, ...], ...]:
    modified = rows if convention is Convention.MODIFIED else modified_rows(rows, zero)
    try:
        texts = pose_texts(modified)
        # Stop if reading the texts would exceed the budget.
        if not budget.charge_reading(sum(reading_cost(each) for row in texts for each in row)):
            return ()
        pose = tuple(tuple(read(each, scope.vocabulary) for each in row) for row in texts)
    except (LongPoseError, ExpressionError):
        return ()
    return pose if all(_may_print(entry, budget) for row in pose for entry in row) else ()
