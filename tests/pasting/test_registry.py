"""Test the formats of pasted text, and what they have in common."""

import numpy as np
import pytest
from dh_grader.expressions import Kind, Vocabulary, joint_variable
from dh_grader.grading.numbers import Samples
from dh_grader.grading.reading.entries import Reader
from dh_grader.grading.reading.matrices import read_matrices, read_matrix
from dh_grader.grading.report import UnreadableAnswerError
from dh_grader.pasting import GridError, read_grid
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.pasting.writers import FORMATS, MATRICES, POSE, Rows
from tests.together import together

# --- Each format reads back its own cells, and refuses other texts

CALLS = [["atan2(y,x)", "q1", "(a+b)*c"], ["1", "(a+b)", "-(a)"], ["q[0]", "cos(q1)", "1e-3"]]
ROUND = [["atan2(y, x)", "(a1 + b) * c"], ["-cos(q1 - q2)", "2 * sin(q1)"]]


def cells(text: str) -> list[list[str]]:
    return [[cell.text for cell in row] for row in read_grid(text).rows]


@together("name", FORMATS)
@together("rows", [POSE, CALLS])
def test_each_format_reads_back_its_cells(name: str, rows: Rows) -> None:
    assert cells(FORMATS[name](rows)) == rows


# In formats with blanks as separators, MATLAB's rule keeps spaced sums and products in one cell.
@together("name", FORMATS)
def test_blanks_and_commas_in_brackets_split_nothing(name: str) -> None:
    assert cells(FORMATS[name](ROUND)) == ROUND


# Two operators in a row may be the marks of a comment: /*
WORDS = st.from_regex(r"[a-cqθ0-9](?:[*/]?[+-]?[a-c0-9]){0,3}", fullmatch=True)


@settings(max_examples=12)
@given(rows=st.lists(st.lists(WORDS, min_size=3, max_size=3), min_size=2, max_size=5))
def test_each_format_reads_back_random_cells(rows: list[list[str]]) -> None:
    assert {name: cells(write(rows)) for name, write in FORMATS.items()} == dict.fromkeys(
        FORMATS, rows
    )


@together("name", sorted(FORMATS))
def test_windows_line_ends_and_blank_lines_change_nothing(name: str) -> None:
    text = FORMATS[name](POSE).replace("\r\n", "\n")
    assert cells(text.replace("\n", "\r\n")) == POSE
    assert cells("\n" + text + "\n\n") == POSE


