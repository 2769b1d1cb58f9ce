"""The matrix that one function returns is read."""

import pytest
from dh_grader.pasting import GridError, read_grid

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
        f"function R = rotx(q1)\nM = {MATRIX};\nend",
        f"function R = rotx(q1)\nif q1\nR = {MATRIX};\nend\nend",
        f"function R = a(q1)\nR = {MATRIX};\nend\nfunction R = b(q1)\nR = {MATRIX};\nend",
    ],
)
def test_a_function_that_may_change_its_matrix_is_refused(text: str) -> None:
    with pytest.raises(GridError) as caught:
        read_grid(text)
    assert caught.value.code in {"text_around", "given_value"}


@pytest.mark.parametrize("prompt", ["(%o5) ", "%o5 ", "(%i4) M;\n(%o4) ", "%i4 M;\n%o4 "])
def test_the_prompts_of_maxima_may_have_no_brackets(prompt: str) -> None:
    assert cells(f"{prompt}matrix([l1, %pi/2], [0, q1])") == [["l1", "%pi/2"], ["0", "q1"]]


PAIR = "[[cos(q1), -sin(q1)], [sin(q1), cos(q1)]]"
VALUES = [["cos(q1)", "-sin(q1)"], ["sin(q1)", "cos(q1)"]]


@pytest.mark.parametrize(
    "text",
    [
        f"def fk(q):\n    T = {PAIR}\n    return T\n",
        f"import numpy as np\ndef fk(q):\n    T = np.array({PAIR})\n    return T\n\nprint(fk(0))",
        f"def fk(q: list[float], l1: float = 0.4) -> np.ndarray:\n    T = {PAIR}\n    return T",
        f"def fk(q):\n    '''The pose.'''\n    T = {PAIR}\n    return (T)\n",
        f'def fk(q):\n    """The pose.\n\n    Of the tool.\n    """\n    T = {PAIR}\n    return T',
        f"def fk(q):\n    q1, q2 = q\n    c1, s1 = cos(q1), sin(q1)\n    T = {PAIR}\n    return T",
        f"def fk(q):\n    return np.array({PAIR})\n\nif __name__ == '__main__':\n    fk(0)\n",
        f"def fk(q):\r\n    T = {PAIR}\r\n    return T\r\n",
    ],
)
def test_a_function_of_python_that_only_returns_its_matrix_is_read(text: str) -> None:
    assert cells(text) == VALUES


@pytest.mark.parametrize(
    "text",
    [
        f"def fk(q):\n    T = {PAIR}\n    return T * 2\n",
        f"def fk(q):\n    T = {PAIR}\n    return T.T\n",
        f"def fk(q):\n    T = {PAIR}\n    T[0][1] = 5\n    return T\n",
        f"def fk(q):\n    T = {PAIR}\n    T = T @ T\n    return T\n",
        f"def fk(q):\n    q2, q1 = q\n    T = {PAIR}\n    return T\n",
        f"def fk(q):\n    if q:\n        return 1\n    T = {PAIR}\n    return T\n",
        f"def fk(q):\n    T = {PAIR}\n    return T\n\nT = fk(q) @ B\n",
        f"theta1, theta2, d3, theta4 = q\nT = {PAIR}\n",
    ],
)
def test_a_function_of_python_that_may_change_its_matrix_is_refused(text: str) -> None:
    with pytest.raises(GridError) as caught:
        read_grid(text)
    assert caught.value.code in {"text_around", "given_value", "no_grid"}
