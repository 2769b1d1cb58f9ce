"""Test pasted tables: their prints, their titles, and several in one text."""

import pytest
from dh_grader.pasting import GridError, read_grid, read_grids

from tests.pasting.writers import MATRICES, POSE
from tests.together import together

# --- Read data frames as programs print them


def cells(text: str) -> list[list[str]]:
    return [[cell.text for cell in row] for row in read_grid(text).rows]


@pytest.mark.parametrize("label", ["Link {}", "Gelenk {}", "joint_{}", "J{}", "连杆{}", "{}"])
def test_a_row_may_have_a_label_without_a_header(label: str) -> None:
    lines = ["a  alpha", *(f"{label.format(i)}  l{i}  0" for i in (1, 2))]
    named = [label.format(1), "l1", "0"], [label.format(2), "l2", "0"]
    assert cells("\n".join(lines)) == [["", "a", "alpha"], *named]


@pytest.mark.parametrize("label", ["theta{}", "q{}", "l{}", "alpha {}"])
def test_a_symbol_is_not_a_label(label: str) -> None:
    lines = ["a alpha", *(f"{label.format(i)} l{i} 0" for i in (1, 2))]
    with pytest.raises(GridError) as caught:
        read_grid("\n".join(lines))
    assert caught.value.code == "ambiguous_columns"


def test_labels_count_the_rows() -> None:
    with pytest.raises(GridError):
        read_grid("a alpha\nLink 1 l1 0\nLink 3 l2 0")


@pytest.mark.parametrize("unit", ["(m)", "[deg]", "(°)", "(度)"])
def test_a_unit_stays_in_its_header(unit: str) -> None:
    assert cells(f"a {unit} d\n1 2\n3 4")[0] == [f"a {unit}", "d"]


def test_a_formula_in_brackets_is_a_value() -> None:
    assert cells("1 (l1)\n2 3") == [["1", "(l1)"], ["2", "3"]]


# --- Remove sentences around a pasted table

TABLE = "i\ta\talpha\td\ttheta\n1\tl1\t0\t0\tq1\n2\tl2\t0\t0\tq2"


@pytest.mark.parametrize(
    "text",
    [
        f"Table 1: parameters of the arm\n{TABLE}",
        f"Table of the arm\t\t\t\t\n{TABLE}",
        f"{TABLE}\n\t\t\t\t\nI checked it twice\t\t\t\t",
        f"My robot with 3 degrees of freedom\n\n{TABLE}\nI hope this helps.",
        f"机械臂参数\n{TABLE}",
        f"```\n{TABLE}\n```",
        f"The table:\n~~~text\n{TABLE}\n~~~\nRegards",
    ],
)
def test_sentences_and_fences_are_no_rows(text: str) -> None:
    assert cells(text) == cells(TABLE)


COMMAS = "a,alpha,d,theta\nl1,0,0,q1\nl2,0,0,q2"


@pytest.mark.parametrize(
    "text",
    [
        *(f"{title}\n{COMMAS}" for title in ("DH table", "% DH", "SCARA", "Hi,", "My table, v2")),
        f"{COMMAS}\nwhere q1, q2 are the joint angles",
        f"{COMMAS}\nEnd",
    ],
)
def test_sentences_around_a_table_with_commas_are_no_rows(text: str) -> None:
    assert cells(text) == cells(COMMAS)
    assert [note.code for note in read_grid(text).notes] == ["text_left_aside"]


@pytest.mark.parametrize("heading", ["Pose", "Lösung:", "**Pose:**"])
@pytest.mark.parametrize("matrix", ["[c1, -s1; s1, c1]", "[c1 -s1\n s1 c1]", "c1 -s1\ns1 c1"])
def test_a_heading_above_a_matrix_is_no_row(heading: str, matrix: str) -> None:
    assert cells(f"{heading}\n{matrix}") == cells(matrix)


@pytest.mark.parametrize("heading", ["T matrix", "Matrix T", "H0 Matrix:"])
def test_the_name_of_a_matrix_above_its_columns_is_no_row(heading: str) -> None:
    assert cells(f"{heading}\nc1 -s1 0\ns1 c1 0\n0 0 1") == cells("c1 -s1 0\ns1 c1 0\n0 0 1")


def test_two_words_are_a_heading_only_above_brackets() -> None:
    assert cells("My answer\n[c1, -s1; s1, c1]") == cells("[c1, -s1; s1, c1]")
    assert cells("gamma, delta\n1, 2") == [["gamma", "delta"], ["1", "2"]]
    assert cells("gamma delta\n1 2\n3 4") == [["gamma", "delta"], ["1", "2"], ["3", "4"]]


