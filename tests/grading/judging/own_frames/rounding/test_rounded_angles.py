"""Rounded angles are read as the exact angles."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise

from tests.grading.support.submitting import codes_at, graded_table, not_correct

# The Stanford arm with z2 reversed, so that the cells do not follow from the reference's.
TURNED_OVER = [
    ["0", "-{quarter}", "0", "theta1"],
    ["0", "-{quarter}", "d2", "theta2"],
    ["0", "{half}", "-d3", "0"],
    ["0", "-{quarter}", "0", "theta4"],
    ["0", "{quarter}", "0", "theta5"],
    ["0", "0", "d6", "theta6"],
]


@pytest.mark.parametrize(("quarter", "half"), [("1.57", "3.14"), ("1.5708", "3.1416")])
def test_rounded_angles_are_right_in_frames_of_the_student(
    quarter: str, half: str, catalogue: Mapping[str, Exercise]
) -> None:
    rows = [[text.format(quarter=quarter, half=half) for text in row] for row in TURNED_OVER]
    report = graded_table(catalogue["stanford-arm"], rows)
    assert not_correct(report) == {}
    assert [m.code for m in report.feedback] == ["own_frame_choice", "rounded"]
    assert codes_at(report, "2", "alpha") == ["rounded"]
    rows[1][2] = "-d2"
    wrong = graded_table(catalogue["stanford-arm"], rows)
    assert list(not_correct(wrong)) == [("2", "d")]


def test_a_decimal_beside_a_round_angle_may_be_intended(catalogue: Mapping[str, Exercise]) -> None:
    # x3 is turned about z3 by nearly 120°, and a later row turns it back.
    rows = [[text.format(quarter="pi/2", half="pi") for text in row] for row in TURNED_OVER]
    rows[2][3] = "-2.09559209845"
    rows[3][3] = "theta4 - 2.09559209845"
    report = graded_table(catalogue["stanford-arm"], rows)
    assert not_correct(report) == {}
    assert report.points == report.max_points
