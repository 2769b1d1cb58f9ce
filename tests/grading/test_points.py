"""Test what rows and cells are worth."""

from collections.abc import Callable, Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.schema_fields import Marking
from dh_grader.grading import Severity, Verdict
from dh_grader.grading.judging import Content
from dh_grader.grading.marks import CellWorth, apportioned, evenly, worth_of
from hypothesis import given
from hypothesis import strategies as st

from tests.grading.support.robots import EXACT, ROBOTS, STANFORD, Robot
from tests.grading.support.submitting import about, graded_table, handed_in, part, points, table
from tests.together import together

# --- The points in a report add up, and each marking scheme works as documented

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


# --- Compute by hand the points of cells and rows


def content(*rows: str, groups: str = "", **more: object) -> Content:
    """Return the content of rows such as "x..."; "x" marks a cell that needs knowledge.

    ``groups`` has the number of each row's group; the rows are groups of their own without it.
    """
    known = tuple(tuple(cell == "x" for cell in row) for row in rows)
    numbers = [int(each) for each in groups] or range(len(rows))
    return Content(
        known,
        tuple((number,) * len(row) for number, row in zip(numbers, rows, strict=True)),
        **more,  # type: ignore[arg-type]
    )


SCARA = content("x...", "xx..", "....", "..x.", besides=True)


def worth(cells: Content, points: float, marking: Marking = "content") -> CellWorth:
    return worth_of(cells, marking, points)


def test_the_scara_s_table_is_worth_the_points_of_the_docs() -> None:
    # docs/marks.md: 1.75 for a unit, 0.25 for each row.
    found = worth(SCARA, 8)
    assert (found.step, found.total) == (0.25, 32)
    assert found.cells == ((7, 0, 0, 0), (7, 7, 0, 0), (0, 0, 0, 0), (0, 0, 7, 0))
    assert found.besides == (1, 1, 1, 1)
    assert found.rows == (8, 15, 1, 8)
    assert [found.points(each) for each in found.rows] == [2, 3.75, 0.25, 2]
    assert found.groups == {0: 8, 1: 15, 2: 1, 3: 8}
    assert found.units == dict.fromkeys(range(4), 7)
    assert (found.unit, found.slip, found.counted, found.least_besides) == (7, 7, 4, 1)
    assert not found.is_fixed
    # A fifth of 7 quarters is 1.4 quarters.
    assert [found.fifth(group) for group in range(4)] == [1, 1, 1, 1]
    assert worth(SCARA, 8, "whole") == found


@together(
    ("rows", "points", "unit", "besides"),
    [
        # In hundredths: 300 / 4.8 is 62.5; 52 are left for four rows.
        (("x...", "xx..", "....", "..x."), 3, 62, (13, 13, 13, 13)),
        # One unit and four rows: all fifths are at most a third of the unit.
        (("x...", "....", "....", "...."), 8, 24, (2, 2, 2, 2)),
        # Of 35 quarters, 26 for the unit would leave more than a quarter.
        (("x...", "....", "....", "...."), 8.75, 27, (2, 2, 2, 2)),
        # 48 / 12.8 is 3.75; with units of 4 nothing would be left for the rows.
        (("xxx.", "xxx.", "xxx.", "xxx."), 12, 3, (3, 3, 3, 3)),
        (("xxxx", "xxxx", "xxxx"), 12, 3, (4, 4, 4)),
        # 32 / 2.4 is 13.3; 6 are left for two rows.
        (("x", "x"), 8, 13, (3, 3)),
        # 20 / 3.4 is 5.9; a unit of 6 would leave 2, one for each row.
        (("xx", "x"), 5, 6, (1, 1)),
        # Without a unit, the rows share all.
        (("..", "..", ".."), 8, 32, (11, 11, 10)),
    ],
)
def test_a_unit_and_the_rest_for_the_rows(
    rows: tuple[str, ...], points: float, unit: int, besides: tuple[int, ...]
) -> None:
    found = worth(content(*rows, besides=True), points)
    assert (found.unit, found.besides) == (unit, besides)
    assert sum(found.rows) == found.total
    assert found.least_besides == min(besides)
    # A lazy answer earns the rest: at most a quarter, where there is any content.
    assert 4 * sum(found.besides) <= found.total or not found.content.count


