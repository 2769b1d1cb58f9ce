"""Read a script with four lists, one for each column of a table."""

import pytest

from service.grids import read_robot

LISTS = "a = [0 l2]; alpha = [0 pi/2]; d = [0 0]; theta = [q1 q2];"
ROWS = [["a", "alpha", "d", "theta"], ["0", "0", "0", "q1"], ["l2", "pi/2", "0", "q2"]]


@pytest.mark.parametrize(
    "text",
    [
        LISTS,
        f"% my robot\nsyms q1 q2 l2\n{LISTS}",
        LISTS.replace(" l2", "; l2").replace(" q2", "; q2"),
        LISTS.replace("; ", "\n"),
        "a = [0, l2]\nalpha = np.array([0, pi/2])\nd = [0, 0]\ntheta = (q1, q2)",
    ],
)
def test_the_lists_are_columns(text: str) -> None:
    robot = read_robot(text)
    assert robot is not None
    assert [[cell.text for cell in row] for row in robot.grid.rows] == ROWS


def test_a_list_of_yaml_has_a_row_in_each_item() -> None:
    robot = read_robot(
        "- {a: 0, alpha: 0, d: 0, theta: q1}\n- {a: l2, alpha: pi/2, d: 0, theta: q2}"
    )
    assert robot is not None
    assert [[cell.text for cell in row] for row in robot.grid.rows] == ROWS


@pytest.mark.parametrize(
    "text",
    [
        f"{LISTS} offset = [0 pi/2];",
        f"{LISTS}\ntheta(2) = q2 + pi/2;",
        f"{LISTS} a = [0 0];",
        LISTS.replace("[0 pi/2]", "[0 90]*pi/180"),
        LISTS.replace("[0 pi/2]", "deg2rad([0 90])"),
        f"l2 = l1/2; {LISTS}",
    ],
)
def test_any_other_statement_leaves_the_table_unread(text: str) -> None:
    assert read_robot(text) is None
