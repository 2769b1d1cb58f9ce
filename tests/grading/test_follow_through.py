"""Test answers that follow from an earlier slip, and single slips."""

from collections.abc import Callable, Mapping
from functools import reduce
from operator import mul
from typing import Any

import pytest
import sympy
from dh_grader.catalogue import Exercise
from dh_grader.grading import PartReport, Severity, Verdict

from tests.grading.support.robots import (
    A1,
    A3,
    A4,
    COLUMNS,
    EXACT,
    IDENTITY,
    LINKS,
    ROBOTS,
    TABLE,
    Robot,
    a2_with,
    graded,
    pose_with,
    table,
)
from tests.grading.support.robots import SCARA_EXERCISE as SCARA
from tests.grading.support.slips import Slip, slips
from tests.grading.support.submitting import (
    about,
    cell,
    graded_table,
    is_known,
    not_correct,
    points,
    row,
)

# --- Test marks for answers that are consistent with an earlier wrong answer


@pytest.fixture
def scara(make_exercise: Callable[[str], Exercise]) -> Exercise:
    return make_exercise(SCARA)


def test_matrices_that_follow_from_a_wrong_table_earn_points(scara: Exercise) -> None:
    wrong = table([TABLE[0], ("a1", "pi", "0", "q2"), *TABLE[2:]])
    links = [A1, a2_with("a1"), A3, A4]
    position = ["a1*c1 + a1*c12", "a1*s1 + a1*s12", "-d3 - d4"]
    parts = graded(scara, table=wrong, links=links, pose=pose_with("a1"), position=position)
    # One of the four content cells is wrong: 1.75 points each, and each row 0.25.
    assert parts["table"].points == 8 - 1.75
    for name in ("links", "pose", "position"):
        assert parts[name].points == parts[name].max_points, name
        assert parts[name].follow_through, name
        assert "follow_through" in [message.code for message in parts[name].feedback]


def test_the_message_says_if_the_earlier_answer_is_wrong(
    scara: Exercise, make_exercise: Callable[[str], Exercise]
) -> None:
    def told(part: PartReport) -> str:
        [message] = [each.message for each in part.feedback if each.code == "follow_through"]
        return message

    # The pose follows from the links, which follow from the wrong table: all three are wrong.
    wrong = table([TABLE[0], ("a1", "pi", "0", "q2"), *TABLE[2:]])
    parts = graded(scara, table=wrong, links=[A1, a2_with("a1"), A3, A4], pose=pose_with("a1"))
    assert parts["links"].verdict is parts["pose"].verdict is Verdict.CORRECT
    assert "is wrong" in told(parts["links"])
    assert "is wrong" in told(parts["pose"])
    # x1 of the elbow points the other way, which is allowed.
    own = table([("-L1", "-90deg", "h", "theta4 + pi"), ("L2", "0", "0", "theta5 + pi")])
    inner = [
        ["-c4", "0", "s4", "L1*c4"],
        ["-s4", "0", "-c4", "L1*s4"],
        ["0", "-1", "0", "h"],
        [*"0001"],
    ]
    parts = graded(make_exercise(ELBOW), table=own, inner=inner)
    assert parts["table"].verdict is parts["inner"].verdict is Verdict.CORRECT
    assert "which is right" in told(parts["inner"])


def test_a_part_may_follow_across_an_unanswered_part(scara: Exercise) -> None:
    wrong = table([TABLE[0], ("a1", "pi", "0", "q2"), *TABLE[2:]])
    parts = graded(scara, table=wrong, pose=pose_with("a1"))
    assert parts["pose"].points == 8
    assert parts["pose"].follow_through


def test_a_right_answer_does_not_follow(scara: Exercise) -> None:
    wrong = table([TABLE[0], ("a1", "pi", "0", "q2"), *TABLE[2:]])
    parts = graded(scara, table=wrong, links=LINKS, pose=pose_with("a2"))
    assert [parts[name].points for name in ("links", "pose")] == [8, 8]
    assert not any(part.follow_through for part in parts.values())


def test_a_right_table_does_not_make_a_wrong_pose_right(scara: Exercise) -> None:
    parts = graded(scara, table=table(TABLE), pose=pose_with("a1"))
    assert parts["pose"].points < 8
    assert not parts["pose"].follow_through


