"""Answer kind ``matrix``: a matrix with any meaning, entry by entry."""

from service.catalogue.parts.matrix import MatrixSpec
from service.grading.judging.content import of_matrix
from service.grading.judging.expected import given_values
from service.grading.judging.matrix import ExpectedMatrix
from service.grading.kinds.shared.matrix_rows import matrix_rows
from service.grading.part import Grading, Judged
from service.grading.reading.matrices.matrix import StudentMatrix, read_matrix


def read_matrix_answer(part: MatrixSpec, answer: object, grading: Grading) -> StudentMatrix:
    """Read the entries of a nested list or a pasted text."""
    return read_matrix(answer, part.quantities, grading.reader)


def judge_matrix_answer(part: MatrixSpec, answer: StudentMatrix, grading: Grading) -> Judged:
    """Judge the matrix entry by entry."""
    expected = ExpectedMatrix(given_values(part, grading), part.quantities)
    judged = matrix_rows(answer, expected, grading)
    content = of_matrix(expected.values, expected.scale(grading.exercise.length_scale))
    return Judged(judged.rows, content, judged.feedback)
