"""The mistakes that can be put into a correct table, by the code of the message about them.

Each function yields changes: new texts for some cells of the table.
"""

# The grader may explain a change by another code; ``find_slip`` refuses such changes.

import math
from collections.abc import Callable, Iterator, Mapping
from itertools import combinations
from typing import Final, TypeAlias

from service.catalogue import Joint
from service.kinematics.chain import ALPHA, THETA, A, D
from service.kinematics.dh import Convention
from service.learning.table_texts import (
    CellText,
    ModelTable,
    TableCell,
    angle_text,
)

SlipChange: TypeAlias = Mapping[TableCell, str]
SlipMaker: TypeAlias = Callable[[ModelTable], Iterator[SlipChange]]

_LENGTHS: Final = (A, D)
# The numbers by which an angle is measured in radians that are written as degrees.
_RADIANS_FIGURES: Final = 5


def _each(table: ModelTable) -> Iterator[tuple[TableCell, CellText]]:
    for i, row in enumerate(table.cells):
        for j, cell in enumerate(row):
            yield (i, j), cell


def _negative(text: str) -> str:
    return text[1:] if text.startswith("-") else f"-{text}"


def _is_single(cell: CellText) -> bool:
    return not any(sign in cell.constant[1:] for sign in "+- ")


def _own(table: ModelTable) -> Iterator[tuple[TableCell, CellText, Joint]]:
    """Yield each cell that contains a joint variable, with the cell's text and its joint."""
    for (i, j), cell in _each(table):
        joint = table.joint_of(i)
        if joint is not None and cell.variable:
            yield (i, j), cell, joint


def _lengths(table: ModelTable) -> list[str]:
    found = [
        cell.constant.removeprefix("-")
        for (_, j), cell in _each(table)
        if j in _LENGTHS and not cell.is_zero and _is_single(cell)
    ]
    return list(dict.fromkeys(found))


# --- one cell: its constant


def _sign(table: ModelTable) -> Iterator[SlipChange]:
    for at, cell in _each(table):
        if cell.is_zero or not _is_single(cell) or cell.degrees in (180.0, -180.0):
            continue
        yield {at: cell.text(constant=_negative(cell.constant))}


def _distance_left_out(table: ModelTable) -> Iterator[SlipChange]:
    for at, cell in _each(table):
        if at[1] in _LENGTHS and not cell.is_zero:
            yield {at: cell.text(constant="0")}


def _distance_extra(table: ModelTable) -> Iterator[SlipChange]:
    for at, cell in _each(table):
        if at[1] in _LENGTHS and cell.is_zero:
            for length in _lengths(table):
                yield {at: cell.text(constant=length)}


def _degrees_as_radians(table: ModelTable) -> Iterator[SlipChange]:
    for at, cell in _each(table):
        if cell.degrees:
            yield {at: cell.text(constant=f"{cell.degrees:.12g} rad")}


def _radians_as_degrees(table: ModelTable) -> Iterator[SlipChange]:
    for at, cell in _each(table):
        if cell.degrees:
            radians = f"{math.radians(cell.degrees):.{_RADIANS_FIGURES}g}"
            yield {at: cell.text(constant=f"{radians}deg")}


def _turned(table: ModelTable, *turns: float) -> Iterator[SlipChange]:
    for at, cell in _each(table):
        if cell.degrees is None:
            continue
        for turn in turns:
            degrees = (cell.degrees + turn + 180.0) % 360.0 - 180.0
            yield {at: cell.text(constant=angle_text(180.0 if degrees == -180.0 else degrees))}


def _quarter_turn(table: ModelTable) -> Iterator[SlipChange]:
    yield from _turned(table, 90.0, -90.0)


def _half_turn(table: ModelTable) -> Iterator[SlipChange]:
    yield from _turned(table, 180.0)


# --- one cell: its joint variable or its quantity


def _unknown_symbol(table: ModelTable) -> Iterator[SlipChange]:
    for (i, j), cell in _each(table):
        joint = table.joint_of(i)
        if j == D and joint is not None and not joint.prismatic:
            name = f"d{joint.index}"
            if name not in table.names:
                yield {(i, j): cell.text(constant=name)}


def _joint_variable_absent(table: ModelTable) -> Iterator[SlipChange]:
    for (i, j), cell in _each(table):
        joint = table.joint_of(i)
        if j == THETA and joint is not None and joint.prismatic:
            name = f"theta{joint.index}"
            if name not in table.names:
                yield {(i, j): cell.text(variable=name)}


def _joint_variable_missing(table: ModelTable) -> Iterator[SlipChange]:
    for at, cell, _ in _own(table):
        yield {at: cell.text(variable="")}


def _joint_variable_sign(table: ModelTable) -> Iterator[SlipChange]:
    for at, cell, _ in _own(table):
        yield {at: cell.text(variable=f"-{cell.variable}")}


def _joint_variable_index(table: ModelTable) -> Iterator[SlipChange]:
    for at, cell, joint in _own(table):
        for other in table.joints:
            if other.prismatic == joint.prismatic and abs(other.index - joint.index) == 1:
                yield {at: cell.text(variable=other.variable)}


def _joint_variable_doubled(table: ModelTable) -> Iterator[SlipChange]:
    for at, cell, _ in _own(table):
        yield {at: cell.text(variable=f"2*{cell.variable}")}


def _joint_variable_column(table: ModelTable) -> Iterator[SlipChange]:
    for (i, _), cell, joint in _own(table):
        other = THETA if joint.prismatic else D
        yield {(i, other): table.cells[i][other].text(variable=cell.variable)}


