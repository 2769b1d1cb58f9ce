"""Try some slips of some robots; ``make slips`` tries all."""

from collections.abc import Callable, Mapping
from functools import cache

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Verdict

from tests.grading.support.submitting import handed_in, part
from tests.pose_slips.campaign import KINDS, answer_to, exercise_of, spoilt, trials
from tests.pose_slips.robots import SpoiltRobot, robots

# Every n-th slip of some robots: enough to cover each code.
SAMPLE = {"scara": 9, "stanford-arm": 29, "planar-rrr": 13, "skew": 17, "sliding": 13}


@cache
def robot_of(name: str) -> SpoiltRobot:
    return next(robot for robot in robots() if robot.name == name)


@pytest.mark.long
@pytest.mark.parametrize(("name", "every"), SAMPLE.items())
def test_slips_are_named(name: str, every: int, figure: Callable[[str], None]) -> None:
    found = list(trials(robot_of(name), lambda k: k % every == 0))
    named = [trial for trial in found if trial.outcome == "named"]
    figure(f"{name}: {len(named)} of {len(found)} slips behind poses named")
    assert len(found) > 8
    assert len(named) >= 0.9 * len(found)
    assert not [trial for trial in found if trial.outcome.startswith("several")]


@pytest.mark.parametrize("name", ["scara", "stanford-arm", "puma", "polar"])
def test_a_right_answer_has_no_message(name: str) -> None:
    robot = robot_of(name)
    answers = {kind: answer_to(kind, robot, spoilt(robot, None)) for kind in KINDS}
    report = handed_in(exercise_of(robot), answers)
    for each in report.parts:
        assert each.verdict is Verdict.CORRECT
        assert each.feedback == ()


# Answers of the students of a course, each with the expected code and words of the message.
SAID = [
    ("spherical-wrist", "position", ["0", "0", "d6"], "home_position", "home position"),
    ("spherical-wrist", "position", ["c4 s5", "s4 s5", "c5"], "quantity", "this contains none"),
    (
        "spatial-rrr",
        "position",
        ["R + L1 c2 + L2 c23", "0", "L1 s2 + L2 s23"],
        "joint_variable_missing",
        "Joint 1 stands still: check what must change with theta1",
    ),
    (
        "planar-rrr-standard",
        "position",
        ["l1 c1 + l2 c12", "l1 s1 + l2 s12 + l3 s123"],
        "independent_of",
        "Nothing here depends on q3",
    ),
    (
        "scara",
        "pose",
        [
            ["c124", "s124", "0", "a1 c1 + a2 c12"],
            ["s124", "-c124", "0", "a1 s1 + a2 s12"],
            ["0", "0", "-1", "-d3 - d4"],
            ["0", "0", "0", "1"],
        ],
        "joint_variable_sign",
        "Joint 4 moves the wrong way: check the sign of its variable. Its axis points",
    ),
]


@pytest.mark.parametrize(("exercise", "part_id", "answer", "code", "words"), SAID)
def test_slips_of_real_students_are_named(
    exercise: str,
    part_id: str,
    answer: object,
    code: str,
    words: str,
    catalogue: Mapping[str, Exercise],
) -> None:
    report = part(handed_in(catalogue[exercise], {part_id: answer}), part_id)
    in_cells = [m for row in report.rows for cell in row.cells for m in cell.feedback]
    [message] = [*report.feedback, *in_cells]
    assert message.code == code
    assert words in message.message


def test_a_slip_is_named_although_an_entry_is_unreadable(catalogue: Mapping[str, Exercise]) -> None:
    _, _, pose, code, words = SAID[-1]
    assert isinstance(pose, list)
    spoiled = [["(", *pose[0][1:]], *pose[1:]]
    report = part(handed_in(catalogue["scara"], {"pose": spoiled}), "pose")
    [message] = report.feedback
    assert (message.code, words in message.message) == (code, True)
    assert {(place.row, place.cell) for place in message.places or ()} == {
        ("1", "2"),
        ("2", "1"),
        ("2", "2"),
    }
