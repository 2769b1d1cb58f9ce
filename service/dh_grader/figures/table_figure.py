"""The figure of a student's table, right or wrong: its frames over the mechanism or alone.

It also computes what the 3D view shows of a table: frames, formulas and lost freedoms. Whether the
table is right is for the grading.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from dh_grader.catalogue import Exercise, Joint, Variable
from dh_grader.catalogue.exercise import DEFAULT_RANGES
from dh_grader.catalogue.kinds import FRAME_CELLS, FramesSpec, frame_labels
from dh_grader.catalogue.robot import at_home
from dh_grader.expressions import (
    AngleUnit,
    Expression,
    ExpressionError,
    Kind,
    Symbol,
    Vocabulary,
    evaluate_all,
    joint_variable,
    read,
    reading_cost,
)
from dh_grader.figures.drawing import (
    LARGE_ROOM,
    Caption,
    DrawnFrames,
    Sheet,
    TakenRoom,
    Theme,
    camera_for,
    frame_axes,
    ground_solid,
    joint_solid,
    link_solid,
    mechanism_solids,
)
from dh_grader.figures.mechanism import (
    Configuration,
    MovableMechanism,
    View,
    distinct,
    drawing_numbers,
)
from dh_grader.figures.solids import back_to_front, polyline
from dh_grader.grading.diagnosis.formulas import nodes
from dh_grader.grading.numbers import SAMPLES, Samples
from dh_grader.grading.reading.entries import Entry, Reader, entry_values
from dh_grader.grading.reading.lists import StudentFrame, read_frames
from dh_grader.grading.reading.table import StudentRow, StudentTable, read_table
from dh_grader.grading.report import Finding, Verdict, WorkBudget, reading_error
from dh_grader.kinematics import (
    ALPHA,
    COLUMNS,
    NO_ROTATION,
    A,
    Convention,
    Matrices,
    Numbers,
    Row,
    Table,
    coincident,
    frames,
    inverse,
    joint_frames,
    modified_rows,
    rank,
    space_jacobian,
    standard_rows,
)
from dh_grader.translations import listed

# --- The figure of a student's table: its frames, drawn over the mechanism or alone
#
# The figure replaces the 3D view in browsers without 3D graphics. It shows one configuration. It
# contains no text from the student: its only texts are the names of axes, x0 to z12.


# The view of a table without a mechanism; the 3D view begins with the same view.
_PLAIN: Final = View(-60, 25)
_UP: Final = np.array([0.0, 0.0, 1.0])
_ONE_POINT: Final = 1e-5
# The length of frame axes as a share of the parts' size, and the minimum length in pixels.
_FRAME: Final = 0.2
_LEAST: Final = 30.0
_CAPTION: Final = Caption(
    "table", "The robot as the table says", "The frames of the table; x is red, y green, z blue."
)


@dataclass(frozen=True, slots=True)
class WrittenChain:
    """A table at some joint values: its frames ``(frames, 4, 4)``, the base frame first.

    ``row_joints`` has the joint of each row, or None for a row without a joint.
    """

    frames: Matrices
    row_joints: tuple[Joint | None, ...]
    convention: Convention

    @property
    def links(self) -> list[Numbers]:
        """The line ``(3, 3)`` of each row, through three points: along z and along x."""
        # In the convention's order.
        return [
            np.array([before[:3, 3], before[:3, 3] + self._first(before, after), after[:3, 3]])
            for before, after in pairwise(self.frames)
        ]

    def _first(self, before: Numbers, after: Numbers) -> Numbers:
        axis = before[:3, 2 if self.convention is Convention.STANDARD else 0]
        return np.asarray(axis * (axis @ (after[:3, 3] - before[:3, 3])))

    @property
    def axes(self) -> Iterator[tuple[Joint, Numbers]]:
        """The joints, each with the frame ``(4, 4)`` whose z axis is the joint axis."""
        for joint, frame in zip(
            self.row_joints, joint_frames(self.frames, self.convention), strict=True
        ):
            if joint is not None:
                yield joint, frame


@dataclass(frozen=True, slots=True)
class SeenMechanism:
    """The mechanism of an exercise, its configuration and its view."""

    mechanism: MovableMechanism
    shown: Configuration
    view: View


def table_figure(
    written: WrittenChain | None, seen: SeenMechanism | None, theme: Theme = Theme.AUTO
) -> str:
    """Return the SVG of a table, of a mechanism, or of both; at least one must be given."""
    links = [] if written is None else written.links
    corners = [np.zeros((1, 3)), *links]
    if seen is not None:
        corners += [*seen.shown.links, seen.shown.base[None]]
    points = np.concatenate(corners)
    extent = float(np.linalg.norm(np.ptp(points, axis=0)))
    if extent < _ONE_POINT:
        # A table whose frames all coincide is drawn as large as its parts.
        points, extent = np.concatenate([points, _UP[None]]), 1.0
    size = seen.mechanism.size if seen else 0.9 * extent
    sheet = Sheet(
        camera_for(points, seen.view if seen else _PLAIN, LARGE_ROOM), size, TakenRoom(hasty=True)
    )
    if seen is not None:
        solids = mechanism_solids(sheet, seen.shown, seen.mechanism, _CAPTION.name)
        for line in links:
            drawn = sheet.camera.seen(line)
            sheet.above.append(polyline(drawn, "chain"))
            sheet.take(drawn, 1.3)
    else:
        solids = _solids(sheet, written, links) if written else []
    if written is not None:
        length = max(_FRAME * size, _LEAST / sheet.camera.scale)
        names = [str(i) for i in range(len(written.frames))]
        frames = DrawnFrames(written.frames, names, ["xyz"] * len(names))
        sheet.above += frame_axes(sheet.camera, frames, length, sheet.room)
    return sheet.svg(solids, _CAPTION, theme)


def _solids(sheet: Sheet, written: WrittenChain, links: list[Numbers]) -> list[str]:
    joints = [
        joint_solid(
            sheet, frame[:3, 3], frame[:3, 2], f"{_CAPTION.name}-{i}", slides=joint.prismatic
        )
        for i, (joint, frame) in enumerate(written.axes)
    ]
    lines = [line for line in map(distinct, links) if len(line) > 1]
    rods = [link_solid(sheet, line, line) for line in lines]
    floor = ground_solid(sheet, np.zeros(3), _UP)
    return [floor.svg, *(solid.svg for solid in back_to_front(sheet.camera, [*joints, *rods]))]


# --- The pose of a table, multiplied out as text: sums of products of sines and cosines
#
# Angles about parallel axes are added before their sine is taken, as in textbooks.
#
# The chain is X_0 Z_1 X_1 Z_2 …. Each entry is a sum of terms. The number of terms is bounded, and
# the terms are not simplified afterwards.


# The maximum for all entries together. An arm of two links with a wrist has about a hundred.
_MOST_TERMS: Final = 160
_SAME: Final = 1e-9
_LARGEST_FACTOR: Final = 9
_QUARTER: Final = np.pi / 2

# A sum: for each product, a tuple of factors as texts, its coefficient.
Terms = dict[tuple[str, ...], int]


class LongPoseError(ValueError):
    """The pose has too many terms to be useful."""


@dataclass(frozen=True, slots=True)
class _Angle:
    # A sum of angles and quarter turns. Each part is a text and its factor.
    parts: tuple[tuple[str, int], ...] = ()
    quarters: int = 0

    def plus(self, other: "_Angle") -> "_Angle":
        total = dict(self.parts)
        for text, factor in other.parts:
            total[text] = total.get(text, 0) + factor
        kept = tuple((text, factor) for text, factor in total.items() if factor)
        return _Angle(kept, self.quarters + other.quarters)

    def reversed(self) -> "_Angle":
        return _Angle(tuple((text, -factor) for text, factor in self.parts), -self.quarters)

    def cosine_and_sine(self) -> tuple[Terms, Terms]:
        # Each quarter turn swaps cosine and sine.
        cosine, sine = _number(1), _number(0)
        if self.parts:
            sign = 1 if self.parts[0][1] > 0 else -1
            text = _sum_text([(text, sign * factor) for text, factor in self.parts])
            cosine, sine = {(f"cos({text})",): 1}, {(f"sin({text})",): sign}
        for _ in range(self.quarters % 4):
            cosine, sine = _times(sine, -1), cosine
        return cosine, sine


def _sum_text(parts: Sequence[tuple[str, int]]) -> str:
    # Without a leading +.
    ordered = [
        f"{'-' if factor < 0 else '+'}{'' if abs(factor) == 1 else f'{abs(factor)}*'}{text}"
        for text, factor in parts
    ]
    return "".join(ordered).removeprefix("+")


def _angle(cell: Expression) -> _Angle:
    # A sum of symbols and quarter turns, or else one text.
    names = sorted(cell.symbols)
    # Evaluate with all symbols 0, with each symbol 1, and at a point that shows if it is not a sum.
    points = np.vstack([np.zeros(len(names)), np.eye(len(names)), 0.37 + np.arange(len(names))])
    [found] = evaluate_all([cell], dict(zip(names, points.T, strict=True)), {})
    values = np.broadcast_to(np.asarray(found, dtype=np.float64), len(points))
    whole = _Angle(((_bracketed(cell.text()), 1),))
    if not np.isfinite(values).all():
        return whole
    quarters, factors = values[0] / _QUARTER, values[1:-1] - values[0]
    rest = values[-1] - values[0] - points[-1] @ factors
    exact = [quarters - round(quarters), rest, *(factors - np.round(factors))]
    if np.abs(exact).max() > _SAME or np.abs(factors).max(initial=0) > _LARGEST_FACTOR:
        return whole
    parts = tuple((name, round(factor)) for name, factor in zip(names, factors, strict=True))
    return _Angle(tuple(part for part in parts if part[1]), round(quarters))


def _length(cell: Expression) -> Terms:
    text = cell.text()
    if text == "0":
        return {}
    if text.startswith("-") and not re.search("[+-]", text[1:]):
        return {(text[1:],): -1}
    return {(_bracketed(text),): 1}


def _bracketed(text: str) -> str:
    return f"({text})" if re.search("[+/-]", text) else text


def _number(value: int) -> Terms:
    return {(): value} if value else {}


def _times(terms: Terms, factor: int) -> Terms:
    return {product: factor * count for product, count in terms.items()}


def _product(one: Terms, other: Terms) -> Terms:
    if len(one) * len(other) > _MOST_TERMS:
        raise LongPoseError
    total = Terms()
    for left, m in one.items():
        for right, n in other.items():
            product = left + right
            total[product] = total.get(product, 0) + m * n
    return {product: count for product, count in total.items() if count}


def _plus(one: Terms, other: Terms) -> Terms:
    total = dict(one)
    for product, count in other.items():
        total[product] = total.get(product, 0) + count
    return {product: count for product, count in total.items() if count}


class _Pose:
    # The rotation's columns and the position so far, and a pending turn about z.
    def __init__(self) -> None:
        self.columns = [[_number(int(i == j)) for i in range(3)] for j in range(3)]
        self.position = [Terms() for _ in range(3)]
        self.turn = _Angle()

    def along(self, column: Sequence[Terms], length: Terms) -> None:
        if length:
            self.position = [
                _plus(at, _product(length, each))
                for at, each in zip(self.position, column, strict=True)
            ]

    def about(self, angle: _Angle, first: int, second: int) -> None:
        cosine, sine = angle.cosine_and_sine()
        pairs = list(zip(self.columns[first], self.columns[second], strict=True))
        self.columns[first] = [_plus(_product(u, cosine), _product(v, sine)) for u, v in pairs]
        self.columns[second] = [
            _plus(_product(v, cosine), _times(_product(u, sine), -1)) for u, v in pairs
        ]
        if sum(len(terms) for column in self.columns for terms in column) > _MOST_TERMS:
            raise LongPoseError

    def turn_now(self) -> None:
        self.about(self.turn, 0, 1)
        self.turn = _Angle()

    def x_axis(self) -> list[Terms]:
        # After the pending turn about z.
        cosine, sine = self.turn.cosine_and_sine()
        return [
            _plus(_product(u, cosine), _product(v, sine))
            for u, v in zip(self.columns[0], self.columns[1], strict=True)
        ]

    def twist(self, angle: _Angle) -> None:
        if angle.parts or angle.quarters % 2:
            self.turn_now()
            self.about(angle, 1, 2)
        elif angle.quarters % 4:
            # A half turn about x reverses y, z and all later turns about z.
            self.columns[1:] = [[_times(terms, -1) for terms in each] for each in self.columns[1:]]
            self.turn = self.turn.reversed()


def pose_texts(modified: Iterable[Row[Expression]]) -> list[list[str]]:
    """Return the product of a table's rows in the modified convention, as texts ``(4, 4)``.

    Raises LongPoseError if there are too many terms.
    """
    pose = _Pose()
    for a, alpha, d, theta in modified:
        length = _length(a)
        if length:
            pose.along(pose.x_axis(), length)
        pose.twist(_angle(alpha))
        pose.along(pose.columns[2], _length(d))
        pose.turn = pose.turn.plus(_angle(theta))
    pose.turn_now()
    columns = [*pose.columns, pose.position]
    if sum(len(terms) for column in columns for terms in column) > _MOST_TERMS:
        raise LongPoseError
    rows = [[_text(column[i]) for column in columns] for i in range(3)]
    return [*rows, ["0", "0", "0", "1"]]


def _text(terms: Terms) -> str:
    ordered = [("*".join(product) or "1", count) for product, count in terms.items()]
    return _sum_text(ordered) or "0"


# --- The symbols and joints that a drawn table may use, from an exercise or from textbooks


# The rows of a free table: ten joints and up to two fixed rows.
_ROWS: Final = range(1, 13)


@dataclass(frozen=True, slots=True)
class DrawingScope:
    """The joints and symbols that a table may use, and the numbers to draw it with."""

    joints: tuple[Joint, ...]
    variables: tuple[Variable, ...]
    vocabulary: Vocabulary

    @classmethod
    def of(cls, exercise: Exercise) -> "DrawingScope":
        """Return the joints and symbols that a table of the exercise may use."""
        return cls(exercise.joints, exercise.variables, exercise.vocabulary)

    def numbers(self, given: Mapping[str, float]) -> dict[str, float]:
        """Return a number for each symbol: the given number, or a default for drawing."""
        numbers = drawing_numbers(self.variables)
        return numbers | {name: given[name] for name in numbers.keys() & given.keys()}


@lru_cache(maxsize=256)
def free_scope(structure: str) -> DrawingScope:
    """Return textbook symbols for a robot with the joints ``structure``, such as "RRP"."""
    # The variable of joint i is theta_i (or q_i) if it is revolute, and d_i (or q_i) if it is
    # prismatic. The other symbols a1, alpha1, d1, theta1, l1 up to index 12 are constants.
    joints = tuple(
        Joint(i, f"d{i}" if letter == "P" else f"theta{i}", prismatic=letter == "P")
        for i, letter in enumerate(structure, 1)
    )
    moving = {joint.variable: joint for joint in joints}
    symbols = [joint_variable(joint.index, sliding=joint.prismatic) for joint in joints]
    symbols += [symbol for symbol in _parameters() if symbol.name not in moving]
    variables = tuple(_variable(symbol) for symbol in symbols)
    return DrawingScope(joints, variables, Vocabulary(symbols, of_books=True))


def _parameters() -> Iterator[Symbol]:
    kinds: dict[str, Kind] = {
        "a": "length", "alpha": "angle", "d": "length", "theta": "angle", "l": "length",
    }  # fmt: skip
    for letter, kind in kinds.items():
        yield from (Symbol(f"{letter}{i}", kind) for i in _ROWS)


def _variable(symbol: Symbol) -> Variable:
    low, high = DEFAULT_RANGES[symbol.kind]
    unit = "m" if symbol.kind == "length" else "rad"
    return Variable(symbol.name, symbol.kind, unit, "", low, high, symbol.joint)


# --- The formulas of a table: its cells, its equivalent in the other convention, and its pose


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


# --- The frames of a student's table, right or wrong, at given joint values


# The number of random configurations that represent a generic one.
_GENERIC = 4
_NOTHING = reading_error("missing", "Nothing is written here; if the value is zero, write 0.")
_NO_NUMBER_HERE = reading_error(
    "undefined", "This has no value at these joint values, or one too large to draw."
)
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
                yield CellWithoutNumber(*place, _NO_NUMBER_HERE)


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


# --- The frames that a student places on joint axes, right or wrong, to be drawn on the robot


_NO_NUMBER: Final = reading_error("undefined", "This has no value, or one too large to draw.")
_PARALLEL: Final = reading_error("undefined", "x and z are parallel, so they make no frame.")


@dataclass(frozen=True, slots=True)
class PlacedFrames:
    """The frames that can be drawn, ``(configurations, frames, 4, 4)``, and their labels.

    If a frame was begun but cannot be drawn, ``left_out`` has the cell that prevents drawing it.
    """

    labels: tuple[str, ...]
    frames: Matrices
    left_out: tuple[CellWithoutNumber, ...]


def placed_frames(
    answer: object,
    part: FramesSpec,
    exercise: Exercise,
    numbers: Mapping[str, float],
    amounts: Numbers,
    budget: WorkBudget,
    angle_unit: AngleUnit = "radians",
) -> PlacedFrames:
    """Return placed frames at values of the joint variables, ``(configurations, joints)``.

    ``numbers`` has a number for every symbol. Raises UnreadableAnswerError if the answer has no
    rows.
    """
    # The frames are written with all joint variables 0, and move with their links.
    values = {name: np.full(SAMPLES, number) for name, number in numbers.items()}
    home = Samples(at_home(exercise.joints, values, SAMPLES))
    labels = frame_labels(exercise.robot, part.convention)
    reader = Reader.of(exercise, home, angle_unit, budget)
    motions = _link_motions(exercise, numbers, amounts)
    drawn, left_out = {}, []
    for i, written in enumerate(read_frames(answer, labels, reader)):
        if not _is_begun(written):
            continue
        found = _frame(labels[i], written, home)
        if isinstance(found, CellWithoutNumber):
            left_out.append(found)
        else:
            drawn[labels[i]] = motions[i] @ found
    frames = np.stack(list(drawn.values()), axis=1) if drawn else np.empty((len(amounts), 0, 4, 4))
    return PlacedFrames(tuple(drawn), frames, tuple(left_out))


def _is_begun(frame: StudentFrame) -> bool:
    if frame.axis.number is not None or frame.z.name or frame.x.name:
        return True
    return any(entry.verdict is not Verdict.MISSING for _, entry in _entries(frame))


def _entries(frame: StudentFrame) -> Iterator[tuple[str, Entry]]:
    # A direction such as +y has no entries.
    yield FRAME_CELLS[0], frame.axis.entry
    yield from (("z", entry) for entry in frame.z.entries)
    yield from zip(FRAME_CELLS[2:5], frame.origin, strict=True)
    yield from (("x", entry) for entry in frame.x.entries)


def _frame(label: str, frame: StudentFrame, home: Samples) -> Matrices | CellWithoutNumber:
    # x is drawn as it is written, even if it is not perpendicular to z.
    for cell, entry in _entries(frame):
        if cell != FRAME_CELLS[0] and not entry.readable:
            finding = entry.findings[0] if entry.findings else _NO_NUMBER
            return CellWithoutNumber(label, cell, finding)
    drawn = np.eye(4)
    for column, cell, direction in ((2, "z", frame.z), (0, "x", frame.x)):
        values = direction.values(home)
        length = 0.0 if values is None else float(np.linalg.norm(values[0]))
        if values is None or not NO_ROTATION < length < np.inf:
            return CellWithoutNumber(label, cell, _NO_NUMBER)
        drawn[:3, column] = values[0] / length
    origin = entry_values(frame.origin, ("length",) * 3, home)[:, 0]
    for cell, value in zip(FRAME_CELLS[2:5], origin, strict=True):
        if not abs(value) <= LARGEST:
            return CellWithoutNumber(label, cell, _NO_NUMBER)
    drawn[:3, 3] = origin
    drawn[:3, 1] = np.cross(drawn[:3, 2], drawn[:3, 0])
    across = float(np.linalg.norm(drawn[:3, 1]))
    if across <= NO_ROTATION:
        return CellWithoutNumber(label, "x", _PARALLEL)
    drawn[:3, 1] /= across
    return drawn


def _link_motions(exercise: Exercise, numbers: Mapping[str, float], amounts: Numbers) -> Matrices:
    # ``(links, configurations, 4, 4)``. Link i is moved by joints 1 to i.
    count = len(amounts)
    still = {name: np.full(count, number) for name, number in numbers.items()}
    moving = still | {joint.variable: amounts[:, i] for i, joint in enumerate(exercise.joints)}
    robot = exercise.robot
    reached = robot.all_frames(moving, count)[1:]
    return np.asarray(
        reached @ inverse(robot.all_frames(at_home(exercise.joints, still, count), count)[1:])
    )
