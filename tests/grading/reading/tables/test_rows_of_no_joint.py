"""Rows for the base, empty rows at the end and repeated headers cost a right table nothing."""

from collections.abc import Mapping

import pytest
from dh_grader import grading
from dh_grader.catalogue import Exercise
from dh_grader.grading import PartReport, Submission
from dh_grader.kinematics import Convention

HEADERS = "i, a, alpha, d, theta"
SCARA = ("1, a1, 0, 0, theta1", "2, a2, 180deg, 0, theta2", "3, 0, 0, d3, 0", "4, 0, 0, d4, theta4")


def graded(catalogue: Mapping[str, Exercise], *rows: str, exercise: str = "scara") -> PartReport:
    report = grading.grade(catalogue[exercise], Submission({"table": "\n".join(rows)}))
    return next(part for part in report.parts if part.part == "table")


@pytest.mark.parametrize(
    "base",
    [
        "0, -, -, -, -",
        "0, , , , ",
        "0, Base frame, , , ",
        "Base, , , , ",
        "Basis, -, -, -, -",
        "0, –, –, –, –",
        "0, base, base, base, base",
        "{0}, , , , ",
        "基座, , , , ",
    ],
)
def test_a_row_of_the_base_without_values_costs_nothing(
    base: str, catalogue: Mapping[str, Exercise]
) -> None:
    part = graded(catalogue, HEADERS, base, *SCARA)
    assert part.points == part.max_points == 8
    assert "text_left_aside" in [message.code for message in part.feedback]


@pytest.mark.parametrize("end", [["5, , , , "], ["5, -, -, -, -"], ["5, , , , ", "6, , , , "]])
def test_empty_numbered_rows_at_the_end_cost_nothing(
    end: list[str], catalogue: Mapping[str, Exercise]
) -> None:
    assert graded(catalogue, HEADERS, *SCARA, *end).points == 8


def test_a_row_of_dashes_without_labels_costs_nothing(catalogue: Mapping[str, Exercise]) -> None:
    rows = [row.partition(", ")[2] for row in SCARA]
    assert graded(catalogue, "a, alpha, d, theta", "-, -, -, -", *rows).points == 8
    assert graded(catalogue, "-, -, -, -", *rows).points == 8


@pytest.mark.parametrize(
    "rows",
    [
        # A value in the row: it is a row too many.
        ["0, a2, 0, 0, 0", *SCARA],
        [*SCARA, "5, a2, 0, 0, 0"],
        ["0, -, -, -, theta1", *SCARA],
        # The row of a joint is empty, so that there are no rows too many.
        ["0, -, -, -, -", *SCARA[:3]],
        ["1, , , , ", *SCARA[1:]],
        [*SCARA[:3], "4, , , , "],
        # Words that are no name of the base.
        ["5, no, idea, , ", *SCARA],
    ],
)
def test_other_rows_still_cost_points(rows: list[str], catalogue: Mapping[str, Exercise]) -> None:
    assert graded(catalogue, HEADERS, *rows).points < 8


def test_a_correction_in_the_row_of_the_base_is_not_ignored(
    catalogue: Mapping[str, Exercise],
) -> None:
    part = graded(catalogue, HEADERS, "0, base: row 2 is wrong, , , ", *SCARA)
    assert part.points < 8


@pytest.mark.parametrize("place", [2, 4, 5])
def test_repeated_headers_cost_nothing(place: int, catalogue: Mapping[str, Exercise]) -> None:
    rows = [HEADERS, *SCARA]
    part = graded(catalogue, *rows[:place], HEADERS, *rows[place:])
    assert part.points == 8
    assert "text_left_aside" in [message.code for message in part.feedback]


def test_headers_in_another_order_are_not_repeated_headers(
    catalogue: Mapping[str, Exercise],
) -> None:
    part = graded(catalogue, HEADERS, *SCARA[:2], "i, a, d, alpha, theta", *SCARA[2:])
    assert part.points < 8


def test_a_fixed_first_row_is_before_the_first_joint(catalogue: Mapping[str, Exercise]) -> None:
    assert catalogue["scara"].robot.convention is Convention.STANDARD
    part = graded(catalogue, HEADERS, "0, 0, 0, 0, 0", *SCARA)
    assert part.points == 8
    [message] = [each.message for each in part.feedback if each.code == "rows_matched"]
    assert "row 1 with the fixed row 0 before the first joint" in message
