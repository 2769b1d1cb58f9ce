"""The size of a grid, such as 2 × 2, and its empty rows."""

import pytest
from dh_grader.pasting import read_grid


def test_size_is_rows_by_columns() -> None:
    assert read_grid("[1 2; 3 4]").size == "2 × 2"
    assert read_grid("1,2,3\n4,5").size == "2 × 2 to 3"


@pytest.mark.parametrize(
    "text",
    [
        "a, b\n, \n1, 2",
        "a; b\n;\n1; 2",
        "a\tb\n\t\n1\t2",
        "| a | b |\n|---|---|\n| | |\n| 1 | 2 |",
    ],
)
def test_an_empty_row_is_a_row_if_the_grid_needs_one_more(text: str) -> None:
    found = read_grid(text)
    assert [[cell.text for cell in row] for row in found.rows] == [["a", "b"], ["1", "2"]]
    assert found.with_empty_rows(2) == found
    with_empty = found.with_empty_rows(3)
    assert [[cell.text for cell in row] for row in with_empty.rows] == [
        ["a", "b"], ["", ""], ["1", "2"]
    ]  # fmt: skip


def test_an_empty_line_is_only_layout() -> None:
    found = read_grid("a, b\n\n1, 2")
    assert found.with_empty_rows(3) == found
