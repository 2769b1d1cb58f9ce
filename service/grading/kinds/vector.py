"""Answer kind ``vector``: a list of lengths, angles and numbers."""

from service.catalogue.parts.vector import VectorSpec
from service.grading.comparison import Match
from service.grading.diagnosis.value_list import slips_of
from service.grading.formula_text import spelled
from service.grading.judging.content import known_cells, of_list
from service.grading.judging.expected import given_values
from service.grading.judging.report_rows import value_rows
from service.grading.judging.value_list import ComparedValues
from service.grading.part import Grading, Judged
from service.grading.reading.value_list import StudentValues, read_list
from service.grading.report import Correction


def read(part: VectorSpec, answer: object, grading: Grading) -> StudentValues:
    """The values in a list or a pasted text."""
    quantities = [component.quantity for component in part.components]
    return read_list(answer, quantities, grading.reader, planar=len(quantities) == 2)


def judge(part: VectorSpec, answer: StudentValues, grading: Grading) -> Judged:
    """The list with one row for each component."""
    [expected] = given_values(part, grading)
    [formulas] = grading.exercise.formulas[part.id]
    compared = ComparedValues(answer, expected)
    found = compared.matches(grading)
    wrong = found < Match.ROUNDED
    corrections: list[Correction | None] = [None] * len(formulas)
    if wrong.any() and grading.corrects:
        spelling = grading.spelling(answer.entries)
        corrections = [spelled(formula.tree, spelling) for formula in formulas]
    slips = slips_of(ComparedValues(answer, expected, corrections), wrong, grading)
    content = of_list(known_cells(expected, 0.0, compared.scales(grading)))
    return Judged(value_rows(answer, found, slips, grading), content)
