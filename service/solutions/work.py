"""The state while one exercise is solved, and the steps that several answer kinds share."""

from collections.abc import Sequence
from dataclasses import dataclass

import sympy

from service.catalogue import Exercise, PartSpec, PosePartSpec
from service.catalogue.robots.robot import ROW_QUANTITIES, FormulaRow
from service.expressions import Expression, Kind, read
from service.expressions.printing.text import to_text
from service.expressions.tree import Node
from service.kinematics.dh import Convention
from service.solutions import layout
from service.solutions.algebra import Algebra
from service.solutions.chains import between, link
from service.solutions.model_solution import PrintedAnswer
from service.solutions.motions import Motion, multiplied
from service.solutions.trees import Writer


@dataclass(frozen=True, slots=True)
class Work:
    """An exercise, its conversion to SymPy, and the conversion back to trees."""

    exercise: Exercise
    algebra: Algebra
    writer: Writer

    def as_written(self, part: PartSpec) -> list[list[Node]] | None:
        """Return the part's formulas from the exercise file; None if the robot is used instead."""
        grid, written = self.exercise.formulas.get(part.id), part.formulas()
        if grid is None or written is None:
            return None
        return [self._row(*each) for each in zip(grid, written.quantities, strict=True)]

    def table_row(self, row: FormulaRow) -> list[Node]:
        """Return a row of the reference table as the author wrote it."""
        return self._row(row, ROW_QUANTITIES)

    def _row(self, formulas: Sequence[Expression], quantities: Sequence[Kind]) -> list[Node]:
        return [self._with_units(*each) for each in zip(formulas, quantities, strict=True)]

    def _with_units(self, formula: Expression, quantity: Kind) -> Node:
        # Students who work in degrees need the units.
        text = to_text(formula.tree)
        in_degrees = read(text, self.exercise.vocabulary, quantity=quantity, angle_unit="degrees")
        if in_degrees.tree == formula.tree:
            return formula.tree
        exact = self.algebra.of(formula)
        return self.writer.angle(exact) if quantity == "angle" else self.writer.number(exact)

    def pose_motions(self, part: PosePartSpec) -> list[Motion]:
        """Return the motions whose product is the pose that the part asks for."""
        return between(self.exercise, part.start, part.to, self.algebra, home=part.home)

    def matrix(self, entries: sympy.Matrix) -> PrintedAnswer:
        """Lay out a matrix of numbers and lengths."""
        return layout.matrix(
            [[self.writer.number(each) for each in row] for row in entries.tolist()]
        )

    def link_matrices(self, convention: Convention) -> dict[str, PrintedAnswer]:
        """Return the transform of each row of the robot's table, by the row's label."""
        reference = self.exercise.robot.tables[convention]
        return {
            label: self.matrix(multiplied(link(row, convention, self.algebra)).matrix())
            for label, row in zip(reference.labels, reference.rows, strict=True)
        }
