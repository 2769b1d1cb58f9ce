"""Read a script for a robotics toolbox as one table row for each link."""

import tomllib
from pathlib import Path
from random import Random
from typing import Final

import pytest
from dh_grader.pasting import GridError, RobotTable, read_robot

from tests.grids.scripts.drawn_scripts import draw_script

SCRIPTS: Final = tomllib.loads(
    Path(__file__).with_name("robot_scripts.toml").read_text(encoding="utf-8")
)
JOINT: Final = "j1 = rigidBodyJoint('j1','revolute');"
PLACED: Final = "setFixedTransform(j1,[0 0 q1 0],'dh')"
THIRTEEN: Final = "\n".join(f"L({i})=Link([0 0 1 0]);" for i in range(1, 14))
LISTED: Final = "L = [RevoluteDH(a=a1), RevoluteDH(a=a2)]"
UNREAD: Final = "unread_script"
CASES: Final = [(convention, name) for convention in SCRIPTS for name in SCRIPTS[convention]]


def table(text: str) -> RobotTable:
    found = read_robot(text)
    assert found is not None
    return found


def rows(found: RobotTable) -> list[str]:
    return [" ".join(cell.text for cell in row) for row in found.grid.rows]


@pytest.mark.parametrize(("convention", "name"), CASES)
def test_each_link_is_a_row(convention: str, name: str) -> None:
    case = SCRIPTS[convention][name]
    found = table(case["script"])
    assert rows(found) == case["rows"]
    assert (found.convention, found.has_headers) == (convention, False)


@pytest.mark.parametrize("blank", [" ", "\u00a0", "\u2009"], ids=["plain", "no-break", "thin"])
@pytest.mark.parametrize(
    "count", [40, pytest.param(2000, marks=pytest.mark.campaign)], ids=["few", "many"]
)
def test_drawn_scripts_in_python_are_read_exactly(blank: str, count: int) -> None:
    random = Random(7)
    for _ in range(count):
        drawn = draw_script(random)
        text = drawn.text.replace(", ", f",{blank}")
        found = table(text)
        assert [["".join(cell.text.split()) for cell in row] for row in found.grid.rows] == [
            ["".join(cell.split()) for cell in row] for row in drawn.rows
        ], text
        assert found.convention == drawn.convention


def test_a_dictionary_of_columns_keeps_its_headers() -> None:
    columns = "'theta': [q1, q2], 'a': np.array([a1, a2]), 'd': [0, 0], 'alpha': [0, 'pi']"
    text = f"df = pd.DataFrame({{{columns}}})\nprint(df)"
    found = table(text)
    assert rows(found) == ["theta a d alpha", "q1 a1 0 0", "q2 a2 0 pi"]
    assert (found.convention, found.has_headers) == (None, True)


def test_an_implied_cell_has_the_place_of_its_link() -> None:
    text = "% a comment\nL(1) = Link('a', a1, ... comment\n  'd', 0.5, 'offset', pi/2);"
    [row] = table(text).grid.rows
    link = "Link('a', a1, ... comment\n  'd', 0.5, 'offset', pi/2)"
    assert [text[slice(*cell.whole)] for cell in row] == ["a1", link, "0.5", "pi/2"]
    [note] = table(text).grid.notes
    assert (note.code, text[slice(*note.span)]) == ("script_rows", link)


def test_a_note_lists_letters_with_assigned_numbers() -> None:
    found = table("a1 = 0.4;\nm = 3;\nL(1) = Link([0 0 a1 0]);\nqz = 0;")
    assert [note.code for note in found.grid.notes] == ["script_rows", "given_numbers"]
    assert "to a1;" in found.grid.notes[1].message


