"""Test slips in a link transform."""

import re
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading.diagnosis import products as link_slips
from dh_grader.grading.diagnosis.products import LinkAmongOthers
from dh_grader.kinematics import Convention

from tests.frame_choice.kinematics import screw_x, screw_z
from tests.grading.diagnosis.example_chain import A1, A2, A3, COUNT, TABLE, wrong_matrix
from tests.grading.diagnosis.pairs import Pair, assert_explains_only_the_first, each_pair
from tests.grading.support.exercise_texts import Make, all_codes
from tests.grading.support.scara import A1 as SCARA_A1
from tests.grading.support.scara import A2 as SCARA_A2
from tests.grading.support.scara import A3 as SCARA_A3
from tests.grading.support.scara import A4 as SCARA_A4
from tests.grading.support.scara import SCARA, graded
from tests.grading.support.submitting import handed_in, part

ANGLES = [np.linspace(0.2, 0.9, COUNT), np.linspace(1.1, -0.4, COUNT)]
ZERO = np.zeros(COUNT)
LINKS = np.array([A1, A2, A3])
STANDARD = LinkAmongOthers(LINKS, ANGLES, Convention.STANDARD)
# The third row in the modified convention: first about and along x, then about and along z.
THIRD = screw_x(*TABLE[2, :2]) @ screw_z(*TABLE[2, 2:])
MODIFIED = LinkAmongOthers(np.array([A1, A2, THIRD]), ANGLES, Convention.MODIFIED)
# The rotation of a link, with a and d of the table as its position.
BESIDE = A3.copy()
BESIDE[:, :3, 3] = np.stack([TABLE[2, 0], ZERO, TABLE[2, 2]], axis=-1)
PAIRS = [
    Pair(
        link_slips.absolute_angle,
        wrong_matrix(screw_z(ZERO, ANGLES[0] + ANGLES[1]) @ A3, A3),
        wrong_matrix(A3 @ screw_z(ZERO, ANGLES[0] + ANGLES[1]), A3),
        source=lambda _: STANDARD,
    ),
    Pair(
        link_slips.absolute_angle,
        wrong_matrix(THIRD @ screw_z(ZERO, ANGLES[1]), THIRD),
        wrong_matrix(screw_z(ZERO, ANGLES[1]) @ THIRD, THIRD),
        source=lambda _: MODIFIED,
    ),
    Pair(
        link_slips.pose_for_link,
        wrong_matrix(A1 @ A2 @ A3, A3),
        wrong_matrix(A2 @ A3, A3),
        source=lambda _: STANDARD,
    ),
    Pair(
        link_slips.translation_not_turned,
        wrong_matrix(BESIDE, A3),
        wrong_matrix(BESIDE @ screw_x(TABLE[2, 0], ZERO), A3),
        source=lambda _: STANDARD,
    ),
]


@each_pair(PAIRS)
def test_a_misconception_explains_only_its_case(pair: Pair) -> None:
    assert_explains_only_the_first(pair)


def matrix(angle: str, length: str, of_length: str) -> list[list[Any]]:
    return [
        [f"c{angle}", f"-s{angle}", 0, f"{length} c{of_length}"],
        [f"s{angle}", f"c{angle}", 0, f"{length} s{of_length}"],
        [0, 0, 1, 0],
        [0, 0, 0, 1],
    ]


@pytest.mark.parametrize(
    ("second", "wrong"),
    [(matrix("12", "a2", "12"), 6), (matrix("12", "a2", "2"), 4), (matrix("2", "a2", "12"), 2)],
    ids=["whole", "rotation", "position"],
)
def test_a_second_link_with_both_angles_is_named(
    second: list[list[Any]], wrong: int, catalogue: Mapping[str, Exercise]
) -> None:
    answer = [matrix("1", "a1", "1"), second]
    report = part(handed_in(catalogue["planar-rr"], {"links": answer}), "links")
    [message] = report.feedback
    assert (message.code, len(message.places or ())) == ("absolute_angle", wrong)
    assert all_codes(report) == {"absolute_angle"}


def test_a_pose_for_the_second_link_is_named(catalogue: Mapping[str, Exercise]) -> None:
    pose = matrix("12", "a2", "12")
    pose[0][3], pose[1][3] = "a1 c1 + a2 c12", "a1 s1 + a2 s12"
    answer = [matrix("1", "a1", "1"), pose]
    report = part(handed_in(catalogue["planar-rr"], {"links": answer}), "links")
    assert all_codes(report) == {"pose_for_link"}


def test_two_links_with_the_same_slip_get_one_message(make_exercise: Make) -> None:
    # In the answer, A2 of a SCARA arm is also turned by θ1, and A4 by θ1 + θ2.
    second = [[re.sub(r"([cs])2", r"\g<1>12", text) for text in row] for row in SCARA_A2]
    turn = "theta1 + theta2 + theta4"
    last = [
        [text.replace("c4", f"cos({turn})").replace("s4", f"sin({turn})") for text in row]
        for row in SCARA_A4
    ]
    exercise = make_exercise(SCARA)
    right = graded(exercise, links=[SCARA_A1, SCARA_A2, SCARA_A3, SCARA_A4])["links"]
    assert all_codes(right) == set()
    report = graded(exercise, links=[SCARA_A1, second, SCARA_A3, last])["links"]
    [message] = report.feedback
    assert message.code == "absolute_angle"
    assert {place.row[:2] for place in message.places or ()} == {"A2", "A4"}
