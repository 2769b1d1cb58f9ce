"""Test tables in frames that a student has chosen."""

from collections.abc import Mapping

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Severity
from dh_grader.grading.frames import pair_in_order

from tests.grading.support.robots import Row
from tests.grading.support.submitting import codes_at, full_marks, graded_table, not_correct

# --- Test the remarks on valid but unusual frames

# Each table differs in one frame, by one of the identities in docs/frame-choice.md. Which frame
# that is depends on the convention: row i has d and θ of z_{i-1} in a standard table, of z_i in a
# modified one.
DEPARTURES: list[tuple[str, str, tuple[Row, ...]]] = [
    (
        "planar-rrr",
        "You put origin 2 elsewhere on z2; that is a valid choice.",
        (
            ("0", "0", "0", "q1"),
            ("l1", "0", "0.3", "q2"),
            ("l2", "0", "-0.3", "q3"),
            ("l3", "0", "0", "0"),
        ),
    ),
    (
        "planar-rrr",
        "You let x2 point the opposite way; that is a valid choice.",
        (
            ("0", "0", "0", "q1"),
            ("l1", "0", "0", "q2 + pi"),
            ("-l2", "0", "0", "q3 - pi"),
            ("l3", "0", "0", "0"),
        ),
    ),
    (
        "rrrp",
        "You put origin 1 elsewhere on z1; that is a valid choice.",
        (
            ("l2", "0", "l1 + 0.2", "q1"),
            ("l3", "180deg", "-0.2", "q2"),
            ("0", "0", "l4", "q3"),
            ("0", "0", "q4", "0"),
        ),
    ),
    (
        "stanford-arm",
        "You let z2 point the opposite way; that is a valid choice.",
        (
            ("0", "-90deg", "0", "theta1"),
            ("0", "-90deg", "d2", "theta2"),
            ("0", "180deg", "-d3", "0"),
            ("0", "-90deg", "0", "theta4"),
            ("0", "90deg", "0", "theta5"),
            ("0", "0", "d6", "theta6"),
        ),
    ),
]


@pytest.mark.parametrize(
    ("exercise", "remark", "rows"), DEPARTURES, ids=[message for _, message, _ in DEPARTURES]
)
def test_only_the_frame_that_differs_is_named(
    exercise: str, remark: str, rows: tuple[Row, ...], catalogue: Mapping[str, Exercise]
) -> None:
    report = graded_table(catalogue[exercise], rows)
    assert full_marks(report)
    assert [message.message for message in report.feedback] == [remark]
    assert report.feedback[0].severity is Severity.INFO


def test_a_table_of_zeros_gets_no_remarks_on_frames(catalogue: Mapping[str, Exercise]) -> None:
    report = graded_table(catalogue["scara"], [("0", "0", "0", "0")] * 4)
    codes = {message.code for message in report.feedback}
    assert "no_joint_variable" in codes
    assert "own_frame_choice" not in codes


@pytest.mark.parametrize(
    "rows",
    [
        # The unknown d1 would move origins 2 and 3; with d4 = 0 this is the nearest valid table.
        (
            ("a1", "0", "0", "q1"),
            ("a2", "180deg", "d1", "q2"),
            ("0", "0", "d3", "0"),
            ("0", "0", "0", "q4"),
        ),
        # Origins 1 and 2 are moved by 0.3 in row 1, and nothing moves them back.
        (
            ("a1", "0", "0.3", "q1"),
            ("a2", "180deg", "0", "q2"),
            ("0", "0", "d3", "0"),
            ("0", "0", "d4", "q4"),
        ),
    ],
    ids=["an unknown symbol", "a shift that is not undone"],
)
def test_a_choice_that_a_wrong_row_implies_is_not_called_valid(
    rows: tuple[Row, ...], catalogue: Mapping[str, Exercise]
) -> None:
    report = graded_table(catalogue["scara"], rows)
    assert not full_marks(report)
    assert "own_frame_choice" not in {message.code for message in report.feedback}


def test_a_choice_between_right_rows_is_named_beside_a_wrong_row(
    catalogue: Mapping[str, Exercise],
) -> None:
    rows = [*DEPARTURES[3][2][:5], ("0", "90deg", "d6", "theta6")]
    report = graded_table(catalogue["stanford-arm"], rows)
    assert not full_marks(report)
    assert [m.message for m in report.feedback if m.code == "own_frame_choice"] == [
        DEPARTURES[3][1]
    ]


# --- Choose the joint of a table row if several are possible


def test_a_row_of_zeros_may_have_a_missing_value(
    catalogue: Mapping[str, Exercise],
) -> None:
    # z3 and z4 point up, so that row e must turn the last frame over, but its α is 0.
    report = graded_table(
        catalogue["rrrp-proximal"],
        [
            ("0", "0", "l1", "q1"),
            ("l2", "0", "0", "q2"),
            ("l3", "0", "-l4", "-q3"),
            ("0", "0", "-q4", "0"),
            ("0", "0", "0", "0"),
        ],
    )
    assert list(not_correct(report)) == [("e", "alpha")]


# --- Match the rows of an answer with the expected rows, in order

PAIRS: dict[str, tuple[list[list[float]], list[tuple[int | None, int | None]]]] = {
    "all agree": ([[1, 0], [0, 1]], [(0, 0), (1, 1)]),
    "the first row is missing": ([[0, 1]], [(None, 0), (0, 1)]),
    "the first row is extra": ([[0], [1]], [(0, None), (1, 0)]),
    "the order counts": ([[0, 1], [1, 0]], [(None, 0), (0, 1), (1, None)]),
    "the larger sum wins": ([[0, 1], [3, 0]], [(0, None), (1, 0), (None, 1)]),
    "nothing agrees": ([[0], [0]], [(0, 0), (1, None)]),
}


@pytest.mark.parametrize("name", PAIRS)
def test_the_pairing_has_the_largest_sum_of_scores(name: str) -> None:
    scores, pairs = PAIRS[name]
    assert pair_in_order(np.array(scores, dtype=np.float64)) == pairs


# --- Rounded angles are read as the exact angles

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