@together(
    ("text", "expected"),
    [
        # MATLAB's rule for blanks and signs
        ("[c1 -s1 0]", [["c1", "-s1", "0"]]),
        ("[c1 - s1 0]", [["c1 - s1", "0"]]),
        ("[c1 -  s1 0]", [["c1 -  s1", "0"]]),
        ("[c1- s1 0]", [["c1- s1", "0"]]),
        ("[c1-s1 0]", [["c1-s1", "0"]]),
        ("[c1 + -s1 0]", [["c1 + -s1", "0"]]),
        ("[ -c1 +s1 ]", [["-c1", "+s1"]]),
        ("[- c1 0]", [["- c1", "0"]]),
        ("[a * b, c]", [["a * b", "c"]]),
        ("[a .* b c]", [["a .* b", "c"]]),
        ("[a ./b c]", [["a ./b", "c"]]),
        ("[(a - b) -(c)]", [["(a - b)", "-(c)"]]),
        ("[1 2\n3 4]", [["1", "2"], ["3", "4"]]),
        ("[1 2 % one\n3 4 # two\n]", [["1", "2"], ["3", "4"]]),
        ("[1 ...\n 2; 3 4]", [["1", "2"], ["3", "4"]]),
        ("[1, 2,; 3, 4;]", [["1", "2"], ["3", "4"]]),
        ("syms q1 q2\nA = [1 2; 3 4];", [["1", "2"], ["3", "4"]]),
        # Scilab, but not the // of Mathematica and Python
        ("[1 2; // one\n3 4]; // two", [["1", "2"], ["3", "4"]]),
        ("{{1, 2}, {3, 4}} // MatrixForm", [["1", "2"], ["3", "4"]]),
        ("[[q1, 4 // 2], [3, 4]]", [["q1", "4 // 2"], ["3", "4"]]),
        (">> A = [1 2; 3 4]", [["1", "2"], ["3", "4"]]),
        ("T(q1, q2) = [1 2; 3 4]", [["1", "2"], ["3", "4"]]),
        ("[[1 2]; [3 4]]", [["1", "2"], ["3", "4"]]),
        ("['a' 'b'; 'c' 'd']", [["a", "b"], ["c", "d"]]),
        ("sym([1 2; 3 4])", [["1", "2"], ["3", "4"]]),
        # a function and its argument, a number and its unit
        ("[sin q1 cos (q2) 0]", [["sin q1", "cos (q2)", "0"]]),
        ("[sin^2 q1 atan2 (y, x)]", [["sin^2 q1", "atan2 (y, x)"]]),
        ("[90 deg 90 ° -45 deg]", [["90 deg", "90 °", "-45 deg"]]),
        # the star that marks a joint variable does not multiply it by the next column
        ("[0 d3* 0; 1 2 3]", [["0", "d3*", "0"], ["1", "2", "3"]]),
        # commas and blanks
        ("[l1 c1 + l2 c12, 0; s1, 1]", [["l1 c1 + l2 c12", "0"], ["s1", "1"]]),
        ("[c1 -s1, 0; 1 2 3]", [["c1", "-s1", "0"], ["1", "2", "3"]]),
        # Python
        ("[[a, b],\n [c, d],]", [["a", "b"], ["c", "d"]]),
        ("[a, b]", [["a", "b"]]),
        ("Matrix([a, b])", [["a"], ["b"]]),
        ("np.array([a, b])", [["a", "b"]]),
        ("Matrix([\n[a, b],\n[c, d]])", [["a", "b"], ["c", "d"]]),
        ("np.array(sp.Matrix([[a, b]]), dtype=float)", [["a", "b"]]),
        ("[(a + b), (c + d)]", [["(a + b)", "(c + d)"]]),
        ("Out[3]: [[a, b], [c, d]]", [["a", "b"], ["c", "d"]]),
        ("matrix([a, b], [c, d])", [["a", "b"], ["c", "d"]]),
        ("{{a, b}, {c, d}}", [["a", "b"], ["c", "d"]]),
        ("[a, b],\n[c, d]", [["a", "b"], ["c", "d"]]),
        # JSON: escapes are undone, but a LaTeX command is none
        (r'[["\u03b81", "\"x\""], ["\\theta", "\theta"]]', [["θ1", '"x"'], ["\\theta", "\\theta"]]),
        ("[[0, 1.5], [-2, 1e-3]]", [["0", "1.5"], ["-2", "1e-3"]]),
        # LaTeX
        (r"a & b \\ c & d \\", [["a", "b"], ["c", "d"]]),
        (r"\begin{bmatrix}a&b\\[2pt]c&d\end{bmatrix}", [["a", "b"], ["c", "d"]]),
        (r"\begin{bmatrix}a&b\\ [c] & d\end{bmatrix}", [["a", "b"], ["[c]", "d"]]),
        (r"\begin{bmatrix}a&b\\*[1.5ex]c&d\end{bmatrix}", [["a", "b"], ["c", "d"]]),
        (r"\begin{bmatrix}a\&x&{b&y}\end{bmatrix}", [[r"a\&x", "{b&y}"]]),
        (r"\begin{tabular*}{3cm}[t]{@{}l|p{2cm}@{}} a & b \end{tabular*}", [["a", "b"]]),
        # a bracket at the beginning of a cell is not an option of the command before it
        (r"\begin{tabular}{cc} [a] + b & c \end{tabular}", [["[a] + b", "c"]]),
        (r"\begin{bmatrix*} [a] + b & c \end{bmatrix*}", [["[a] + b", "c"]]),
        (r"\begin{array}{cc} \hline [a] + b & (c) d \end{array}", [["[a] + b", "(c) d"]]),
        (r"\begin{array}{cc} \hline {a} + b & c \end{array}", [["{a} + b", "c"]]),
        (r"\begin{array}{cc} \toprule (a) b & [c] d \end{array}", [["(a) b", "[c] d"]]),
        (r"\begin{array}{cc} \toprule[1pt] (a) b & c \end{array}", [["(a) b", "c"]]),
        (r"\begin{array}{cc} \cmidrule(lr){1-2} (a) & c \end{array}", [["(a)", "c"]]),
        (r"\begin{array}{cc} a & b \\ [2\pi] c & d \end{array}", [["a", "b"], [r"[2\pi] c", "d"]]),
        (r"\begin{bmatrix} \displaystyle{a} b & c \end{bmatrix}", [["{a} b", "c"]]),
        (
            r"\begin{array}{cc} a & b \tabularnewline \cline{1-2} c & d \end{array}",
            [["a", "b"], ["c", "d"]],
        ),
        (r"\left(\begin{matrix} a & b \end{matrix}\right).", [["a", "b"]]),
        (r"\begin{align*} T &= \begin{bmatrix} a & b \end{bmatrix} \\ \end{align*}", [["a", "b"]]),
        (r"\cos{\left(q_1 \right)} & \bigl[ x \Bigr] \\", [[r"\cos{(q_1 )}", "[ x ]"]]),
        (r"T = A_1 A_2 = \begin{bmatrix} a & b \end{bmatrix}", [["a", "b"]]),
        ("\\begin{matrix} a % first\n & 5\\% \\end{matrix}", [["a", "5\\%"]]),
        (r"\begin{tabular}{cc} $a_1$ & $x$ + $y$ \end{tabular}", [["a_1", "x  +  y"]]),
        (r"\begin{NiceTabular}{cc}[hvlines] a & b \end{NiceTabular}", [["a", "b"]]),
        (r"\begin{bNiceMatrix}[margin] a & b \end{bNiceMatrix}", [["a", "b"]]),
        (r"\begin{bNiceMatrix} [a] + b & c \end{bNiceMatrix}", [["[a] + b", "c"]]),
        # HTML
        ("<table><tr><td>x<sup>2</sup><td>90<sup>o</sup></table>", [["x^(2)", "90°"]]),
        ("<tr><th>a<sub>i-1</sub></th><th>&alpha;&nbsp;</th></tr>", [["a_{i-1}", "α"]]),
        ("<tr><td>θ<sub>1</sub><sup>*</sup><td><b>d</b><br>3", [["θ_{1}*", "d 3"]]),
        ("<tr><td>1 < 2 & 3<td>&lt;", [["1 < 2 & 3", "<"]]),
        ("<table><style>td{}</style><tr><td colspan='1'>a<td>b</table>", [["a", "b"]]),
        # escapes in strings: a surrogate pair, and half of one
        (r'[["\u03b8", "\ud835\udf03", "\ud800 a"]]', [["θ", "𝜃", "\ufffd a"]]),
        # spreadsheets
        ('"a ""x""",b\n"atan2(y, x)",c', [['a "x"', "b"], ["atan2(y, x)", "c"]]),
        ("a\tb\t\t\nc\td\t\t\n\t\t\t\n", [["a", "b"], ["c", "d"]]),
        ("\t\ta\tb\n\t\tc\td", [["a", "b"], ["c", "d"]]),
        ('"a\nb"\tc\nd\te', [["a\nb", "c"], ["d", "e"]]),
        ("(a, 0, 0, q1\n1, 2, 3, 4", [["(a", "0", "0", "q1"], ["1", "2", "3", "4"]]),
        ("(a, 0\n1), 2", [["(a", "0"], ["1)", "2"]]),
        ("atan2(y, x), 1\n2, (a, b)", [["atan2(y, x)", "1"], ["2", "(a, b)"]]),
        ("0,5;1\n2;3", [["0.5", "1"], ["2", "3"]]),
        ("a,\tb,\tc\nd,\te,\tf", [["a", "b", "c"], ["d", "e", "f"]]),
        ("\ufeffa,b\nc,d", [["a", "b"], ["c", "d"]]),
        # Markdown
        ("|a \\| b|c|\n|-|-|\n|`d`|**e**|", [["a \\| b", "c"], ["d", "e"]]),
        ("| | a |\n|---|---|\n| 1 | b |", [["", "a"], ["1", "b"]]),
        ("+---+---+\n| a | b |\n+===+===+\n| c | d |\n+---+---+", [["a", "b"], ["c", "d"]]),
        ("||a||b||\n|c|d|", [["a", "b"], ["c", "d"]]),
        # quotation marks of word processors around whole cells
        ("„a“;“b”\n« c »;»d«", [["a", "b"], ["c", "d"]]),
        ("«a» + «b»; c\nd; e", [["«a» + «b»", "c"], ["d", "e"]]),
        # columns
        ("a   b\n-------\n1   q1 + 90", [["a", "b"], ["1", "q1 + 90"]]),
        ("a  link length\n1  2x", [["a", "link length"], ["1", "2x"]]),
    ],
)  # fmt: skip
def test_cells_of_a_written_text(text: str, expected: list[list[str]]) -> None:
    assert cells(text) == expected


