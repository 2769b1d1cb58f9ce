"""The reference robot of an exercise, by a DH table or by screw axes, and its formulas.

It turns an author's texts into formulas and numbers; it does not handle students' answers.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dh_grader.catalogue.schema_fields import Formula, Homogeneous, Screw
from dh_grader.expressions import Expression, ExpressionError, Kind, Vocabulary, read
from dh_grader.expressions.evaluate import SymbolValues
from dh_grader.kinematics import (
    COLUMNS,
    Convention,
    Matrices,
    Numbers,
    Row,
    Table,
    frames,
    joint_frames,
    modified_rows,
    moved,
    pose,
    product_in_space,
    standard_rows,
)
from dh_grader.translations import say

# --- The variables of an exercise, and trial values to check an author's formulas


# The number of trial values at which an author's formula is evaluated.
TRIALS = 16


@dataclass(frozen=True, slots=True)
class Variable:
    """A symbol that answers may contain, with the range of its test values.

    Angles are in radians, lengths in ``unit``. ``joint`` is set for a joint variable.
    """

    name: str
    kind: Kind
    unit: str
    description: str
    low: float
    high: float
    joint: int | None = None


def trial_values(variables: tuple[Variable, ...]) -> SymbolValues:
    """Return ``TRIALS`` values of each variable; every call returns the same values."""
    rng = np.random.default_rng(0)
    return {v.name: rng.uniform(v.low, v.high, TRIALS) for v in variables}


# --- Read the formulas of an exercise file, and evaluate them at trial values of their symbols
#
# The values show faults in right answers, for example a matrix that is not a rotation.


FormulaGrid = tuple[tuple[Expression, ...], ...]
# The field of a formula, the formula, and its quantity.
FormulaField = tuple[str, Expression, Kind]

# The largest rounding error of a 0 or 1 in an author's formulas.
EXACT = 1e-9

_LINE: tuple[Kind, ...] = ("number", "number", "number", "length")
HOMOGENEOUS: tuple[tuple[Kind, ...], ...] = (_LINE, _LINE, _LINE, ("number",) * 4)
ROTATION: tuple[tuple[Kind, ...], ...] = (("number",) * 3,) * 3
# The vector v of a screw is a length: a moment arm, or a pitch per radian.
SCREW: tuple[Kind, ...] = ("number", "number", "number", "length", "length", "length")


@dataclass
class FieldError(Exception):
    """An invalid value of an exercise file; ``field`` is its path in the file."""

    field: str
    reason: str

    def __str__(self) -> str:
        """Field and reason on one line."""
        return f"{self.field}: {self.reason}"


@dataclass(frozen=True, slots=True)
class WrittenFormulas:
    """The formulas of a right answer, each with its quantity (length, angle or number)."""

    # The field of row i and column j, such as ``expected[{i}][{j}]``.
    path: str
    rows: Sequence[Sequence[Formula]]
    quantities: Sequence[Sequence[Kind]]
    # Takes the answer's field and the numbers ``(rows, columns, TRIALS)``; raises FieldError if
    # they cannot be right.
    check: Callable[[str, Numbers], None] | None = None


def matrix_of(
    field: str,
    rows: Sequence[Sequence[Formula]],
    quantities: Sequence[Sequence[Kind]],
    check: Callable[[str, Numbers], None] | None = None,
) -> WrittenFormulas:
    """Return the formulas of a matrix at ``field``, with their quantities."""
    return WrittenFormulas(f"{field}[{{i}}][{{j}}]", rows, quantities, check)


def list_of(path: str, formulas: Sequence[Formula], quantities: Sequence[Kind]) -> WrittenFormulas:
    """Return a list of formulas as one row.

    ``path`` is the field of formula j, for example ``steps[{j}].angle``.
    """
    return WrittenFormulas(path, (formulas,), (quantities,))


def transform_of(field: str, rows: Homogeneous) -> WrittenFormulas:
    """Return the formulas of a homogeneous transform."""
    return matrix_of(field, rows, HOMOGENEOUS, check_transform)


def screws_of(field: str, axes: Sequence[Screw]) -> WrittenFormulas:
    """Return the formulas of screw axes (ω; v)."""
    return matrix_of(field, axes, (SCREW,) * len(axes), _check_screws)


def fields_of(
    path: str, grid: FormulaGrid, quantities: Sequence[Sequence[Kind]]
) -> Iterator[FormulaField]:
    """Yield each formula of a grid with its field and quantity (length, angle or number)."""
    for i, (row, kinds) in enumerate(zip(grid, quantities, strict=True)):
        for j, (formula, kind) in enumerate(zip(row, kinds, strict=True)):
            yield path.format(i=i, j=j), formula, kind


def grid_values(grid: FormulaGrid, values: SymbolValues, samples: int) -> Numbers:
    """Evaluate formulas at ``values``; return numbers ``(rows, columns, samples)``."""
    numbers = np.empty((len(grid), len(grid[0]), samples))
    for i, row in enumerate(grid):
        for j, formula in enumerate(row):
            numbers[i, j] = formula.evaluate(values)
    return numbers


class FormulaReader:
    """Reads the formulas of one exercise and evaluates them at trial values."""

    def __init__(self, vocabulary: Vocabulary, variables: tuple[Variable, ...]) -> None:
        self._vocabulary = vocabulary
        self._values = trial_values(variables)

    def read(self, field: str, source: Formula, quantity: Kind) -> Expression:
        """Read the formula at ``field``. Raises FieldError if it is unreadable."""
        try:
            return read(source, self._vocabulary, quantity=quantity)
        except ExpressionError as error:
            reason = error.message
            if error.suggestion:
                reason = say(
                    "{reason}; did you mean {suggestion!r}?",
                    reason=reason,
                    suggestion=error.suggestion,
                )
            raise FieldError(field, reason) from error

    def grid(self, written: WrittenFormulas, prefix: str = "") -> FormulaGrid:
        """Read and check the formulas of an answer. Raises FieldError.

        ``prefix`` is the beginning of the formulas' fields in the file.
        """
        path = prefix + written.path
        rows = enumerate(zip(written.rows, written.quantities, strict=True))
        grid = tuple(
            tuple(
                self.read(path.format(i=i, j=j), source, quantity)
                for j, (source, quantity) in enumerate(zip(row, quantities, strict=True))
            )
            for i, (row, quantities) in rows
        )
        numbers = self.trial_numbers(grid, lambda i, j: path.format(i=i, j=j))
        if written.check is not None:
            written.check(prefix + written.path.partition("[")[0], numbers)
        return grid

    def trial_numbers(self, grid: FormulaGrid, field: Callable[[int, int], str]) -> Numbers:
        """Evaluate formulas at trial values; return numbers ``(rows, columns, TRIALS)``.

        Raises FieldError if a number is undefined.
        """
        numbers = grid_values(grid, self._values, TRIALS)
        for i, j in np.argwhere(~np.isfinite(numbers).all(axis=-1)).tolist():
            raise FieldError(
                field(i, j),
                say(
                    "{formula} has no value for some values of its symbols; fix it, or narrow "
                    "their ranges",
                    formula=grid[i][j].text(),
                ),
            )
        return numbers


def check_rotation(field: str, numbers: Numbers) -> None:
    """Raise FieldError unless the upper left 3×3 blocks of the numbers are rotations."""
    rotation = np.moveaxis(numbers[:3, :3], -1, 0)
    if np.abs(np.swapaxes(rotation, 1, 2) @ rotation - np.eye(3)).max() > EXACT:
        raise FieldError(
            field,
            say("is no rotation: its columns must be unit vectors at right angles to each other"),
        )
    if (np.linalg.det(rotation) < 0).any():
        raise FieldError(field, say("is left-handed: the determinant of a rotation is 1, not −1"))


def check_transform(field: str, numbers: Numbers) -> None:
    """Raise FieldError unless numbers ``(4, 4, samples)`` are homogeneous transforms."""
    check_rotation(field, numbers)
    if np.abs(numbers[3] - np.array([[0.0], [0.0], [0.0], [1.0]])).max() > EXACT:
        raise FieldError(field, say("must end in the row 0, 0, 0, 1"))


def _check_screws(field: str, numbers: Numbers) -> None:
    omega, v = np.linalg.norm(numbers.reshape(-1, 2, 3, numbers.shape[-1]), axis=2).swapaxes(0, 1)
    turns, slides = np.abs(omega - 1) < EXACT, (omega < EXACT) & (np.abs(v - 1) < EXACT)
    for i, fits in enumerate((turns.all(axis=1) | slides.all(axis=1)).tolist()):
        if not fits:
            raise FieldError(
                f"{field}[{i}]",
                say("is no screw axis (ω; v): either ω is a unit vector, or it is 0 and v is one"),
            )


# --- A reference robot given by a DH table: its formulas and their numbers


FormulaRow = Row[Expression]

# The quantities of the cells of a row, in the order of ``COLUMNS``.
ROW_QUANTITIES: tuple[Kind, Kind, Kind, Kind] = ("length", "angle", "length", "angle")
TOOL_ROW = "e"


@dataclass(frozen=True, slots=True)
class Joint:
    """One joint: its index, variable and type. The index is also the label of its table row."""

    index: int
    variable: str
    prismatic: bool

    @property
    def column(self) -> str:
        """The table column of the joint variable: "theta" or "d"."""
        return "d" if self.prismatic else "theta"


@dataclass(frozen=True)
class ReferenceTable:
    """A DH table of formulas in one convention: a row for each joint, then any fixed rows."""

    convention: Convention
    joints: tuple[Joint, ...]
    rows: tuple[FormulaRow, ...]

    @property
    def lazy_rows(self) -> list[dict[str, str]]:
        """Return rows of zeros with only the joint variables in their columns."""
        rows = [dict.fromkeys(COLUMNS, "0") for _ in self.rows]
        for row, joint in zip(rows, self.joints, strict=False):
            row[joint.column] = joint.variable
        return rows

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """The row labels: joint numbers, then "e" and "e2" for rows without a joint."""
        joints = tuple(str(joint.index) for joint in self.joints)
        fixed = (TOOL_ROW, f"{TOOL_ROW}2")
        return joints + fixed[: len(self.rows) - len(joints)]

    def values(self, values: SymbolValues, samples: int) -> Table:
        """Return the numbers of the table, ``(rows, 4, samples)``, at values of the symbols."""
        constants, formulas = self._constants_and_formulas
        table = np.repeat(constants[..., None], samples, axis=-1)
        for i, j, formula in formulas:
            table[i, j] = formula.evaluate(values)
        return table

    @cached_property
    def _constants_and_formulas(
        self,
    ) -> tuple[Numbers, tuple[tuple[int, int, Expression], ...]]:
        constants = np.zeros((len(self.rows), len(COLUMNS)))
        formulas = []
        for i, row in enumerate(self.rows):
            for j, formula in enumerate(row):
                if formula.symbols:
                    formulas.append((i, j, formula))
                else:
                    constants[i, j] = formula.evaluate({})
        return constants, tuple(formulas)


def at_home(joints: tuple[Joint, ...], values: SymbolValues, samples: int) -> SymbolValues:
    """Return the values with every joint variable set to 0."""
    return {**values, **{joint.variable: np.zeros(samples) for joint in joints}}


# The screw axis of a revolute and of a prismatic joint along the z axis.
ABOUT_Z = np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
ALONG_Z = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0])


@dataclass(frozen=True, slots=True)
class Robot:
    """A reference robot. ``tables`` has a table in each convention that can express it."""

    structure: str
    convention: Convention
    joints: tuple[Joint, ...]
    tables: Mapping[Convention, ReferenceTable]

    def pose(self, values: SymbolValues, samples: int) -> Matrices:
        """Return the pose of the end effector in the base frame, ``(samples, 4, 4)``."""
        table = self.tables[self.convention]
        return pose(table.values(values, samples), table.convention)

    def fields(self) -> Iterator[FormulaField]:
        """Yield every formula of the author's table with its field and quantity."""
        for i, row in enumerate(self.tables[self.convention].rows):
            for column, formula, quantity in zip(COLUMNS, row, ROW_QUANTITIES, strict=True):
                yield f"robot.table[{i}].{column}", formula, quantity

    @property
    def frames(self) -> tuple[int | str, ...]:
        """The names of the robot's frames from first to last: "base", numbers, "tool"."""
        first = self.joints[0].index
        last = first + len(self.tables[self.convention].rows) - 1
        return ("base", *range(first, last), "tool")

    def frame(self, name: int | str, values: SymbolValues, samples: int) -> Matrices:
        """Return the pose of a frame in the base frame, ``(samples, 4, 4)``."""
        return np.asarray(self.all_frames(values, samples)[self.frame_number(name)])

    def all_frames(self, values: SymbolValues, samples: int) -> Matrices:
        """Return the poses of all frames in the base frame, ``(frames, samples, 4, 4)``."""
        table = self.tables[self.convention]
        return frames(table.values(values, samples), table.convention)

    def frame_number(self, name: int | str) -> int:
        """The number of table rows between the base frame and the frame ``name``."""
        known = {"base": 0, "tool": len(self.tables[self.convention].rows)}
        return known[name] if isinstance(name, str) else name - self.joints[0].index + 1

    def has_frame(self, name: int | str) -> bool:
        """True if the robot has a frame of this name."""
        first = self.joints[0].index
        return isinstance(name, str) or first - 1 <= name < first + len(self.joints)

    def screws(self, values: SymbolValues, samples: int) -> Numbers:
        """Return the screw axes with all joint variables 0, ``(joints, samples, 6)``."""
        poses = self.all_frames(at_home(self.joints, values, samples), samples)
        on_axis = joint_frames(poses, self.convention)
        return np.stack(
            [
                moved(frame, ALONG_Z if joint.prismatic else ABOUT_Z)
                for joint, frame in zip(self.joints, on_axis, strict=False)
            ]
        )


