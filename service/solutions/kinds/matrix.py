"""The model answer of kind ``matrix``: the matrix in the exercise file."""

from service.catalogue import Exercise
from service.catalogue.parts.matrix import MatrixSpec
from service.solutions import layout
from service.solutions.model_solution import PrintedAnswer
from service.solutions.work import Work


def answer_matrix(part: MatrixSpec, work: Work) -> PrintedAnswer:
    """Return the matrix in the exercise file."""
    given = work.as_written(part)
    assert given is not None
    return layout.matrix(given)


def lazy_matrix(part: MatrixSpec, _exercise: Exercise) -> list[object]:
    """Return two matrices: one of zeros, and one with 1 on the diagonal and 0 elsewhere."""
    rows, columns = len(part.quantities), len(part.quantities[0])
    zeros = [["0"] * columns for _ in range(rows)]
    ones = [["1" if i == j else "0" for j in range(columns)] for i in range(rows)]
    return [zeros, ones]
