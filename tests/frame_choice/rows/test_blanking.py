"""An empty cell earns no more points than a wrong one."""

from dataclasses import replace

import pytest

from tests.frame_choice.robots import GIVEN, POLICIES, Policy, Robot, exercise
from tests.frame_choice.rows import careless
from tests.frame_choice.rows.blanking import run
from tests.frame_choice.rows.other_readings import OTHER_READINGS, OtherReading
from tests.frame_choice.rows.student_rows import StudentRowsTexts as Texts
from tests.frame_choice.rows.student_rows import shipped_robots
from tests.frame_choice.trials import grade_rows

EACH = 6
SOME_ROBOTS = 4

FREE = {policy.name: policy for policy in POLICIES}
JOINTS = ("q1", "q2", "q3", "q4")
STANFORD = (
    ("0", "-pi/2", "0", "q1"),
    ("0", "pi/2", "d2", "q2"),
    ("0", "0", "q3", "0"),
    ("0", "-pi/2", "0", "q4"),
    ("0", "pi/2", "0", "q5"),
    ("0", "0", "d6", "q6"),
)
REVERSED = [*([*row[:3], f"-{row[3]}"] if row[3] != "0" else [*row] for row in STANFORD)]
PLANAR = (("0", "0", "0", "q1"), ("l1", "0", "0", "q2"), ("l2", "0", "0", "q3"))
SIX = ("q1", "q2", "q3", "q4", "q5", "q6")
COLLINEAR = (
    ("0", "0", "0", "q1"),
    ("l2", "0", "l2", "q2+pi/2"),
    ("0", "0", "l3", "q3+pi"),
    ("0", "pi", "0", "q4"),
    ("0.607", "0", "0.5316", "q5"),
    ("l4", "pi/2", "0", "q6"),
)
FLIPPED = [
    ["0", "0", "0", "-q1"],
    ["l2", "0", "l2", "-q2 + pi/2"],
    ["0", "0", "l3", "q3 + pi"],
    ["0.607", "0", "0.5316", "q5"],
    ["l4", "pi/2", "0", "-q6"],
]
PARALLEL = (
    ("0", "0", "0", "q1"),
    ("0", "0", "0.155", "q2"),
    ("0", "pi/2", "0.4", "q3+pi/6"),
    ("0.081", "0", "0.6", "q4"),
    ("0.5", "0", "0.442", "q5"),
    ("0.63", "pi/6", "0.5", "q6"),
    ("0", "pi", "0", "pi/2"),
)
LAST = [
    ["0", "pi/2", "0.4", "q3 - 5*pi/6"],
    ["-0.081", "pi", "-0.9", "-q4"],
    ["-0.5", "pi", "0.142", "q5 + pi"],
    ["0.63", "pi/6", "0.5", "q6 - pi/2"],
    ["0", "pi", "0", "0"],
]
SEVEN = (
    ("0.4797", "0", "0.449", "q1"),
    ("0.8", "0.3", "0", "q2"),
    ("0.278", "2*pi/3", "0", "q3"),
    ("0.6", "-40*pi/180", "0", "q4"),
    ("0", "0", "0", "q5+-40*pi/180"),
    ("0", "0", "0", "q6"),
    ("0", "pi/2", "0.590", "q7"),
    ("0.228", "-pi/2", "0.1229", "0"),
)
SEVEN_MOVED = [
    *([*row] for row in SEVEN[:3]),
    ["0.6", "-2*pi/9", "0.68", "q4"],
    ["0", "0", "-0.96", "q5 - 2*pi/9"],
    ["0", "0", "0.28", "q6"],
    ["0", "-pi/2", "0", "-q7"],
]
# The end effector may be reached by the row of joint 5 alone, with d = t.
TOOL_ON_AXIS = (
    ("0", "0", "h", "q1"),
    ("r", "-pi/2", "0", "q2-pi/2"),
    ("a3", "0", "0", "q3"),
    ("p", "-pi/2", "l4", "q4"),
    ("0", "pi/2", "0", "q5"),
    ("0", "0", "t", "0"),
)
FIRST_FOUR = [[*row] for row in TOOL_ON_AXIS[:4]]
TOOL_ROBOT = Robot(
    "RRRRR, tool on axis 5",
    "RRRRR",
    "modified",
    SIX[:5],
    TOOL_ON_AXIS,
    ("h", "r", "a3", "p", "l4", "t"),
)
NO_ROW = ["", "", "", ""]
# Tables in which an empty place once earned more: a number in place of a joint variable, a wrong
# cell in a row of zeros, and wrong rows that hide the frames in which all others are right.
ONCE_GAINED = [
    (
        Robot(
            "RR",
            "RR",
            "modified",
            JOINTS[:2],
            (("0", "0", "0.1", "q1"), ("0", "pi/2", "0", "q2")),
            (),
        ),
        FREE["free base"],
        [["0", "0", "0", "90"], ["0", "pi/2", "0", "q2"]],
        [["0", "0", "0", ""], ["0", "pi/2", "0", "q2"]],
    ),
    (
        Robot(
            "RRRR",
            "RRRR",
            "standard",
            JOINTS,
            (
                ("0.69", "0", "0.1958", "q1"),
                ("0", "0", "0", "q2"),
                ("0.2", "0", "0.14", "q3"),
                ("0.38", "0", "0.81", "q4"),
            ),
            (),
        ),
        FREE["free base, tool"],
        [
            ["0.69", "0", "0.1958", "q1"],
            ["0.3", "0", "0.14", "q2"],
            ["0.2", "0", "0.14", "q3"],
            ["0.49", "0", "0", "q4"],
        ],
        [
            ["0.69", "0", "0.1958", "q1"],
            ["", "", "", ""],
            ["0.2", "0", "0.14", "q3"],
            ["0.49", "0", "0", "q4"],
        ],
    ),
    (
        Robot(
            "RRR, drawn",
            "RRR",
            "modified",
            JOINTS[:3],
            (*PLANAR, ("l3", "0", "0", "0")),
            ("l1", "l2", "l3"),
        ),
        FREE["free base, tool"],
        [[*PLANAR[0]], [*PLANAR[1]], ["0.4", "180", "0.4", "q3"], ["-0.52", "0", "0", "0"]],
        [[*PLANAR[0]], [*PLANAR[1]], ["", "", "", ""], ["-0.52", "0", "0", "0"]],
    ),
    (
        Robot(
            "RRPRRR, drawn",
            "RRPRRR",
            "standard",
            ("q1", "q2", "q3", "q4", "q5", "q6"),
            STANFORD,
            ("d2", "d6"),
        ),
        FREE["free base, directions"],
        [*REVERSED[:2], ["0.12", "pi", "d6", "0"], *REVERSED[3:]],
        [*REVERSED[:2], ["", "", "", ""], *REVERSED[3:]],
    ),
    (
        Robot(
            "RPR",
            "RPR",
            "standard",
            JOINTS[:3],
            (("0", "pi", "0.33", "q1"), ("0", "-pi/2", "q2", "0"), ("0", "pi", "0", "q3")),
            (),
        ),
        FREE["free base, tool"],
        [["0", "pi", "0.33", "q1"], ["0.3", "0", "-(q2)", "pi"], ["0.36", "0", "0.12", "q3"]],
        [["0", "pi", "0.33", "q1"], ["", "", "", ""], ["0.36", "0", "0.12", "q3"]],
    ),
    (
        Robot("RRRRRR", "RRRRRR", "modified", SIX, COLLINEAR, ("l2", "l3", "l4")),
        FREE["all free"],
        [*FLIPPED[:3], ["0.607", "pi", "0", "q4"], *FLIPPED[3:]],
        [*FLIPPED[:3], ["", "", "", ""], *FLIPPED[3:]],
    ),
    (
        Robot("RRRRRR, exchanged", "RRRRRR", "modified", SIX, PARALLEL, ()),
        GIVEN,
        [["0", "0", "0.155", "q2 + pi/2"], ["0", "0", "0", "q1 - pi/2"], *LAST],
        [["0", "0", "0.155", "q2 + pi/2"], ["", "", "", ""], *LAST],
    ),
    (
        Robot("RRRRRRR", "RRRRRRR", "modified", (*SIX, "q7"), SEVEN, ()),
        FREE["free tool"],
        [*SEVEN_MOVED, ["-0.44", "pi/2", "0.12", "-q7"]],
        [*SEVEN_MOVED, ["", "", "", ""]],
    ),
    *(
        (replace(TOOL_ROBOT, name=f"{TOOL_ROBOT.name}: {name}"), GIVEN, texts, empty)
        for name, texts, empty in (
            (
                "last row",
                [*FIRST_FOUR, ["0", "pi/2", "0", "q5"], ["-t", "q1", "0", "0"]],
                [*FIRST_FOUR, ["0", "pi/2", "0", "q5"], NO_ROW],
            ),
            (
                "last two rows",
                [*FIRST_FOUR, ["0.4", "pi", "-t", "q1"], ["r", "pi/2", "l4", "pi/4"]],
                [*FIRST_FOUR, NO_ROW, NO_ROW],
            ),
            (
                "row before a missing one",
                [*FIRST_FOUR, ["0.4", "pi", "-t", "q1"], NO_ROW],
                [*FIRST_FOUR, NO_ROW, NO_ROW],
            ),
            (
                "row after an empty one",
                [*FIRST_FOUR, NO_ROW, ["r", "pi/2", "l4", "pi/4"]],
                [*FIRST_FOUR, NO_ROW, NO_ROW],
            ),
        )
    ),
]


