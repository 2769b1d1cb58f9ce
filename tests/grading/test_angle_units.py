"""Test answers in degrees and in radians."""

from collections.abc import Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Verdict

from tests.grading.support.robots import EXACT, PLANAR_RRR, SPELLINGS, STANFORD
from tests.grading.support.submitting import (
    cell,
    codes,
    codes_at,
    full_marks,
    graded_pose,
    graded_table,
    not_correct,
)

[DEGREES] = [spelling for spelling in SPELLINGS if spelling.name == "bare degrees"]


def test_bare_degrees_instead_of_radians_are_named(catalogue: Mapping[str, Exercise]) -> None:
    report = graded_table(catalogue[STANFORD.exercise], DEGREES.rows(STANFORD))
    turned = {(label, "alpha") for label in ("1", "2", "4", "5")}
    assert not_correct(report) == dict.fromkeys(turned, Verdict.INCORRECT)
    for place in turned:
        assert codes_at(report, *place) == ["degrees_as_radians"]


def test_bare_radians_instead_of_degrees_are_named(catalogue: Mapping[str, Exercise]) -> None:
    rows = [list(row) for row in DEGREES.rows(STANFORD)]
    rows[0][1] = "-1.5708"
    report = graded_table(catalogue[STANFORD.exercise], rows, angle_unit="degrees")
    assert not_correct(report) == {("1", "alpha"): Verdict.INCORRECT}
    assert codes(cell(report, "1", "alpha")) == ["radians_as_degrees"]


@pytest.mark.parametrize("unit", ["90deg", "90°", "pi/2", "1.5707963267948966 rad", "asin(1)"])
def test_a_written_unit_wins(unit: str, catalogue: Mapping[str, Exercise]) -> None:
    rows = [list(row) for row in EXACT.rows(STANFORD)]
    rows[1][1] = rows[4][1] = unit
    for angle_unit in ("radians", "degrees"):
        report = graded_table(
            catalogue[STANFORD.exercise],
            rows,
            angle_unit="degrees" if angle_unit == "degrees" else "radians",
        )
        assert full_marks(report), (angle_unit, not_correct(report))


def test_lengths_have_no_angle_unit(catalogue: Mapping[str, Exercise]) -> None:
    rows = [list(row) for row in EXACT.rows(PLANAR_RRR)]
    rows[1][0] = "l1 + 90 - 90"
    assert full_marks(graded_table(catalogue[PLANAR_RRR.exercise], rows, angle_unit="degrees"))


def test_an_offset_in_a_sum_has_the_unit_of_the_submission(
    catalogue: Mapping[str, Exercise],
) -> None:
    rows = [list(row) for row in EXACT.rows(PLANAR_RRR)]
    rows[0][3] = "q1 + 360"
    exercise = catalogue[PLANAR_RRR.exercise]
    assert full_marks(graded_table(exercise, rows, angle_unit="degrees"))
    assert not_correct(graded_table(exercise, rows)) == {("1", "theta"): Verdict.INCORRECT}


def test_angles_in_a_matrix_have_the_unit_of_the_submission(
    catalogue: Mapping[str, Exercise],
) -> None:
    pose = [
        ["sin(q1 + q2 + q3 + 90)", "-s123", "cos(90)", "l1 c1 + l2 c12 + l3 c123"],
        ["s123", "-cos(q1 + q2 + q3 - 180)", "0", "l1 s1 + l2 s12 + l3 s123"],
        ["0", "0", "sin(90)", "0"],
        ["0", "0", "0", "1"],
    ]
    exercise = catalogue[PLANAR_RRR.exercise]
    assert full_marks(graded_pose(exercise, pose, angle_unit="degrees"))
    wrong = not_correct(graded_pose(exercise, pose))
    assert set(wrong) == {("1", "1"), ("1", "3"), ("2", "2"), ("3", "3")}
