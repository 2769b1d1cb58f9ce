"""Test pasted matrices."""

import pytest
from dh_grader.pasting import GridError, read_grid

# --- Each line may be one row in round brackets

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


# --- A matrix of Eigen is read row by row, unless other statements may change it

VALUES = "1, 0, 0,\n     0, cos(q1), -sin(q1),\n     0, sin(q1), cos(q1)"
EIGEN_ROWS = [["1", "0", "0"], ["0", "cos(q1)", "-sin(q1)"], ["0", "sin(q1)", "cos(q1)"]]


@pytest.mark.parametrize(
    "text",
    [
        f"R << {VALUES};",
        f"R << {VALUES}",
        f"Matrix3d R;\nR << {VALUES};",
        f"Eigen::Matrix3f R;  // rotation\nR << {VALUES};".replace("0,\n", "0, // row\n", 1),
        f"Eigen::MatrixXd R(3, 3);\nR << {VALUES.replace(chr(10), '')};",
        f"#include <Eigen/Dense>\nusing namespace Eigen;\nMatrix<double, 3, 3> R; R<<{VALUES};",
        f"R << {VALUES};\nstd::cout << R << std::endl;",
    ],
)
def test_a_matrix_of_eigen_is_read(text: str) -> None:
    assert cells(text) == EIGEN_ROWS


def test_the_size_of_a_declaration_decides_on_the_rows() -> None:
    assert cells("Matrix2d A;\nA << a, b, c,\n d;") == [["a", "b"], ["c", "d"]]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (f"R << {VALUES};\nR *= 2;", "text_around"),
        (f"R << {VALUES};\nR = R.transpose();", "text_around"),
        (f"R << {VALUES};\nR.transposeInPlace();", "text_around"),
        (f"R << {VALUES};\nQ << {VALUES};", "text_around"),
        (f"R << {VALUES};\nstd::cout << R.transpose();", "text_around"),
        (f"R << {VALUES};\nstd::cout << 2*R;", "text_around"),
        (f"Matrix3d Q;\nR << {VALUES};", "text_around"),
        (f"Matrix4d R;\nR << {VALUES};", "wrong_count"),
        (f"MatrixXd R(2, 4);\nR << {VALUES};", "wrong_count"),
    ],
)
def test_a_statement_that_may_change_a_matrix_of_eigen_is_refused(text: str, code: str) -> None:
    with pytest.raises(GridError) as caught:
        read_grid(text)
    assert caught.value.code == code


# --- Read Word's one-line matrices: @ separates rows, & separates values


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
