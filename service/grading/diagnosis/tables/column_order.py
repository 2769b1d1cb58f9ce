"""Tables whose columns are not in the expected order, but for example θ, d, a, α."""

# The columns have no headers, or the cells were typed one by one under the headers a, α, d, θ.

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import permutations
from typing import Final

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Joint
from service.expressions import Expression, Symbol
from service.grading.diagnosis.formulas.quantity import quantity_of
from service.grading.diagnosis.tables.intended_table import IntendedTable
from service.grading.diagnosis.wording import SYMBOLS
from service.grading.feedback import Finding
from service.grading.misconception import register
from service.grading.numerics.comparison import difference
from service.grading.numerics.tolerances import INTENDED_CELL
from service.grading.part import Grading
from service.grading.reading.tables.table import IS_ANGLE, StudentRow, StudentTable, values_of
from service.grading.report import Verdict
from service.kinematics.chain import ALPHA, COLUMNS, THETA, A, D
from service.translations import paragraph, say

# For each written column, from left to right, the column that it is meant to be.
Order = tuple[int, ...]

# The orders of the Robotics Toolbox, of Craig and of Wikipedia; they are preferred among equals.
_USUAL: Final[tuple[Order, ...]] = (
    (THETA, D, A, ALPHA),
    (ALPHA, A, D, THETA),
    (D, THETA, A, ALPHA),
)
# For each column, one of the other quantity: an angle for a length.
_OTHER_QUANTITY: Final[Order] = (ALPHA, A, THETA, D)
# At most this many orders are judged; the first is almost always right.
_MAX_ORDERS: Final = 2
_PERMUTED = register(
    of=StudentTable,
    code="columns_permuted",
    rule="convention",
    means="the columns are in another order, such as θ, d, a, α, without headers that say so",
    example=("planar-rr", "table", "theta1, 0, a1, 0 ↵ theta2, 0, a2, 0"),
    unlike={"1/a": "0"},
)


def in_other_orders(table: StudentTable, grading: Grading) -> Iterator[IntendedTable]:
    """Yield the table in each order of columns that fits the cells better than the written one."""
    # For example, a column with joint variables must be d or θ, and a column with lengths a or d.
    # Only the orders that suit the cells best are tried, the likeliest first.
    if table.reread is None or _suits(table, grading):
        return
    other = table.reread([COLUMNS[column] for column in _OTHER_QUANTITY])
    if len(other.rows) != len(table.rows):
        return
    misfits = _misfits(table, other, grading.exercise.joints)
    orders = [*_USUAL, *(order for order in permutations(range(4)) if order not in _USUAL)]
    found = [int(misfits[range(4), order].sum()) for order in orders]
    if min(found) >= np.trace(misfits):
        return
    tried = [table]
    for order in (
        order for order, misfit in zip(orders, found, strict=True) if misfit == min(found)
    ):
        intended = _reordered(order, table, other)
        if any(_is_same(intended, one) for one in tried):
            continue
        if len(tried) > _MAX_ORDERS:
            return
        tried.append(intended)
        finding = _finding(order, named=table.named)
        yield IntendedTable(intended, finding, _moved(intended, table))


def _suits(table: StudentTable, grading: Grading) -> bool:
    sliding = _sliding(grading.exercise.joints)
    known = grading.exercise.vocabulary.by_name
    return all(
        entry.verdict is Verdict.MISSING
        if entry.expression is None
        else _suits_column(entry.expression, column, sliding, known)
        for row in table.rows
        for column, entry in enumerate(row.entries)
    )


def _suits_column(
    expression: Expression, column: int, sliding: Mapping[str, bool], known: Mapping[str, Symbol]
) -> bool:
    # A name before a value may name its column.
    if any(note.code == "equation" for note in expression.notes):
        return False
    moving = [sliding[name] for name in expression.symbols if name in sliding]
    if moving:
        return column == (D if moving[0] else THETA)
    if not IS_ANGLE[column]:
        return expression.source.isdecimal() or quantity_of(expression.tree) != "angle"
    # An angle column is suspicious only if its cell contains a length.
    return all(name in known and known[name].kind != "length" for name in expression.symbols)


def _sliding(joints: Sequence[Joint]) -> dict[str, bool]:
    return {joint.variable: joint.prismatic for joint in joints}


def _misfits(table: StudentTable, other: StudentTable, joints: Sequence[Joint]) -> NDArray[np.int_]:
    # Counts the cells of each written column that cannot be a, α, d or θ: (4, 4). The table other
    # has lengths read as angles and angles read as lengths.
    sliding = _sliding(joints)
    count = np.zeros((len(COLUMNS), len(COLUMNS)), np.int_)
    for one, two in zip(table.rows, other.rows, strict=True):
        for place in range(len(COLUMNS)):
            # Read as an angle, a bare number may get a unit that the student did not write.
            as_length = two if IS_ANGLE[place] else one
            expression = as_length.expressions[_OTHER_QUANTITY[place] if IS_ANGLE[place] else place]
            if expression is None or expression.source == "0":
                continue
            moving = [sliding[name] for name in expression.symbols if name in sliding]
            if moving:
                count[place] += np.arange(len(COLUMNS)) != (D if moving[0] else THETA)
            elif (found := quantity_of(expression.tree)) in ("angle", "length"):
                count[place] += (found == "angle") != IS_ANGLE
    return count


def _reordered(order: Order, table: StudentTable, other: StudentTable) -> StudentTable:
    rows = tuple(
        _reordered_row(order, one, two) for one, two in zip(table.rows, other.rows, strict=True)
    )
    # The note on the order of columns is no longer true.
    findings = tuple(each for each in table.findings if each.code != "column_order")
    return replace(table, rows=rows, values=values_of(rows), findings=findings)


def _reordered_row(order: Order, one: StudentRow, two: StudentRow) -> StudentRow:
    cells = []
    for column in range(len(COLUMNS)):
        place = order.index(column)
        is_other = IS_ANGLE[place] != IS_ANGLE[column]
        row, place = (two, _OTHER_QUANTITY[place]) if is_other else (one, place)
        cells.append((row.entries[place], row.values[place]))
    entries, values = zip(*cells, strict=True)
    return StudentRow(entries, np.array(values))


def _is_same(one: StudentTable, other: StudentTable) -> bool:
    return bool(np.nan_to_num(np.abs(one.values - other.values)).max() < INTENDED_CELL)


def _moved(intended: StudentTable, table: StudentTable) -> frozenset[tuple[int, int]]:
    error = np.abs(difference(intended.values, table.values, IS_ANGLE[:, None])).max(axis=-1)
    return frozenset((i, column) for i, column in np.argwhere(error > INTENDED_CELL).tolist())


def _finding(order: Order, *, named: bool) -> Finding:
    written = ", ".join(SYMBOLS[column] for column in order)
    advice = say(
        "A table without headers has the order a, α, d, θ: put headers above the columns, or "
        "change their order."
    )
    if named:
        advice = say("Write each parameter under its own header: a, α, d, θ.")
    return _PERMUTED.finding(
        paragraph(say("The columns stand in the order {order}.", order=written), advice),
        say("Write the columns in the order a, α, d, θ."),
    )
