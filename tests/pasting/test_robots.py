"""Test scripts and prints of toolboxes that build a robot."""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import Final

import pytest
from dh_grader.pasting import GridError, RobotTable, read_robot

# --- Generate random scripts for the Robotics Toolbox for Python

# Source: P. Corke, Robotics Toolbox for Python, the constructors of RevoluteDH, PrismaticDH, their
# modified forms, DHLink and DHRobot.

_LENGTHS = [
    "0",
    "0.4318",
    "a1",
    "l_2",
    "d1 + 0.1",
    "2*l1",
    "-0.15",
    "1e-3",
    "L3/2",
    "λ",
    "(a1 + a2)",
]
_ANGLES = ["0", "pi/2", "-pi/2", "np.pi/2", "-math.pi / 2", "radians(90)", "np.deg2rad(-90)", "α1"]
_OFFSETS = ["0", "0", "pi/2", "-pi/2", "0.1", "- 0.2"]
# Arguments that no DH table has.
_EXTRAS = [
    "",
    "",
    "qlim=[-pi, pi]",
    "m=4.43, r=[0, 1, 2]",
    "I=np.diag([0, 0.35, 0])",
    "name='a, (1)'",
]
_REMARKS = ["", "", "  # link 1: a, alpha", "  # don't, [ (", "  # θ₁ – Gelenk"]
_HEADS = [
    "",
    "import roboticstoolbox as rtb\nfrom math import pi\n",
    '"""A robot.\n\nRevoluteDH(a=9)\n"""\nimport numpy as np\n',
    "# -*- coding: utf-8 -*-\nl1, l2 = symbols('l1 l2')\n",
]
_TAILS = ["", "\nprint(robot)", "\nT = robot.fkine([0]*6)\nprint(T)", "\nrobot.teach()  # look"]
_OPTIONS = ["", ", name='x'", ", name=\"2R, planar\", manufacturer='me'"]


@dataclass(frozen=True)
class DrawnScript:
    """A script, and the table cells that it defines."""

    text: str
    rows: list[list[str]]
    convention: str


def draw_script(random: Random) -> DrawnScript:
    """Return a script with one to seven links."""
    modified = random.random() < 0.4
    drawn = [_link(random, number, modified=modified) for number in range(1, random.randint(2, 8))]
    links = [text for text, _ in drawn]
    body = _robot(random, links, random.choice(_OPTIONS))
    text = random.choice(_HEADS) + body + random.choice(_TAILS)
    return DrawnScript(text, [row for _, row in drawn], "modified" if modified else "standard")


def _link(random: Random, number: int, *, modified: bool) -> tuple[str, list[str]]:
    is_prismatic, is_general = random.random() < 0.4, random.random() < 0.2
    constant, variable = ("theta", "d") if is_prismatic else ("d", "theta")
    cells = {"a": random.choice(_LENGTHS), "alpha": random.choice(_ANGLES)}
    cells[constant] = random.choice(_ANGLES if is_prismatic else _LENGTHS)
    by_name = [
        f"{name}={cell}" for name, cell in cells.items() if cell != "0" or random.random() < 0.5
    ]
    random.shuffle(by_name)
    if is_general:
        name = "DHLink"
        given = [*by_name, *["sigma=1"] * is_prismatic, *["mdh=True"] * modified]
    else:
        name = f"{'Prismatic' if is_prismatic else 'Revolute'}{'M' * modified}DH"
        by_place = [cells[constant], cells["a"], cells["alpha"]]
        given = random.choice([by_name, by_place])
    moved = f"q{number}"
    if random.random() < 0.1:
        given = [*given, "flip=True"]
        moved = f"-{moved}"
    if (offset := random.choice(_OFFSETS)) != "0":
        given = [*given, f"offset={offset}"]
        moved += offset if offset[0] == "-" else f"+{offset}"
    given = [each for each in [*given, random.choice(_EXTRAS)] if each]
    between = random.choice([", ", ",", " , ", ",\n        "])
    module = random.choice(["", "", "rtb.", "roboticstoolbox."])
    row = cells | {variable: moved}
    call = f"{module}{name}({between.join(given)})"
    return call, [row[column] for column in ("a", "alpha", "d", "theta")]


def _robot(random: Random, links: list[str], options: str) -> str:
    names = [f"L{number}" for number in range(1, len(links) + 1)]
    remark = random.choice(_REMARKS)
    together = ", ".join(links)
    lines = "".join(f"    {link},{remark}\n" for link in links)
    named = "\n".join(f"{name} = {link}{remark}" for name, link in zip(names, links, strict=True))
    appended = "\n".join(f"L.append({link})" for link in links)
    return random.choice(
        [
            f"robot = rtb.DHRobot([\n{lines}]{options})",
            f"links = [{together}]\nrobot = DHRobot(links{options})",
            f"{named}\nrobot = rtb.DHRobot([{', '.join(names)}]{options})",
            f"L = []\n{appended}\nrobot = DHRobot(L{options})",
            f"E1 = [\n{lines}]",
            f"robot = DHRobot(\n    ({together},){options}\n)",
            f"robot = DHRobot(links=[{together}]{options})",
        ]
    )


# --- Read a script for a robotics toolbox as one table row for each link

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


# --- Read the table of a robot that a toolbox prints

HEAD = "| j |     theta |         d |         a |     alpha |    offset |\n"
ROWS = "|  1|         q1|          0|         a1|     1.5708|     0.5236|\n"
ROWS += "|  2|          0|         q2|          0|          0|        0.1|\n"
FIRST = "arm:: 2 axis, RP, modDH, slowRNE\n"


def printed_rows(text: str) -> list[str]:
    robot = read_robot(text)
    assert robot is not None
    return [" | ".join(cell.text for cell in row) for row in robot.grid.rows]


def test_an_offset_is_added_to_the_joint_variable() -> None:
    expected = ["a1 | 1.5708 | 0 | q1 + (0.5236)", "0 | 0 | q2 + (0.1) | 0"]
    assert printed_rows(FIRST + HEAD + ROWS) == expected
    assert printed_rows(HEAD + ROWS) == expected


@pytest.mark.parametrize("variable", ["q2", "θ2", "θ₂", "theta_2", "Theta2", r"\theta_{2}"])
def test_a_markdown_table_with_the_same_headers(variable: str) -> None:
    table = "| j | theta | d | a | alpha | offset |\n|---|:-:|---|---|---|---|\n"
    table += f"| 1 | q1 | d1 | 0 | 90° | 0 |\n| 2 | {variable} | 0 | a2 | 0 | pi/2 |\n"
    assert printed_rows(table) == ["0 | 90° | d1 | q1", f"a2 | 0 | 0 | {variable} + (pi/2)"]


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
    assert len(printed_rows(FIRST + HEAD + ROWS + "\n".join(lines))) == 2
    moved = "\n".join(lines).replace("1 0  0 0 1 0", "1 0  0 0 1 5")
    with pytest.raises(GridError):
        read_robot(FIRST + HEAD + ROWS + moved)
