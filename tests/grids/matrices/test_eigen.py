"""A matrix of Eigen is read row by row, unless other statements may change it."""

import pytest
from dh_grader.pasting import GridError, read_grid

VALUES = "1, 0, 0,\n     0, cos(q1), -sin(q1),\n     0, sin(q1), cos(q1)"
ROWS = [["1", "0", "0"], ["0", "cos(q1)", "-sin(q1)"], ["0", "sin(q1)", "cos(q1)"]]


def cells(text: str) -> list[list[str]]:
    return [[cell.text for cell in row] for row in read_grid(text).rows]


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
    assert cells(text) == ROWS


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
