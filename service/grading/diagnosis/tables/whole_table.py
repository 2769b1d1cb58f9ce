"""Slips that run through a whole table.

A misconception undone gives another table; where that table describes the robot, the misconception
explains the answer.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import chain, combinations, islice

import numpy as np
from numpy.typing import NDArray

from service.grading.diagnosis.wording import MEASURED, POSITIVE, SYMBOLS
from service.grading.feedback import Finding
from service.grading.judging.own_frames import written_table
from service.grading.judging.own_frames.written_table import RepairedTable, WrittenTable
from service.grading.misconception import AnyHypothesis, Repaired, hypotheses_of
from service.grading.numerics.tolerances import INTENDED_CELL, INTENDED_POSE
from service.kinematics.chain import ALPHA, COLUMNS, THETA, A, D, Table
from service.kinematics.dh import Convention

_OF_LINK = slice(A, ALPHA + 1)

Misconception = Callable[[WrittenTable], Iterator[RepairedTable]]


@dataclass(frozen=True, slots=True)
class WrongTable:
    """A wrong table at all samples, and at a subset that is enough to compare it.

    ``valid`` tells which tables ``(T, rows, 4, samples)``, at the subset, describe the robot.
    """

    written: WrittenTable
    subset: WrittenTable
    valid: Callable[[Table, Convention], NDArray[np.bool_]]

    def explained_by(self, hypotheses: Iterable[AnyHypothesis]) -> list[AnyHypothesis]:
        """Those hypotheses, at the subset, that change the table to a valid one; all at once."""
        tried = list(hypotheses)
        explains = np.zeros(len(tried), dtype=np.bool_)
        for convention in Convention:
            places = [i for i, each in enumerate(tried) if each.answer.convention is convention]
            if places:
                tables = np.array([tried[i].answer.values for i in places])
                explains[places] = self.valid(tables, convention)
                if convention is self.subset.convention:
                    change = np.abs(tables - self.subset.values).max(axis=(1, 2, 3))
                    explains[places] &= change > INTENDED_POSE
        return [tried[i] for i in np.flatnonzero(explains)]


def link_columns_shifted(table: WrittenTable) -> Iterator[RepairedTable]:
    """The link's own columns, a and α or one of them, stand one row too early or too late.

    The row that the shift leaves open holds what was shifted out at the other end, or nothing.
    """
    rows = list(range(len(table.constants)))
    up, down = [*rows[1:], rows[0]], [rows[-1], *rows[:-1]]
    for columns in (_OF_LINK, slice(A, A + 1), slice(ALPHA, ALPHA + 1)):
        for late, order, end in ((True, up, -1), (False, down, 0)):
            of_other = late == (table.convention is Convention.STANDARD)
            other = table.convention.other if of_other and columns == _OF_LINK else None
            finding = partial(_shifted, " and ".join(SYMBOLS[columns]), late, other)
            constants = table.constants.copy()
            constants[:, columns] = table.constants[order, columns]
            yield Repaired(table.changed(constants), finding)
            is_open = np.abs(table.values[-1 - end, columns]).max() < INTENDED_CELL
            if table.reference is not None and is_open:
                # The row that fell off the end is not in the student's table.
                completed = constants.copy()
                completed[end, columns] = table.reference[end, columns]
                yield Repaired(table.changed(completed), finding)


def _shifted(named: str, late: bool, other: Convention | None) -> Finding:
    """``other`` is the convention in which they stand there, if it is so in one."""
    in_other = f" In the {other} convention they stand there." if other else ""
    return Finding(
        "link_columns_shifted",
        f"{named} stand one row too {'late' if late else 'early'}: check which link each of them "
        f"describes.{in_other}",
        f"Move {named} {'up' if late else 'down'} by one row.",
    )


def column_sign(table: WrittenTable) -> Iterator[RepairedTable]:
    """One kind of parameter was measured in the wrong sense throughout."""
    for column in range(len(COLUMNS)):
        if table.constants[:, column].any():
            constants = table.constants.copy()
            constants[:, column] *= -1
            yield Repaired(table.changed(constants), partial(_turned_sign, column))


def _turned_sign(column: int) -> Finding:
    return Finding(
        "column_sign",
        f"{SYMBOLS[column]} has the wrong sign throughout: it is measured {MEASURED[column]}, "
        f"positive {POSITIVE[column]}.",
        f"Change the sign of every {SYMBOLS[column]}.",
    )


def columns_swapped(table: WrittenTable) -> Iterator[RepairedTable]:
    """A parameter on x was taken for the one on z: a for d, or α for θ.

    In the whole table or in one row; the joint variables may have gone along or not.
    """
    for one, other in ((A, D), (ALPHA, THETA)):
        still = np.abs(table.constants[:, one] - table.constants[:, other]).max(axis=-1) > 0
        moving = np.abs(table.motion[:, one] - table.motion[:, other]).max(axis=-1) > 0
        for row in (None, *range(len(still))):
            rows = slice(None) if row is None else slice(row, row + 1)
            finding = partial(exchanged_columns, one, other)
            constants = _exchanged(table.constants, rows, one, other)
            if still[rows].any():
                yield Repaired(table.changed(constants), finding)
            if moving[rows].any():
                motion = _exchanged(table.motion, rows, one, other)
                yield Repaired(table.changed(constants, motion), finding)


def _exchanged(cells: Table, rows: slice, one: int, other: int) -> Table:
    exchanged = cells.copy()
    exchanged[rows, [one, other]] = cells[rows, [other, one]]
    return exchanged


def exchanged_columns(one: int, other: int) -> Finding:
    """The finding that two columns stand in each other's places, throughout or in a row."""
    names = SYMBOLS[one], SYMBOLS[other]
    return Finding(
        "columns_swapped",
        f"{names[0]} and {names[1]} are exchanged: {names[0]} is measured {MEASURED[one]}, "
        f"{names[1]} {MEASURED[other]}.",
        f"Exchange {names[0]} and {names[1]}.",
    )


