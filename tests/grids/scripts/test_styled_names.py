r"""Bullets, bold type, ``\boxed`` and "T matrix" before a matrix change nothing."""

import pytest
from dh_grader.grading import FeedbackLevel, Submission, grade
from dh_grader.pasting import GridError, read_grid, read_grids

from tests.shipped import shipped_exercises

ROWS = [["c1", "-s1", "0"], ["s1", "c1", "0"], ["0", "0", "1"]]
MATRIX = "[c1, -s1, 0; s1, c1, 0; 0, 0, 1]"
LATEX = r"\begin{bmatrix} c1 & -s1 & 0 \\ s1 & c1 & 0 \\ 0 & 0 & 1 \end{bmatrix}"
NUMPY = "np.array([[c1, -s1, 0], [s1, c1, 0], [0, 0, 1]])"
STYLES = ["**{}** = ", "**{} =** ", "- {} = ", "* {} = ", "• {} = ", "- **{}** = ", "**{}**:\n"]


def cells(text: str) -> list[list[str]]:
    return [[cell.text.strip() for cell in row] for row in read_grid(text).rows]


@pytest.mark.parametrize("heading", STYLES)
def test_a_styled_name_before_a_matrix_is_a_name(heading: str) -> None:
    assert cells(heading.format("T") + MATRIX) == ROWS
    text = "\n".join(heading.format(name) + MATRIX for name in ("A1", "A2"))
    assert [each.name.text for each in read_grids(text)] == ["A1", "A2"]


@pytest.mark.parametrize("heading", ["T matrix ", "T matrix\n", "Matrix T ", "The matrix T "])
@pytest.mark.parametrize("matrix", [MATRIX, LATEX, NUMPY])
def test_the_words_t_matrix_need_no_colon(heading: str, matrix: str) -> None:
    assert cells(heading + matrix) == ROWS


@pytest.mark.parametrize("heading", ["inverse T matrix ", "T matrix inverse ", "minus matrix T "])
def test_other_words_before_a_matrix_are_refused(heading: str) -> None:
    with pytest.raises(GridError):
        read_grid(heading + LATEX)


def test_boxed_matrices_keep_their_names() -> None:
    text = f"\\boxed{{A_1 = {MATRIX}}}\n$$\\boxed{{A_2 = {MATRIX}}}$$"
    assert [each.name.text for each in read_grids(text)] == ["A_1", "A_2"]


def test_a_minus_before_a_value_is_no_bullet() -> None:
    assert cells("- l1, 0, 0, q1\n- l2, 0, 0, q2")[0][0] == "- l1"


TABLE = "a, alpha, d, theta\n0, 0, 0, q1\nl1, 0, 0, q2\nl2, 0, 0, q3\nl3, 0, 0, 0"
BARS = "\n".join(f"| {' | '.join(line.split(', '))} |" for line in TABLE.splitlines())


def points(text: str) -> float:
    exercise = shipped_exercises()["planar-rrr"]
    return grade(exercise, Submission({"table": text}, feedback=FeedbackLevel.FULL)).parts[0].points


@pytest.mark.parametrize("table", [TABLE, BARS], ids=["commas", "bars"])
@pytest.mark.parametrize(
    "line",
    [
        "![my robot](figure.png)",
        "![[figure.png]]",
        '<img src="figure.png">',
        r"\includegraphics[width=5cm]{robot.png}",
        r"$$T_i = R_z(\theta_i) T_z(d_i) T_x(a_i) R_x(\alpha_i)$$",
        "A_i = Rot_z(theta_i) Trans_z(d_i) Trans_x(a_i) Rot_x(alpha_i)",
        "T = A1*A2*A3",
    ],
)
def test_an_image_or_a_product_above_a_table_spoils_nothing(line: str, table: str) -> None:
    assert points(f"{line}\n\n{table}") == points(table) == 8


@pytest.mark.parametrize("line", ["T = A1 + 2", "q1 = q1 + 90deg", "A_i = Rot_z(theta_i + 90)"])
def test_other_formulas_above_a_table_are_not_dropped(line: str) -> None:
    try:
        notes = read_grid(f"{line}\n\n{BARS}", of_table=True).notes
    except GridError:
        return
    assert "text_left_aside" not in {note.code for note in notes}


@pytest.mark.parametrize("last", ["5 |", "| 5 |"])
def test_a_last_row_that_was_only_begun_spoils_nothing(last: str) -> None:
    assert points(f"{BARS}\n{last}") == 8


def test_a_begun_row_that_is_needed_stays() -> None:
    rows = BARS.splitlines()
    assert points("\n".join([*rows[:3], "3 |"])) < 8
