"""Test the message that says with which joints the rows were compared."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Submission, Verdict, grade

from tests.grading.support.robots import SCARA, Row
from tests.grading.support.submitting import graded_table

ROWS = list(SCARA.rows)
ZERO: Row = ("0", "0", "0", "0")


@pytest.fixture
def scara(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue["scara"]


def told(exercise: Exercise, rows: list[Row]) -> str:
    report = graded_table(exercise, rows, "degrees")
    return " ".join(each.message for each in report.feedback if each.code == "rows_matched")


def test_rows_after_a_missing_one_are_named(scara: Exercise) -> None:
    message = told(scara, [ROWS[0], *ROWS[2:]])
    assert "Your rows were compared in this way: row 2 with joint 3, row 3 with joint 4." in message
    assert "row 1" not in message


def test_rows_after_an_extra_one_are_named(scara: Exercise) -> None:
    message = told(scara, [ROWS[0], ("7", "1", "7", "7"), *ROWS[1:]])
    assert "row 3 with joint 2, row 4 with joint 3" in message
    assert "row 5 with joint 4" in message


def test_equal_rows_are_told_apart(catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue["rrrp-drawn"]
    reference = exercise.robot.tables[exercise.robot.convention]
    rows = [[formula.source for formula in row] for row in reference.rows]
    report = graded_table(exercise, [*rows[:3], rows[2], rows[3]])
    [message] = [each.message for each in report.feedback if each.code == "rows_matched"]
    assert message == "Your rows were compared in this way: row 5 with joint 4."


def test_a_length_put_in_twice_is_an_extra_row(catalogue: Mapping[str, Exercise]) -> None:
    # Without row 5 the table is right, so no cell is wrong, and the row costs a unit of 2 points.
    #
    # The four rows have 3 units, 2 points each, and half a point for each row (docs/marks.md).
    exercise = catalogue["planar-rrr"]
    reference = exercise.robot.tables[exercise.robot.convention]
    rows = [[formula.source for formula in row] for row in reference.rows]
    report = graded_table(exercise, [*rows, rows[-1]])
    assert report.points == 8 - 2
    assert [message.code for message in report.feedback] == ["extra_row"]
    assert {row.verdict for row in report.rows} == {Verdict.CORRECT}
    # A row that cannot be read may be 0.
    unread = graded_table(exercise, [*rows, ["?", "0", "0", "0"]])
    assert "extra_row" not in [message.code for message in unread.feedback]


@pytest.mark.parametrize("rows", [ROWS, [*ROWS, ZERO], ROWS[:3], [ROWS[0], ROWS[2], *ROWS[2:]]])
def test_rows_in_their_places_get_no_message(rows: list[Row], scara: Exercise) -> None:
    assert told(scara, rows) == ""


def test_an_end_row_in_its_place_gets_no_message(
    catalogue: Mapping[str, Exercise],
) -> None:
    # The modified table of the planar arm has a row "e" in its expected place.
    exercise = catalogue["planar-rrr"]
    reference = exercise.robot.tables[exercise.robot.convention]
    assert reference.labels[-1] == "e"
    rows = [[formula.source for formula in row] for row in reference.rows]
    report = graded_table(exercise, rows)
    assert [each.code for each in report.feedback if each.code == "rows_matched"] == []


def test_each_fixed_row_before_the_last_joint_has_a_label_of_its_own(
    catalogue: Mapping[str, Exercise],
) -> None:
    rows = "a1, 0, 0, q1\n0, 0, 1, 0\n0, 0, -1, 0\na2, 0, 0, q2"
    report = grade(catalogue["planar-rr"], Submission({"table": rows})).parts[0]
    assert [row.label for row in report.rows] == ["1", "0", "0b", "2"]
    [message] = [each.message for each in report.feedback if each.code == "rows_matched"]
    assert "row 2 with the fixed row 0 before the last joint" in message
    assert "row 3 with the fixed row 0b before the last joint" in message