@pytest.mark.parametrize(
    ("text", "code", "marked"),
    [
        ("[c1 -s1; s1 c1]", "blank_before_sign", "-s1"),
        ("[l1 c1 + l2 c12, 0; s1, 1]", "commas_separate", "l1 c1 + l2 c12, 0; s1, 1"),
        ("a b\nc d", "blank_columns", "a"),
        # a script: a note lists its numbers, which are not used
        (
            "a1 = 0.4; % m\na2 = .3;\nT = [a1, a2; 0, 1];\ndisp(T)",
            "given_numbers",
            "a1 = 0.4; % m\na2 = .3",
        ),
        ("clc; a1 = 4e-1; q1 = sym('q1'); T = [a1, q1; 0, 1];", "given_numbers", "a1 = 4e-1"),
    ],
)
def test_an_ambiguous_reading_has_a_note(text: str, code: str, marked: str) -> None:
    grid = read_grid(text)
    [note] = grid.notes
    assert grid.size == "2 × 2"
    assert (note.code, text[slice(*note.span)]) == (code, marked)


@pytest.mark.parametrize("name", ["MATLAB", "nested list", "CSV", "Markdown", "bmatrix"])
def test_an_unambiguous_reading_has_no_note(name: str) -> None:
    assert read_grid(MATRICES.get(name, FORMATS[name])(POSE)).notes == ()


