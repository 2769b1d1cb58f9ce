"""Answer kind ``matrix``: a matrix of any meaning, entry by entry."""

from dataclasses import dataclass

from service.catalogue.parts.matrix import MatrixSpec
from service.grading.judging.expected import own_values
from service.grading.kinds.matrix_rows import (
    ExpectedMatrix,
    UnreadableMatrixError,
    judged_matrix,
    read_matrix,
)
from service.grading.part import Grading, PartTerms
from service.grading.report import PartReport, Verdict


@dataclass(frozen=True, slots=True)
class MatrixKind:
    """Grades a matrix against the formulas of the exercise."""

    def grade(self, part: MatrixSpec, answer: object, grading: Grading) -> PartReport:
        """The report on a matrix, row by row and entry by entry."""
        terms = PartTerms(part.id, part.kind, part.points, part.all_or_nothing)
        try:
            entries = read_matrix(answer, part.quantities, grading.reader)
        except UnreadableMatrixError as error:
            return terms.unread(Verdict.UNREADABLE, grading.visible((error.finding,)))
        values = own_values(part.id, grading.exercise, grading.samples)
        if values is None:
            raise LookupError(f"part {part.id!r} has no formulas")
        expected = ExpectedMatrix(values, part.quantities)
        judged = judged_matrix(entries, expected, part.points, grading)
        return terms.report(judged.rows, judged.feedback)
