"""The points in a report add up, and each marking scheme works as documented."""

from collections.abc import Callable, Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Severity, Verdict
from hypothesis import given
from hypothesis import strategies as st

from tests.grading.support.robots import EXACT, ROBOTS, STANFORD, Robot
from tests.grading.support.submitting import graded_table, handed_in, part, table
from tests.grading.support.worth import about, points

STRICT = """
title = "Planar RR"
source = "MEAM 520, More Denavit-Hartenberg (DH), Example 1"
statement = "Two links in a plane."
[robot]
structure = "RR"
convention = "standard"
joints = ["theta1", "theta2"]
table = [["a1", "0", "0", "theta1"], ["a2", "0", "0", "theta2"]]
[symbols]
a1 = { kind = "length", description = "first link" }
a2 = { kind = "length", description = "second link" }
[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
points = 7
convention = "standard"
marking = "whole"
[[parts]]
id = "again"
kind = "dh_table"
title = "The same, cell by cell"
points = 1
convention = "standard"
"""
RIGHT = [("a1", "0", "0", "q1"), ("a2", "0", "0", "q2")]


@given(
    robot=st.sampled_from(ROBOTS),
    wrong=st.sets(st.tuples(st.integers(0, 5), st.integers(0, 3))),
)
def test_a_row_is_worth_its_content_cells(
    given_frames: Mapping[str, Exercise], robot: Robot, wrong: set[tuple[int, int]]
) -> None:
    rows = [list(row) for row in EXACT.rows(robot)]
    wrong = {(i, j) for i, j in wrong if i < len(rows)}
    for i, j in wrong:
        rows[i][j] += " + 0.321"
    report = graded_table(given_frames[robot.exercise], rows)
    expected = points(robot, [i for i, _ in wrong])
    assert [row.points for row in report.rows] == about(expected)
    assert [row.max_points for row in report.rows] == about(points(robot, []))
    assert report.points == pytest.approx(sum(expected), abs=1e-5)
    assert (report.points == report.max_points) is (not wrong)
    for i, row in enumerate(report.rows):
        bad = sum(1 for place in wrong if place[0] == i)
        assert row.verdict is (
            Verdict.CORRECT if not bad else Verdict.PARTIAL if row.points else Verdict.INCORRECT
        )


def test_the_parts_add_up_to_the_score(given_frames: Mapping[str, Exercise]) -> None:
    exercise = given_frames[STANFORD.exercise]
    report = handed_in(exercise, {"table": table(EXACT.rows(STANFORD))})
    assert (report.points, report.max_points, report.score) == (12, 20, 0.6)
    assert [part.max_points for part in report.parts] == [12, 8]
    assert (report.exercise, report.version) == (exercise.id, exercise.version)
    assert report.gradable is True


def test_a_part_without_an_answer_is_missing(given_frames: Mapping[str, Exercise]) -> None:
    for answers in ({}, {"table": None}, {"pose": None, "table": None}):
        report = handed_in(given_frames[STANFORD.exercise], answers)
        assert [part.verdict for part in report.parts] == [Verdict.MISSING] * 2
        assert (report.points, report.score, report.gradable) == (0, 0, False)


def test_a_wrong_answer_is_gradable(given_frames: Mapping[str, Exercise]) -> None:
    report = handed_in(given_frames[STANFORD.exercise], {"table": table([["1"] * 4] * 6)})
    assert (report.gradable, report.points) == (True, 0)
    assert part(report, "table").verdict is Verdict.INCORRECT