@pytest.mark.parametrize("row", ["pi", "theta", "l2", "0"])
def test_a_short_line_above_commas_that_may_be_a_cell_stays(row: str) -> None:
    assert len(cells(f"{row}\n{COMMAS}")) == len(cells(COMMAS)) + 1


def test_a_note_tells_that_sentences_were_ignored() -> None:
    text = f"My table\n{TABLE}"
    [note] = read_grid(text).notes
    assert (note.code, text[slice(*note.span)]) == ("text_left_aside", "My table")


@pytest.mark.parametrize("unit", ["degrees", "Grad", "grados", "degrés", "mm", "弧度", "°"])
def test_a_sentence_with_a_unit_is_refused(unit: str) -> None:
    with pytest.raises(GridError) as caught:
        read_grid(f"Parameters in {unit}\n{TABLE}")
    assert caught.value.code == "text_around"


@pytest.mark.parametrize(
    "line",
    [
        "**Correction:** in the second row the offset should of course be d2 and not 0.",
        "Sorry, the twist of link 1 is wrong.",
        "Korrektur: in Zeile 2 muss der Winkel positiv sein.",
        "En la fila 2 debería ser negativo.",
        "La deuxième ligne est fausse, une erreur de signe.",
    ],
)
def test_a_sentence_that_corrects_the_table_above_it_is_refused(line: str) -> None:
    for text in (f"{TABLE}\n\n{line}", f"```\n{TABLE}\n```\n{line}"):
        with pytest.raises(GridError) as caught:
            read_grid(text)
        assert caught.value.code == "text_around"
        assert text[slice(*caught.value.span)] == line


@pytest.mark.parametrize(
    "line",
    ["Die Spalten sind bei mir vertauscht.", "I have swapped two of the columns.", "两列互换了"],
)
def test_a_sentence_on_exchanged_columns_is_refused(line: str) -> None:
    for text in (f"{TABLE}\n{line}", f"{line}\n{TABLE}"):
        with pytest.raises(GridError):
            read_grid(text)


@pytest.mark.parametrize("line", ["Here is the corrected table:", "This table should be right:"])
def test_a_sentence_above_the_table_may_say_that_it_is_corrected(line: str) -> None:
    assert cells(f"{line}\n{TABLE}") == cells(TABLE)


@pytest.mark.parametrize(
    "line", ["theta d", "3", "l3 0 0 q3", "where l1 = l2", "Joint theta alpha", "pi"]
)
def test_a_line_that_may_be_a_row_stays(line: str) -> None:
    assert len(cells(f"{line}\n{TABLE}")) == 4


@pytest.mark.parametrize(
    "line",
    [
        "where l1 = 0.4",
        "mit l_1 = 0,4 m; l_2 = 0,3 m und d1 = 1 m.",
        "其中 l1＝400mm，l2＝300mm",
        "l1: 0.4\nl2: 0.3",
    ],
)
def test_numbers_of_letters_around_a_table_are_ignored_with_a_note(line: str) -> None:
    for text in (f"{line}\n{TABLE}", f"{TABLE}\n\n{line}"):
        assert cells(text) == cells(TABLE)
        assert [note.code for note in read_grid(text).notes] == ["given_numbers"]


@pytest.mark.parametrize("line", ["l1 = l2", "l1 = 0.4 + l2", "z = 0"])
def test_other_equations_around_a_table_stay(line: str) -> None:
    assert len(cells(f"{line}\n{TABLE}")) == 4


def test_equations_that_are_all_rows_stay() -> None:
    assert cells("p_x = l1, 1\np_y = l2, 2\np1 = 0, 3")[-1][0] == "p1 = 0"


@pytest.mark.parametrize(
    "row", ["3\t\t\t\t", "e\t\t\t\t", "l2\t\t\t\t", "\t\t\t\tq3", "pi/2\t\t\t\t"]
)
def test_a_last_row_with_one_entry_stays(row: str) -> None:
    assert len(cells(f"{TABLE}\n{row}")) == len(cells(TABLE)) + 1


# --- Read several matrices in one text

FIRST, SECOND = [["a", "b"], ["c", "d"]], [["e", "f"], ["g", "h"]]
TEX = r"\begin{bmatrix} a & b \\ c & d \end{bmatrix}", r"\begin{bmatrix} e&f\\g&h \end{bmatrix}"


def several(text: str) -> list[tuple[str, list[list[str]]]]:
    found = []
    for name, grid in ((each.name.text, each.grid) for each in read_grids(text)):
        assert not isinstance(grid, GridError), grid.message
        found.append((name, [[cell.text for cell in row] for row in grid.rows]))
    return found


