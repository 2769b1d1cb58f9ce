"""Read the table of a robot that a toolbox prints."""

import pytest
from dh_grader.pasting import GridError, read_robot

HEAD = "| j |     theta |         d |         a |     alpha |    offset |\n"
ROWS = "|  1|         q1|          0|         a1|     1.5708|     0.5236|\n"
ROWS += "|  2|          0|         q2|          0|          0|        0.1|\n"
FIRST = "arm:: 2 axis, RP, modDH, slowRNE\n"


def rows(text: str) -> list[str]:
    robot = read_robot(text)
    assert robot is not None
    return [" | ".join(cell.text for cell in row) for row in robot.grid.rows]


def test_an_offset_is_added_to_the_joint_variable() -> None:
    expected = ["a1 | 1.5708 | 0 | q1 + (0.5236)", "0 | 0 | q2 + (0.1) | 0"]
    assert rows(FIRST + HEAD + ROWS) == expected
    assert rows(HEAD + ROWS) == expected


@pytest.mark.parametrize("variable", ["q2", "θ2", "θ₂", "theta_2", "Theta2", r"\theta_{2}"])
def test_a_markdown_table_with_the_same_headers(variable: str) -> None:
    table = "| j | theta | d | a | alpha | offset |\n|---|:-:|---|---|---|---|\n"
    table += f"| 1 | q1 | d1 | 0 | 90° | 0 |\n| 2 | {variable} | 0 | a2 | 0 | pi/2 |\n"
    assert rows(table) == ["0 | 90° | d1 | q1", f"a2 | 0 | 0 | {variable} + (pi/2)"]


@pytest.mark.parametrize("d", ["0", "d2"])
def test_an_offset_of_no_joint_variable_is_refused(d: str) -> None:
    table = HEAD + f"| 1 | 0 | {d} | 0 | 0 | pi/2 |\n"
    with pytest.raises(GridError, match="θ or to d"):
        read_robot(table)


@pytest.mark.parametrize(("first", "convention"), [(FIRST, "modified"), ("", None)])
def test_the_first_line_names_the_convention(first: str, convention: str | None) -> None:
    robot = read_robot(first + HEAD + ROWS)
    assert robot is not None
    assert robot.convention == convention


@pytest.mark.parametrize(
    "text",
    [
        FIRST + HEAD,
        FIRST + HEAD + ROWS.partition("\n")[0],
        FIRST + HEAD + ROWS.replace("\n", "\n\n"),
        HEAD + ROWS + "\n" + ROWS,
        FIRST + HEAD + ROWS + FIRST + HEAD + ROWS,
        FIRST + HEAD + ROWS + "base:    t = (0, 0, 1), RPY/xyz = (0, 0, 0) deg",
        FIRST + HEAD.replace("alpha", "beta ") + ROWS,
        FIRST + HEAD + ROWS.replace("|     0.5236|", "|"),
    ],
)
def test_a_print_that_is_not_whole_is_refused(text: str) -> None:
    with pytest.raises(GridError) as caught:
        read_robot(text)
    assert caught.value.code == "unread_script"


def test_unit_matrices_of_base_and_tool_change_nothing() -> None:
    lines = ["grav =    0  base = 1  0  0  0   tool =  1  0  0  0"]
    lines += ["0 0 1 0 0   0 1 0 0", "9.81 0 0 1 0  0 0 1 0", "0 0 0 1  0 0 0 1"]
    assert len(rows(FIRST + HEAD + ROWS + "\n".join(lines))) == 2
    moved = "\n".join(lines).replace("1 0  0 0 1 0", "1 0  0 0 1 5")
    with pytest.raises(GridError):
        read_robot(FIRST + HEAD + ROWS + moved)
