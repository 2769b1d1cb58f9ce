"""The frames of a student's table, right or wrong, at given joint values."""

from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from service.catalogue import Joint
from service.expressions import AngleUnit, Expression, evaluate_all
from service.figures.tables.scope import DrawingScope
from service.grading.feedback import Finding, reading_error
from service.grading.numerics.samples import SAMPLES, Samples
from service.grading.reading.entry import Reader
from service.grading.reading.tables.table import StudentRow, StudentTable, read_table
from service.grading.work_budget import WorkBudget
from service.kinematics.chain import COLUMNS, Table, frames
from service.kinematics.dh import Convention
from service.kinematics.jacobian import coincident, rank, space_jacobian
from service.kinematics.transforms import Matrices, Numbers
from service.translations import listed

# The number of random configurations that represent a generic one.
_GENERIC = 4
# Larger numbers (metres or radians) are not drawn.
LARGEST = 1e6


@dataclass(frozen=True, slots=True)
class CellWithoutNumber:
    """A cell without a number: its row and column as labelled in reports, and the reason."""

    row: str
    column: str
    finding: Finding


@dataclass(frozen=True, slots=True)
class FreedomLoss:
    """Redundant joints, by their indices, and a message that says why they are redundant."""

    joints: tuple[int, ...]
    message: str


@dataclass(frozen=True, slots=True)
class TableFrames:
    """The frames of a table ``(configurations, frames, 4, 4)``, the base frame first.

    The frames end before the first row that has a cell without a number. ``unread`` lists all cells
    without a number.
    """

    # For the rows before that row, ``values`` has the numbers ``(configurations, rows, 4)``, and
    # ``row_joints`` has the joint whose variable is in the row. ``symbols`` are the symbols in the
    # table. ``freedoms`` is the number of degrees of freedom of a complete table, else None.
    frames: Matrices
    values: Numbers
    row_joints: tuple[Joint | None, ...]
    symbols: Set[str]
    unread: tuple[CellWithoutNumber, ...] = ()
    complete: bool = True
    freedoms: int | None = None
    lost: tuple[FreedomLoss, ...] = ()


def table_to_draw(
    answer: object, scope: DrawingScope, budget: WorkBudget, angle_unit: AngleUnit = "radians"
) -> StudentTable:
    """Read a student's table by the same rules as grading.

    Raises UnreadableAnswerError if the answer has no rows.
    """
    # The values at these samples are not used.
    samples = Samples({variable.name: np.full(SAMPLES, 0.5) for variable in scope.variables})
    return read_table(answer, Reader(scope.vocabulary, samples, angle_unit, "m", budget))


def table_frames(
    written: StudentTable,
    convention: Convention,
    scope: DrawingScope,
    numbers: Mapping[str, float],
    amounts: Numbers,
) -> TableFrames:
    """Return the frames of a table at values of the joint variables, ``(configurations, joints)``.

    ``numbers`` has a number for every symbol.
    """
    count = len(amounts)
    values = {name: np.full(count + _GENERIC, number) for name, number in numbers.items()}
    rng = np.random.default_rng(0)
    for variable in scope.variables:
        values[variable.name][count:] = rng.uniform(variable.low, variable.high, _GENERIC)
    for i, joint in enumerate(scope.joints):
        values[joint.variable][:count] = amounts[:, i]
    table = _numbers(written, values, count + _GENERIC)
    with np.errstate(invalid="ignore"):
        is_number = np.asarray((np.abs(table) <= LARGEST).all(axis=-1))
    unread = tuple(_unread(written, is_number, scope))
    whole = np.asarray(is_number.all(axis=-1))
    end = len(whole) if whole.all() else int(whole.argmin())
    read = table[:end, :, :count]
    reached = np.moveaxis(frames(read, convention), 1, 0), np.moveaxis(read, -1, 0)
    used = [_symbols(row) for row in written.rows]
    symbols = set[str]().union(*used)
    joints = tuple(_joint(row, scope) for row in used[:end])
    if unread or end < len(scope.joints):
        return TableFrames(*reached, joints, symbols, unread, complete=False)
    freedoms, lost = _freedoms(table[..., count:], convention, scope, symbols)
    return TableFrames(*reached, joints, symbols, freedoms=freedoms, lost=lost)


def _symbols(row: StudentRow) -> Set[str]:
    return set[str]().union(*(each.symbols for each in row.expressions if each is not None))


def _joint(symbols: Set[str], scope: DrawingScope) -> Joint | None:
    return next((joint for joint in scope.joints if joint.variable in symbols), None)


def _numbers(written: StudentTable, values: Mapping[str, Numbers], count: int) -> Table:
    known = values.keys()
    cells: list[Expression | None] = [
        each if each is not None and each.symbols <= known else None
        for row in written.rows
        for each in row.expressions
    ]
    table = np.empty((len(cells), count))
    for i, found in enumerate(evaluate_all(cells, values, {})):
        table[i] = found
    return table.reshape(len(written.rows), len(COLUMNS), count)


def _unread(
    written: StudentTable, is_number: NDArray[np.bool_], scope: DrawingScope
) -> Iterator[CellWithoutNumber]:
    names = {variable.name for variable in scope.variables}
    for i, row in enumerate(written.rows):
        for j, entry in enumerate(row.entries):
            place = str(i + 1), COLUMNS[j]
            if entry.expression is None:
                yield CellWithoutNumber(*place, entry.findings[0] if entry.findings else _NOTHING)
            elif absent := sorted(entry.expression.symbols - names):
                message = f"This robot has no {absent[0]}."
                yield CellWithoutNumber(*place, reading_error("unknown_joint", message))
            elif not is_number[i, j]:
                yield CellWithoutNumber(*place, _NO_NUMBER)


_NOTHING = reading_error("missing", "Nothing is written here; if the value is zero, write 0.")
_NO_NUMBER = reading_error(
    "undefined", "This has no value at these joint values, or one too large to draw."
)


def _freedoms(
    table: Table, convention: Convention, scope: DrawingScope, used: Set[str]
) -> tuple[int, tuple[FreedomLoss, ...]]:
    # At a generic configuration.
    moving = [i for i, joint in enumerate(scope.joints) if joint.variable in used]
    still = tuple(joint for joint in scope.joints if joint.variable not in used)
    lost = [
        FreedomLoss(
            (joint.index,),
            f"Joint {joint.index} does not move: nothing in the table depends on {joint.variable}.",
        )
        for joint in still
    ]
    if not moving:
        return 0, tuple(lost)
    slides = [scope.joints[i].prismatic for i in moving]
    screws = space_jacobian(table, convention, moving, slides)
    scale = float(np.abs(table[:, [0, 2]]).max(initial=0.0)) or 1.0
    screws[:, 3:] /= np.where(slides, 1.0, scale)
    joined = np.triu(coincident(screws))
    done: set[int] = set()
    for i, others in enumerate(joined):
        together = [i, *np.flatnonzero(others).tolist()]
        if len(together) > 1 and not done.intersection(together):
            done.update(together)
            lost.append(_one_axis([moving[k] for k in together], scope))
    return rank(screws), tuple(lost)


def _one_axis(together: Sequence[int], scope: DrawingScope) -> FreedomLoss:
    joints = [scope.joints[i] for i in together]
    motion = "turn about one and the same line"
    if joints[0].prismatic:
        motion = "slide along one and the same direction"
    named = listed([str(joint.index) for joint in joints])
    return FreedomLoss(tuple(joint.index for joint in joints), f"Joints {named} {motion}.")