def _joint_variable_extra(table: ModelTable) -> Iterator[SlipChange]:
    for (i, j), cell in _each(table):
        for joint in table.joints:
            is_own = table.joint_of(i) == joint
            if not cell.variable and not is_own and joint.prismatic == (j in _LENGTHS):
                yield {(i, j): cell.text(variable=joint.variable)}


def _wrong_quantity(table: ModelTable) -> Iterator[SlipChange]:
    lengths = [length for length in _lengths(table) if length in table.names]
    for (i, j), cell in _each(table):
        if cell.variable:
            continue
        if j in _LENGTHS:
            yield {(i, j): "90deg"}
        else:
            yield from ({(i, j): length} for length in lengths)


# --- several cells


def _columns_swapped(table: ModelTable) -> Iterator[SlipChange]:
    for one, other in ((A, D), (ALPHA, THETA)):
        for i, row in enumerate(table.cells):
            if not (row[one].variable or row[other].variable):
                yield {(i, one): row[other].text(), (i, other): row[one].text()}
        constants = {
            (i, j): row[j].text(constant=row[k].constant)
            for i, row in enumerate(table.cells)
            for j, k in ((one, other), (other, one))
        }
        yield constants


def _column_sign(table: ModelTable) -> Iterator[SlipChange]:
    for column in (A, ALPHA, D, THETA):
        cells = [(at, cell) for at, cell in _each(table) if at[1] == column]
        if all(_is_single(cell) for _, cell in cells):
            yield {
                at: cell.text(constant=_negative(cell.constant))
                for at, cell in cells
                if not cell.is_zero
            }


def _row_order(table: ModelTable) -> Iterator[SlipChange]:
    for i, k in combinations(range(len(table.joints)), 2):
        yield {
            (row, j): table.cells[source][j].text()
            for row, source in ((i, k), (k, i))
            for j in range(len(table.cells[row]))
        }


def _lengths_exchanged(table: ModelTable) -> Iterator[SlipChange]:
    for one, other in combinations([n for n in _lengths(table) if n in table.names], 2):
        exchange = {one: other, other: one, f"-{one}": f"-{other}", f"-{other}": f"-{one}"}
        yield {
            at: cell.text(constant=exchange[cell.constant])
            for at, cell in _each(table)
            if cell.constant in exchange
        }


def _link_columns_shifted(table: ModelTable) -> Iterator[SlipChange]:
    count = len(table.cells)
    for columns in ((A, ALPHA), (A,), (ALPHA,)):
        for step in (1, -1):
            yield {
                (i, j): table.cells[(i - step) % count][j].text()
                for i in range(count)
                for j in columns
            }


def _other_convention(table: ModelTable) -> Iterator[SlipChange]:
    count = len(table.cells)
    step = 1 if table.convention is Convention.STANDARD else -1
    end = count - 1 if step == 1 else 0
    if all(table.cells[end][j].is_zero for j in (A, ALPHA)):
        yield {
            (i, j): table.cells[(i - step) % count][j].text()
            for i in range(count)
            for j in (A, ALPHA)
        }


def _joint_numbering(table: ModelTable) -> Iterator[SlipChange]:
    for step in (-1, 1):
        yield {
            at: cell.text(variable=_numbered(joint, joint.index + step, table))
            for at, cell, joint in _own(table)
        }


def _joint_numbering_by_kind(table: ModelTable) -> Iterator[SlipChange]:
    changes = {}
    counts = {True: 0, False: 0}
    for at, cell, joint in _own(table):
        counts[joint.prismatic] += 1
        name = _numbered(joint, counts[joint.prismatic], table)
        changes[at] = cell.text(variable=name)
    yield changes


def _numbered(joint: Joint, number: int, table: ModelTable) -> str:
    letters = joint.variable.rstrip("0123456789")
    known = {each.variable for each in table.joints}
    name = f"{letters}{number}"
    is_taken = name in table.names and name not in known
    return f"q{number}" if is_taken else name


SLIPS: Final[Mapping[str, SlipMaker]] = {
    "sign": _sign,
    "distance_left_out": _distance_left_out,
    "distance_extra": _distance_extra,
    "degrees_as_radians": _degrees_as_radians,
    "radians_as_degrees": _radians_as_degrees,
    "quarter_turn": _quarter_turn,
    "half_turn": _half_turn,
    "unknown_symbol": _unknown_symbol,
    "joint_variable_absent": _joint_variable_absent,
    "joint_variable_missing": _joint_variable_missing,
    "joint_variable_sign": _joint_variable_sign,
    "joint_variable_index": _joint_variable_index,
    "joint_variable_doubled": _joint_variable_doubled,
    "joint_variable_column": _joint_variable_column,
    "joint_variable_extra": _joint_variable_extra,
    "wrong_quantity": _wrong_quantity,
    "columns_swapped": _columns_swapped,
    "column_sign": _column_sign,
    "row_order": _row_order,
    "lengths_exchanged": _lengths_exchanged,
    "link_columns_shifted": _link_columns_shifted,
    "other_convention": _other_convention,
    "joint_numbering": _joint_numbering,
    "joint_numbering_by_kind": _joint_numbering_by_kind,
}


def changes_of(name: str, table: ModelTable) -> list[SlipChange]:
    """Return the changes of the table that may lead to the message with this code."""
    # Unchanged cells are left out.
    texts = table.texts
    found: list[SlipChange] = []
    for change in SLIPS[name](table):
        real = {at: text for at, text in change.items() if texts[at[0]][at[1]] != text}
        if real and real not in found:
            found.append(real)
    return found
