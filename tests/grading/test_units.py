"""Test units of angles, and numbers without units."""

from collections.abc import Callable, Iterator, Mapping

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.kinds import SPECS
from dh_grader.grading import FeedbackLevel, Verdict

from tests.grading.support.bare_numbers import BARE, OF_A_ROBOT, BareExercise
from tests.grading.support.robots import EXACT, PLANAR_RRR, SPELLINGS, STANFORD
from tests.grading.support.submitting import (
    cell,
    codes,
    codes_at,
    full_marks,
    graded_pose,
    graded_table,
    handed_in,
    not_correct,
    part,
)
from tests.together import together

# --- Test answers in degrees and in radians

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


# --- Grade exercises that have only numbers, without a robot

Make = Callable[[str], Exercise]
# Texts of cells that are unreadable, empty, or without a value.
SPOILT = ["0.5 +", "foo", "", None, "0,5", "1/0", "sqrt(-1)", "0.333", True]
ODD: list[object] = ["", None, [], {}, "0.5", 3, "[1 2; 3 4]", [[]], {"rows": []}]


def spoilt(answer: object) -> Iterator[object]:
    if isinstance(answer, dict):
        for key in answer:
            yield from ({**answer, key: each} for each in SPOILT)
            yield {name: each for name, each in answer.items() if name != key}
    elif isinstance(answer, list):
        for i, entry in enumerate(answer):
            changes = list(spoilt(entry)) if isinstance(entry, list) else SPOILT
            yield from ([*answer[:i], change, *answer[i + 1 :]] for change in changes)
            yield [*answer[:i], *answer[i + 1 :]]


def test_there_is_an_exercise_of_each_kind() -> None:
    assert {bare.kind for bare in BARE} | OF_A_ROBOT == set(SPECS)


@pytest.mark.long
@together("bare", BARE)
def test_right_numbers_get_full_marks_and_wrong_ones_do_not(
    bare: BareExercise, make_exercise: Make
) -> None:
    exercise = make_exercise(bare.text)
    for level in FeedbackLevel:
        right = part(handed_in(exercise, {"it": bare.right}, feedback=level), "it")
        assert (right.verdict, right.points) == (Verdict.CORRECT, right.max_points)
        for answer in bare.wrong:
            wrong = part(handed_in(exercise, {"it": answer}, feedback=level), "it")
            assert wrong.verdict in (Verdict.INCORRECT, Verdict.PARTIAL), answer
            assert wrong.points < wrong.max_points


@pytest.mark.long
@together("bare", BARE)
def test_unreadable_numbers_get_a_report(bare: BareExercise, make_exercise: Make) -> None:
    exercise = make_exercise(bare.text)
    for answer in [*spoilt(bare.right), *ODD]:
        report = part(handed_in(exercise, {"it": answer}), "it")
        assert 0 <= report.points <= report.max_points


def test_a_wrong_number_is_explained(make_exercise: Make) -> None:
    # Slips in bare numbers get the same codes as those in formulas, but no counterexample.
    vector, position = (make_exercise(BARE[i].text) for i in (0, 2))
    report = part(handed_in(vector, {"it": ["0.7", "30deg", "-3"]}), "it")
    found = [message for row in report.rows for each in row.cells for message in each.feedback]
    assert [message.code for message in found] == ["value", "value", "sign"]
    assert not any(message.values for message in found)
    report = part(handed_in(position, {"it": ["-0.5", "0", "-2"]}), "it")
    assert [message.code for message in report.feedback] == ["reversed_position"]


@pytest.mark.parametrize("answer", [["0", "0", "0"], ["1", "1", "1"]])
def test_wrong_numbers_are_wrong_beside_unused_symbols(
    answer: list[str], make_exercise: Make
) -> None:
    text = BARE[2].text.replace(
        "[[parts]]", '[symbols]\nl1 = { kind = "length", description = "unused" }\n[[parts]]'
    )
    report = part(handed_in(make_exercise(text), {"it": answer}), "it")
    assert report.points < report.max_points