@together(
    ("text", "names"),
    [
        # MATLAB and Octave
        ("A1 = [a b; c d];\nA2 = [e f; g h];", "A1 A2"),
        ("A1 = [a b; c d]; A2 = [e f; g h]; T = A1*A2", "A1 A2"),
        ("syms a b\nA1 = [a b; c d]\nA2 = [e f; g h]\nT = simplify(A1 * A2);", "A1 A2"),
        ("A1 =\n \n[a, b]\n[c, d]\n \n \nA2 =\n \n[e, f]\n[g, h]\n", "A1 A2"),
        ("A1 =\n\n   a   b\n   c   d\n\nA2 =\n\n   e   f\n   g   h\n", "A1 A2"),
        ("A(:,:,1) =\n\n[a, b]\n[c, d]\n\nA(:,:,2) =\n\n[e, f]\n[g, h]", "A(:,:,1) A(:,:,2)"),
        ("A{1} = [a b; c d]; A{2} = [e f; g h];", "A{1} A{2}"),
        (">> A1\n\nA1 =\n\n[a, b]\n[c, d]\n\n>> A2\n\nA2 =\n\n[e, f]\n[g, h]\n", "A1 A2"),
        ("A1 = trotz(q1)*transl(0, 0, 1)\nA1 = [a b; c d]\nA2 = [e f; g h]", "A1 A2"),
        ("% A2\n[a, b; c, d]\n% A1\n[e, f; g, h]", "A2 A1"),
        # Python
        ("[Matrix([[a, b], [c, d]]), Matrix([[e, f], [g, h]])]", ""),
        ("A1 = Matrix([[a, b], [c, d]]), A2 = Matrix([[e, f], [g, h]])", "A1 A2"),
        ("import sympy as sp\nA1 = sp.Matrix([[a, b], [c, d]])\nA2 = sp.Matrix([[e, f], [g, h]])",
         "A1 A2"),
        ("Matrix([[a, b], [c, d]])\nMatrix([[e, f], [g, h]])", ""),
        ("[[[a, b], [c, d]], [[e, f], [g, h]]]", ""),
        ("np.array([[[a, b], [c, d]], [[e, f], [g, h]]])", ""),
        ("[array([[a, b],\n       [c, d]], dtype=object), array([[e, f], [g, h]])]", ""),
        ("[[[a b]\n  [c d]]\n\n [[e f]\n  [g h]]]", ""),
        (">>> A2\nMatrix([\n[a, b],\n[c, d]])\n>>> print(A1)\nMatrix([[e, f], [g, h]])", "A2 A1"),
        (">>> A1 = Matrix([\n...  [a, b],\n...  [c, d]])\n>>> A2 = Matrix([[e, f], [g, h]])",
         "A1 A2"),
        # Mathematica and Maxima
        ("{{{a, b}, {c, d}}, {{e, f}, {g, h}}}", ""),
        (("In[1]:= x = 3\n\nIn[2]:= A1\nOut[2]= {{a, b}, {c, d}}\n\nIn[3]:= A2 // MatrixForm\n\n"
         "Out[3]//MatrixForm= {{e, f}, {g, h}}"), "A1 A2"),
        ("A1 = {{a, b}, {c, d}} // MatrixForm\nA2 = Simplify[{{e, f}, {g, h}}] (* link 2 *)",
         "A1 A2"),
        ("A1 : matrix([a, b], [c, d]);\nA2 : matrix([e, f], [g, h])$", "A1 A2"),
        ("(%o1) matrix([a,b],[c,d])\n(%i2) A2;\n(%o2) matrix([e,f],[g,h])", " A2"),
        # headings, blocks and drawings
        ("A1\n[a, b]\n[c, d]\nA2\n[e, f]\n[g, h]", "A1 A2"),
        ("Link 1:\n[a, b]\n[c, d]\nLink 2:\n[e, f]\n[g, h]", "Link 1|Link 2"),
        ("Here are my matrices:\nA1 = [a b; c d]\nA2 = [e f; g h]", "A1 A2"),
        ("[a, b]\n[c, d]\n\n[e, f]\n[g, h]", ""),
        ("a b\nc d\n\ne f\ng h", ""),
        ("A1 =\n⎡a  b⎤\n⎢    ⎥\n⎣c  d⎦\n\nA2 =\n[e  f]\n[    ]\n[g  h]", "A1 A2"),
        (("A1 = (sym 2×2 matrix)\n\n  ⎡a  b⎤\n  ⎢    ⎥\n  ⎣c  d⎦\n\nA2 = (sym 2×2 matrix)\n\n"
         "  ⎡e  f⎤\n  ⎢    ⎥\n  ⎣g  h⎦\n"), "A1 A2"),
        # LaTeX
        (f"A_1 = {TEX[0]}, \\quad A_2 = {TEX[1]}", "A_1 A_2"),
        (f"$$A_1 = {TEX[0]}$$\n$$A_2 = {TEX[1]}$$ $$T = A_1A_2$$", "A_1 A_2"),
        ((f"\\begin{{align}} {{}}^0T_1 &= {TEX[0]} \\\\ {{}}^1T_2 &= R T \\\\ &= {TEX[1]}"
         "\\end{align}"), "{}^0T_1 {}^1T_2"),
        (f"^0T_1 = {TEX[0]}\n^1T_2 = {TEX[1]}", "^0T_1 ^1T_2"),
        (f"\\left[ {TEX[0]}, \\  {TEX[1]}\\right]", ""),
        (f"\\left\\{{\\left({TEX[0]}\\right),\\left({TEX[1]}\\right)\\right\\}}", ""),
        (f"\\begin{{array}}{{l}} A_1 = {TEX[0]} \\\\ A_2 = {TEX[1]} \\end{{array}}", "A_1 A_2"),
        (f"A_1: {TEX[0]} A_2: {TEX[1]}", "A_1 A_2"),
        (r"$$\pmatrix{a&b\cr c&d\cr }\leqno{\tt (\%o1)}$$ $$\pmatrix{e&f\cr g&h\cr }$$", ""),
    ],
)  # fmt: skip
def test_all_matrices_and_names_are_read(text: str, names: str) -> None:
    found = several(text)
    assert [rows for _, rows in found] == [FIRST, SECOND]
    divider = "|" if "|" in names else " "
    expected = names.split(divider) if names else ["", ""]
    assert [name for name, _ in found] == expected


