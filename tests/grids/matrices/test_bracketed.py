"""Each line may be one row in round brackets."""

import pytest
from dh_grader.pasting import GridError, read_grid

ROWS = [["l1", "atan2(0, 1)", "0", "q1"], ["l2", "0", "0", "q2"]]


def cells(text: str) -> list[list[str]]:
    return [[cell.text for cell in row] for row in read_grid(text).rows]


@pytest.mark.parametrize("end", ["", ",", ";"])
def test_a_row_in_round_brackets_on_each_line_is_read(end: str) -> None:
    lines = [f"({', '.join(row)}){end}" for row in ROWS]
    assert cells("\n".join(lines)) == ROWS
    assert cells("\n\n".join(["(a, alpha, d, theta)", *lines]))[1:] == ROWS


@pytest.mark.parametrize(
    "text",
    [
        "(l1, 0, 0, q1)*2\n(l2, 0, 0, q2)",
        "2(l1, 0, 0, q1)\n(l2, 0, 0, q2)",
        "(l1, 0, 0, q1)'\n(l2, 0, 0, q2)'",
        "(l1, 0) + (0, q1)\n(l2, 0, 0, q2)",
        "(l1 + 2)\n(l2 + 3)",
    ],
)
def test_brackets_in_a_formula_are_no_rows(text: str) -> None:
    with pytest.raises(GridError) as caught:
        read_grid(text)
    assert caught.value.code == "ambiguous_columns"
