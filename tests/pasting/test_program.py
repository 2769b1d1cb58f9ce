"""Test tables in program text."""

from collections.abc import Sequence

import pytest
from dh_grader.pasting import GridError, read_grid, read_robot

# --- The matrix that one function returns is read

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


# --- Later statements of a script are left out only if they cannot change its table

MATLAB = "DH = [a1 pi/2 0 q1; a2 0 d2 q2];"
PYTHON = "import numpy as np\nDH = np.array([[a1, pi/2, 0, q1], [a2, 0, d2, q2]])"
LATER_STATEMENTS_ROWS = [["a1", "pi/2", "0", "q1"], ["a2", "0", "d2", "q2"]]


def rows(text: str) -> list[list[str]]:
    robot = read_robot(text)
    grid = robot.grid if robot else read_grid(text, of_table=True)
    return [[cell.text for cell in row] for row in grid.rows]


@pytest.mark.parametrize(
    "later",
    [
        "T01 = dh2mat(DH(1,:));\nT12 = dh2mat(DH(2,:));",
        "A1 = dh(DH(1,:)); A2 = dh(DH(2,:)); % the links\nT = simplify(A1*A2)",
        "T = eye(4);\nfor i = 1:size(DH, 1)\n  A{i} = dh(DH(i,:));\n  T = T*A{i};\nend\nT",
        "for k=1:2, T = T*dh(DH(k,:)); end",
        "for k = 1:n\n A(:,:,k) = dh(DH(k,1), DH(k,2), DH(k,3), DH(k,4));\nend",
        "disp('DH table:'); disp(DH)",
        "T = array2table(DH, 'VariableNames', {'a', 'alpha', 'd', 'theta'})",
        "T = fkine(DH);\np = T(1:3, 4)",
        "[T, A] = fkine(DH);\nA{1}*A{2}",
        "DH =\n[ a1, pi/2, 0, q1]\n[ a2, 0, d2, q2]",
        "\n2×4 Matrix{Num}:\n a1  1.5708   0  q1\n a2  0  d2  q2",
    ],
)
def test_statements_of_matlab_and_julia_may_use_the_table(later: str) -> None:
    assert rows(f"{MATLAB}\n{later}") == LATER_STATEMENTS_ROWS
    with pytest.raises(GridError):
        # A matrix may be an intermediate result.
        read_grid(f"{MATLAB}\nT = f(DH);\n{later}")


@pytest.mark.parametrize(
    "later",
    [
        "T = np.eye(4)\nfor row in DH:\n    T = T @ dh(*row)\nprint(T)",
        "for i in range(len(DH)):\n    T = T @ dh(DH[i])",
        "for i, row in enumerate(DH):\n    T = T @ dh(row[0], row[1], row[2], row[3])",
        "for a, alpha, d, theta in DH:\n    T = T @ dh(a, alpha, d, theta)",
        "Ts = [dh(*row) for row in DH]\nT = Ts[0] @ Ts[1]",
        "T = reduce(np.matmul, [dh(*row) for row in DH])",
        "for i in range(DH.rows):\n    T = T * dh(*DH.row(i))",
        "if __name__ == '__main__':\n    print(DH)",
        "print(tabulate(DH, headers=['a', 'alpha', 'd', 'theta']))",
        "robot = Robot(DH)\nprint('Done', DH.shape[0])",
    ],
)
def test_statements_of_python_may_use_the_table(later: str) -> None:
    assert rows(f"{PYTHON}\n{later}") == LATER_STATEMENTS_ROWS


def test_the_toolbox_reads_a_matrix_in_its_own_order() -> None:
    text = "DH = [q1 0 a1 0; q2 0 a2 0];\nrobot = SerialLink(DH)"
    assert rows(text) == [["a1", "0", "0", "q1"], ["a2", "0", "0", "q2"]]


