"""Rows that an exercise gives earn nothing and cannot be changed."""

import pytest
from dh_grader.grading.grade import Submission, grade
from dh_grader.grading.report import PartReport, Verdict

from tests.shipped import shipped_exercises

OWN = [["l2", "0", "0", "q3"], ["l3", "0", "0", "0"]]
GIVEN = [["0", "0", "0", "q1"], ["l1", "0", "0", "q2"]]
EMPTY = ["", "", "", ""]


def graded(table: object, exercise: str = "planar-rrr-faded", unit: str = "radians") -> PartReport:
    submission = Submission({"table": table}, "degrees" if unit == "degrees" else "radians")
    report = grade(shipped_exercises()[exercise], submission)
    return report.parts[0]


def codes(part: PartReport) -> list[str]:
    return [each.code for each in part.feedback]


@pytest.mark.parametrize(
    "table",
    [
        OWN,
        [*GIVEN, *OWN],
        [EMPTY, EMPTY, *OWN],
        [["0", "", "", "q1"], EMPTY, *OWN],
        [GIVEN[1], *OWN],
        "a, alpha, d, theta\nl2, 0, 0, q3\nl3, 0, 0, 0",
        "theta, d, a, alpha\nq1, 0, 0, 0\nq2, 0, l1, 0\nq3, 0, l2, 0\n0, 0, l3, 0",
    ],
)
def test_given_rows_may_be_left_out(table: object) -> None:
    part = graded(table)
    assert (part.points, part.verdict, codes(part)) == (4, Verdict.CORRECT, [])


def test_given_rows_earn_nothing() -> None:
    part = graded([*GIVEN, EMPTY, EMPTY])
    assert part.points == 0
    assert [row.max_points for row in part.rows] == [0, 0, 2, 2]
    assert graded([*GIVEN, OWN[0], EMPTY]).points == graded([OWN[0], EMPTY]).points == 2
    assert graded([GIVEN[1], OWN[0]]).points == graded([OWN[0]]).points == 2


def test_a_changed_given_row_is_graded_as_it_is_given() -> None:
    part = graded([["0", "0", "0", "q1"], ["l2", "0", "0", "q2"], *OWN])
    assert (part.points, codes(part)) == (4, ["given_row_changed"])
    assert part.feedback[0].message.startswith("Row 2 is given,")


def test_a_given_row_between_others() -> None:
    own = [["a2", "180deg", "0", "theta2"], ["0", "0", "d4", "theta4"]]
    assert graded(own, "scara-faded").points == 4
    assert graded([own[0]], "scara-faded").points < 4
    whole = [["a1", "0", "0", "theta1"], own[0], ["0", "0", "d3", "0"], own[1]]
    assert codes(graded(whole, "scara-faded", "degrees")) == []


def test_a_slip_costs_a_share_of_the_other_rows() -> None:
    part = graded([["l3", "0", "0", "q3"], OWN[1]])
    assert part.rows[2].points < part.rows[2].max_points
    assert part.points == 4 - (part.rows[2].max_points - part.rows[2].points)


def test_too_many_rows_are_graded_as_they_are() -> None:
    part = graded([*GIVEN, *OWN, ["l3", "0", "0", "0"]])
    assert "extra_row" in codes(part)
    assert part.points < 4
