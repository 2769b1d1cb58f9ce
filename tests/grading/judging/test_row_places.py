"""Rows that are graded under another number than they have in the answer."""

from collections.abc import Mapping

import pytest

from service.catalogue import Exercise
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


def test_a_row_too_few(scara: Exercise) -> None:
    message = told(scara, [ROWS[0], *ROWS[2:]])
    assert "Your rows were compared in this way: row 2 with joint 3, row 3 with joint 4." in message
    assert "row 1" not in message


def test_a_row_too_many(scara: Exercise) -> None:
    message = told(scara, [ROWS[0], ("7", "1", "7", "7"), *ROWS[1:]])
    assert "row 3 with joint 2, row 4 with joint 3" in message
    assert "row 5 with joint 4" in message


@pytest.mark.parametrize("rows", [ROWS, [*ROWS, ZERO], ROWS[:3], [ROWS[0], ROWS[2], *ROWS[2:]]])
def test_nothing_is_told_of_rows_in_their_places(rows: list[Row], scara: Exercise) -> None:
    assert told(scara, rows) == ""


def test_of_an_end_row_that_is_meant_as_such_nothing_is_told(
    catalogue: Mapping[str, Exercise],
) -> None:
    """The proximal table of the planar arm has a row "e", which stands where it should."""
    exercise = catalogue["planar-rrr"]
    reference = exercise.robot.tables[exercise.robot.convention]
    assert reference.labels[-1] == "e"
    rows = [[formula.source for formula in row] for row in reference.rows]
    report = graded_table(exercise, rows)
    assert [each.code for each in report.feedback if each.code == "rows_matched"] == []