UNREAD = [("a1", "0", "0", "q1"), ("a2", "0", "(", "q2")]
ONE_WRONG = [("a1", "0", "0", "q1"), ("a1", "0", "0", "q2")]
TOO_MANY = [*RIGHT, ("1", "1", "1", "1")]
# By hand: a1 and a2 are the content cells of the eight. Of 7 points, 2.4 units, a unit is 2.92,
# rounded to 3 points; each row has half a point more. The unread 0 costs a fifth of 3 points,
# rounded to 0.5. By cells, 28 quarters for 8 cells: every other cell gets one more, a point; a2 and
# its d are among them.
MARKINGS = {
    "content": {"wrong": 4.0, "unread": 6.5, "extra": 4.0},
    "cells": {"wrong": 6.0, "unread": 6.0, "extra": 3.5},
    "rows": {"wrong": 3.5, "unread": 3.5, "extra": 3.5},
    "whole": {"wrong": 0.0, "unread": 0.0, "extra": 0.0},
}


@pytest.mark.parametrize("marking", MARKINGS)
def test_a_part_says_how_it_is_marked(
    marking: str, make_exercise: Callable[[str], Exercise]
) -> None:
    exercise = make_exercise(STRICT.replace('"whole"', f'"{marking}"'))
    answers = {"right": RIGHT, "wrong": ONE_WRONG, "unread": UNREAD, "extra": TOO_MANY}
    for name, expected in {"right": 7.0, **MARKINGS[marking]}.items():
        report = part(handed_in(exercise, {"table": table(answers[name])}), "table")
        assert report.points == pytest.approx(expected, abs=1e-5), name
        assert sum(row.points for row in report.rows) == pytest.approx(expected, abs=1e-5), name
        assert sum(row.max_points for row in report.rows) == pytest.approx(7, abs=1e-5), name
        assert (report.verdict is Verdict.CORRECT) is (name == "right"), name
        assert (report.verdict is Verdict.PARTIAL) is (0 < expected < 7), name


def test_parts_of_a_tenth_of_a_point_add_up(make_exercise: Callable[[str], Exercise]) -> None:
    exercise = make_exercise(STRICT.replace("points = 1\n", "points = 0.1\n"))
    report = handed_in(exercise, {"again": table(RIGHT), "table": table(RIGHT)})
    assert (report.points, report.score) == (7.1, 1.0)
    one_off = handed_in(exercise, {"again": table([RIGHT[0], ("a2", "0", "1", "q2")])})
    # Ten hundredths for 2.4 units: a unit costs four.
    assert part(one_off, "again").points == 0.06


ROTATION = """
title = "Turned about x"
source = "made for this test"
statement = "A rotation by q1 about x."
[symbols.q1]
kind = "angle"
description = "the angle"
[[parts]]
id = "rotation"
kind = "rotation"
title = "Rotation"
points = 3
expected = [["1", "0", "0"], ["0", "cos(q1)", "-sin(q1)"], ["0", "sin(q1)", "cos(q1)"]]
"""


def test_a_wrong_entry_costs_one_content_cell(
    make_exercise: Callable[[str], Exercise],
) -> None:
    # Four entries of a turn about x are content cells: they differ from the identity.
    exercise = make_exercise(ROTATION)
    right = [["1", "0", "0"], ["0", "cos(q1)", "-sin(q1)"], ["0", "sin(q1)", "cos(q1)"]]
    for wrong, expected in (([(0, 0)], 2.25), ([(1, 2)], 2.25), ([(0, 1), (2, 2)], 1.5)):
        rows = [["2" if (i, j) in wrong else right[i][j] for j in range(3)] for i in range(3)]
        report = part(handed_in(exercise, {"rotation": rows}), "rotation")
        assert report.points == expected
        assert sum(row.points for row in report.rows) == pytest.approx(expected, abs=1e-5)


def test_the_name_of_another_convention_costs_nothing(given_frames: Mapping[str, Exercise]) -> None:
    # The table is right in the expected convention; only the convention that it names is wrong.
    answer = table(EXACT.rows(STANFORD)) | {"convention": "modified"}
    report = part(handed_in(given_frames[STANFORD.exercise], {"table": answer}), "table")
    assert report.points == report.max_points
    assert [(m.code, m.severity) for m in report.feedback] == [
        ("convention_not_asked_for", Severity.WARNING)
    ]
