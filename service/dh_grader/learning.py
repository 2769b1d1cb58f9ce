"""A correct table as texts, and the same table with one random mistake, for practice."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256
from itertools import combinations, count
from typing import Final, TypeAlias, TypeVar

import numpy as np

from dh_grader.catalogue import Exercise, Joint, ReferenceTable, Robot
from dh_grader.expressions import Expression
from dh_grader.kinematics import ALPHA, COLUMNS, THETA, A, Convention, D
from dh_grader.slices import checkpoint

# --- The correct table of a robot as texts that mean the same in every angle unit


# The row and column of a cell.
TableCell: TypeAlias = tuple[int, int]
# The texts of the cells, row by row.
TableTexts: TypeAlias = tuple[tuple[str, ...], ...]

ANGLES: Final = (ALPHA, THETA)


@dataclass(frozen=True, slots=True)
class CellText:
    """A cell as the sum of a joint variable and a constant; the variable may be "".

    ``degrees`` is the constant if it is an angle without symbols, else None.
    """

    variable: str
    constant: str
    degrees: float | None

    @property
    def is_zero(self) -> bool:
        """True if the constant is 0."""
        return self.constant == "0"

    def text(self, *, variable: str | None = None, constant: str | None = None) -> str:
        """Return the text of the cell, with another ``variable`` or ``constant`` if given."""
        named = self.variable if variable is None else variable
        added = self.constant if constant is None else constant
        if not named:
            return added
        if added == "0":
            return named
        return f"{named} - {added[1:]}" if added.startswith("-") else f"{named} + {added}"


@dataclass(frozen=True, slots=True)
class ModelTable:
    """The correct table of a robot in one convention, with its joints.

    ``names`` are all symbols of the exercise.
    """

    convention: Convention
    joints: tuple[Joint, ...]
    labels: tuple[str, ...]
    cells: tuple[tuple[CellText, ...], ...]
    names: frozenset[str]

    @property
    def texts(self) -> TableTexts:
        """The texts of all cells."""
        return tuple(tuple(cell.text() for cell in row) for row in self.cells)

    def changed(self, changes: Mapping[TableCell, str]) -> TableTexts:
        """Return the texts of the table with new texts in some cells."""
        return tuple(
            tuple(changes.get((i, j), cell.text()) for j, cell in enumerate(row))
            for i, row in enumerate(self.cells)
        )

    def joint_of(self, row: int) -> Joint | None:
        """Return the joint of a row; None for a row without a joint."""
        return self.joints[row] if row < len(self.joints) else None


def model_table(robot: Robot, convention: Convention, names: frozenset[str]) -> ModelTable:
    """Return the correct table of a robot in a convention."""
    table = robot.tables[convention]
    return ModelTable(convention, table.joints, table.labels, _cells(table), names)


def _cells(table: ReferenceTable) -> tuple[tuple[CellText, ...], ...]:
    found = []
    for i, row in enumerate(table.rows):
        joint = table.joints[i] if i < len(table.joints) else None
        column = None if joint is None else D if joint.prismatic else THETA
        found.append(
            tuple(
                _cell(formula, joint.variable if joint and j == column else "", j in ANGLES)
                for j, formula in enumerate(row)
            )
        )
    return tuple(found)


def _cell(formula: Expression, variable: str, is_angle: bool) -> CellText:
    if formula.symbols - {variable}:
        constant = formula.text()
        if variable:
            # The variable comes first in a formula such as d3 + l1.
            constant = constant.removeprefix(variable).replace(" ", "").removeprefix("+") or "0"
        return CellText(variable, constant, None)
    value = float(np.asarray(formula.evaluate({variable: np.zeros(1)} if variable else {})).flat[0])
    if not is_angle:
        return CellText(variable, formula.text() if not variable else f"{value:.12g}", None)
    degrees = round(math.degrees(value), 9) + 0.0
    return CellText(variable, angle_text(degrees), degrees)


def angle_text(degrees: float) -> str:
    """Return an angle with its unit, such as 90deg; 0 has no unit."""
    return f"{degrees:.12g}deg" if degrees else "0"


def as_rows(texts: Sequence[Sequence[str]]) -> list[dict[str, str]]:
    """Return a table as the rows of an answer."""
    return [dict(zip(COLUMNS, row, strict=True)) for row in texts]


# --- The mistakes that can be put into a correct table, by the code of the message about them
#
# Each function yields changes: new texts for some cells of the table.
#
# The grader may explain a change by another code; ``find_slip`` refuses such changes.


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


# --- Make a table with one random mistake, so that the grader finds exactly this mistake


@dataclass(frozen=True, slots=True)
class TableBlame:
    """The grader's judgement of a wrong table.

    ``codes`` are the codes of its messages, and ``cells`` are the wrong cells. To correct the
    table, it is enough to correct any one of the cells ``single``.
    """

    codes: frozenset[str]
    cells: frozenset[TableCell]
    single: frozenset[TableCell] = frozenset()


@dataclass(frozen=True, slots=True)
class DrawnSlip:
    """A table with one mistake, which a student must find.

    ``texts`` is the wrong table, ``model`` the right table, and ``misconception`` the code of the
    mistake. ``places`` are the sets of cells that explain the mistake.
    """

    # There are several sets if parallel axes share an offset.

    misconception: str
    texts: TableTexts
    model: ModelTable
    places: tuple[frozenset[TableCell], ...]

    @property
    def cells(self) -> frozenset[TableCell]:
        """The cells in which the wrong table differs from the right table."""
        return self.places[0]


# The grader's judgement of a table at the samples of a turn; None if it is right.
JudgeTable: TypeAlias = Callable[[TableTexts, int], TableBlame | None]

# The columns in which neighbours on parallel or equal axes share an offset.
_SHARED: Final = (D, THETA)
# Tables that are judged for one draw at most.
MAX_TRIES: Final = 60
# Further samples at which the grader must find the same slip: the explanation of a few tables
# depends on the samples.
CONFIRMATIONS: Final = 5


class NoSlipError(ValueError):
    """No mistake of the wanted kind fits the robot."""


def drawn_slip(
    exercise: Exercise,
    convention: Convention,
    seed: int,
    judge_table: JudgeTable,
    wanted: str | None = None,
) -> DrawnSlip:
    """Return the table with one mistake, which ``seed`` determines.

    ``wanted`` is the code that the mistake must have, if any. Raises NoSlipError if there is no
    such table.
    """
    # The grader must find exactly one slip in the table.
    table = model_table(exercise.robot, convention, exercise.symbols)
    for _, (name, change) in zip(range(MAX_TRIES), _tries(table, seed, wanted), strict=False):
        checkpoint()
        texts = table.changed(change)
        blame = judge_table(texts, 0)
        if blame is None or not (places := _places(name, change, blame)):
            continue
        if all(judge_table(texts, turn) == blame for turn in range(1, CONFIRMATIONS + 1)):
            return DrawnSlip(name, texts, table, places)
    named = "slip" if wanted is None else f"slip {wanted}"
    raise NoSlipError(f"the {convention.value} table of this robot has no {named} to find")


def _tries(table: ModelTable, seed: int, wanted: str | None) -> Iterator[tuple[str, SlipChange]]:
    draws = SlipDraws(f"find the slip\n{seed}")
    codes = draws.shuffled(list(SLIPS)) if wanted is None else [wanted]
    left = {name: draws.shuffled(changes_of(name, table)) for name in codes}
    while any(left.values()):
        for name in codes:
            if left[name]:
                yield name, left[name].pop(0)


def _places(name: str, change: SlipChange, blame: TableBlame) -> tuple[frozenset[TableCell], ...]:
    cells = frozenset(change)
    if blame.codes != {name} or blame.cells != cells:
        return ()
    if len(cells) > 1:
        return (cells,)
    [(_, column)] = cells
    others = sorted(blame.single - cells)
    if others and (column not in _SHARED or any(other != column for _, other in others)):
        return ()
    return (cells, *(frozenset({other}) for other in others))


# --- Pseudo-random numbers that are the same on every computer: integers from SHA-256 of a text


T = TypeVar("T")

_BYTES: Final = 8


class SlipDraws:
    """A sequence of pseudo-random numbers. Equal texts give equal sequences."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._blocks = count()

    def below(self, limit: int) -> int:
        """Return a pseudo-random integer from 0 to ``limit - 1``."""
        digest = sha256(f"{self._text}\n{next(self._blocks)}".encode()).digest()
        return int.from_bytes(digest[:_BYTES], "big") * limit >> 8 * _BYTES

    def shuffled(self, values: Sequence[T]) -> list[T]:
        """Return the values in a random order."""
        left = list(values)
        return [left.pop(self.below(len(left))) for _ in values]
