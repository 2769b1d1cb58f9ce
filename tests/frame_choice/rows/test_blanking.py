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
# Tables in which an empty cell once earned more: a number in place of a joint variable, and a wrong
# cell in a row of zeros.
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
