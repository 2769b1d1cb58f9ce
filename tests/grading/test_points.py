"""Points add up, and all_or_nothing means what it says."""

from collections.abc import Callable, Mapping

import pytest
from hypothesis import given
from hypothesis import strategies as st

from service.catalogue import Exercise
from service.grading import Severity, Verdict
from tests.grading.support.robots import EXACT, ROBOTS, STANFORD, Robot
from tests.grading.support.submitting import graded_table, handed_in, part, table

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
all_or_nothing = true
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
def test_each_cell_is_worth_the_same_within_a_table(
    given_frames: Mapping[str, Exercise], robot: Robot, wrong: set[tuple[int, int]]
) -> None:
    rows = [list(row) for row in EXACT.rows(robot)]
    wrong = {(i, j) for i, j in wrong if i < len(rows)}
    for i, j in wrong:
        rows[i][j] += " + 0.321"
    report = graded_table(given_frames[robot.exercise], rows)
    cells = 4 * len(rows)
    assert report.points == pytest.approx(report.max_points * (cells - len(wrong)) / cells)
    assert sum(row.points for row in report.rows) == pytest.approx(report.points)
    assert sum(row.max_points for row in report.rows) == pytest.approx(report.max_points)
    assert (report.points == report.max_points) is (not wrong)
    for i, row in enumerate(report.rows):
        bad = sum(1 for place in wrong if place[0] == i)
        assert row.verdict is (
            Verdict.CORRECT if not bad else Verdict.INCORRECT if bad == 4 else Verdict.PARTIAL
        )


def test_the_parts_add_up_to_the_score(given_frames: Mapping[str, Exercise]) -> None:
    exercise = given_frames[STANFORD.exercise]
    report = handed_in(exercise, {"table": table(EXACT.rows(STANFORD))})
    assert (report.points, report.max_points, report.score) == (12, 20, 0.6)
    assert [part.max_points for part in report.parts] == [12, 8]
    assert (report.exercise, report.version) == (exercise.id, exercise.version)
    assert report.gradable is True


def test_a_part_that_is_not_handed_in_is_missing(given_frames: Mapping[str, Exercise]) -> None:
    for answers in ({}, {"table": None}, {"pose": None, "table": None}):
        report = handed_in(given_frames[STANFORD.exercise], answers)
        assert [part.verdict for part in report.parts] == [Verdict.MISSING] * 2
        assert (report.points, report.score, report.gradable) == (0, 0, False)


def test_a_wrong_answer_is_gradable(given_frames: Mapping[str, Exercise]) -> None:
    report = handed_in(given_frames[STANFORD.exercise], {"table": table([["1"] * 4] * 6)})
    assert (report.gradable, report.points) == (True, 0)
    assert part(report, "table").verdict is Verdict.INCORRECT


def test_all_or_nothing(make_exercise: Callable[[str], Exercise]) -> None:
    exercise = make_exercise(STRICT)
    wrong = [("a1", "0", "0", "q1"), ("a1", "0", "0", "q2")]
    unread = [("a1", "0", "0", "q1"), ("a2", "0", "(", "q2")]
    for rows, points in ((RIGHT, 7), (wrong, 0), (unread, 0), ([*RIGHT, ["1"] * 4], 0)):
        report = part(handed_in(exercise, {"table": table(rows)}), "table")
        assert report.points == points
        assert report.verdict is (Verdict.CORRECT if points else Verdict.PARTIAL)


def test_thirds_leave_no_dust(make_exercise: Callable[[str], Exercise]) -> None:
    exercise = make_exercise(STRICT.replace("points = 1\n", "points = 0.1\n"))
    report = handed_in(exercise, {"again": table(RIGHT), "table": table(RIGHT)})
    assert (report.points, report.score) == (7.1, 1.0)
    one_off = handed_in(exercise, {"again": table([RIGHT[0], ("a2", "0", "1", "q2")])})
    assert part(one_off, "again").points == 0.0875


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


def test_three_thirds_of_a_point_are_a_point(make_exercise: Callable[[str], Exercise]) -> None:
    """One entry of three is right in each row; each row is worth a point."""
    rows = [["1", "2", "2"], ["0", "2", "2"], ["0", "2", "2"]]
    report = part(handed_in(make_exercise(ROTATION), {"rotation": rows}), "rotation")
    assert [row.points for row in report.rows] == [0.333333] * 3
    assert report.points == 1


def test_another_convention_named_costs_nothing(given_frames: Mapping[str, Exercise]) -> None:
    """The table is right in the convention that is asked for; its label is not."""
    answer = table(EXACT.rows(STANFORD)) | {"convention": "modified"}
    report = part(handed_in(given_frames[STANFORD.exercise], {"table": answer}), "table")
    assert report.points == report.max_points
    assert [(m.code, m.severity) for m in report.feedback] == [
        ("convention_not_asked_for", Severity.WARNING)
    ]
