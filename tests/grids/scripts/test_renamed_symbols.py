"""Scripts that give the symbols of the exercise other names."""

from collections.abc import Sequence

import pytest
from dh_grader.pasting import GridError, read_grid, read_robot

DH = "dh = Matrix([[l1, 0, 0, t1], [l2, pi, 0, t2]])"
MEANT = [["l1", "0", "0", "q1"], ["l2", "pi", "0", "q2"]]


def cells(text: str) -> list[list[str]]:
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
    assert cells(script) == meant


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
