"""Grade screw axes."""

import json
from collections.abc import Mapping
from typing import Any

import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import PartReport, Verdict

from tests.grading.support.exercise_texts import SPATIAL_RRR, Make, all_codes, graded, one_part
from tests.grading.support.submitting import full_marks, handed_in, not_correct, part

Screws = list[list[Any]]

SPACE: Screws = [[0, 0, 1, 0, 0, 0], [0, 0, 0, 1, 0, 0], [0, 0, 1, 0, "-L1", 0]]
BODY: Screws = [[0, 0, 1, 0, "L1 + L2", 0], [0, 0, 0, 1, 0, 0], [0, 0, 1, 0, "L2", 0]]


@pytest.fixture
def rpr(catalogue: Mapping[str, Exercise]) -> Exercise:
    return catalogue["planar-rpr-poe"]


def changed(screws: Screws, i: int, row: list[Any]) -> Screws:
    return [*screws[:i], row, *screws[i + 1 :]]


@pytest.mark.parametrize(
    ("part_id", "screws"),
    [
        ("space-screws", SPACE),
        ("body-screws", BODY),
        ("space-screws", "[0 0 1 0 0 0; 0 0 0 1 0 0; 0 0 1 0 -L1 0]"),
    ],
)
def test_the_axes_of_the_lecture_are_right(part_id: str, screws: object, rpr: Exercise) -> None:
    report = part(handed_in(rpr, {part_id: screws}), part_id)
    assert full_marks(report), report
    assert [row.label for row in report.rows] == ["1", "2", "3"]
    assert {cell.label for row in report.rows for cell in row.cells} == set("123456")


# Slips in the planar RPR arm: the changed axes, the changed row, and the message.
SLIPS: dict[str, tuple[str, int, list[Any], str]] = {
    "v = ω × q": ("space-screws", 2, [0, 0, 1, 0, "L1", 0], "moment_sign"),
    "body for space": ("space-screws", 2, BODY[2], "body_for_space"),
    "space for body": ("body-screws", 0, SPACE[0], "space_for_body"),
    "reversed": ("space-screws", 2, [0, 0, -1, 0, "L1", 0], "axis_reversed"),
    "slides the other way": ("space-screws", 1, [0, 0, 0, -1, 0, 0], "axis_reversed"),
    "ω not of unit length": ("space-screws", 2, [0, 0, 2, 0, "-2 L1", 0], "not_normalised"),
    "v not of unit length": ("space-screws", 1, [0, 0, 0, "L1", 0, 0], "not_normalised"),
    "slides in ω": ("space-screws", 1, [1, 0, 0, 0, 0, 0], "infinite_pitch"),
    "slides in both": ("space-screws", 1, [1, 0, 0, 1, 0, 0], "infinite_pitch"),
    "turns in v": ("space-screws", 0, [0, 0, 0, 0, 0, 1], "infinite_pitch"),
    "turns nowhere": ("space-screws", 2, [0, 0, 0, 0, 0, 1], "infinite_pitch"),
    "halves exchanged": ("space-screws", 2, [0, "-L1", 0, 0, 0, 1], "exchanged_halves"),
    "the point": ("space-screws", 2, [0, 0, 1, "L1", 0, 0], "point_for_velocity"),
    "a sliding joint that turns": ("space-screws", 1, [0, 0, 1, 1, 0, 0], "infinite_pitch"),
    "a sliding joint as a turn": ("space-screws", 1, [0, 0, 1, 0, 0, 0], "infinite_pitch"),
    "another point": ("space-screws", 2, [0, 0, 1, 0, "-L1 - L2", 0], "point_off_axis"),
    "through the origin": ("space-screws", 2, [0, 0, 1, 0, 0, 0], "point_off_axis"),
    "another direction": ("space-screws", 2, [0, 1, 0, 0, 0, "L1"], "other_direction"),
    "with a joint variable": ("space-screws", 2, [0, 0, 1, 0, "-L1 - theta2", 0], "not_at_home"),
    "a pitch": ("space-screws", 2, [0, 0, 1, 0, "-L1", "0.5"], "pitch"),
}


@pytest.mark.parametrize("name", SLIPS)
def test_a_slip_is_named_in_its_row(name: str, rpr: Exercise) -> None:
    part_id, i, row, code = SLIPS[name]
    screws = SPACE if part_id == "space-screws" else BODY
    report = part(handed_in(rpr, {part_id: changed(screws, i, row)}), part_id)
    assert {label for label, _ in not_correct(report)} == {str(i + 1)}
    assert [message.code for message in report.rows[i].feedback] == [code]
    assert not any(cell.feedback for cell in report.rows[i].cells)
    assert report.points < 6


def test_an_unexplained_slip_is_reported_number_by_number(rpr: Exercise) -> None:
    screws = changed(SPACE, 2, [0, 0, 0.5, 0, "-L1", 0])
    report = part(handed_in(rpr, {"space-screws": screws}), "space-screws")
    assert not_correct(report) == {("3", "3"): Verdict.INCORRECT}
    assert report.rows[2].cells[2].feedback