@pytest.mark.parametrize(
    "later",
    [
        # another table, or a part of it
        "DH = fliplr(DH)", "DH(1,2) = 0;", "DH(:,2) = DH(:,2)*pi/180;", "DH(3,:) = [0 0 0 q3];",
        "DH2 = f(DH);", "table = f(DH)", "M = [0 0 0 q1; 0 0 0 q2];", "T = f(DH, [4 3 1 2])",
        "M = DH;\nM(:,2) = 0;", "DHn = [DH; 0 0 0 0];", "x = y = DH", "[DH, T] = f(DH)",
        "for i = 1:2\n  DH(i,2) = f(i);\nend", "if x\n  T = dh(DH(1,:));\nend", "DH += 1",
        "DH[:, 1] = 0", "DH *= 2", "DH.sort()", "DH[0][1] = 0", "DH.append([0, 0, 0, 0])",
        "del DH[0]", "np.random.shuffle(DH)", "np.multiply(DH, 2, out=DH)", "DH, x = f(DH)",
        "for row in DH:\n  row[1] = 3", "for r in DH:\n  r *= 2", "DH.row_del(0)",
        "DH.row_swap(0, 1)", "T = f([r for r in DH if r[0]])", "T = f([2*r for r in DH])",
        "row = DH[0]\nrow[1] = 3",
        "for DH in x:\n  print(DH)", "eval('DH = 1')", "from m import DH; DH = f(1)",
        # another unit
        "T = dh(deg2rad(DH(1,:)));", "T = dh(DH(1,:)*pi/180);", "T = dhd(DH(1,:), 'degrees');",
        "T = cosd(DH(1,:));", "T = f(DH/1000);", "T = dh(DH(1,:), 'mm');", "disp(DH*2)",
        # another order of the columns
        "for theta, d, a, alpha in DH:\n  T = T @ dh(theta, d, a, alpha)", "a = DH(1,3);",
        "T = trotz(DH(1,1))*transl(0, 0, DH(1,2));", "T = dh(DH(1,4), DH(1,3), DH(1,1), DH(1,2))",
        "ts = [r[0] for r in DH]", "print(tabulate(DH, headers=['theta', 'd', 'a', 'alpha']))",
        "function T = dh(theta, d, a, alpha)\nT = 1;\nend", "T = dh(DH(1,:)');", "T = f(DH(:,1));",
        "for row = DH\n  T = T*dh(row);\nend", "T = fliplr(DH);",
        # another value of a letter
        "q1 = 0;", "a1 = 2*x;", "T = f(DH), d2 = 5", "disp(1), d2 = f(5)",
        # a second matrix
        "disp([0 0 0 q1; 0 0 0 q2])", "T = pd.DataFrame(DH, columns=['theta', 'd', 'a', 'alpha'])",
        # the output of another table
        "DH =\n[ a1, pi, 0, q1]\n[ a2, 0, d2, q2]", "T =\n[ a1, pi/2, 0, q1]\n[ a2, 0, d2, q2]",
        "\n2×4 Matrix{Num}:\n a1  90  0  q1\n a2  0  d2  q2\n a3  0  0  q3",
        "\n2×4 Matrix{Num}:\n a1  -1.5708  0  q1\n a2  0  d2  q2",
        "\n2×4 Matrix{Num}:\n q1  1.5708  0  a1\n q2  0  d2  a2",
    ],
)  # fmt: skip
def test_a_statement_that_may_change_the_table_is_refused(later: str) -> None:
    for script in (MATLAB, PYTHON):
        with pytest.raises(GridError):
            rows(f"{script}\n{later}")


PRINTED = "a   alpha  d   theta\na1  pi/2   0   q1\na2  0      d2  q2"


@pytest.mark.parametrize(
    "line",
    [
        "print(dh)",
        "print(df.to_string(index=False))",
        "from tabulate import tabulate\nprint(tabulate(dh, headers='firstrow'))",
        "print(tabulate(dh, headers=['a', 'alpha', 'd', 'theta'], tablefmt='plain'))",
        "print(tabulate(rows, headers=['a','alpha','d','theta']))",
    ],
)
def test_a_line_that_prints_the_table_may_be_above_it(line: str) -> None:
    assert rows(f"{line}\n{PRINTED}") == [["a", "alpha", "d", "theta"], *LATER_STATEMENTS_ROWS]


