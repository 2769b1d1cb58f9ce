"""What the parts of an exercise expect, where their file says so and not the robot.

The formulas of a part are kept as a grid: the entries of a matrix, the rows of a list of screw
axes, a single row for a list. Whatever the file says is tried at some values of its symbols first,
so that no student is marked against a rotation that is none.
"""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from service.catalogue.exercise import Variable
from service.catalogue.reading import TRIALS, FieldError, no_value, read_formula, trial_values
from service.catalogue.robot import Robot
from service.catalogue.schema import (
    DhRowSpec,
    EulerAnglesSpec,
    Formula,
    MatrixSpec,
    PartSpec,
    PositionSpec,
    RotationSpec,
    ScrewAxesSpec,
    ScrewRobotSpec,
    TransformSpec,
    VectorSpec,
)
from service.catalogue.screw_robot import FormulaGrid, ScrewRobot, grid_values
from service.expressions import Kind, Vocabulary
from service.kinematics.dh_row import dh1_residual, dh2_residual
from service.kinematics.transforms import Matrices, Numbers

Reference = Robot | ScrewRobot

_LINE: tuple[Kind, ...] = ("number", "number", "number", "length")
HOMOGENEOUS: tuple[tuple[Kind, ...], ...] = (_LINE, _LINE, _LINE, ("number",) * 4)
ROTATION: tuple[tuple[Kind, ...], ...] = (("number",) * 3,) * 3
# A pitch is a length per radian, and a moment arm a length.
SCREW: tuple[Kind, ...] = ("number", "number", "number", "length", "length", "length")

# What rounding may leave of a 0 or 1 in an author's formulas.
EXACT = 1e-9


def part_formulas(
    parts: Sequence[PartSpec],
    reference: Reference | None,
    vocabulary: Vocabulary,
    variables: tuple[Variable, ...],
) -> Mapping[str, FormulaGrid]:
    """The formulas of each part that has its own, by the part's id. Raises FieldError."""
    author = _Author(vocabulary, variables)
    found: dict[str, FormulaGrid] = {}
    for i, part in enumerate(parts):
        grid = author.formulas(f"parts[{i}]", part)
        if grid is not None:
            found[part.id] = grid
        else:
            _check_robot(f"parts[{i}]", part, reference)
    return found


def _check_robot(field: str, part: PartSpec, reference: Reference | None) -> None:
    """The robot can say what is right. Raises FieldError."""
    if part.kind in ("dh_table", "link_transforms"):
        if not isinstance(reference, Robot):
            raise FieldError(
                f"{field}.kind", f'a "{part.kind}" needs a robot with a table; write [robot] table'
            )
        return
    if reference is None:
        raise FieldError(
            f"{field}.expected", "is required here: the exercise has no robot that would tell it"
        )
    for name in ("from", "to"):
        frame = getattr(part, "start" if name == "from" else "to", "base")
        if not reference.has_frame(frame):
            known = ", ".join(map(str, reference.frames))
            raise FieldError(f"{field}.{name}", f"the robot has no frame {frame!r}; it has {known}")


