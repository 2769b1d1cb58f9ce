"""Columns and rows of a matrix whose signs are all wrong."""

from service.grading.diagnosis.matrices.matrix_case import UPPER_ROWS, MatrixCase
from service.grading.diagnosis.wrong_value import Hypotheses
from service.grading.feedback import Finding
from service.grading.misconception import Written, misconception
from service.translations import listed, say, say_count


class Lines:
    """The columns and rows of a wrong matrix."""


@misconception(
    of=Lines,
    rank=10,
    code=("column_sign", "row_sign"),
    rule="rotation_columns",
    means=(
        "a whole column has the wrong sign: an axis of the last frame points the opposite way",
        "a whole row has the wrong sign: an axis of the first frame points the opposite way",
    ),
    example=("homogeneous-inverse", "numbers", {"3/2": "1", "3/4": "-2"}),
    unlike={"1/4": "1"},
)
def line_sign(case: MatrixCase) -> Hypotheses:
    """A whole column or row has the wrong sign."""
    # A column or row with a single wrong entry is not reported here.
    opposite = case.agree(case.actual, -case.expected)
    wrong = case.wrong & case.mask(UPPER_ROWS)
    columns = [j for j in range(wrong.shape[1]) if opposite[:3, j].all() and wrong[:, j].sum() > 1]
    rows = [i for i in range(3) if opposite[i].all() and wrong[i].sum() > 1]
    by_column = case.mask(*((slice(0, 3), slice(j, j + 1)) for j in columns))
    by_row = case.mask(*((slice(i, i + 1), slice(None)) for i in rows))
    if columns and (by_column & wrong).sum() >= (by_row & wrong).sum():
        yield Written(-case.expected[by_column], _column_sign(columns), by_column)
    elif rows:
        yield Written(-case.expected[by_row], _row_sign(rows), by_row)


def _column_sign(columns: list[int]) -> Finding:
    # Translators: {parts} is a list such as "x axis and position".
    hint = say_count(
        "Column {columns} has the wrong sign throughout: check which way the {parts} of the last "
        "frame should point.",
        "Columns {columns} have the wrong sign throughout: check which way the {parts} of the last "
        "frame should point.",
        count=len(columns),
        columns=_numbers(columns),
        parts=_parts(columns),
    )
    return Finding("column_sign", hint, say("Change the sign of each entry there."))


def _row_sign(rows: list[int]) -> Finding:
    # Translators: {parts} is a list such as "x axis and z axis".
    hint = say_count(
        "Row {rows} has the wrong sign throughout: check which way the {parts} of the first frame "
        "should point.",
        "Rows {rows} have the wrong sign throughout: check which way the {parts} of the first "
        "frame should point.",
        count=len(rows),
        rows=_numbers(rows),
        parts=_parts(rows),
    )
    return Finding("row_sign", hint, say("Change the sign of each entry there."))


def _numbers(indices: list[int]) -> str:
    return listed([str(i + 1) for i in indices])


def _parts(indices: list[int]) -> str:
    names = [*(say("{letter} axis", letter=letter) for letter in "xyz"), say("position vector")]
    return listed([names[i] for i in indices])
