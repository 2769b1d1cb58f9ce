"""Grade the coordinates of a point."""

import pytest
from dh_grader.grading import Verdict

from tests.grading.support.exercise_texts import SPATIAL_RRR, Make, all_codes, graded, one_part
from tests.grading.support.submitting import cell, full_marks, not_correct

# Robotic Fundamentals (UMFM4X-15-M), Forward Kinematics, Example 3.
SPATIAL = ["c1 (L2 c23 + L1 c2 + R)", "s1 (L2 c23 + L1 c2 + R)", "L2 s23 + L1 s2"]
POSITION = one_part("position", "", SPATIAL_RRR)
COORDINATES_XY = one_part("position", 'coordinates = "xy"', SPATIAL_RRR)


@pytest.mark.parametrize(
    "answer",
    [
        SPATIAL,
        [[text] for text in SPATIAL],
        [SPATIAL],
        "c1*(L2*c23+L1*c2+R)\ns1*(L2*c23+L1*c2+R)\nL2*s23+L1*s2",
        "[c1*(L2*c23+L1*c2+R), s1*(L2*c23+L1*c2+R), L2*s23+L1*s2]",
    ],
)
def test_a_position_in_each_shape_gets_full_marks(answer: object, make_exercise: Make) -> None:
    report = graded(make_exercise(POSITION), answer)
    assert full_marks(report), report
    assert [(row.label, [cell.label for cell in row.cells]) for row in report.rows] == [
        ("1", ["1"]),
        ("2", ["1"]),
        ("3", ["1"]),
    ]


@pytest.mark.parametrize(
    ("answer", "blamed", "codes"),
    [
        ([SPATIAL[1], SPATIAL[0], SPATIAL[2]], {"1", "2"}, {"exchanged_coordinates"}),
        ([f"-({text})" for text in SPATIAL], {"1", "2", "3"}, {"reversed_position"}),
        (["c1 (L1 c2 + R)", "s1 (L1 c2 + R)", "L1 s2"], {"1", "2", "3"}, {"distance_left_out"}),
        ([SPATIAL[0], SPATIAL[1], "-L2 s23 - L1 s2"], {"3"}, {"sign"}),
        ([SPATIAL[0], SPATIAL[1], "L2 c23 + L1 c2"], {"3"}, {"sine_for_cosine"}),
        ([SPATIAL[0], SPATIAL[1], "1/0"], {"3"}, {"undefined"}),
    ],
)
def test_a_slip_in_a_position_is_named(
    answer: list[str], blamed: set[str], codes: set[str], make_exercise: Make
) -> None:
    report = graded(make_exercise(POSITION), answer)
    assert {row for row, _ in not_correct(report)} == blamed
    assert all_codes(report) == codes


@pytest.mark.parametrize("answer", [[], ["0"] * 4, [["0", "0", "0"]] * 2, {"u": 1}, 1, None])
def test_a_position_of_another_shape_is_unreadable(answer: object, make_exercise: Make) -> None:
    report = graded(make_exercise(POSITION), answer)
    assert report.points == 0
    assert report.verdict in (Verdict.UNREADABLE, Verdict.MISSING)


def test_a_third_zero_of_a_planar_position_is_ignored(make_exercise: Make) -> None:
    report = graded(make_exercise(COORDINATES_XY), [*SPATIAL[:2], 0])
    assert full_marks(report)
    assert all_codes(report) == {"zero_left_aside"}


@pytest.mark.parametrize("answer", [[*SPATIAL, 1], f"[{'; '.join(SPATIAL)}; 1]"])
def test_the_one_of_homogeneous_coordinates_is_ignored(answer: object, make_exercise: Make) -> None:
    report = graded(make_exercise(POSITION), answer)
    assert full_marks(report)
    assert all_codes(report) == {"homogeneous_one"}


@pytest.mark.parametrize(
    ("tail", "codes"),
    [
        ([1], {"homogeneous_one"}),
        ([0, "1"], {"zero_left_aside", "homogeneous_one"}),
        (["z = 0", 1], {"zero_left_aside", "homogeneous_one"}),
        ([1, 0], {"wrong_shape"}),
        (["z = 1"], {"wrong_shape"}),
        ([0, 0], {"wrong_shape"}),
    ],
)
def test_these_values_may_follow_two_coordinates(
    tail: list[object], codes: set[str], make_exercise: Make
) -> None:
    report = graded(make_exercise(COORDINATES_XY), [*SPATIAL[:2], *tail])
    assert full_marks(report) == (codes != {"wrong_shape"})
    assert all_codes(report) == codes


@pytest.mark.parametrize("coordinates", ["xz", "yz"])
def test_an_ambiguous_zero_is_refused(coordinates: str, make_exercise: Make) -> None:
    # If x and z are asked for, [x, y, 0] must not be read with y as the value of z.
    text = one_part("position", f'coordinates = "{coordinates}"', SPATIAL_RRR)
    assert all_codes(graded(make_exercise(text), ["0", "0", 0])) == {"wrong_shape"}


def test_a_zero_after_three_values_is_refused(make_exercise: Make) -> None:
    report = graded(make_exercise(POSITION), [*SPATIAL, 0])
    assert all_codes(report) == {"wrong_shape"}
    [message] = report.feedback
    assert message.message == "Write a list of 3 values; yours has 4."


def test_two_coordinates_leave_the_third_missing(make_exercise: Make) -> None:
    report = graded(make_exercise(POSITION), SPATIAL[:2])
    assert not_correct(report) == {("3", "1"): Verdict.MISSING}


@pytest.mark.parametrize("coordinates", ["xy", "xz", "yz"])
def test_a_part_may_ask_for_some_coordinates(coordinates: str, make_exercise: Make) -> None:
    text = one_part("position", f'coordinates = "{coordinates}"', SPATIAL_RRR)
    answer = [SPATIAL["xyz".index(letter)] for letter in coordinates]
    assert full_marks(graded(make_exercise(text), answer))


def test_an_unreadable_line_has_its_span(make_exercise: Make) -> None:
    text = "c1*(L2*c23+L1*c2+R)\n\n(s1\nL2*s23+L1*s2"
    report = graded(make_exercise(POSITION), text)
    assert not_correct(report) == {("2", "1"): Verdict.UNREADABLE}
    [message] = cell(report, "2", "1").feedback
    assert message.span is not None
    assert text[slice(*message.span)].startswith("(")
