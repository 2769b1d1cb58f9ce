"""Test misconceptions in screw axes."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import FeedbackLevel, PartReport, Verdict
from dh_grader.grading.diagnosis import screws_and_placements as all_screws
from dh_grader.grading.diagnosis import screws_and_placements as screw_axis
from dh_grader.grading.diagnosis.screws_and_placements import (
    WrongScrew,
    WrongScrews,
    explain_screw,
    explain_screws,
)
from dh_grader.grading.numbers import SAMPLES
from dh_grader.kinematics import Numbers

from tests.grading.diagnosis.pairs import Pair, assert_explains_only_the_first, each_pair
from tests.grading.support.submitting import HEAD, Make, all_codes, handed_in, part

# --- Test the misconceptions about a screw axis

RNG = np.random.default_rng(9)
LENGTH = RNG.uniform(0.3, 0.9, SAMPLES)
PITCH = RNG.uniform(0.1, 0.4, SAMPLES)


def axis(*numbers: Numbers | float) -> Numbers:
    return np.array([np.zeros(SAMPLES) + number for number in numbers])


# The axis along z through (l, 0, 0) in the base frame; the tool is at (2l, 0, 0).
TURN = axis(0, 0, 1, 0, -LENGTH, 0)
TURN_SEEN_FROM_TOOL = axis(0, 0, 1, 0, LENGTH * 2 - LENGTH, 0)
SCREW = axis(0, 0, 1, 0, -LENGTH, PITCH)
SLIDE = axis(0, 0, 0, 1, 0, 0)


def case(actual: Numbers, expected: Numbers = TURN, elsewhere: Numbers | None = None) -> WrongScrew:
    scale = np.repeat([1.0, 0.5], 3)
    return WrongScrew(actual, expected, scale, elsewhere, "space")


# In a third frame, so that it differs from the axis with the other sign of v.
ELSEWHERE = axis(0, 0, 1, 0.2, LENGTH, 0)
PAIRS = [
    Pair(
        screw_axis.screw_axis_other_frame,
        case(ELSEWHERE, TURN, ELSEWHERE),
        case(axis(0, 0, 1, 0.3, 0, 0), TURN, ELSEWHERE),
        "body_for_space",
    ),
    Pair(
        screw_axis.moment_sign,
        case(axis(0, 0, 1, 0, LENGTH, PITCH), SCREW),
        case(axis(0, 0, 1, 0, LENGTH, -PITCH), SCREW),
        "moment_sign",
    ),
    Pair(screw_axis.axis_reversed, case(-SCREW, SCREW), case(-SLIDE + 0.1, SLIDE), "axis_reversed"),
    Pair(
        screw_axis.not_normalised,
        case(3 * TURN),
        case(axis(0, 0, 3, 0, -LENGTH, 0)),
        "not_normalised",
    ),
    Pair(
        screw_axis.sliding_as_turning,
        case(axis(1, 0, 0, 0, 0, 0), SLIDE),
        case(axis(0, 0, 0, 0, 1, 0), SLIDE),
        "infinite_pitch",
    ),
    Pair(
        screw_axis.turning_as_sliding,
        case(axis(0, 0, 0, 0, 0, 1)),
        case(axis(0, 0, 0, 0, 1, 0)),
        "infinite_pitch",
    ),
    Pair(
        screw_axis.screw_axis_exchanged_halves,
        case(axis(0, -LENGTH, 0, 0, 0, 1)),
        case(axis(0, LENGTH, 0, 0, 0, 1)),
        "exchanged_halves",
    ),
    Pair(
        screw_axis.point_for_velocity,
        case(axis(0, 0, 1, LENGTH, 0, 0.4)),
        case(axis(0, 0, 1, 0, LENGTH, 0)),
        "point_for_velocity",
    ),
    Pair(
        screw_axis.pitch,
        case(axis(0, 0, 1, 0, -LENGTH, 0), SCREW),
        case(axis(0, 0, 1, 0, LENGTH, 0), SCREW),
        "pitch",
    ),
    Pair(
        screw_axis.point_off_axis,
        case(axis(0, 0, 1, 0.4, LENGTH / 2, PITCH), SCREW),
        case(axis(0, 0, 1, 0.4, LENGTH / 2, 0), SCREW),
    ),
    Pair(
        screw_axis.other_direction,
        case(axis(0, 0.6, 0.8, 0.4, 0, 0)),
        case(axis(0, 0, -1, 0.4, 0, 0)),
    ),
]


@pytest.mark.parametrize("direction", [(0, 0, 1), (0.6, 0, 0.8)])
def test_a_slide_along_another_line_is_explained(direction: tuple[float, float, float]) -> None:
    finding = explain_screw(case(axis(0, 0, 0, *direction), SLIDE))
    assert finding is not None
    assert finding.code == "other_direction"
    assert "v is not along the axis" in finding.hint


@each_pair(PAIRS)
def test_a_misconception_explains_only_its_case(pair: Pair) -> None:
    assert_explains_only_the_first(pair)


@pytest.mark.parametrize("right", [TURN, SCREW, SLIDE])
def test_a_right_axis_gets_no_finding(right: Numbers) -> None:
    assert explain_screw(case(right, right, TURN_SEEN_FROM_TOOL)) is None


def test_an_axis_without_values_gets_no_finding() -> None:
    assert explain_screw(case(TURN * np.nan)) is None


# --- Test slips in all screw axes

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


def all_screws_case(actual: Numbers) -> WrongScrews:
    wrong = np.abs(actual - SPACE).max(axis=-1) > 1e-6
    return WrongScrews(actual, SPACE, np.repeat([1.0, 0.5], 3), wrong, BODY, "space")


def with_velocities(factor: Numbers) -> Numbers:
    """Return the axes with v multiplied by ``factor``."""
    changed = SPACE.copy()
    changed[:, 3:] *= factor[..., None]
    return changed


ACROSS = np.array([[-1, -1, -1], [1, 1, 1], [1, -1, -1]])
ALL_SCREWS_PAIRS = [
    Pair(
        all_screws.all_screws_exchanged_halves,
        all_screws_case(SPACE[:, [3, 4, 5, 0, 1, 2]]),
        all_screws_case(SPACE[:, [3, 4, 5, 0, 2, 1]]),
        "exchanged_halves",
    ),
    Pair(
        all_screws.axes_reversed, all_screws_case(-SPACE), all_screws_case(-BODY), "axis_reversed"
    ),
    Pair(
        all_screws.moment_signs,
        all_screws_case(with_velocities(ACROSS)),
        all_screws_case(with_velocities(-np.ones((3, 3)))),
        "moment_sign",
    ),
    Pair(
        all_screws.all_screws_other_frame,
        all_screws_case(BODY),
        all_screws_case(-BODY),
        "body_for_space",
    ),
]


@each_pair(ALL_SCREWS_PAIRS)
def test_a_misconception_explains_only_its_screws(pair: Pair) -> None:
    assert_explains_only_the_first(pair)


def test_one_wrong_axis_shows_no_slip_of_all_axes() -> None:
    assert explain_screws(all_screws_case(np.array([*SPACE[:2], -SPACE[2]]))) is None
    assert explain_screws(all_screws_case(SPACE * np.nan)) is None


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
