"""A constant that is right to three figures is accepted, with a note."""

from collections.abc import Callable

import pytest

from service.catalogue import Exercise
from service.grading import Severity, Verdict
from tests.grading.support.submitting import (
    cell,
    codes,
    codes_at,
    graded_pose,
    graded_table,
    not_correct,
)

# An arm whose pose holds constants: sqrt(2)/2 in row 3, 2/3 as a length.
ARM = """
title = "A tilted joint"
source = "made for this test"
statement = "One joint, tilted by an eighth of a turn."
[robot]
structure = "RR"
convention = "standard"
joints = ["q1", "q2"]
table = [["2/3", "45deg", "2", "q1 + pi/2"], ["0", "180deg", "1000", "q2"]]
[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
points = 8
convention = "standard"
[[parts]]
id = "pose"
kind = "transform"
title = "Pose"
"""
ROWS = [["2/3", "pi/4", "2", "q1 + pi/2"], ["0", "pi", "1000", "q2"]]


@pytest.fixture
def arm(make_exercise: Callable[[str], Exercise]) -> Exercise:
    return make_exercise(ARM)


ACCEPTED = [
    (0, "alpha", "0.785"),
    (0, "alpha", "0.7854"),
    (0, "alpha", "44.98deg"),
    (0, "theta", "q1 + 1.5708"),
    (0, "theta", "q1 + 1.57"),
    (0, "theta", "1.571 + q1"),
    (0, "a", "0.6667"),
    (0, "a", "0.667"),
    (1, "alpha", "3.14"),
    (1, "alpha", "-3.14"),
    (1, "alpha", "3.1416"),
    (1, "d", "999.5"),
]
REFUSED = [
    (0, "alpha", "0.8"),
    (0, "alpha", "0.78"),
    (0, "theta", "q1 + 1.6"),
    (0, "theta", "q1 + 1.5"),
    (0, "a", "0.67"),
    (0, "a", "0.66"),
    (0, "d", "2.01"),
    (1, "alpha", "3.1"),
    (1, "alpha", "3.2"),
    (1, "a", "0.0001"),
    (1, "d", "998"),
    (1, "theta", "q2 + 0.01"),
]


def graded(arm: Exercise, i: int, column: str, text: str) -> tuple[Verdict, list[str]]:
    rows = [list(row) for row in ROWS]
    rows[i][("a", "alpha", "d", "theta").index(column)] = text
    report = graded_table(arm, rows)
    assert set(not_correct(report)) <= {(str(i + 1), column)}
    found = cell(report, str(i + 1), column)
    return found.verdict, codes(found)


@pytest.mark.parametrize(("i", "column", "text"), ACCEPTED)
def test_three_figures_are_enough(i: int, column: str, text: str, arm: Exercise) -> None:
    assert graded(arm, i, column, text) == (Verdict.CORRECT, ["rounded"])


@pytest.mark.parametrize(("i", "column", "text"), REFUSED)
def test_two_figures_are_not(i: int, column: str, text: str, arm: Exercise) -> None:
    verdict, found = graded(arm, i, column, text)
    assert verdict is Verdict.INCORRECT
    assert found == [
        "distance_extra" if ROWS[i][("a", "alpha", "d", "theta").index(column)] == "0" else "value"
    ]


def test_what_is_exact_carries_no_note(arm: Exercise) -> None:
    report = graded_table(arm, ROWS)
    assert not_correct(report) == {}
    assert not [code for row in report.rows for found in row.cells for code in codes(found)]


@pytest.mark.parametrize(
    ("text", "verdict"),
    [
        ("-sqrt(2)/2", Verdict.CORRECT),
        ("-0.707", Verdict.CORRECT),
        ("-0.7071", Verdict.CORRECT),
        ("-cos(0.785)", Verdict.CORRECT),
        ("-0.7", Verdict.INCORRECT),
        ("-0.71", Verdict.INCORRECT),
    ],
)
def test_constants_in_a_pose(text: str, verdict: Verdict, arm: Exercise) -> None:
    matrix = [["0"] * 4, ["0"] * 4, ["0", "0", text, "0"], ["0", "0", "0", "1"]]
    report = graded_pose(arm, matrix)
    assert cell(report, "3", "3").verdict is verdict
    note = [] if text.startswith("-sqrt") else ["rounded"]
    assert codes_at(report, "3", "3") == (note if verdict is Verdict.CORRECT else ["value"])


def test_the_note_costs_nothing_and_says_what_to_write(arm: Exercise) -> None:
    rows = [list(row) for row in ROWS]
    rows[1][1] = "3.1416"
    report = graded_table(arm, rows)
    assert (report.verdict, report.points) == (Verdict.CORRECT, report.max_points)
    [note] = cell(report, "2", "alpha").feedback
    assert note.severity is Severity.INFO
    assert "write the number exactly" in note.message