@together(
    ("points", "more", "step", "total"),
    [
        # Quarters, from two points for each row and one for each cell on.
        (8, {}, 0.25, 32),
        (7.75, {}, 0.01, 775),
        (8.1, {}, 0.01, 810),
        (8.5, {}, 0.25, 34),
        (5, {"usual": (2, 5)}, 0.25, 20),
        (4.75, {"usual": (2, 5)}, 0.01, 475),
        (8, {"usual": (5, 4)}, 0.01, 800),
        (8, {"most": 9}, 0.01, 800),
        (9, {"most": 9}, 0.25, 36),
        # Rows that are given earn nothing, so they do not count.
        (6, {"given": (True, False, False, False)}, 0.25, 24),
        (5.75, {"given": (True, False, False, False)}, 0.01, 575),
        (0.001, {}, 0.001, 1),
    ],
)
def test_points_come_in_quarters_or_hundredths(
    points: float, more: dict[str, object], step: float, total: int
) -> None:
    cells = content("x...", "xx..", "....", "..x.", groups="0023", besides=True, **more)
    found = worth(cells, points)
    assert found.step == pytest.approx(step)
    assert found.total == total
    assert found.points(found.total) == pytest.approx(points)


def test_additional_cells_do_not_make_a_mistake_cheaper() -> None:
    # Three units and four rows: 32 / 3.8 is 8.4, and 8 quarters are left. The student's frames
    # need a fourth cell.
    fixed = worth(content("x...", "xx..", "....", "..x.", besides=True, most=3), 8)
    assert (fixed.is_fixed, fixed.unit, fixed.slip, fixed.least_besides) == (True, 8, 8, 2)
    assert (fixed.rows, fixed.counted) == ((8, 15, 1, 8), 3)
    assert fixed.groups == {0: 10, 1: 18, 2: 2, 3: 10}
    assert fixed.units == dict.fromkeys(range(4), 8)
    # A fifth of 8 quarters is 1.6.
    assert fixed.fifth(0) == 2
    usual = worth(content("x...", "xx..", "....", "..x.", besides=True, most=4), 8)
    assert (usual.is_fixed, usual.unit, usual.counted) == (False, 7, 4)
    # The student's frames need fewer cells.
    assert worth(content("x...", "xx..", besides=True, most=4), 8).counted == 3


def test_cells_without_a_counterpart_cost_all_points() -> None:
    # Nothing in the reference needs knowledge; the rows share all points evenly.
    rows = worth(content("x...", "....", besides=True, most=0), 4)
    assert (rows.is_fixed, rows.unit, rows.least_besides) == (True, 16, 8)
    matrix = worth(content("x.", "..", groups="00", most=0), 4)
    assert (matrix.is_fixed, matrix.unit, matrix.groups) == (True, 16, {0: 16})
    # Of a single hundredth, nothing is left for the row.
    tiny = worth(content("xx", besides=True, most=1), 0.01)
    assert (tiny.unit, tiny.least_besides, tiny.groups) == (1, 0, {0: 2})


def test_the_entries_of_a_matrix_share_its_points() -> None:
    pose = content("xx.x", ".x..", "..xx", groups="000")
    found = worth(pose, 6)
    assert found.cells == ((4, 4, 0, 4), (0, 4, 0, 0), (0, 0, 4, 4))
    assert (found.besides, found.groups, found.units) == ((0, 0, 0), {0: 24}, {0: 4})
    assert (found.unit, found.slip, found.least_besides) == (4, 4, 0)
    # 28 quarters for six cells: the first ones get the larger shares.
    assert worth(pose, 7).rows == (5 + 5 + 4, 5, 5 + 4)
    assert (worth(pose, 7).unit, worth(pose, 7).units) == (4, {0: 4})
    # If only five cells count usually, a unit is a fifth of 24, rounded up.
    fixed = worth(content("xx.x", ".x..", "..xx", groups="000", most=5), 6)
    assert (fixed.is_fixed, fixed.unit, fixed.groups) == (True, 5, {0: 30})


def test_a_rotation_and_a_position_have_half_of_the_points_each() -> None:
    # The cells of a row belong to two groups: the last column is the position.
    known = ((True, True, False), (False, True, True), (False, False, True))
    both = Content(known, ((0, 0, 1),) * 3, equal=True)
    found = worth(both, 6)
    assert found.cells == ((4, 4, 0), (0, 4, 6), (0, 0, 6))
    assert (found.groups, found.units) == ({0: 12, 1: 12}, {0: 4, 1: 6})
    # 24 // 5 for a slip that no cell shows.
    assert (found.unit, found.slip, found.besides) == (4, 4, (0, 0, 0))