@pytest.mark.parametrize("name", sorted(set(MATRICES) - {"LaTeX rows"}))
def test_two_matrices_in_the_same_format_are_read(name: str) -> None:
    write = MATRICES[name]
    one, two = (write(POSE).removeprefix("A = ").removeprefix("T = ") for _ in range(2))
    one, two = (text.removeprefix("T =\n \n") for text in (one, two))
    found = several(f"A1 =\n{one}\nA2 =\n{two}" if "import" not in one else f"{one}\n{two}")
    assert [rows for _, rows in found] == [POSE, POSE]


def test_a_single_matrix_is_read_as_one() -> None:
    assert several("[a b; c d]") == [("", FIRST)]
    assert several(TEX[0]) == [("", FIRST)]
    assert several("(((a+b)*c, d), ((e+f)*g, h))") == [("", [["(a+b)*c", "d"], ["(e+f)*g", "h"]])]


def test_an_unreadable_matrix_does_not_affect_the_others() -> None:
    text = "A1 = [a b; c d]\nA2 = [e f; g h]'\nA3 = [e f; g h]"
    first, second, third = (each.grid for each in read_grids(text))
    assert isinstance(second, GridError)
    assert (second.code, text[slice(*second.span)]) == ("text_around", "'")
    assert not isinstance(first, GridError)
    assert not isinstance(third, GridError)


@pytest.mark.parametrize(
    ("text", "code", "marked"),
    [
        ("[a b; c d", "unbalanced_bracket", "["),
        (f"A_1 = {TEX[0]}^T, A_2 = {TEX[1]}", "text_around", "^T, A_2 ="),
        (f"A_1 = {TEX[0]}, A_2 = \\frac12 {TEX[1]}", "text_around", r"\frac12"),
        (f"A_1 = {TEX[0]} \\cdot {TEX[1]}", "text_around", r"\cdot"),
        (f"A_1 = {TEX[0]}, A_2 = {TEX[1]} \\cdot 2", "text_around", r"\cdot 2"),
        (f"A_1 = {TEX[0]} \\begin{{bmatrix}} a", "unbalanced_environment", r"\begin{bmatrix}"),
        ("\n".join(f"A{i} = [1 2; 3 4]" for i in range(25)), "too_many_matrices", None),
        ("", "empty", ""),
    ],
)
def test_an_unreadable_list_is_refused_with_the_place(
    text: str, code: str, marked: str | None
) -> None:
    with pytest.raises(GridError) as caught:
        read_grids(text)
    assert caught.value.code == code
    if marked is not None:
        assert text[slice(*caught.value.span)] == marked


def test_spans_are_places_in_the_pasted_text() -> None:
    text = ">> A1\n\nA1 =\n\n[a, b]\n[c, d]\n\n% and the second\nA2 = [e f; g h];"
    for each in read_grids(text):
        assert not isinstance(each.grid, GridError)
        assert text[slice(*each.name.whole)] == each.name.text
        for cell in (cell for row in each.grid.rows for cell in row):
            assert text[slice(*cell.whole)] == cell.text
