"""What is no grid, or no single one, is refused with a code and the place."""

import pytest

from service.grids import GRID_LIMITS, GridError, read_grid


def refusal(text: str) -> GridError:
    with pytest.raises(GridError) as caught:
        read_grid(text)
    return caught.value


@pytest.mark.parametrize(
    ("text", "code", "marked"),
    [
        ("", "empty", ""),
        (" \n\t", "empty", " \n\t"),
        ("q1", "no_grid", "q1"),
        ("0 0 0 q1", "no_grid", "0 0 0 q1"),
        ("atan2(y, x)", "no_grid", "atan2(y, x)"),
        # what stands around a matrix may change it
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
        ("⎡1  2⎤\n⎣3  4⎦", "drawn_matrix", "⎡"),
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
def test_refused_with_its_place(text: str, code: str, marked: str) -> None:
    error = refusal(text)
    assert (error.code, text[slice(*error.span)]) == (code, marked)
    assert str(error) == error.message
    assert error.message.endswith(".")


def test_a_bracket_of_another_shape_names_both_places() -> None:
    assert "does not fit the ( at character 6" in refusal("[[1, (2], [3, 4]]").message


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("1,2\n" * (GRID_LIMITS.rows + 1), "too_many_rows"),
        ("[" + "[1, 2]," * (GRID_LIMITS.rows + 2) + "]", "too_many_rows"),
        ("[1, 2]\n" * (GRID_LIMITS.rows + 2), "too_many_rows"),
        (",".join("1" * (GRID_LIMITS.columns + 1)), "too_many_columns"),
        (" ".join("1" * 100) + "\n" + " ".join("1" * 100), "too_many_columns"),
        ("a,b\n" + "," * GRID_LIMITS.separators, "too_many_cells"),
        ("a,b\n" + " " * GRID_LIMITS.characters, "too_long"),
    ],
)
def test_limits(text: str, code: str) -> None:
    assert refusal(text).code == code


def test_what_just_fits_the_limits_is_read() -> None:
    row = ",".join(["1"] * GRID_LIMITS.columns)
    assert read_grid("\n".join([row] * GRID_LIMITS.rows)).size == "13 × 12"
    assert len(read_grid("a,b".ljust(GRID_LIMITS.characters)).rows) == 1
