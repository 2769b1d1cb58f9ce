"""Read Word's one-line matrices: @ separates rows, & separates values."""

import pytest
from dh_grader.pasting import GridError, read_grid


@pytest.mark.parametrize(
    "text",
    [
        "■(a&b@c&d)",
        "[■(a&b@c&d)]",
        "T=(■8(a & b @ c & d))",
        "A_1^0=[ ■(a&b@c&d) ]#(3)",
        "⒨(a&b@c&d)",
        "\\bmatrix(a&b@c&d).",
    ],
)
def test_each_form_has_the_same_cells(text: str) -> None:
    assert [[cell.text for cell in row] for row in read_grid(text).rows] == [["a", "b"], ["c", "d"]]


def test_separators_in_brackets_separate_nothing() -> None:
    assert read_grid("[■(f(a&b)&〖c@d〗@1&2)]").size == "2 × 2"


@pytest.mark.parametrize(
    "text", ["2[■(1&2@3&4)]", "[■(1&2@3&4)]^T", "|■(1&2@3&4)|", "[■(1&2)][■(3&4)]", "A[■(1&2@3&4)]"]
)
def test_text_beside_the_matrix_is_refused(text: str) -> None:
    with pytest.raises(GridError) as caught:
        read_grid(text)
    assert caught.value.code == "text_around"


def test_an_equation_array_is_a_column() -> None:
    assert read_grid("p=[█(a@b@c)]").size == "3 × 1"


def test_an_equation_array_with_aligned_lines_is_refused() -> None:
    with pytest.raises(GridError) as caught:
        read_grid("█(x&=a@y&=b)")
    assert caught.value.code == "no_grid"


@pytest.mark.parametrize("text", ["[■(1&2@3&4]", "[■((1&2@3&4)]", "■("])
def test_brackets_must_fit(text: str) -> None:
    with pytest.raises(GridError) as caught:
        read_grid(text)
    assert caught.value.code == "unbalanced_bracket"