def test_a_trivial_table_earns_no_later_marks(scara: Exercise) -> None:
    zero = table([("0", "0", "0", "0")] * 4)
    parts = graded(scara, table=zero, links=[IDENTITY] * 4, pose=IDENTITY)
    assert [parts[name].points for name in ("table", "links", "pose")] == [0, 0, 0]
    assert not any(part.follow_through for part in parts.values())


def test_no_part_follows_from_a_poor_table(scara: Exercise) -> None:
    # Only the joint variables of this table are correct, so no later part follows from it.
    poor = table(
        [("0", "1", "1", "q1"), ("0", "1", "1", "q2"), ("1", "1", "d3", "1"), ("1", "1", "1", "q4")]
    )
    parts = graded(scara, table=poor, pose=IDENTITY)
    assert parts["table"].points < 4
    assert not parts["pose"].follow_through


def test_a_variable_without_effect_earns_no_later_marks(scara: Exercise) -> None:
    # The term 0·q does not move the joint.
    idle = "0*(q1 + q2 + d3 + q4)"
    still = [[f"1 + {idle}", "0", "0", "0"], *IDENTITY[1:]]
    parts = graded(scara, table=table([("0", "0", "0", idle)] * 4), links=[still] * 4, pose=still)
    assert [parts[name].points for name in ("table", "links", "pose")] == [0, 0, 0]


def test_no_part_follows_from_a_chain_with_lost_freedom(scara: Exercise) -> None:
    # Without twists and lengths, all four joint axes are on one line, and the pose is trivial.
    bare = table(
        [("0", "0", "0", "q1"), ("0", "0", "0", "q2"), ("0", "0", "d3", "0"), ("0", "0", "0", "q4")]
    )
    turn = "q1 + q2 + q4"
    pose = [
        [f"cos({turn})", f"-sin({turn})", "0", "0"],
        [f"sin({turn})", f"cos({turn})", "0", "0"],
        ["0", "0", "1", "d3"],
        list("0001"),
    ]
    parts = graded(scara, table=bare, pose=pose)
    assert parts["table"].points == 4 * 0.25
    assert not parts["pose"].follow_through
    assert parts["pose"].points <= 4


a1, a2, d3, d4, one, two, four = sympy.symbols("a1 a2 d3 d4 theta1 theta2 theta4")
ARM = [(a1, 0, 0, one), (a2, sympy.pi, 0, two), (0, 0, d3, 0), (0, 0, d4, four)]
# A row with one slip, and whether later parts may follow from the table.
SLIPS: dict[str, tuple[int, tuple[Any, ...], bool]] = {
    "a length": (1, (a1, sympy.pi, 0, two), True),
    "the joint counts the other way": (1, (a2, sympy.pi, 0, -two), True),
    "the joint stands still": (2, (0, 0, d4, 0), False),
    "the joint moves with another": (1, (a2, sympy.pi, 0, one + two), False),
    "the joint moves twice as far": (1, (a2, sympy.pi, 0, 2 * two), False),
    "the variable of another joint": (1, (a2, sympy.pi, 0, four), False),
    "a sliding joint that turns as well": (2, (0, 0, d3, two), False),
}


def link(a: Any, alpha: Any, d: Any, theta: Any) -> sympy.Matrix:
    """Return the standard link transform (Spong et al., eq. 3.10)."""
    c, s, ca, sa = sympy.cos(theta), sympy.sin(theta), sympy.cos(alpha), sympy.sin(alpha)
    return sympy.Matrix(
        [
            [c, -s * ca, s * sa, a * c],
            [s, c * ca, -c * sa, a * s],
            [0, sa, ca, d],
            [0, 0, 0, 1],
        ]
    )


@pytest.mark.parametrize("name", SLIPS)
def test_parts_follow_only_from_an_arm_with_the_robots_joints(name: str, scara: Exercise) -> None:
    place, slip, carries = SLIPS[name]
    rows = [slip if i == place else row for i, row in enumerate(ARM)]
    pose = reduce(mul, [link(*row) for row in rows]).applyfunc(sympy.expand)
    texts = [[str(entry) for entry in row] for row in pose.tolist()]
    parts = graded(scara, table=table([[str(cell) for cell in row] for row in rows]), pose=texts)
    assert parts["table"].points >= 4
    assert parts["pose"].follow_through is carries


