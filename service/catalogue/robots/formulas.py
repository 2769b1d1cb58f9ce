"""Read the formulas of an exercise file, and evaluate them at trial values of their symbols.

The values show faults in right answers, for example a matrix that is not a rotation.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from service.catalogue.files.fields import Formula, Homogeneous, Screw
from service.catalogue.robots.variables import TRIALS, Variable, trial_values
from service.expressions import Expression, ExpressionError, Kind, Vocabulary, read
from service.expressions.evaluation.samples import SymbolValues
from service.kinematics.transforms import Numbers
from service.translations import say

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
