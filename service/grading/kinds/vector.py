"""Answer kind ``vector``: a list of lengths, angles and numbers."""

from dataclasses import dataclass

import numpy as np

from service.catalogue.parts.vector import VectorSpec
from service.expressions import Kind
from service.grading.comparison import Match
from service.grading.judging.expected import own_values
from service.grading.judging.report_rows import entry_rows
from service.grading.judging.value_list import WrittenValues, slips_of
from service.grading.kinds.matrix_rows import UnreadableMatrixError
from service.grading.part import Grading, PartTerms
from service.grading.reading.value_list import read_list
from service.grading.report import PartReport, Verdict
from service.kinematics.transforms import Numbers


@dataclass(frozen=True, slots=True)
class VectorKind:
    """Grades a list component by component; angles compare modulo 2π."""

    def grade(self, part: VectorSpec, answer: object, grading: Grading) -> PartReport:
        """The report on a vector, one row for each component."""
        terms = PartTerms(part.id, part.kind, part.points, part.all_or_nothing)
        quantities: list[Kind] = [component.quantity for component in part.components]
        try:
            planar = len(quantities) == 2
            entries = read_list(answer, quantities, grading.reader, planar=planar)
        except UnreadableMatrixError as error:
            return terms.unread(Verdict.UNREADABLE, grading.visible((error.finding,)))
        expected = _expected(part, grading)
        [formulas] = grading.exercise.formulas[part.id]
        texts = [formula.text() for formula in formulas]
        written = WrittenValues(entries, expected, quantities, texts)
        found = written.matches(grading)
        slips = slips_of(written, found < Match.ROUNDED, grading)
        column = [[entry] for entry in entries]
        return terms.report(entry_rows(column, found[:, None], slips, part.points, grading))


def _expected(part: VectorSpec, grading: Grading) -> Numbers:
    values = own_values(part.id, grading.exercise, grading.samples)
    if values is None:
        raise LookupError(f"part {part.id!r} has no formulas")
    return np.asarray(values[0])
