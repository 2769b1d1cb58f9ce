"""Marking the wrong cell earns half of the points, correcting the table the other half."""

from collections.abc import Mapping
from typing import Any

import pytest
from dh_grader.catalogue import CatalogueError, Exercise, FeedbackLevel
from dh_grader.grading import PartReport, Verdict
from dh_grader.grading.kinds.tables import shown_shape

from tests.grading.support.exercise_texts import SPATIAL_RRR, Make, all_codes, graded, one_part
from tests.grading.support.submitting import full_marks, handed_in, not_correct, part, table

RIGHT = [
    ["a1", "0", "0", "theta1"],
    ["a2", "180deg", "0", "theta2"],
    ["0", "0", "d3", "0"],
    ["0", "0", "d4", "theta4"],
]
# The axes of joints 3 and 4 point up.
GIVEN = [RIGHT[0], ["a2", "0", "0", "theta2"], *RIGHT[2:]]
OTHER_FRAMES = [*GIVEN[:2], ["0", "180deg", "-d3 - d4", "0"], ["0", "0", "0", "theta4"]]


@pytest.fixture
def scara(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue["find-the-slip-scara"]


def found(
    exercise: Exercise, answer: object, feedback: FeedbackLevel = FeedbackLevel.HINTS
) -> PartReport:
    return part(handed_in(exercise, {"slip": answer}, feedback=feedback), "slip")


def test_the_given_table_is_shown(scara: Exercise) -> None:
    assert shown_shape(scara.parts[0], scara).model_dump()["given"] == GIVEN


@pytest.mark.parametrize("rows", [RIGHT, OTHER_FRAMES])
@pytest.mark.parametrize(
    "marked", ["2.alpha", "2 α", " Row 2: alpha ", ["2.alpha"], ["2/alpha", "2.alpha"]]
)
def test_a_marked_and_mended_slip_has_full_marks_and_its_name(
    marked: object, rows: list[list[str]], scara: Exercise
) -> None:
    report = found(scara, {"marked": marked, "table": table(rows)})
    assert full_marks(report)
    [message] = report.rows[0].cells[0].feedback
    assert message.code == "slip_found"
    assert "off by 180°" in message.message


@pytest.mark.parametrize(
    ("marked", "rows", "points", "codes"),
    [
        ("2.alpha", None, 4, {"not_mended"}),
        ("2.alpha", GIVEN, 4, {"half_turn"}),
        ("2.alpha", [*GIVEN[:3], ["0", "0", "d3", "theta4"]], 4, None),
        (None, RIGHT, 4, set()),
        ("3.alpha", RIGHT, 4, {"slip_elsewhere"}),
        ("2", RIGHT, 4, {"slip_elsewhere"}),
        (["2.alpha", "3.alpha"], RIGHT, 4, {"slip_elsewhere"}),
        ("3.alpha", GIVEN, 0, {"slip_elsewhere"}),
        (None, GIVEN, 0, set()),
        ("beta", RIGHT, 4, {"unknown_place"}),
    ],
)
def test_each_half_is_right_or_not(
    marked: object,
    rows: list[list[str]] | None,
    points: float,
    codes: set[str] | None,
    scara: Exercise,
) -> None:
    answer: dict[str, object] = {"marked": marked, "table": rows and table(rows)}
    report = found(scara, answer)
    assert report.points == points
    assert codes is None or all_codes(report) == codes
    assert sum(row.max_points for row in report.rows) == report.max_points
    assert sum(row.points for row in report.rows) == report.points


def test_lost_points_name_the_mark_and_the_table(scara: Exercise) -> None:
    lost = found(scara, {"marked": "3.alpha", "table": table(GIVEN)}).lost
    assert [(each.message, each.points) for each in lost] == [
        ("the mark", 4),
        ("the mended table", 4),
    ]


@pytest.mark.parametrize("level", FeedbackLevel)
def test_the_report_does_not_find_the_slip_for_the_student(
    level: FeedbackLevel, scara: Exercise
) -> None:
    for marked in (None, "3.alpha", "nonsense"):
        report = found(scara, {"marked": marked, "table": table(GIVEN)}, level)
        assert all(row.label in ("marked", "table") for row in report.rows)
        assert "half_turn" not in all_codes(report)
        assert "alpha" not in str(report.lost)


def test_the_name_of_the_slip_is_a_hint(scara: Exercise) -> None:
    answer = {"marked": "2.alpha", "table": table(RIGHT)}
    assert "slip_found" not in all_codes(found(scara, answer, FeedbackLevel.VERDICTS))


def test_an_unreadable_cell_is_not_a_wrong_one(scara: Exercise) -> None:
    rows = [*RIGHT[:3], ["0", "0", "d9", "theta4"]]
    report = found(scara, {"marked": "2.alpha", "table": table(rows)})
    assert not_correct(report) == {("4", "d"): Verdict.UNREADABLE}
    report = found(scara, {"marked": "1.a", "table": table(rows)})
    assert not_correct(report)["table", "table"] is Verdict.UNREADABLE
    report = found(scara, {"marked": "1.a", "table": table([*GIVEN[:3], rows[3]])})
    assert not_correct(report)["table", "table"] is Verdict.INCORRECT


@pytest.mark.parametrize("unit", ["radians", "degrees"])
def test_the_given_table_means_the_same_in_both_units(unit: Any, make_exercise: Make) -> None:
    fields = 'convention = "standard"\nslip = "degrees_as_radians"'
    exercise = make_exercise(one_part("find_slip", fields, SPATIAL_RRR))
    given = shown_shape(exercise.parts[0], exercise).model_dump()["given"]
    assert given[0][1] == "90 rad"
    right = [["R", "90deg", "0", "theta1"], *given[1:]]
    assert full_marks(graded(exercise, {"marked": "1.alpha", "table": table(right)}, unit))
    back = graded(exercise, {"marked": "1.alpha", "table": table(given)}, unit)
    assert back.points == 3
    assert all_codes(back) == {"degrees_as_radians"}


ROWS = 'convention = "standard"\nslip = "row_order"\nseed = 3'


@pytest.mark.parametrize(
    ("marked", "is_right"),
    [
        (["1", "2"], True),
        (["1.a", "1.alpha", "1.theta", "2.a", "2.alpha", "2.theta"], True),
        (["1", "2", "3"], False),
        ("1", False),
        (["1.a", "2.a"], False),
    ],
)
def test_rows_are_marked_whole_or_by_their_cells(
    marked: object, is_right: bool, make_exercise: Make
) -> None:
    exercise = make_exercise(one_part("find_slip", ROWS, SPATIAL_RRR))
    given = shown_shape(exercise.parts[0], exercise).model_dump()["given"]
    assert given == [
        ["L1", "0", "0", "theta2"],
        ["R", "90deg", "0", "theta1"],
        ["L2", "0", "0", "theta3"],
    ]
    report = graded(exercise, {"marked": marked})
    assert report.points == (3 if is_right else 0)


def test_an_offset_that_neighbours_share_may_be_marked_in_each(make_exercise: Make) -> None:
    # The three axes of a planar arm are parallel: only the sum of d1, d2 and d3 counts.
    setting = """
[robot]
structure = "RR"
convention = "standard"
joints = ["q1", "q2"]
table = [["l1", "0", "0", "q1"], ["l2", "90deg", "h", "q2"]]
[symbols]
h = { kind = "length", description = "height" }
l1 = { kind = "length", description = "a length" }
l2 = { kind = "length", description = "a length" }
"""
    fields = 'convention = "standard"\nslip = "distance_left_out"\nseed = 2'
    exercise = make_exercise(one_part("find_slip", fields, setting))
    given = shown_shape(exercise.parts[0], exercise).model_dump()["given"]
    assert given[1][2] == "0"
    for marked, points in (("2.d", 3), ("1.d", 3), (["1.d", "2.d"], 0), ("1.a", 0)):
        assert graded(exercise, {"marked": marked}).points == points


def test_writing_never_earns_less_than_leaving_empty(scara: Exercise) -> None:
    answers: list[dict[str, object]] = [
        {"marked": marked, "table": rows and table(rows)}
        for marked in (None, "1.a", "2.alpha")
        for rows in (None, GIVEN, RIGHT)
    ]
    points = {str(answer): found(scara, answer).points for answer in answers}
    for answer in answers:
        for name in answer:
            assert points[str({**answer, name: None})] <= points[str(answer)]


@pytest.mark.parametrize(
    "answer",
    [
        7,
        [1],
        {"rows": 5},
        {"marked": "2.alpha", "rows": []},
        {"marked": "2.alpha", "cells": []},
        True,
        {"table": 7},
    ],
)
def test_another_shape_is_refused(answer: object, scara: Exercise) -> None:
    report = found(scara, answer)
    assert report.verdict is Verdict.UNREADABLE
    assert [message.code for message in report.feedback] == ["wrong_shape"]


def test_an_unreadable_table_does_not_lose_the_mark(scara: Exercise) -> None:
    report = found(scara, {"marked": "2.alpha", "table": 7})
    assert report.points == 4
    assert all_codes(report) == {"wrong_shape"}


def test_a_table_alone_is_the_mended_one(scara: Exercise) -> None:
    pasted = "\n".join(", ".join(row) for row in RIGHT)
    for answer in (table(RIGHT), pasted, {"table": pasted}):
        assert found(scara, answer).points == 4
    assert full_marks(found(scara, f"marked: 2.alpha\n{pasted}"))


@pytest.mark.parametrize(
    "answer", ["", {}, {"marked": "", "table": None}, {"marked": []}, {"rows": []}]
)
def test_an_empty_answer_is_missing(answer: object, scara: Exercise) -> None:
    assert found(scara, answer).verdict is Verdict.MISSING


def test_the_parts_of_a_slip_cannot_be_counted_by_rows(make_exercise: Make) -> None:
    fields = 'convention = "standard"\nmarking = "rows"'
    with pytest.raises(CatalogueError, match="each worth half"):
        make_exercise(one_part("find_slip", fields, SPATIAL_RRR))
