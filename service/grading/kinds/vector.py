"""Answer kind ``vector``: a list of lengths, angles and numbers."""

import numpy as np

from service.catalogue.parts.vector import VectorSpec
from service.grading.diagnosis.lists.value_list import SEARCH_WORK, search_of, slips_of
from service.grading.diagnosis.upstream.slipped_answers import SlippedAnswers, slipped_answers
from service.grading.diagnosis.wrong_value import Mask
from service.grading.feedback import Finding
from service.grading.formula_text import spelled
from service.grading.judging.content import known_cells, of_list
from service.grading.judging.expected import given_values
from service.grading.judging.report_rows import value_places, value_rows
from service.grading.judging.value_list import ComparedValues
from service.grading.numerics.comparison import Match
from service.grading.part import Grading, Judged
from service.grading.reading.lists.component_names import names_of_components
from service.grading.reading.lists.value_list import PLANAR, StudentValues, read_list
from service.grading.report import Correction


def read_vector_answer(part: VectorSpec, answer: object, grading: Grading) -> StudentValues:
    """Read the values in a list or a pasted text."""
    names = names_of_components(
        tuple((each.name, each.quantity) for each in part.components), grading.reader.vocabulary
    )
    tails = (PLANAR,) if len(part.components) == len("xy") else ()
    return read_list(answer, names, grading.reader, tails)


def judge_vector_answer(part: VectorSpec, answer: StudentValues, grading: Grading) -> Judged:
    """Judge the values; the report has one row for each component."""
    [expected] = given_values(part, grading)
    [formulas] = grading.exercise.formulas[part.id]
    compared = ComparedValues(answer, expected)
    found = compared.matches(grading)
    wrong = found < Match.ROUNDED
    corrections: list[Correction | None] = [None] * len(formulas)
    if wrong.any() and grading.corrects:
        spelling = grading.spelling(answer.entries)
        corrections = [spelled(formula.tree, spelling) for formula in formulas]
    different = found == Match.DIFFERENT
    explains = wrong.any() and grading.affords(SEARCH_WORK)
    answers = slipped_answers(part, grading) if explains else None
    answers = answers and answers.of(lambda grid: grid[:, 0])
    explained = _slip(answers, compared, different, grading) if different.sum() > 1 else None
    wrong &= ~(different & bool(explained))
    corrected = ComparedValues(answer, expected, corrections)
    slips = slips_of(corrected, wrong, grading, answers)
    content = of_list(known_cells(expected, 0.0, compared.scales(grading)))
    feedback = grading.messages((explained,), value_places(different)) if explained else ()
    return Judged(value_rows(answer, found, slips, grading), content, feedback)


def _slip(
    answers: SlippedAnswers | None, compared: ComparedValues, wrong: Mask, grading: Grading
) -> Finding | None:
    # None if fewer than two values are wrong.
    search = search_of(answers, compared, wrong, grading)
    found = search.explanation(np.ones_like(wrong)) if search else None
    return None if found is None else found.findings[0]
