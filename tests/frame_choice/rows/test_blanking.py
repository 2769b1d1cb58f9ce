"""An empty cell earns no more than a wrong one: a sample of ``blanking``, and known tables."""

import pytest

from tests.frame_choice.robots import GIVEN, POLICIES, Policy, Robot, exercise
from tests.frame_choice.rows.blanking import run
from tests.frame_choice.rows.shipped_robots import shipped_robots
from tests.frame_choice.rows.student_rows import Texts
from tests.frame_choice.trials import grade_rows

EACH = 22

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
]


def test_an_empty_row_or_cell_earns_no_more() -> None:
    found = run(range(len(shipped_robots())), EACH, seed=3, unseen=0, policies=(GIVEN,))
    assert found.tries.total() >= EACH * len(shipped_robots())
    assert not found.misses, "\n".join(found.misses)


@pytest.mark.parametrize(
    ("robot", "policy", "texts", "empty"), ONCE_GAINED, ids=[case[0].name for case in ONCE_GAINED]
)
def test_an_empty_place_earns_no_more_in_known_tables(
    robot: Robot, policy: Policy, texts: Texts, empty: Texts
) -> None:
    compiled = exercise(robot, policy)
    written, blank = (grade_rows(compiled, t, robot.convention) for t in (texts, empty))
    assert 0 < blank.points <= written.points < written.max_points
