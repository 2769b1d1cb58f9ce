"""The matrix that one function returns is read."""

import pytest

from service.grids import GridError, read_grid

MATRIX = "[1 0 0; 0 cos(q1) -sin(q1); 0 sin(q1) cos(q1)]"
ROWS = [["1", "0", "0"], ["0", "cos(q1)", "-sin(q1)"], ["0", "sin(q1)", "cos(q1)"]]


def cells(text: str) -> list[list[str]]:
    return [[cell.text for cell in row] for row in read_grid(text).rows]


@pytest.mark.parametrize(
    "text",
    [
        f"function R = rotx(q1)\nR = {MATRIX};\nend",
        f"function [R] = rotx(q1)\n% a rotation\n  R = {MATRIX};\nendfunction",
        f"function R = rotx(q1)\n  R = {MATRIX};",
        f"function R = rotx(q1), R = {MATRIX}; end",
        f"function R = rotx(q1)\nc1 = cos(q1); s1 = sin(q1);\nR = {MATRIX};\nend",
        f"function R = rotx\nR = sym({MATRIX});\nend",
        f"function rotx(q1)\n    return {MATRIX}\nend",
        f"function rotx(q1)\n    {MATRIX}\nend",
    ],
)
def test_the_matrix_of_a_function_is_read(text: str) -> None:
    assert cells(text) == ROWS


@pytest.mark.parametrize(
    "text",
    [
        f"function R = rotx(q1)\nR = {MATRIX};\nR = R';\nend",
        f"function R = rotx(q1)\nR = {MATRIX};\nR(2,3) = 0;\nend",
        f"function R = rotx(q1)\nM = {MATRIX};\nR = M';\nend",
        f"function R = rotx(q1)\nR = {MATRIX}*2;\nend",
        f"function R = rotx(q1)\nR = {MATRIX}';\nend",
        f"function R = rotx(q1)\nq1 = q1*pi/180;\nR = {MATRIX};\nend",
        f"function R = rotx(q1)\nR = {MATRIX};\nend\nrotx(pi)'",
        f"function rotx(q1)\nR = {MATRIX}\nreturn R'\nend",
    ],
)
def test_a_function_that_may_change_its_matrix_is_refused(text: str) -> None:
    with pytest.raises(GridError) as caught:
        read_grid(text)
    assert caught.value.code in {"text_around", "given_value"}


@pytest.mark.parametrize(
    "text",
    [
        f"function R = rotx(q1)\nM = {MATRIX};\nend",
        f"function R = rotx(q1)\nif q1\nR = {MATRIX};\nend\nend",
        f"function R = a(q1)\nR = {MATRIX};\nend\nfunction R = b(q1)\nR = {MATRIX};\nend",
    ],
)
def test_words_of_other_functions_stay_in_the_cells(text: str) -> None:
    assert {"function", "if"} & {word for row in cells(text) for word in row[0].split()}


@pytest.mark.parametrize("prompt", ["(%o5) ", "%o5 ", "(%i4) M;\n(%o4) ", "%i4 M;\n%o4 "])
def test_the_prompts_of_maxima_may_have_no_brackets(prompt: str) -> None:
    assert cells(f"{prompt}matrix([l1, %pi/2], [0, q1])") == [["l1", "%pi/2"], ["0", "q1"]]