@pytest.mark.long
def test_an_empty_row_or_cell_earns_no_more() -> None:
    found = run(range(len(shipped_robots())), EACH, seed=3, unseen=0, policies=(GIVEN,))
    assert found.tries.total() >= EACH * len(shipped_robots())
    assert not found.misses, "\n".join(found.misses)


@pytest.mark.long
def test_an_empty_place_earns_no_more_after_slips_in_whole_rows() -> None:
    found = careless.run(range(SOME_ROBOTS), EACH, seed=4)
    assert found.tries.total() > 0.8 * EACH * SOME_ROBOTS
    assert not found.misses, "\n".join(found.misses)


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("robot", "policy", "texts", "empty"), ONCE_GAINED, ids=[case[0].name for case in ONCE_GAINED]
)
def test_an_empty_place_earns_no_more_in_known_tables(
    robot: Robot, policy: Policy, texts: Texts, empty: Texts
) -> None:
    _holds(robot, policy, robot.convention, texts, empty)


@pytest.mark.parametrize("table", OTHER_READINGS, ids=[each.robot.name for each in OTHER_READINGS])
def test_an_empty_place_leads_to_no_better_reading(table: OtherReading) -> None:
    _holds(table.robot, table.policy, table.convention, table.texts, table.empty)


def _holds(robot: Robot, policy: Policy, convention: str, texts: Texts, empty: Texts) -> None:
    compiled = exercise(robot, policy)
    written, blank = (grade_rows(compiled, each, convention) for each in (texts, empty))
    assert 0 < blank.points <= written.points < written.max_points
    for report in (written, blank):
        assert sum(row.points for row in report.rows) == pytest.approx(report.points)
        lost = sum(each.points for each in report.lost)
        assert lost == pytest.approx(report.max_points - report.points)