def test_no_part_follows_from_links_that_only_slide(scara: Exercise) -> None:
    sliding = [[*"100", "theta1"], [*"010", "theta2"], [*"001", "d3 + theta4"], [*"0001"]]
    links = [sliding, IDENTITY, IDENTITY, IDENTITY]
    parts = graded(scara, links=links, pose=sliding, position=["theta1", "theta2", "d3 + theta4"])
    assert not any(part.follow_through for part in parts.values())
    assert parts["pose"].points <= 2
    assert parts["position"].points == 0


# An elbow whose joints have the numbers 4 and 5, with the home pose and the pose of frame {4}.
ELBOW = """
title = "t"
source = "s"
statement = "s"
[robot]
structure = "RR"
convention = "standard"
joints = ["theta4", "theta5"]
table = [["L1", "90deg", "h", "theta4"], ["L2", "0", "0", "theta5"]]
[symbols]
L1 = { kind = "length", range = [0.3, 0.9], description = "l" }
L2 = { kind = "length", range = [0.3, 0.9], description = "l" }
h = { kind = "length", range = [0.3, 0.9], description = "l" }
[[parts]]
id = "table"
kind = "dh_table"
title = "t"
points = 6
convention = "standard"
frames = "free"
[[parts]]
id = "home"
kind = "transform"
title = "t"
points = 4
home = true
follows = "table"
[[parts]]
id = "inner"
kind = "transform"
title = "t"
points = 4
to = 4
follows = "table"
[[parts]]
id = "home-position"
kind = "position"
title = "t"
points = 3
home = true
follows = "table"
"""


def test_a_home_pose_and_an_inner_frame_follow(make_exercise: Callable[[str], Exercise]) -> None:
    elbow = make_exercise(ELBOW)
    # Both lengths are wrong. At home, both links lie along x0, and z2 points along −y0.
    wrong = table([("L2", "90deg", "h", "theta4"), ("L1", "0", "0", "theta5")])
    home = [["1", "0", "0", "L1 + L2"], ["0", "0", "-1", "0"], ["0", "1", "0", "2*h"], [*"0001"]]
    inner = [
        ["c4", "0", "s4", "L2*c4"],
        ["s4", "0", "-c4", "L2*s4"],
        ["0", "1", "0", "h"],
        [*"0001"],
    ]
    assert not graded(elbow, table=wrong, home=home)["home"].follow_through
    home[2][3] = "h"
    parts = graded(elbow, table=wrong, home=home, inner=inner)
    assert parts["home"].verdict is Verdict.CORRECT
    assert (parts["inner"].points, parts["inner"].follow_through) == (4, True)
    doubled = table([("L1", "90deg", "2*h", "theta4"), ("L2", "0", "0", "theta5")])
    home[2][3] = "2*h"
    position = ["L1 + L2", "0", "2*h"]
    parts = graded(elbow, table=doubled, home=home, **{"home-position": position})
    for name in ("home", "home-position"):
        assert parts[name].points == parts[name].max_points, name
        assert parts[name].follow_through, name


def test_no_message_on_a_home_position_asks_for_joints(
    make_exercise: Callable[[str], Exercise],
) -> None:
    parts = graded(make_exercise(ELBOW), **{"home-position": ["L1", "0", "0"]})
    cells = [cell for row in parts["home-position"].rows for cell in row.cells]
    told = [message.message for cell in cells for message in cell.feedback]
    assert len(told) == 2
    assert not any("joint" in text or "depends" in text for text in told)


# A generated arm that is near a lost freedom if d of joint 3 is halved: its smallest singular value
# is about 1 % of the largest one.
NEARLY_LOST = """
title = "t"
source = "s"
statement = "s"
[robot]
structure = "PRRRR"
convention = "modified"
joints = ["d1", "theta2", "theta3", "theta4", "theta5"]
table = [
    ["0", "0", "d1", "0"], ["1.1", "0", "0.25", "theta2"], ["0", "90deg", "0.25", "theta3"],
    ["0", "30deg", "-0.15", "theta4"], ["0", "-90deg", "0.62", "theta5"],
    ["-0.15", "30deg", "0.62", "0"],
]
[[parts]]
id = "table"
kind = "dh_table"
title = "t"
points = 18
convention = "modified"
frames = "free"
[[parts]]
id = "links"
kind = "link_transforms"
title = "t"
points = 6
convention = "modified"
follows = "table"
"""