def refusal(text: str) -> GridError:
    with pytest.raises(GridError) as caught:
        read_grid(text)
    return caught.value


@together(
    ("text", "code", "marked"),
    [
        ("", "empty", ""),
        (" \n\t", "empty", " \n\t"),
        ("q1", "no_grid", "q1"),
        ("0 0 0 q1", "no_grid", "0 0 0 q1"),
        ("atan2(y, x)", "no_grid", "atan2(y, x)"),
        # text around a matrix may change it
        ("[1 2; 3 4]'", "text_around", "'"),
        ("[1 2; 3 4]*[5; 6]", "text_around", "*[5; 6]"),
        ("[1 2; 3 4] [5 6; 7 8]", "text_around", "5 6; 7 8"),
        ("[[1, 2], [3, 4]].T", "text_around", "T"),
        ("Matrix([[1, 2]]).T", "text_around", ".T"),
        ("np.array([[1, 2]]) @ B", "text_around", "@ B"),
        (r"\frac{1}{2}\begin{bmatrix}1&2\end{bmatrix}", "text_around", r"\frac{1}{2}"),
        (r"2\begin{bmatrix}1&2\end{bmatrix}", "text_around", "2"),
        (r"\begin{bmatrix}1&2\end{bmatrix}^{-1}", "text_around", "^{-1}"),
        (r"\begin{bmatrix}1&2\end{bmatrix}^T", "text_around", "^T"),
        (r"\begin{bmatrix}1&2\end{bmatrix}\begin{bmatrix}1&2\end{bmatrix}", "text_around",
         r"\begin{bmatrix}1&2\end{bmatrix}"),
        ("inv([1 2; 3 4])", "unknown_call", "inv"),
        ("np.linalg.inv([[1, 2], [3, 4]])", "unknown_call", "np.linalg.inv"),
        ("L(1) = Link([0 0 a1 0]);\nR = SerialLink(L)", "unknown_call", "Link"),
        # a letter of the matrix is assigned a value that is not a plain number
        ("a1 = 0.4; q1 = pi/2;\nT = [a1, q1; 0, 1]", "given_value", "q1 = pi/2"),
        ("q1 = sym('2*q2');\nT = [a1, q1; 0, 1]", "given_value", "q1 = sym('2*q2')"),
        ("| a | b |\nsee below\n| c | d |", "text_around", "see below"),
        # cells that hold more than a value
        (r"\begin{array}{cc} \multicolumn{2}{c}{x} \end{array}", "spanning_cell", r"\multicolumn"),
        ("<table><tr><td colspan=2>a</table>", "spanning_cell", "colspan=2"),
        ("<table><tr><td rowspan='3'>a</table>", "spanning_cell", "rowspan='3"),
        ("<table><tr><td><table>", "nested_table", "<table>"),
        ("<table></table><table>", "two_tables", "<table>"),
        (r"\begin{matrix} \begin{array}{c}a", "nested_table", r"\begin{array}"),
        ("<table><tr><td><mfrac>1 2</mfrac></table>", "unread_tag", "<mfrac>"),
        ("[[[1, 2], [3, 4]], [[5, 6], [7, 8]]]", "nested_too_deep", "[1, 2], [3, 4]"),
        ('[{"a": 1, "d": 2}]', "named_values", '"a": 1'),
        (r"\begin{vmatrix} 1 & 2 \end{vmatrix}", "not_a_matrix", r"\begin{vmatrix}"),
        ("⎡1  2⎤\n⎣3  4⎦", "drawn_matrix", "3  4"),
        # brackets, quotes, tags that do not end
        ("[1 2; 3 4", "unbalanced_bracket", "["),
        ("[1 2; 3 4]]", "unbalanced_bracket", "]"),
        ("[[1, (2], [3, 4]]", "unbalanced_bracket", "]"),
        ("['a, b]", "unclosed_quote", "'"),
        ('a,"b\nc,d', "unclosed_quote", '"'),
        ('"a" b,c', "stray_quote", '"'),
        ("<table><tr><td class='x", "unclosed_tag", "<"),
        (r"\begin{bmatrix} a & b", "unbalanced_environment", r"\begin{bmatrix}"),
        (r"\begin{bmatrix} a & b \end{pmatrix}", "unbalanced_environment", r"\end{pmatrix}"),
        (r"a & b \\ \end{bmatrix}", "unbalanced_environment", r"\end{bmatrix}"),
        (r"\begin{array}{cc a & b \end{array}", "unbalanced_bracket", "{"),
        # separators that leave two readings
        ("[c1 -s1, 0; s1 c1, 0]", "mixed_separators", "c1 -s1, 0"),
        ("1 2; 3 4", "ambiguous_separators", "1 2; 3 4"),
        ("1, 2; 3, 4", "ambiguous_separators", "1, 2; 3, 4"),
        ("1 2 3\n4 5", "ambiguous_columns", "4 5"),
        ("1  l1 c1  0\n2  l2 c2  0", "ambiguous_columns", "1  l1 c1  0"),
        ("Matrix(2, 2, [1, 2, 3])", "wrong_count", "1, 2, 3"),
    ],
)  # fmt: skip
def test_an_unreadable_text_is_refused_with_the_place(text: str, code: str, marked: str) -> None:
    error = refusal(text)
    assert (error.code, text[slice(*error.span)]) == (code, marked)
    assert str(error) == error.message
    assert error.message.endswith(".")


