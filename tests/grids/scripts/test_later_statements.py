"""Later statements of a script are left out only if they cannot change its table."""

import pytest
from dh_grader.pasting import GridError, read_grid, read_robot

MATLAB = "DH = [a1 pi/2 0 q1; a2 0 d2 q2];"
PYTHON = "import numpy as np\nDH = np.array([[a1, pi/2, 0, q1], [a2, 0, d2, q2]])"
ROWS = [["a1", "pi/2", "0", "q1"], ["a2", "0", "d2", "q2"]]


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
    assert rows(f"{MATLAB}\n{later}") == ROWS
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
    assert rows(f"{PYTHON}\n{later}") == ROWS


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
    assert rows(f"{line}\n{PRINTED}") == [["a", "alpha", "d", "theta"], *ROWS]


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
