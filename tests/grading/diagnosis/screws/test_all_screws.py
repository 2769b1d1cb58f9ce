"""Test slips in all screw axes."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import FeedbackLevel, PartReport, Verdict
from dh_grader.grading.diagnosis import screws_and_placements as all_screws
from dh_grader.grading.diagnosis.screws_and_placements import WrongScrews, explain_screws
from dh_grader.kinematics import Numbers

from tests.grading.diagnosis.pairs import Pair, assert_explains_only_the_first, each_pair
from tests.grading.diagnosis.screws.test_screw_axis import LENGTH, PITCH, axis
from tests.grading.support.exercise_texts import HEAD, Make, all_codes
from tests.grading.support.submitting import handed_in, part

SPACE = np.array(
    [
        axis(0, 0, 1, 0.3, -LENGTH, 0),
        axis(0, 0, 0, 1, 0, 0),
        axis(1, 0, 0, PITCH, 0.2, -LENGTH),
    ]
)
BODY = np.array(
    [
        axis(0, 0, 1, 0.3, LENGTH, 0),
        axis(0, 0, 0, 1, 0, 0),
        axis(1, 0, 0, PITCH, 0.4, LENGTH),
    ]
)


def case(actual: Numbers) -> WrongScrews:
    wrong = np.abs(actual - SPACE).max(axis=-1) > 1e-6
    return WrongScrews(actual, SPACE, np.repeat([1.0, 0.5], 3), wrong, BODY, "space")


def with_velocities(factor: Numbers) -> Numbers:
    """Return the axes with v multiplied by ``factor``."""
    changed = SPACE.copy()
    changed[:, 3:] *= factor[..., None]
    return changed


ACROSS = np.array([[-1, -1, -1], [1, 1, 1], [1, -1, -1]])
PAIRS = [
    Pair(
        all_screws.all_screws_exchanged_halves,
        case(SPACE[:, [3, 4, 5, 0, 1, 2]]),
        case(SPACE[:, [3, 4, 5, 0, 2, 1]]),
        "exchanged_halves",
    ),
    Pair(all_screws.axes_reversed, case(-SPACE), case(-BODY), "axis_reversed"),
    Pair(
        all_screws.moment_signs,
        case(with_velocities(ACROSS)),
        case(with_velocities(-np.ones((3, 3)))),
        "moment_sign",
    ),
    Pair(all_screws.all_screws_other_frame, case(BODY), case(-BODY), "body_for_space"),
]


@each_pair(PAIRS)
def test_a_misconception_explains_only_its_case(pair: Pair) -> None:
    assert_explains_only_the_first(pair)


def test_one_wrong_axis_shows_no_slip_of_all_axes() -> None:
    assert explain_screws(case(np.array([*SPACE[:2], -SPACE[2]]))) is None
    assert explain_screws(case(SPACE * np.nan)) is None


Screws = list[list[Any]]
# A SCARA arm: two turning joints, a sliding one that points down, a turning one that points down.
SCARA = f"""{HEAD}
[robot]
structure = "RRPR"
joints = ["q1", "q2", "q3", "q4"]
home = [
    ["1", "0", "0", "a + b"], ["0", "-1", "0", "0"], ["0", "0", "-1", "h"], ["0", "0", "0", "1"],
]
screws = [
    ["0", "0", "1", "0", "0", "0"], ["0", "0", "1", "0", "-a", "0"],
    ["0", "0", "0", "0", "0", "-1"], ["0", "0", "-1", "0", "a + b", "0"],
]
[symbols]
a = {{ kind = "length", description = "first link" }}
b = {{ kind = "length", description = "second link" }}
h = {{ kind = "length", description = "height" }}
[[parts]]
id = "home"
kind = "transform"
title = "M"
points = 3
home = true
[[parts]]
id = "space"
kind = "screw_axes"
title = "Space"
points = 6
frame = "space"
[[parts]]
id = "body"
kind = "screw_axes"
title = "Body"
points = 6
frame = "body"
[[parts]]
id = "pose"
kind = "transform"
title = "T"
points = 6
"""
OF_SPACE: Screws = [
    [0, 0, 1, 0, 0, 0], [0, 0, 1, 0, "-a", 0], [0, 0, 0, 0, 0, -1], [0, 0, -1, 0, "a + b", 0],
]  # fmt: skip
# In the tool frame: y and z are opposite to those of the base, at a distance of a + b.
OF_BODY: Screws = [
    [0, 0, -1, 0, "-a - b", 0], [0, 0, -1, 0, "-b", 0], [0, 0, 0, 0, 0, 1], [0, 0, 1, 0, 0, 0],
]  # fmt: skip
IN_MOTION: Screws = [
    [0, 0, 1, 0, 0, 0], [0, 0, 1, "a s1", "-a c1", 0], [0, 0, 0, 0, 0, -1],
    [0, 0, -1, "-a s1 - b s12", "a c1 + b c12", 0],
]  # fmt: skip
THROUGHOUT: dict[str, tuple[str, Screws, str, float]] = {
    "(v; ω)": ("space", [row[3:] + row[:3] for row in OF_SPACE], "exchanged_halves", 0.75),
    "(v; ω) of body axes": (
        "body",
        [row[3:] + row[:3] for row in OF_BODY],
        "exchanged_halves",
        0.75,
    ),
    "body for space": ("space", OF_BODY, "body_for_space", 0.5),
    "space for body": ("body", OF_SPACE, "space_for_body", 0.5),
    "v = ω × q": (
        "space",
        [OF_SPACE[0], [0, 0, 1, 0, "a", 0], OF_SPACE[2], [0, 0, -1, 0, "-a-b", 0]],
        "moment_sign",
        0.75,
    ),
    "reversed": (
        "space",
        [[0, 0, -1, 0, 0, 0], [0, 0, -1, 0, "a", 0], [0, 0, 0, 0, 0, 1], [0, 0, 1, 0, "-a-b", 0]],
        "axis_reversed",
        0.75,
    ),
    "as the arm has moved": ("space", IN_MOTION, "not_at_home", 0.75),
}


def graded(exercise: Exercise, part_id: str, answer: object) -> PartReport:
    return part(handed_in(exercise, {part_id: answer}, feedback=FeedbackLevel.HINTS), part_id)


@pytest.mark.parametrize("name", THROUGHOUT)
def test_a_slip_in_all_axes_gets_one_message_and_costs_once(name: str, make_exercise: Make) -> None:
    part_id, answer, code, share = THROUGHOUT[name]
    report = graded(make_exercise(SCARA), part_id, answer)
    assert [message.code for message in report.feedback] == [code]
    assert all_codes(report) == {code}
    wrong = {
        (row.label, cell.label)
        for row in report.rows
        for cell in row.cells
        if cell.verdict is not Verdict.CORRECT
    }
    assert {(place.row, place.cell) for place in report.feedback[0].places or ()} == wrong
    assert report.points == pytest.approx(6 * share, abs=0.01)


def test_right_axes_get_no_message(make_exercise: Make) -> None:
    for part_id, answer in (("space", OF_SPACE), ("body", OF_BODY)):
        report = graded(make_exercise(SCARA), part_id, answer)
        assert (report.points, all_codes(report)) == (6, set())


def test_wrong_axes_with_joint_variables_earn_nothing(make_exercise: Make) -> None:
    # Joint variables are a single slip only if the answer is correct with all of them set to 0.
    report = graded(make_exercise(SCARA), "space", [["q1"] * 6] * 4)
    assert all_codes(report) == {"not_at_home"}
    assert report.points == 0


def test_a_joint_variable_in_a_home_pose_is_named(catalogue: Mapping[str, Exercise]) -> None:
    turned = [["c13", "-s13"], ["s13", "c13"]]
    end = ["(L1 + theta2) c1 + L2 c13", "(L1 + theta2) s1 + L2 s13"]
    moved = [[*row, 0, x] for row, x in zip(turned, end, strict=True)]
    report = graded(catalogue["planar-rpr-poe"], "home", [*moved, [0, 0, 1, 0], [0, 0, 0, 1]])
    [message] = report.feedback
    assert (message.code, len(message.places or ())) == ("not_at_home", 6)
    assert all_codes(report) == {"not_at_home"}