@pytest.mark.parametrize(
    ("after", "named"),
    [
        ("'", "`'`"),
        ("\u200b", "An invisible character"),
        (" \u200bx", "`x`"),
        (" [5; 6]", "`5; 6`"),
        (" []", "Empty brackets"),
    ],
)
def test_text_after_a_matrix_is_quoted(after: str, named: str) -> None:
    message = refusal(f"[1 2; 3 4]{after}").message
    assert message.startswith((f"{named} stands next", f"{named} stand next"))


def test_the_error_for_a_wrong_closing_bracket_names_both_places() -> None:
    assert "does not fit the ( at character 6" in refusal("[[1, (2], [3, 4]]").message


# --- Read the identity matrix by its name

TURN = "[c1 -s1 0; s1 c1 0; 0 0 1]"


def reader() -> Reader:
    return Reader(
        Vocabulary([joint_variable(1)]), Samples({"theta1": np.array([0.3])}), "radians", "m"
    )


def values(text: str, size: int) -> list[list[float]]:
    read = read_matrix(text, [["number"] * size] * size, reader()).values
    return [[float(cell[0]) for cell in row] for row in read]


def unit(size: int) -> list[list[float]]:
    return [[float(i == j) for j in range(size)] for i in range(size)]


# The sign # stands for the size.
OF_SIZE = [
    "eye(#)", "np.eye(#)", "eye(#, #);", "T = np.identity(#)", "IdentityMatrix[#]", "I_#", "I#",
    "A1 = sp.eye(#)", "$I_{#}$", r"\mathbf{I}_#", r"I_{# \times #}", "R := eye(#)",
]  # fmt: skip