def tables_in_both_conventions(
    joints: tuple[Joint, ...], rows: Sequence[FormulaRow], convention: Convention, zero: Expression
) -> dict[Convention, ReferenceTable]:
    """Return the author's table and, if possible, the equivalent one in the other convention."""
    if convention is Convention.STANDARD:
        other, regrouped = Convention.MODIFIED, modified_rows(rows, zero)
    else:
        other, regrouped = Convention.STANDARD, standard_rows(rows, zero)
    tables = {convention: ReferenceTable(convention, joints, tuple(rows))}
    begins_on_first_axis = all(_is_zero(cell) for cell in rows[0][:2])
    if other is Convention.MODIFIED or begins_on_first_axis:
        if len(regrouped) > len(joints) and all(_is_zero(cell) for cell in regrouped[-1]):
            regrouped.pop()
        tables[other] = ReferenceTable(other, joints, tuple(regrouped))
    return tables


def _is_zero(formula: Expression) -> bool:
    return not formula.symbols and float(formula.evaluate({})) == 0.0


# --- The reference robot given by its product of exponentials: a home pose and screw axes


@dataclass(frozen=True, slots=True)
class ScrewRobot:
    """A reference robot: ``home`` is 4×4, ``axes`` has a six-vector (ω; v) for each joint."""

    structure: str
    joints: tuple[Joint, ...]
    home: FormulaGrid
    axes: FormulaGrid

    def fields(self) -> Iterator[FormulaField]:
        """Yield every formula of the author with its field and quantity."""
        yield from fields_of("robot.home[{i}][{j}]", self.home, HOMOGENEOUS)
        yield from fields_of("robot.screws[{i}][{j}]", self.axes, (SCREW,) * len(self.axes))

    @property
    def frames(self) -> tuple[int | str, ...]:
        """The names of the robot's frames: the base (space) frame and the tool (body) frame."""
        return ("base", "tool")

    def has_frame(self, name: int | str) -> bool:
        """True if the robot has a frame of this name."""
        return name in self.frames

    def frame(self, name: int | str, values: SymbolValues, samples: int) -> Matrices:
        """Return the pose of a frame in the base frame, ``(samples, 4, 4)``."""
        if name == "base":
            return np.broadcast_to(np.eye(4), (samples, 4, 4))
        home = np.moveaxis(grid_values(self.home, values, samples), -1, 0)
        amounts = np.array([values[joint.variable] for joint in self.joints])
        return product_in_space(self.screws(values, samples), amounts, home)

    def screws(self, values: SymbolValues, samples: int) -> Numbers:
        """Return the screw axes with all joint variables 0, ``(joints, samples, 6)``."""
        return np.swapaxes(grid_values(self.axes, values, samples), 1, 2)


Reference = Robot | ScrewRobot
