"""The model answer of kind ``matrix``: the matrix that the file gives."""

from service.catalogue.parts.matrix import MatrixSpec
from service.solutions import layout
from service.solutions.model_solution import PrintedAnswer
from service.solutions.work import Work


def answer(part: MatrixSpec, work: Work) -> PrintedAnswer:
    """The entries row by row."""
    given = work.as_written(part)
    assert given is not None
    return layout.matrix(given)
