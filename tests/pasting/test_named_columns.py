"""Test tables whose columns are vectors with names."""

import pytest
from dh_grader.grading import FeedbackLevel, Submission, grade
from dh_grader.pasting import GridError, read_grid, read_grids, read_robot

from tests.shipped import shipped_exercises

# --- Named lists, objects and data frames are tables if no other statement can change them

LISTS = "a = [0 l2]; alpha = [0 pi/2]; d = [0 0]; theta = [q1 q2];"
ROWS = [["a", "alpha", "d", "theta"], ["0", "0", "0", "q1"], ["l2", "pi/2", "0", "q2"]]


@pytest.mark.parametrize(
    "text",
    [
        LISTS,
        f"% my robot\nsyms q1 q2 l2\n{LISTS}",
        LISTS.replace(" l2", "; l2").replace(" q2", "; q2"),
        LISTS.replace("; ", "\n"),
        "a = [0, l2]\nalpha = np.array([0, pi/2])\nd = [0, 0]\ntheta = (q1, q2)",
    ],
)
def test_the_lists_are_columns(text: str) -> None:
    robot = read_robot(text)
    assert robot is not None
    assert [[cell.text for cell in row] for row in robot.grid.rows] == ROWS


MATLAB_TABLE = (
    "T = table([0;l2],[0;pi/2],[0;0],[q1;q2],'VariableNames',{'a','alpha','d','theta'})\n\nT =\n\n"
    "  2x4 table\n\n    a     alpha    d    theta\n    __    _____    _    _____\n\n"
    "    0     0        0    q1\n    l2    1.5708   0    q2\n"
)


def test_the_output_below_a_table_of_matlab_is_left_out() -> None:
    robot = read_robot(MATLAB_TABLE)
    assert robot is not None
    assert [[cell.text for cell in row] for row in robot.grid.rows] == ROWS
    with pytest.raises(GridError):
        read_robot(f"{MATLAB_TABLE}\nT.alpha = deg2rad(T.alpha)")


def test_a_list_of_yaml_has_a_row_in_each_item() -> None:
    robot = read_robot(
        "- {a: 0, alpha: 0, d: 0, theta: q1}\n- {a: l2, alpha: pi/2, d: 0, theta: q2}"
    )
    assert robot is not None
    assert [[cell.text for cell in row] for row in robot.grid.rows] == ROWS


@pytest.mark.parametrize(
    "text",
    [
        f"{LISTS} offset = [0 pi/2];",
        f"{LISTS}\ntheta(2) = q2 + pi/2;",
        f"{LISTS} a = [0 0];",
        LISTS.replace("[0 pi/2]", "[0 90]*pi/180"),
        LISTS.replace("[0 pi/2]", "deg2rad([0 90])"),
        f"l2 = l1/2; {LISTS}",
    ],
)
def test_any_other_statement_leaves_the_table_unread(text: str) -> None:
    assert read_robot(text) is None


LINES = '[["0", 0, 0, "q1"], ["l2", "pi/2", 0, "q2"]]'
ITEMS = "[{'a': 0, 'alpha': 0, 'd': 0, 'theta': q1}, {'a': l2, 'alpha': pi/2, 'd': 0, 'theta': q2}]"
TURNED = '[["q1", 0, 0, "0"], ["q2", 0, "l2", "pi/2"]]'
HEADERS = "columns=['a', 'alpha', 'd', 'theta']"


def cells(text: str) -> list[list[str]]:
    robot = read_robot(text)
    grid = robot.grid if robot else read_grid(text, of_table=True)
    return [[cell.text for cell in row] for row in grid.rows]


@pytest.mark.parametrize(
    "text",
    [
        f'{{"dh_parameters": {LINES}}}',
        f'{{"robot": "2-link arm", "convention": "standard", "n": 2, "links": {LINES}}}',
        f"dh = {{'table': {LINES}}}\nprint(dh)",
        f"pd.DataFrame({LINES})",
        f"import pandas as pd\ndf = pd.DataFrame(np.array({LINES}))\ndf",
    ],
)
def test_an_object_or_a_data_frame_may_hold_the_rows(text: str) -> None:
    assert cells(text) == ROWS[1:]


@pytest.mark.parametrize(
    "text",
    [
        f"pd.DataFrame({LINES}, {HEADERS})",
        f"dh = pd.DataFrame(data={LINES}, index=[1, 2], {HEADERS})\nprint(dh)",
        f"dh = pd.DataFrame({HEADERS}, data={LINES})\nT = chain(dh)",
        f"dh = {ITEMS}\nfor row in dh:\n    T = T @ transform(row)",
    ],
)
def test_the_columns_of_a_data_frame_are_headers(text: str) -> None:
    assert cells(text) == ROWS


def test_the_columns_of_a_data_frame_may_be_in_any_order() -> None:
    found = cells(f"pd.DataFrame({TURNED}, columns=['theta', 'd', 'a', 'alpha'])")
    assert found[0] == ["theta", "d", "a", "alpha"]
    assert found[2] == ["q2", "0", "l2", "pi/2"]