class _Author:
    """Reads and tries the formulas of one exercise's parts."""

    def __init__(self, vocabulary: Vocabulary, variables: tuple[Variable, ...]) -> None:
        self.vocabulary = vocabulary
        self.values = trial_values(variables)

    def formulas(self, field: str, part: PartSpec) -> FormulaGrid | None:
        """The grid of formulas that the part has, or None."""
        match part:
            case TransformSpec(expected=expected) if expected is not None:
                return self.transform(f"{field}.expected", expected)
            case RotationSpec(expected=expected) if expected is not None:
                return self._grid(f"{field}.expected", expected, ROTATION, _check_rotation)
            case RotationSpec(steps=steps) if steps is not None:
                angles = [step.angle for step in steps]
                return self._list(f"{field}.steps", angles, ["angle"] * len(angles), ".angle")
            case PositionSpec(expected=expected) if expected is not None:
                return self._list(f"{field}.expected", expected, ["length"] * len(expected))
            case EulerAnglesSpec(expected=expected) if expected is not None:
                return self._list(f"{field}.expected", expected, ["angle"] * 3)
            case ScrewAxesSpec(expected=expected) if expected is not None:
                return self.screws(f"{field}.expected", expected)
            case MatrixSpec():
                return self._grid(f"{field}.expected", part.expected, part.quantities)
            case VectorSpec():
                return self._list(
                    f"{field}.components",
                    [component.expected for component in part.components],
                    tuple(component.quantity for component in part.components),
                    ".expected",
                )
            case DhRowSpec():
                grid = self.transform(f"{field}.transform", part.transform)
                _check_conditions(f"{field}.transform", part, self._matrices(grid))
                return grid
        return None

    def transform(self, field: str, rows: Sequence[Sequence[Formula]]) -> FormulaGrid:
        """A homogeneous transform. Raises FieldError."""
        return self._grid(field, rows, HOMOGENEOUS, _check_transform)

    def screws(self, field: str, axes: Sequence[Sequence[Formula]]) -> FormulaGrid:
        """Screw axes (ω; v), each of unit length. Raises FieldError."""
        return self._grid(field, axes, (SCREW,) * len(axes), _check_screws)

    def _grid(
        self,
        field: str,
        rows: Sequence[Sequence[Formula]],
        quantities: Sequence[Sequence[Kind]],
        check: Callable[[str, Numbers], None] | None = None,
    ) -> FormulaGrid:
        grid = tuple(
            tuple(
                read_formula(f"{field}[{i}][{j}]", source, self.vocabulary, quantity)
                for j, (source, quantity) in enumerate(zip(row, row_quantities, strict=True))
            )
            for i, (row, row_quantities) in enumerate(zip(rows, quantities, strict=True))
        )
        self._check_defined(grid, lambda i, j: f"{field}[{i}][{j}]")
        if check is not None:
            check(field, grid_values(grid, self.values, TRIALS))
        return grid

    def _list(
        self, field: str, sources: Sequence[Formula], quantities: Sequence[Kind], below: str = ""
    ) -> FormulaGrid:
        row = tuple(
            read_formula(f"{field}[{i}]{below}", source, self.vocabulary, quantity)
            for i, (source, quantity) in enumerate(zip(sources, quantities, strict=True))
        )
        self._check_defined((row,), lambda _, j: f"{field}[{j}]{below}")
        return (row,)

    def _check_defined(self, grid: FormulaGrid, place: Callable[[int, int], str]) -> None:
        undefined = ~np.isfinite(grid_values(grid, self.values, TRIALS)).all(axis=-1)
        if undefined.any():
            i, j = (int(index) for index in np.argwhere(undefined)[0])
            raise FieldError(place(i, j), no_value(grid[i][j]))

    def _matrices(self, grid: FormulaGrid) -> Matrices:
        return np.moveaxis(grid_values(grid, self.values, TRIALS), -1, 0)


def _check_rotation(field: str, numbers: Numbers) -> None:
    rotation = np.moveaxis(numbers[:3, :3], -1, 0)
    if np.abs(np.swapaxes(rotation, 1, 2) @ rotation - np.eye(3)).max() > EXACT:
        raise FieldError(
            field, "is no rotation: its columns must be unit vectors at right angles to each other"
        )
    if (np.linalg.det(rotation) < 0).any():
        raise FieldError(field, "is left-handed: the determinant of a rotation is 1, not −1")


def _check_transform(field: str, numbers: Numbers) -> None:
    _check_rotation(field, numbers)
    if np.abs(numbers[3] - np.array([[0.0], [0.0], [0.0], [1.0]])).max() > EXACT:
        raise FieldError(field, "must end in the row 0, 0, 0, 1")


def _check_screws(field: str, numbers: Numbers) -> None:
    turn, slide = np.linalg.norm(numbers.reshape(-1, 2, 3, numbers.shape[-1]), axis=2).swapaxes(
        0, 1
    )
    turns, slides = np.abs(turn - 1) < EXACT, (turn < EXACT) & (np.abs(slide - 1) < EXACT)
    for i, fits in enumerate((turns.all(axis=1) | slides.all(axis=1)).tolist()):
        if not fits:
            raise FieldError(
                f"{field}[{i}]",
                "is no screw axis (ω; v): either ω is a unit vector, or it is 0 and v is one",
            )


def _check_conditions(field: str, part: DhRowSpec, transform: Matrices) -> None:
    """The two conditions hold for all values of the symbols or fail for all. Raises FieldError."""
    for residual in (
        dh1_residual(transform, part.convention),
        dh2_residual(transform, part.convention),
    ):
        holds = np.abs(residual) < EXACT
        if holds.any() and not holds.all():
            raise FieldError(
                field, "has a DH row for some values of its symbols and none for others"
            )


def screw_robot_formulas(
    spec: ScrewRobotSpec, vocabulary: Vocabulary, variables: tuple[Variable, ...]
) -> tuple[FormulaGrid, FormulaGrid]:
    """The home pose and the screw axes of a robot. Raises FieldError."""
    author = _Author(vocabulary, variables)
    home = author.transform("robot.home", spec.home)
    axes = author.screws("robot.screws", spec.screws)
    turns = np.abs(grid_values(axes, author.values, TRIALS)[:, :3]).max(axis=(1, 2)) > EXACT
    for i, (letter, turning) in enumerate(zip(spec.structure, turns.tolist(), strict=True)):
        if turning != (letter == "R"):
            moves, should = ("turns", "slides") if turning else ("slides", "turns")
            raise FieldError(
                f"robot.screws[{i}]",
                f"{moves}, but structure {spec.structure!r} says that joint {i + 1} {should}",
            )
    return home, axes