def test_rows_or_cells_are_worth_the_same_if_the_exercise_says_so() -> None:
    rows = worth(SCARA, 8, "rows")
    assert (rows.rows, rows.cells, rows.slip) == ((8, 8, 8, 8), ((0,) * 4,) * 4, 8)
    assert (rows.step, rows.total, rows.unit) == (0.25, 32, 8)
    cells = worth(SCARA, 8, "cells")
    assert (cells.cells, cells.rows, cells.slip, cells.unit) == (((2,) * 4,) * 4, (8,) * 4, 8, 2)
    assert cells.groups == {0: 32}
    given = content("x...", "xx..", "....", "..x.", given=(True, False, False, False))
    # 32 for three rows, and for twelve cells.
    assert worth(given, 8, "rows").rows == (0, 11, 11, 10)
    assert worth(given, 8, "rows").slip == 10
    cells = worth(given, 8, "cells")
    assert cells.cells[0] == (0, 0, 0, 0)
    assert sorted(sum(cells.cells, ())) == [0] * 4 + [2] * 4 + [3] * 8
    assert (cells.slip, cells.unit) == (10, 2)


def test_a_given_row_earns_nothing_besides_its_cells() -> None:
    given = content("....", "xx..", "..x.", besides=True, groups="001", given=(True, False, False))
    # 16 / 3.4 is 4.7; a unit of 5 would leave 1 for two groups, so a unit is 4.
    found = worth(given, 4)
    assert found.besides[0] == 0
    assert found.rows[0] == 0
    assert sum(found.rows) == 16


def test_a_hundredth_of_a_point_goes_to_one_cell() -> None:
    found = worth(content("x...", "xx..", "....", "..x.", besides=True), 0.01)
    assert sum(found.rows) == found.total == 1
    assert (found.besides, found.unit) == ((0, 0, 0, 0), 1)
    # A loss is a step at least, also in a group that is worth nothing.
    assert found.groups == dict.fromkeys(range(4), 1)
    assert found.fifth(0) == 1
    fixed = worth(content("x...", "xx..", "....", "..x.", besides=True, most=3), 0.01)
    assert fixed.groups == {0: 1, 1: 2, 2: 1, 3: 1}
    cells = worth(SCARA, 0.01, "cells")
    assert (cells.unit, cells.slip) == (1, 1)
    assert worth(SCARA, 0.01, "rows").slip == 1
    # Two hundredths for three cells: nothing is left for the rows.
    found = worth(content("x", "xx", besides=True), 0.02)
    assert (sum(found.rows), found.besides, found.least_besides) == (2, (0, 0), 0)
    for equal in (True, False):
        pose = content("xx", ".x", groups="00", equal=equal)
        assert (worth(pose, 0.01).unit, worth(pose, 0.01).rows) == (1, (1, 0))


@together(
    ("total", "count", "expected"),
    [
        (8, 4, [2, 2, 2, 2]), (9, 4, [3, 2, 2, 2]), (10, 4, [3, 2, 3, 2]), (1, 3, [1, 0, 0]),
        (0, 2, [0, 0]), (5, 1, [5]),
    ],
)  # fmt: skip
def test_even_shares(total: int, count: int, expected: list[int]) -> None:
    assert sorted(evenly(total, count)) == sorted(expected)


@together(
    ("total", "weights", "expected"),
    [
        (6, [1, 2, 3], [1, 2, 3]), (3, [1, 2, 3], [1, 1, 1]), (5, [1, 1, 1], [2, 2, 1]),
        (3, [2, 0, 2], [2, 0, 1]), (12, [1, 2, 3], [2, 4, 6]), (4, [1, 4, 5], [0, 2, 2]),
        (3, [0, 0], [0, 0]), (0, [1, 2], [0, 0]), (2, [3, 3, 4], [1, 0, 1]), (4, [], []),
    ],
)  # fmt: skip
def test_shares_in_proportion(total: int, weights: list[int], expected: list[int]) -> None:
    assert apportioned(total, weights) == expected


@given(st.lists(st.integers(0, 40), min_size=1, max_size=8), st.integers(0, 100))
def test_shares_sum_up_and_are_within_one_of_the_exact_ones(weights: list[int], total: int) -> None:
    whole = sum(weights)
    found = apportioned(total, weights)
    assert sum(found) == (total if whole else 0)
    for share, weight in zip(found, weights, strict=True):
        assert whole == 0 or abs(share - total * weight / whole) < 1
        assert total > whole or share <= weight