@pytest.mark.parametrize("size", [3, 4])
@pytest.mark.parametrize("text", OF_SIZE)
def test_a_named_identity_is_read(text: str, size: int) -> None:
    assert values(text.replace("#", str(size)), size) == unit(size)


@pytest.mark.parametrize(
    "text",
    [
        "import numpy as np\nT = np.eye(4)", "T = np.eye(4)\nprint(T)",
        "T = eye(4); % pose\ndisp(T)", "% the pose\nT = eye(4)",
    ],
)  # fmt: skip
def test_a_program_that_makes_only_the_identity_is_read(text: str) -> None:
    assert values(text, 4) == unit(4)


@pytest.mark.parametrize("text", ["I", "T = I", "$I$", r"\mathbf{I}"])
def test_an_identity_without_a_size_has_the_size_that_is_asked_for(text: str) -> None:
    assert values(text, 3) == unit(3)
    assert values(text, 4) == unit(4)


def test_an_identity_of_another_size_is_refused() -> None:
    with pytest.raises(UnreadableAnswerError, match="yours is 3 × 3"):
        values("eye(3)", 4)


@pytest.mark.parametrize("name", ["eye(3)", "np.identity(3)", "I", "I_3"])
def test_an_identity_stands_in_a_list_of_matrices(name: str) -> None:
    for text in (
        f"R1 = {TURN}\nR2 = {name}",
        f"R1 = {TURN}; R2 = {name};",
        f"R2 = {name}\nR1 = {TURN}",
    ):
        quantities: list[list[Kind]] = [["number"] * 3] * 3
        _, second = read_matrices(text, ["1", "2"], quantities, reader())
        assert [[float(cell[0]) for cell in row] for row in second.values] == unit(3)


@pytest.mark.parametrize("text", ["eye(4)*A", "I + 1", "eye(5)", "eye(3, 4)", "Ix", "identity"])
def test_other_texts_are_no_identity(text: str) -> None:
    with pytest.raises(GridError):
        read_grid(text)


def test_no_table_is_an_identity() -> None:
    with pytest.raises(GridError):
        read_grid("I", of_table=True)
