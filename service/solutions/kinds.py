"""The right answer to a part, by its kind: one function for each."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sympy

from service.catalogue import Exercise
from service.catalogue.formulas import SCREW
from service.catalogue.parts.dh_row import DhRowSpec
from service.catalogue.parts.dh_table import DhTableSpec
from service.catalogue.parts.euler_angles import EulerAnglesSpec
from service.catalogue.parts.link_transforms import LinkTransformsSpec
from service.catalogue.parts.matrix import MatrixSpec
from service.catalogue.parts.position import PositionSpec
from service.catalogue.parts.rotation import RotationSpec
from service.catalogue.parts.screw_axes import ScrewAxesSpec
from service.catalogue.parts.transform import TransformSpec
from service.catalogue.parts.vector import VectorSpec
from service.expressions import Expression, Kind, read
from service.expressions.printing.text import to_text
from service.expressions.tree import Node
from service.kinematics.dh import Convention
from service.solutions import layout
from service.solutions.algebra import Algebra
from service.solutions.chains import between, link
from service.solutions.layout import Shown
from service.solutions.motions import Motion, Turn, X, Y, Z, multiplied
from service.solutions.orientation import euler_angles
from service.solutions.rows import dh_row
from service.solutions.screws import screw_axes
from service.solutions.trees import Writer

ROW: tuple[Kind, ...] = ("length", "angle", "length", "angle")
_AXES = {"x": X, "y": Y, "z": Z}


@dataclass(frozen=True, slots=True)
class Work:
    """One exercise being solved."""

    exercise: Exercise
    algebra: Algebra
    writer: Writer

    def own(self, part_id: str) -> list[list[sympy.Expr]] | None:
        """The formulas that the part's file gives, in SymPy; None where the robot tells."""
        grid = self.exercise.formulas.get(part_id)
        return None if grid is None else self.algebra.matrix(grid).tolist()

    def as_written(self, part_id: str, quantities: Sequence[Kind]) -> list[list[Node]] | None:
        """The same as the author has written them."""
        grid = self.exercise.formulas.get(part_id)
        if grid is None:
            return None
        return [
            [self.spelled(formula, kind) for formula, kind in zip(row, quantities, strict=True)]
            for row in grid
        ]

    def spelled(self, formula: Expression, quantity: Kind) -> Node:
        """The author's formula, with units where those who work in degrees would miss them."""
        text = to_text(formula.tree)
        in_degrees = read(text, self.exercise.vocabulary, quantity=quantity, angle_unit="degrees")
        if in_degrees.tree == formula.tree:
            return formula.tree
        exact = self.algebra.of(formula)
        return self.writer.angle(exact) if quantity == "angle" else self.writer.number(exact)

    def matrix(self, entries: sympy.Matrix) -> Shown:
        """A matrix of numbers and lengths."""
        return layout.matrix(
            [[self.writer.number(each) for each in row] for row in entries.tolist()]
        )


def _dh_table(part: DhTableSpec, work: Work) -> Shown:
    robot = work.exercise.robot
    either = part.convention == "either"
    convention = robot.convention if part.convention == "either" else part.convention
    reference = robot.tables[convention]
    rows = [
        [work.spelled(formula, kind) for formula, kind in zip(row, ROW, strict=True)]
        for row in reference.rows
    ]
    return layout.table(rows, reference.labels, convention, named=either)


def pose_motions(
    part: TransformSpec | RotationSpec | PositionSpec | EulerAnglesSpec, work: Work
) -> list[Motion]:
    """The motions that lead to the pose of the robot that the part asks for."""
    return between(work.exercise, part.start, part.to, work.algebra, home=part.home)


def _transform(part: TransformSpec, work: Work) -> Shown:
    own = work.as_written(part.id, ["number", "number", "number", "length"])
    return layout.matrix(own) if own else work.matrix(multiplied(pose_motions(part, work)).matrix())


def _rotation(part: RotationSpec, work: Work) -> Shown:
    if part.steps is None:
        own = work.as_written(part.id, ["number"] * 3)
        if own:
            return layout.matrix(own)
    return work.matrix(multiplied(_turns(part, work)).rotation)


def _turns(part: RotationSpec, work: Work) -> list[Motion]:
    """The turns that the rotation is made of; about a fixed axis they go before all others."""
    angles = work.own(part.id)
    if part.steps is None or angles is None:
        return pose_motions(part, work)
    motions: list[Motion] = []
    for step, angle in zip(part.steps, angles[0], strict=True):
        motions.insert(0 if step.about == "fixed" else len(motions), Turn(_AXES[step.axis], angle))
    return motions


def _position(part: PositionSpec, work: Work) -> Shown:
    own = work.as_written(part.id, ["length"] * len(part.coordinates))
    if own:
        return layout.listed(own[0])
    position = multiplied(pose_motions(part, work)).position
    return layout.listed(
        [work.writer.number(position["xyz".index(letter)]) for letter in part.coordinates]
    )


def _vector(part: VectorSpec, work: Work) -> Shown:
    own = work.as_written(part.id, [component.quantity for component in part.components])
    assert own is not None
    return layout.listed(own[0])


def _euler_angles(part: EulerAnglesSpec, work: Work) -> Shown:
    own = work.as_written(part.id, ["angle"] * 3)
    if own:
        return layout.listed(own[0])
    angles = euler_angles(pose_motions(part, work), part.turns, part.axes)
    return layout.listed(list(map(work.writer.angle, angles)))


def _screw_axes(part: ScrewAxesSpec, work: Work) -> Shown:
    own = work.as_written(part.id, SCREW)
    return (
        layout.matrix(own)
        if own
        else work.matrix(sympy.Matrix(screw_axes(work.exercise, part.frame, work.algebra)))
    )


def _matrix(part: MatrixSpec, work: Work) -> Shown:
    own = work.as_written(part.id, list(part.quantities[0]))
    assert own is not None
    return layout.matrix(own)


def _dh_row(part: DhRowSpec, work: Work) -> Shown:
    row = dh_row(part, work.exercise, work.algebra)
    if row is None:
        return layout.no_row()
    write = {"angle": work.writer.angle, "length": work.writer.number}
    nodes = [write[kind](cell) for kind, cell in zip(ROW, row, strict=True)]
    return layout.row(nodes, "1", part.convention)


def _link_transforms(part: LinkTransformsSpec, work: Work) -> Shown:
    matrices = link_matrices(work, part.convention)
    return Shown(
        [shown.answer for shown in matrices.values()],
        "\n\n".join(f"A{label} =\n{shown.text}" for label, shown in matrices.items()),
        "\n".join(
            f"A_{{{label}}} = {shown.latex}" + r" \quad" for label, shown in matrices.items()
        ),
    )


def link_matrices(work: Work, convention: Convention) -> dict[str, Shown]:
    """The transform of each row of the robot's table in this convention, by its label."""
    reference = work.exercise.robot.tables[convention]
    return {
        label: work.matrix(multiplied(link(row, convention, work.algebra)).matrix())
        for label, row in zip(reference.labels, reference.rows, strict=True)
    }


# What is right in each kind of part, as an answer in the students' notation.
ANSWERS: Mapping[str, Callable[[Any, Work], Shown]] = {
    "dh_table": _dh_table,
    "link_transforms": _link_transforms,
    "transform": _transform,
    "rotation": _rotation,
    "matrix": _matrix,
    "position": _position,
    "vector": _vector,
    "euler_angles": _euler_angles,
    "screw_axes": _screw_axes,
    "dh_row": _dh_row,
}