@pytest.mark.parametrize(
    ("text", "code", "marked"),
    [
        # nothing is run
        ("for i=1:3\nL(i)=Link(DH(i,:));\nend", UNREAD, "L(i)=Link(DH(i,:))"),
        ("L = [RevoluteDH(a=x) for x in lengths]", UNREAD, None),
        ("def arm():\n    DHRobot([RevoluteDH()])", UNREAD, "DHRobot([RevoluteDH()])"),
        ("L(1) = Link(DH(1,:));", UNREAD, "DH(1,:)"),
        ("robot = SerialLink(L);", UNREAD, "L"),
        ("a1 = 2*b;\nL(1) = Link([0 0 a1 0]);", "given_value", "a1 = 2*b"),
        # values that a toolbox ignores but a student may mean
        ("L(1) = Link([pi/2 0 a1 0]);", UNREAD, "pi/2"),
        ("L(1) = Link([q1+pi/2 0 a1 0 0 pi]);", UNREAD, "q1+pi/2"),
        (f"{JOINT}\nsetFixedTransform(j1,[0 0 0 pi/2],'dh')", UNREAD, "pi/2"),
        ("setFixedTransform(j1,[a1 0 d1 0],'dh')", UNREAD, None),
        ("setFixedTransform(j1,trvec2tform([0 0 1]))", UNREAD, None),
        # lists of links that are not all in the text, or change afterwards
        ("L1=Link([0 0 a1 0]);\nr=SerialLink([L1 L2 L3 L4])", UNREAD, "[L1 L2 L3 L4]"),
        ("r = SerialLink([L(1) L(2) L(3) L(4)])", UNREAD, "[L(1) L(2) L(3) L(4)]"),
        ("r = DHRobot([RevoluteDH(), B, C, D])", UNREAD, "[RevoluteDH(), B, C, D]"),
        ("r = DHRobot([RevoluteDH()] + [RevoluteDH()])", UNREAD, "[RevoluteDH()] + [RevoluteDH()]"),
        (f"{LISTED}\nL.reverse()", UNREAD, "L.reverse()"),
        (f"{LISTED}\ndel L[0]", UNREAD, "del L[0]"),
        (f"{LISTED}\nL = L[1:]", UNREAD, "L = L[1:]"),
        (f"{LISTED}\nL[0].a *= 2", UNREAD, "L[0].a *= 2"),
        # the joint's type
        ("L1 = Link('a', 1, 'alpha', 0);", UNREAD, "Link('a', 1, 'alpha', 0)"),
        ("L1 = Link('theta', 0, 'd', 1);", UNREAD, "Link('theta', 0, 'd', 1)"),
        ("L1 = Link('revolute', 'prismatic');", UNREAD, "Link('revolute', 'prismatic')"),
        ("L1 = Link([0 0 0 0 x]);", UNREAD, "x"),
        # other transforms
        ("r = SerialLink([Link([0 0 1 0])], 'tool', T);", UNREAD, "'tool'"),
        ("r = DHRobot([RevoluteDH()], base=T)", UNREAD, "base=T"),
        ("L(1)=Link([0 0 1 0]);\nr = SerialLink(L);\nr.base = T;", UNREAD, "r.base = T"),
        ("L(1)=Link([0 0 1 0]);\nr.links(1).offset = 1;", UNREAD, "r.links(1).offset = 1"),
        ("d(1)=1; d(1)=2;\nL(1)=Link([0 d(1) 0 0]);", UNREAD, "d(1)"),
        # arguments, numbers, order
        ("L(1) = Link('d', 0, 'unit', 1);", UNREAD, "'unit'"),
        ("L(1) = Link('d', 0, 'd', 1);", UNREAD, "'d'"),
        ("L(1)=Link([0 0 1 0]);\nL(1).offset = ", UNREAD, "Link([0 0 1 0])"),
        ("L(1) = Link([0 0 1]);", UNREAD, "[0 0 1]"),
        ("setFixedTransform(j1,[0 0 1],'dh')", UNREAD, None),
        ("L(1)=Link([0 0 1 0]);\nL(1)=Link([0 0 2 0]);", UNREAD, "L(1)=Link([0 0 2 0])"),
        ("L(2)=Link([0 0 1 0]);", UNREAD, None),
        ("L1=Link([0 0 1 0]);\nL2=RevoluteMDH('a',1);", UNREAD, None),
        ("L1=Link([0 0 1 0]);\nM2=Link([0 0 1 0]);", UNREAD, None),
        (f"{PLACED.replace('1', '2')}\n{PLACED}", UNREAD, PLACED),
        ("{'a': [1, 2], 'alpha': [0, 0], 'd': [0], 'theta': [q1, q2]}", UNREAD, "[0]"),
        (THIRTEEN, "too_many_rows", "L(13)=Link([0 0 1 0])"),
        ("L(1)=Link([0 0 1 0];", "unbalanced_bracket", "("),
        ("Link([" * 500, "unbalanced_bracket", "["),
        ("Link([" * 4000, UNREAD, None),
        ("DHLink(0, 0, 0, 0, 0, 2)", UNREAD, "2"),
        ("Link([" * 10000, "too_long", None),
    ],
)  # fmt: skip
def test_an_uncertain_table_is_refused(text: str, code: str, marked: str | None) -> None:
    with pytest.raises(GridError) as caught:
        read_robot(text)
    span = caught.value.span
    assert (caught.value.code, text[slice(*span)]) == (code, marked or text[slice(*span)])


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[a1 0 0 q1; a2 0 0 q2]",
        "Link (i), a, alpha, d, theta\n1, a1, 0, 0, q1",
        "Link(i) & a & alpha & d & theta",
        "DH = [a1 0 0 q1]; % for SerialLink(DH)",
        '[{"a": 1, "d": 2}]',
        '{"rows": [0, 0, 0, 1]}',
        r"\begin{tabular}{a:b:c:d} 1 & 2 \end{tabular}",
        "{alpha0: 0, a0: 0, d2: 1}",
        "{a1: 1, alpha2: 0, d1: 1}",
    ],
)
def test_other_texts_are_not_read_as_scripts(text: str) -> None:
    assert read_robot(text) is None