@pytest.mark.parametrize(
    "line",
    [
        "print(np.degrees(dh))",
        "print(df*1000)",
        "print(dh[:, ::-1])",
        "print(tabulate(dh, headers=['theta', 'd', 'a', 'alpha']))",
    ],
)
def test_a_line_that_prints_another_table_is_refused(line: str) -> None:
    with pytest.raises(GridError):
        rows(f"{line}\n{PRINTED.partition(chr(10))[2]}")


# --- Scripts that give the symbols of the exercise other names

DH = "dh = Matrix([[l1, 0, 0, t1], [l2, pi, 0, t2]])"
MEANT = [["l1", "0", "0", "q1"], ["l2", "pi", "0", "q2"]]


def cells_of_renamed(text: str) -> list[list[str]]:
    return [["".join(cell.text.split()) for cell in row] for row in read_grid(text).rows]


@pytest.mark.parametrize(
    ("script", "meant"),
    [
        (f"t1, t2 = symbols('q1 q2')\n{DH}", MEANT),
        (f"t1, t2 = sp.symbols('q1, q2', real=True)\n{DH}", MEANT),
        (f"t1, t2 = sp.symbols('q1:3')\n{DH}", MEANT),
        (f"t1 = Symbol('q1')\nt2 = sympy.Symbol('q2', real=True)  # the second\n{DH}", MEANT),
        (f"t1 = sym('q1'); t2 = sym('q2');\n{DH}", MEANT),
        (f"t1, t2 = dynamicsymbols('q1 q2')\nl1, l2 = symbols('l1 l2')\n{DH}", MEANT),
        (f">>> t1, t2 = symbols('q1 q2')\n>>> {DH}\n", MEANT),
        # Names are exchanged at the same time.
        (f"l1, l2, t1, t2 = symbols('l2 l1 q2 q1')\n{DH}",
         [["l2", "0", "0", "q2"], ["l1", "pi", "0", "q1"]]),
        # A tuple of symbols has indices from 0.
        ("t = symbols('q1:3')\ndh = [[l1, 0, 0, t[0]], [l2, pi, 0, t[1]]]", MEANT),
        # The symbol has the spelling of LaTeX, and the name is a part of another name.
        ("t1 = symbols(r'\\theta_1')\nT = [[cos(t1), t12], [-sin(t1), 1]]",
         [[r"cos(\theta_1)", "t12"], [r"-sin(\theta_1)", "1"]]),
        ("q1, q2 = symbols('q1 q2')\nT = [[q1, q2], [0, 1]]", [["q1", "q2"], ["0", "1"]]),
    ],
)  # fmt: skip
def test_a_name_means_its_symbol(script: str, meant: Sequence[Sequence[str]]) -> None:
    assert cells_of_renamed(script) == meant


@pytest.mark.parametrize(
    ("script", "line"),
    [
        (f"t1, t2 = symbols('q1')\n{DH}", "t1, t2 = symbols('q1')"),
        (f"t1, t2 = symbols('q1 q2 q3')\n{DH}", "t1, t2 = symbols('q1 q2 q3')"),
        (f"t1 = symbols('2*q1')\n{DH}", "t1 = symbols('2*q1')"),
        (f"t1 = symbols('q1')\nt1 = symbols('q2')\n{DH}", "t1 = symbols('q2')"),
    ],
)
def test_an_uncertain_name_is_refused_with_its_line(script: str, line: str) -> None:
    with pytest.raises(GridError) as refused:
        read_grid(script)
    assert refused.value.code == "given_value"
    assert script[slice(*refused.value.span)] == line


def test_names_of_arguments_and_texts_are_no_symbols() -> None:
    robot = read_robot(
        "a, t1 = symbols('a1 theta1')\n"
        "robot = DHRobot([RevoluteDH(a=a, alpha=0), RevoluteDH(a=a, alpha=0)], name='a')"
    )
    assert robot is not None
    assert [row[0].text for row in robot.grid.rows] == ["a1", "a1"]