def test_a_wrong_number_costs_a_unit(rpr: Exercise) -> None:
    screws = changed(SPACE, 2, [0, 0, 1, 0, "-L1 - L2", 0])
    report = part(handed_in(rpr, {"space-screws": screws}), "space-screws")
    assert not_correct(report) == {("3", "5"): Verdict.INCORRECT}
    # Only v1 of row 2 and v2 of row 3 are content cells. With a fifth for each row these are 2.6
    # units of 6 / 2.6, about 2.25 points.
    assert report.points == 6 - 2.25


def test_zeros_earn_little(rpr: Exercise) -> None:
    # Fifteen of the eighteen numbers are 0, and two of the others are the same for all joints.
    report = part(handed_in(rpr, {"space-screws": [[0] * 6] * 3}), "space-screws")
    assert len(not_correct(report)) == 4
    assert report.points <= report.max_points / 6


def test_a_missing_joint_and_a_short_row_affect_only_themselves(rpr: Exercise) -> None:
    answer = [SPACE[0], [0, 0, 0]]
    report = part(handed_in(rpr, {"space-screws": answer}), "space-screws")
    verdicts = [row.verdict for row in report.rows]
    assert verdicts == [Verdict.CORRECT, Verdict.UNREADABLE, Verdict.MISSING]


@pytest.mark.parametrize("answer", [[], [[0] * 6] * 4, {"rows": []}, 1, [0] * 6])
def test_an_answer_of_another_shape_is_unreadable(answer: object, rpr: Exercise) -> None:
    report = part(handed_in(rpr, {"space-screws": answer}), "space-screws")
    assert (report.verdict, report.points) == (Verdict.UNREADABLE, 0)
    assert all_codes(report) == {"wrong_shape"}


FREE = one_part(
    "screw_axes",
    'frame = "space"\ndirections = "free"\nexpected = [["0", "0", "1", "0", "-l", "0"]]',
)


def test_an_axis_may_be_reversed_if_directions_are_free(make_exercise: Make) -> None:
    exercise = make_exercise(FREE)
    report = graded(exercise, [[0, 0, -1, 0, "l", 0]])
    assert full_marks(report)
    assert all_codes(report) == {"own_direction"}
    assert graded(exercise, [[0, 0, -1, 0, "-l", 0]]).verdict is Verdict.PARTIAL
    given = make_exercise(FREE.replace('directions = "free"\n', ""))
    assert all_codes(graded(given, [[0, 0, -1, 0, "l", 0]])) == {"axis_reversed"}


# Lynch & Park, "Modern Robotics" (2017), example 4.5: the space axes of the UR5 as columns.
UR5 = [
    ["0", "0", "0", "0", "0", "0"],
    ["0", "1", "1", "1", "0", "1"],
    ["1", "0", "0", "0", "-1", "0"],
    ["0", "-H1", "-H1", "-H1", "-W1", "H2 - H1"],
    ["0", "0", "0", "0", "L1 + L2", "0"],
    ["0", "0", "L1", "L1 + L2", "0", "L1 + L2"],
]


def test_six_axes_may_be_the_columns_of_a_matrix(make_exercise: Make) -> None:
    rows = [list(axis) for axis in zip(*UR5, strict=True)]
    lengths = "".join(
        f'{name} = {{ kind = "length", description = "a length" }}\n'
        for name in ("H1", "H2", "W1", "L1", "L2")
    )
    expected = f'frame = "space"\nexpected = {json.dumps(rows)}'
    exercise = make_exercise(one_part("screw_axes", expected, f"[symbols]\n{lengths}"))

    def pasted(matrix: list[list[str]]) -> PartReport:
        return graded(exercise, f"[{'; '.join(', '.join(row) for row in matrix)}]")

    assert full_marks(pasted(rows))
    assert all_codes(pasted(rows)) == set()
    assert full_marks(pasted(UR5))
    assert all_codes(pasted(UR5)) == {"columns_as_axes"}
    slip = [*UR5[:5], ["0", "0", "L1", "L1", "0", "L1 + L2"]]
    assert not_correct(pasted(slip)) == {("4", "6"): Verdict.INCORRECT}


def test_one_axis_needs_no_list_around_it(make_exercise: Make) -> None:
    assert full_marks(graded(make_exercise(FREE), [0, 0, 1, 0, "-l", 0]))


def test_the_axes_of_a_robot_with_a_table_are_right(make_exercise: Make) -> None:
    # At home, axis 1 is z0; axes 2 and 3 are along −y through x = R and x = R + L1.
    space = make_exercise(one_part("screw_axes", 'frame = "space"', SPATIAL_RRR))
    answer: Screws = [
        [0, 0, 1, 0, 0, 0],
        [0, -1, 0, 0, 0, "-R"],
        [0, -1, 0, 0, 0, "-R - L1"],
    ]
    assert full_marks(graded(space, answer))
    body = make_exercise(one_part("screw_axes", 'frame = "body"', SPATIAL_RRR))
    # The tool's y is up and its z along −y0; it lies R + L1 + L2 out.
    answer = [
        [0, 1, 0, 0, 0, "-R - L1 - L2"],
        [0, 0, 1, 0, "L1 + L2", 0],
        [0, 0, 1, 0, "L2", 0],
    ]
    assert full_marks(graded(body, answer))