@pytest.mark.parametrize(
    "text",
    [
        f'{{"unit": "degrees", "dh": {LINES}}}',
        f'{{"angles": "deg", "dh": {LINES}}}',
        f'{{"lengths": "mm", "dh": {LINES}}}',
        f'{{"length": "m", "dh": {LINES}}}',
        f'{{"robot": "an arm, angles in degrees", "dh": {LINES}}}',
        f'{{"title": "lengths in mm", "dh": {ITEMS}}}',
        f'{{"dh_in_degrees": {LINES}}}',
        f'{{"order": "other", "dh": {LINES}}}',
        f'{{"columns": "theta, d, a, alpha", "dh": {LINES}}}',
        f'{{"columns": ["theta", "d", "a", "alpha"], "dh": {LINES}}}',
        f'{{"theta_d_a_alpha": {LINES}}}',
        f'{{"left": {LINES}, "right": {TURNED}}}',
        f'{{"base": {{"d": 1}}, "dh": {LINES}}}',
        f'{{"dh": {LINES}, "offsets": [0, 1]}}',
        f'{{"arm": {{"dh": {LINES}}}}}',
        "pd.DataFrame([[1, 2, 3, 4]] * 4, index=['a', 'alpha', 'd', 'theta'])",
        "pd.DataFrame([[l1, l2], [0, 0], [0, 0], [q1, q2]], index=['a', 'alpha', 'd', 'theta'])",
        f"pd.DataFrame({LINES}, columns=names)",
        f"pd.DataFrame({LINES}, columns='theta d a alpha'.split())",
        f"pd.DataFrame({LINES}, [1, 2], ['theta', 'd', 'a', 'alpha'])",
        f"pd.DataFrame({LINES}, {HEADERS}).T",
        f"pd.DataFrame({LINES}, {HEADERS}) * 2",
        f"df = pd.DataFrame({LINES})\ndf.columns = ['theta', 'd', 'a', 'alpha']",
        f"df = pd.DataFrame({LINES}, {HEADERS})\ndf['alpha'] = np.deg2rad(df['alpha'])",
        f"df = pd.DataFrame({LINES}, {HEADERS})\ndf.alpha *= pi/180",
        f"df = pd.DataFrame({LINES}, {HEADERS})\ndf.loc[0, 'a'] = 3",
        f"df = pd.DataFrame({LINES}, {HEADERS})\ndf.drop(0, inplace=True)",
        f"df = pd.DataFrame({LINES}, {HEADERS})\ndf = df[::-1]",
        f"dh = {ITEMS}\nfor row in dh:\n    row['alpha'] = np.radians(row['alpha'])",
        f"dh = {ITEMS}\nfor row in dh: row['alpha'] *= x",
        f"dh = {ITEMS}\nfirst = dh[0]\nfirst['a'] = 3",
        f"dh = {ITEMS}\ndh[0].update(a=3)",
        f"dh = {ITEMS}\ndh.append(dict(a=1, alpha=0, d=0, theta=q3))",
        f"dh = {ITEMS}\ndh = {ITEMS}",
    ],
)
def test_an_object_or_a_data_frame_that_may_mean_something_else_is_refused(text: str) -> None:
    with pytest.raises(GridError):
        cells(text)


# --- Bullets, bold type, ``\boxed`` and "T matrix" before a matrix change nothing

STYLED_NAMES_ROWS = [["c1", "-s1", "0"], ["s1", "c1", "0"], ["0", "0", "1"]]
MATRIX = "[c1, -s1, 0; s1, c1, 0; 0, 0, 1]"
LATEX = r"\begin{bmatrix} c1 & -s1 & 0 \\ s1 & c1 & 0 \\ 0 & 0 & 1 \end{bmatrix}"
NUMPY = "np.array([[c1, -s1, 0], [s1, c1, 0], [0, 0, 1]])"
STYLES = ["**{}** = ", "**{} =** ", "- {} = ", "* {} = ", "• {} = ", "- **{}** = ", "**{}**:\n"]


def cells_of_styled(text: str) -> list[list[str]]:
    return [[cell.text.strip() for cell in row] for row in read_grid(text).rows]


@pytest.mark.parametrize("heading", STYLES)
def test_a_styled_name_before_a_matrix_is_a_name(heading: str) -> None:
    assert cells_of_styled(heading.format("T") + MATRIX) == STYLED_NAMES_ROWS
    text = "\n".join(heading.format(name) + MATRIX for name in ("A1", "A2"))
    assert [each.name.text for each in read_grids(text)] == ["A1", "A2"]


@pytest.mark.parametrize("heading", ["T matrix ", "T matrix\n", "Matrix T ", "The matrix T "])
@pytest.mark.parametrize("matrix", [MATRIX, LATEX, NUMPY])
def test_the_words_t_matrix_need_no_colon(heading: str, matrix: str) -> None:
    assert cells_of_styled(heading + matrix) == STYLED_NAMES_ROWS


@pytest.mark.parametrize("heading", ["inverse T matrix ", "T matrix inverse ", "minus matrix T "])
def test_other_words_before_a_matrix_are_refused(heading: str) -> None:
    with pytest.raises(GridError):
        read_grid(heading + LATEX)


def test_boxed_matrices_keep_their_names() -> None:
    text = f"\\boxed{{A_1 = {MATRIX}}}\n$$\\boxed{{A_2 = {MATRIX}}}$$"
    assert [each.name.text for each in read_grids(text)] == ["A_1", "A_2"]


def test_a_minus_before_a_value_is_no_bullet() -> None:
    assert cells_of_styled("- l1, 0, 0, q1\n- l2, 0, 0, q2")[0][0] == "- l1"


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
