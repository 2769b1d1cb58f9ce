"""Read several matrices in one text."""

import pytest
from dh_grader.pasting import GridError, read_grids

from tests.grids.writers import MATRICES, POSE
from tests.together import together

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