def row_order(table: WrittenTable) -> Iterator[RepairedTable]:
    """Two rows, or all of them, stand in the wrong order."""
    rows = range(len(table.constants))
    exchanges = [{i: j, j: i} for i, j in combinations(rows, 2)]
    orders = [[exchange.get(row, row) for row in rows] for exchange in exchanges]
    for order in [*orders, list(reversed(rows))] if len(rows) > 2 else orders:
        repaired = table.changed(table.constants[order], table.motion[order])
        yield Repaired(repaired, partial(_reordered, order))


def _reordered(order: list[int]) -> Finding:
    moved = [str(i + 1) for i, row in enumerate(order) if row != i]
    return Finding(
        "row_order",
        f"Rows {' and '.join(moved) if len(moved) == 2 else ', '.join(moved)} stand in the wrong "
        f"order: row i belongs to joint i, counted from the base.",
    )


def lengths_exchanged(table: WrittenTable) -> Iterator[RepairedTable]:
    """Two lengths were taken for each other."""
    for one, other, change in table.exchanges:
        finding = partial(_exchanged_lengths, one, other)
        yield Repaired(table.changed(table.constants + change), finding)


def _exchanged_lengths(one: str, other: str) -> Finding:
    return Finding(
        "lengths_exchanged",
        f"{one} and {other} are exchanged: check which length each of them is.",
        f"Exchange {one} and {other}.",
    )


BASIC = written_table.MISCONCEPTIONS
MISCONCEPTIONS = (
    *BASIC,
    lengths_exchanged,
    link_columns_shifted,
    column_sign,
    columns_swapped,
    row_order,
)


def _with_another(
    basic: Misconception, others: Sequence[Misconception], table: WrittenTable
) -> Iterator[RepairedTable]:
    """A basic misconception and another one were held at once."""
    for first in basic(table):
        for second in hypotheses_of(first.answer, others):
            yield Repaired(second.answer, partial(_both, first, second))


def _both(first: RepairedTable, second: RepairedTable) -> tuple[Finding, ...]:
    return (*first.findings, *second.findings)


PAIRS = tuple(
    partial(_with_another, basic, MISCONCEPTIONS[i + 1 :]) for i, basic in enumerate(BASIC)
)


def explaining(case: WrongTable, *, combine: bool) -> list[RepairedTable]:
    """All hypotheses that explain the whole table; else the first pair, if ``combine`` allows."""
    found = list(_explaining(case, MISCONCEPTIONS))
    return found or (list(islice(_explaining(case, PAIRS), 1)) if combine else [])


def _explaining(
    case: WrongTable, misconceptions: Sequence[Misconception]
) -> Iterator[RepairedTable]:
    """The hypotheses that explain the table at the subset, built again at all samples."""
    tried = [(misconception, list(misconception(case.subset))) for misconception in misconceptions]
    every = chain.from_iterable(hypotheses for _, hypotheses in tried)
    explains = set(map(id, case.explained_by(every)))
    for misconception, hypotheses in tried:
        if not explains.isdisjoint(map(id, hypotheses)):
            # At all samples a misconception may yield nothing where a value jumps in between.
            for at_subset, complete in zip(hypotheses, misconception(case.written), strict=False):
                if id(at_subset) in explains:
                    yield complete