def modified_link(a: str, alpha: str, d: str, theta: str) -> list[list[str]]:
    """Return the modified link transform (Craig, eq. 3.6)."""
    c, s, ca, sa = f"cos({theta})", f"sin({theta})", f"cos({alpha})", f"sin({alpha})"
    return [
        [c, f"-{s}", "0", a],
        [f"{s}*{ca}", f"{c}*{ca}", f"-{sa}", f"-{sa}*({d})"],
        [f"{s}*{sa}", f"{c}*{sa}", ca, f"{ca}*({d})"],
        [*"0001"],
    ]


def test_blanks_do_not_decide_if_a_part_follows(make_exercise: Callable[[str], Exercise]) -> None:
    # Blanks draw other samples, and some samples are nearer to a lost freedom.
    exercise = make_exercise(NEARLY_LOST)
    rows = [
        ("0", "0", "d1", "0"), ("1.1", "0", "0.25", "theta2"), ("0", "90deg", "0.125", "theta3"),
        ("0", "30deg", "-0.15", "theta4"), ("0", "-90deg", "0.62", "theta5"),
        ("-0.15", "30deg", "0.62", "0"),
    ]  # fmt: skip
    links = [modified_link(*row) for row in rows]
    for blanks in range(12):
        spaced = [("0" + " " * blanks, *rows[0][1:]), *rows[1:]]
        parts = graded(exercise, table=table(spaced), links=links)
        assert parts["links"].follow_through, blanks


# --- One slip in a table costs the points of one cell

CELLS = [
    (robot, i, j) for robot in ROBOTS for i in range(len(robot.rows)) for j in range(len(COLUMNS))
]


@pytest.mark.sampled(4)
@pytest.mark.parametrize(
    ("robot", "i", "j"),
    CELLS,
    ids=[f"{robot.exercise} {robot.labels[i]}.{COLUMNS[j]}" for robot, i, j in CELLS],
)
def test_a_slip_costs_only_its_own_cell(
    robot: Robot, i: int, j: int, given_frames: Mapping[str, Exercise]
) -> None:
    for slip in slips(robot, i, j):
        check(slip, given_frames[robot.exercise])


def check(slip: Slip, exercise: Exercise) -> None:
    rows = [list(cells) for cells in EXACT.rows(slip.robot)]
    rows[slip.row][slip.column] = slip.text
    report = graded_table(exercise, rows, angle_unit=slip.angle_unit)

    label, column = slip.robot.labels[slip.row], COLUMNS[slip.column]
    assert not_correct(report) == {(label, column): slip.verdict}, slip
    # An empty cell costs as much as a wrong one, an unreadable cell only its worth.
    wrong = slip.verdict is not Verdict.UNREADABLE
    wrong = wrong or is_known(slip.robot, slip.row, slip.column)
    expected = points(slip.robot, [slip.row] * wrong, [slip.row] * (not wrong))
    assert report.verdict is Verdict.PARTIAL, slip
    assert [row.points for row in report.rows] == about(expected), slip
    assert report.points == pytest.approx(sum(expected), abs=1e-5), slip
    # A row that earns nothing is not partly right.
    verdict = Verdict.PARTIAL if expected[slip.row] else slip.verdict
    assert row(report, label).verdict is verdict, slip

    [feedback] = cell(report, label, column).feedback
    assert (feedback.code, feedback.severity) == (slip.code, Severity.ERROR), slip
    assert feedback.message.strip().endswith((".", "?")), slip


def test_each_table_is_tried_with_many_slips(figure: Callable[[str], None]) -> None:
    for robot in ROBOTS:
        cells = [(i, j) for known, i, j in CELLS if known is robot]
        count = sum(len(list(slips(robot, i, j))) for i, j in cells)
        figure(f"{robot.exercise}: {count} single-cell slips, each graded alone")
        assert count > 8 * len(cells)
