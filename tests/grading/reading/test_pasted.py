"""Read square brackets and decimal commas in pasted texts."""

from collections.abc import Callable
from typing import Any

import pytest
from dh_grader.catalogue import Exercise, shipped_folder
from dh_grader.expressions import Vocabulary, joint_variable
from dh_grader.grading import Submission, grade
from dh_grader.grading.numbers import Samples
from dh_grader.grading.reading.entries import Reader, pasted_grid
from dh_grader.grading.report import Verdict
from dh_grader.pasting import GridError, read_grid


def cells(text: str) -> list[str]:
    reader = Reader(Vocabulary([joint_variable(i) for i in (1, 2, 3)]), Samples({}), "radians", "m")
    entries = [reader.read(cell.text, "number") for cell in pasted_grid(text, reader).rows[0]]
    return [entry.expression.text() for entry in entries if entry.expression]


def test_a_joint_with_index_0_counts_from_0() -> None:
    assert cells("q[0], q[1]") == ["theta1", "theta2"]


def test_the_number_of_the_last_joint_counts_from_1() -> None:
    assert cells("theta[1], theta[3]") == ["theta1", "theta3"]


@pytest.mark.parametrize("text", ["q[1], 0", "cos(q[1]), sin(q[2])", "θ[2], 1"])
def test_other_indices_have_two_readings(text: str) -> None:
    with pytest.raises(GridError) as caught:
        cells(text)
    assert caught.value.code == "ambiguous_index"


# --- decimal commas


@pytest.mark.parametrize(
    ("text", "read"),
    [
        ("0,5;1\n2,25;l1", [["0.5", "1"], ["2.25", "l1"]]),
        ("0,5;0.25\n2;3", [["0.5", "0.25"], ["2", "3"]]),
        ("0,5\t1,000\n2\tl1", [["0.5", "1.000"], ["2", "l1"]]),
        ("-0,5l1;cos(0,5)\n2*1,25;atan2(1,5)", [["-0.5l1", "cos(0,5)"], ["2*1.25", "atan2(1,5)"]]),
        ("|a, mm|alpha|\n|---|---|\n|12,5|q1|", [["a, mm", "alpha"], ["12.5", "q1"]]),
        # Thousands, points beside commas, lists, or one line: no comma is certain.
        ("1,000;2\n12,500;3", [["1,000", "2"], ["12,500", "3"]]),
        ("1,2,3;0,5\n2;3", [["1,2,3", "0,5"], ["2", "3"]]),
        ("1, 2;0,5\n2;3", [["1, 2", "0,5"], ["2", "3"]]),
        ("q1,5;0,5\n2;3", [["q1,5", "0,5"], ["2", "3"]]),
    ],
)
def test_a_comma_is_a_decimal_comma_only_where_nothing_else_fits(
    text: str, read: list[list[str]]
) -> None:
    assert [[cell.text for cell in row] for row in read_grid(text, of_table=True).rows] == read


def test_a_decimal_comma_in_a_cell_keeps_its_place() -> None:
    cell = read_grid("0,5;1\n2,25;l1", of_table=True).rows[1][0]
    assert (cell.text, cell.whole) == ("2.25", (6, 10))


# The table of the UR5e as its maker prints it, in the language of a German spreadsheet.
ROWS = (
    ("0", "90°", "0,1625", "theta1"),
    ("-0,425", "0", "0", "theta2"),
    ("-0,3922", "0", "0", "theta3"),
    ("0", "90°", "0,1333", "theta4"),
    ("0", "-90°", "0,0997", "theta5"),
    ("0", "0", "0,0996", "theta6"),
)
COLUMNS = ("a", "alpha", "d", "theta")


@pytest.fixture
def arm(make_exercise: Callable[[str], Exercise]) -> Callable[[bool], Exercise]:
    def made(allowed: bool) -> Exercise:
        text = (shipped_folder() / "ur5e.toml").read_text(encoding="utf-8")
        return make_exercise(f"decimal_comma = {str(allowed).lower()}\n{text}")

    return made


SHAPES: dict[str, Any] = {
    "cells": {"rows": [dict(zip(COLUMNS, row, strict=True)) for row in ROWS]},
    "spreadsheet": {"rows": "\n".join(map("\t".join, ROWS))},
    "csv": {"rows": "\n".join(map(";".join, ROWS))},
    "markdown": {"rows": "\n".join(f"| {' | '.join(row)} |" for row in ROWS)},
    "quoted": {"rows": "\n".join(",".join(f'"{cell}"' for cell in row) for row in ROWS)},
    "spaces": {"rows": "\n".join(map("  ".join, ROWS))},
}


@pytest.mark.parametrize("shape", SHAPES)
def test_a_table_with_decimal_commas_has_full_marks(
    arm: Callable[[bool], Exercise], shape: str
) -> None:
    [report, *_] = grade(arm(True), Submission({"table": SHAPES[shape]})).parts
    assert report.points == report.max_points


@pytest.mark.parametrize("shape", ["spreadsheet", "csv", "markdown", "quoted"])
def test_between_other_signs_than_commas_a_decimal_comma_is_read_with_a_note(
    arm: Callable[[bool], Exercise], shape: str
) -> None:
    [report, *_] = grade(arm(False), Submission({"table": SHAPES[shape]})).parts
    assert report.points == report.max_points
    notes = [finding for finding in report.feedback if finding.code == "decimal_comma_read"]
    assert [str(note.message) for note in notes] == [
        "`0,1625` is read as 0.1625: the comma is a decimal comma."
    ]


@pytest.mark.parametrize("shape", ["cells", "spaces"])
def test_elsewhere_no_decimal_comma_is_read_without_leave(
    arm: Callable[[bool], Exercise], shape: str
) -> None:
    [report, *_] = grade(arm(False), Submission({"table": SHAPES[shape]})).parts
    assert report.verdict is not Verdict.CORRECT
    cells = [cell for row in report.rows for cell in row.cells]
    assert all(cell.verdict is not Verdict.INCORRECT for cell in cells)


def test_a_wrong_length_is_wrong(arm: Callable[[bool], Exercise]) -> None:
    rows = [dict(row) for row in SHAPES["cells"]["rows"]]
    rows[1]["a"] = "-0,452"
    [report, *_] = grade(arm(True), Submission({"table": {"rows": rows}})).parts
    wrong = [
        (row.label, c.label)
        for row in report.rows
        for c in row.cells
        if c.verdict is not Verdict.CORRECT
    ]
    assert wrong == [("2", "a")]
