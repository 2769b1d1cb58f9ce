"""Test screw axes, positions, angles and vectors."""

import json
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Correction, FeedbackLevel, PartReport, Verdict
from dh_grader.grading.kinds.motions import nearest_triple
from dh_grader.kinematics import PROPER, SEQUENCES
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tests.grading.support.submitting import (
    SPATIAL_RRR,
    Make,
    all_codes,
    cell,
    full_marks,
    graded,
    handed_in,
    not_correct,
    one_part,
    part,
)

# --- Grade screw axes

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


# --- Grade the coordinates of a point

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


# --- Grade Euler angles: every triple that gives the rotation is correct

# A slip costs as few of the angles as possible.

RPY = one_part("euler_angles", 'sequence = "RPY"', SPATIAL_RRR)


@pytest.fixture
def spatial(make_exercise: Make) -> Exercise:
    return make_exercise(RPY)


BETA = "atan2(-s23, sqrt((c1 c23)^2 + (s1 c23)^2))"
RIGHT = {
    "by inspection": ["theta1", "-(theta2 + theta3)", "90deg"],
    "the other triple": ["theta1 + pi", "pi + theta2 + theta3", "-pi/2"],
    "whole turns": ["theta1 - 2pi", "2pi - theta2 - theta3", "450deg"],
    # Robotic Fundamentals (UMFM4X-15-M): β = Atan2(−r31, √(r11² + r21²)) and so on.
    "the lecture's own formulas": [
        f"atan2(s1 c23/cos({BETA}), c1 c23/cos({BETA}))",
        BETA,
        f"atan2(c23/cos({BETA}), 0)",
    ],
    "the root with a minus": [
        "atan2(-s1 c23, -c1 c23)",
        "atan2(-s23, -sqrt((c1 c23)^2 + (s1 c23)^2))",
        "atan2(-c23, 0)",
    ],
    "rounded": ["theta1", "-theta2 - theta3", "1.571"],
    "a column": [["theta1"], ["-theta2 - theta3"], ["pi/2"]],
    "pasted": "[theta1, -theta2-theta3, pi/2]",
    "pasted LaTeX": r"\begin{bmatrix} \theta_1 \\ -\theta_2-\theta_3 \\ \pi/2 \end{bmatrix}",
}


@pytest.mark.parametrize("name", RIGHT)
def test_every_triple_of_the_rotation_is_right(name: str, spatial: Exercise) -> None:
    report = graded(spatial, RIGHT[name])
    assert full_marks(report), report
    assert [row.label for row in report.rows] == ["1", "2", "3"]


def test_angles_may_be_in_degrees(spatial: Exercise) -> None:
    assert full_marks(graded(spatial, ["theta1", "-theta2-theta3", 90], "degrees"))


def test_the_erratum_of_the_lecture(spatial: Exercise) -> None:
    # The lecture prints β = θ2 + θ3, but its own formula gives β = −(θ2 + θ3).
    report = graded(spatial, ["theta1", "theta2 + theta3", "90deg"])
    assert not_correct(report) == {("2", "1"): Verdict.INCORRECT}
    assert report.points == pytest.approx(4)
    [message] = report.rows[1].cells[0].feedback
    assert message.code == "sign"
    assert "sign of this angle is wrong" in message.message
    assert message.correction == Correction("Change its sign.")


def test_the_erratum_in_the_shipped_exercise(catalogue: Mapping[str, Exercise]) -> None:
    exercise = catalogue["spatial-rrr"]
    right = handed_in(exercise, {"rpy": ["theta1", "-(theta2 + theta3)", "90deg"]})
    printed = handed_in(exercise, {"rpy": ["theta1", "theta2 + theta3", "90deg"]})
    assert full_marks(part(right, "rpy"))
    assert not_correct(part(printed, "rpy")) == {("2", "1"): Verdict.INCORRECT}
    assert all_codes(part(printed, "rpy")) == {"sign"}


def test_a_hint_does_not_contain_the_correction(spatial: Exercise) -> None:
    answers = {"it": ["theta1", "theta2 + theta3", "90deg"]}
    report = part(handed_in(spatial, answers, feedback=FeedbackLevel.HINTS), "it")
    [message] = report.rows[1].cells[0].feedback
    assert "sign of this angle is wrong" in message.message
    assert message.correction is None


WRONG: dict[str, tuple[list[Any], set[str], set[str]]] = {
    "one sign": (["-theta1", "-theta2-theta3", "pi/2"], {"1"}, {"sign"}),
    "two signs": (["-theta1", "theta2+theta3", "pi/2"], {"1", "2"}, {"sign"}),
    "degrees": (["theta1", "-theta2-theta3", "90"], {"3"}, {"degrees_as_radians"}),
    "the last first": (["pi/2", "-theta2-theta3", "theta1"], {"1", "3"}, {"angle_order"}),
    "arguments exchanged": (
        ["atan2(c1, s1)", "-theta2-theta3", "pi/2"],
        {"1"},
        {"swapped_atan2"},
    ),
    "a joint too few": (["theta1", "-theta2", "pi/2"], {"2"}, {"joint_variable_missing"}),
    "half a turn": (["theta1 + pi", "-theta2-theta3", "pi/2"], {"1"}, {"half_turn"}),
    "no value": (["theta1", "1/0", "pi/2"], {"2"}, {"undefined"}),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_slip_costs_only_the_angles_that_it_changes(name: str, spatial: Exercise) -> None:
    answer, blamed, codes = WRONG[name]
    report = graded(spatial, answer)
    assert {row for row, _ in not_correct(report)} == blamed
    assert report.points == pytest.approx(6 - 2 * len(blamed))
    # There is no note on the order of the arguments, because the message already mentions it.
    assert all_codes(report) == codes


def test_an_unreadable_angle_affects_only_itself(spatial: Exercise) -> None:
    report = graded(spatial, ["theta1", "(theta2", ""])
    assert not_correct(report) == {("2", "1"): Verdict.UNREADABLE, ("3", "1"): Verdict.MISSING}


@pytest.mark.parametrize("answer", [[], ["0"] * 4, {"a": 1}, 5, True, [["0", "0"], ["0", "0"]]])
def test_angles_of_another_shape_are_unreadable(answer: object, spatial: Exercise) -> None:
    report = graded(spatial, answer)
    assert report.points == 0
    assert all_codes(report) <= {"wrong_shape", "wrong_type", "missing"}
    assert report.verdict in (Verdict.UNREADABLE, Verdict.PARTIAL)


SINGULAR = one_part("euler_angles", 'sequence = "ZYZ"\nexpected = ["phi", "0", "psi"]')


@pytest.mark.parametrize(
    "answer",
    [["phi", "0", "psi"], ["psi", "0", "phi"], ["phi + psi", "0", "0"], [1, 0, "phi+psi-1"]],
)
def test_only_the_sum_counts_in_a_singular_configuration(
    answer: object, make_exercise: Make
) -> None:
    report = graded(make_exercise(SINGULAR), answer)
    assert full_marks(report)
    assert all_codes(report) == {"singular_orientation"}


@pytest.mark.parametrize("answer", [["phi", "0", "0"], ["phi", "0", "-psi"], ["phi", "0.1", "psi"]])
def test_a_wrong_sum_in_a_singular_configuration_is_wrong(
    answer: object, make_exercise: Make
) -> None:
    # Only the sum of the angles needs knowledge: if it is wrong, the answer earns nothing.
    report = graded(make_exercise(SINGULAR), answer)
    assert (report.verdict, report.points) == (Verdict.INCORRECT, 0)
    assert len(not_correct(report)) == 1


@pytest.mark.parametrize(
    ("first", "answer", "is_right"),
    [
        # Only the last angle minus the first one counts: -0.5236. The true numbers 0.3007 and
        # -0.2229 are cut off; none in the range of the next decimal fits.
        ("30deg", ["0.300", "90deg", "-0.222"], True),
        ("30deg", ["0.300", "90deg", "-0.221"], False),
        # 0.3008 is cut off or rounded up.
        ("0", ["0.300", "90deg", "0.301"], True),
        ("0", ["0.300", "90deg", "0.302"], False),
    ],
)
def test_two_angles_may_be_rounded_in_a_singular_configuration(
    first: str, answer: list[str], is_right: bool, make_exercise: Make
) -> None:
    fields = f'sequence = "ZYX"\nexpected = ["{first}", "90deg", "0"]'
    report = graded(make_exercise(one_part("euler_angles", fields, setting="")), answer)
    assert full_marks(report) is is_right


@pytest.mark.parametrize("axes", ["moving", "fixed"])
@pytest.mark.parametrize("sequence", SEQUENCES)
def test_every_sequence_of_axes_is_graded(sequence: str, axes: str, make_exercise: Make) -> None:
    fields = f'sequence = "{sequence}"\naxes = "{axes}"\nexpected = ["phi", "psi + 0.3", "k - 0.5"]'
    exercise = make_exercise(one_part("euler_angles", fields))
    middle = "-psi - 0.3" if sequence in PROPER else "pi - psi - 0.3"
    assert full_marks(graded(exercise, ["phi", "psi + 0.3", "k - 0.5"]))
    assert full_marks(graded(exercise, ["phi - pi", middle, "k - 0.5 + pi"]))
    assert not_correct(graded(exercise, ["phi", "psi + 0.3", "k - 0.4"]))


def test_the_angles_of_another_sequence_are_named(make_exercise: Make) -> None:
    # The answer describes the same rotation by angles of another sequence.
    fields = 'sequence = "XYZ"\naxes = "moving"\nexpected = ["0.3", "0.5", "0.7"]'
    exercise = make_exercise(one_part("euler_angles", fields))
    turns = Rotation.from_euler("XYZ", [0.3, 0.5, 0.7])
    others: list[tuple[Any, str]] = [
        ("xyz", "XYZ about fixed axes"),
        ("ZXZ", "ZXZ about moving axes"),
    ]
    for name, said in others:
        answer = [float(angle) for angle in turns.as_euler(name)]
        [message] = graded(exercise, answer).feedback
        assert message.code == "other_euler_sequence"
        assert said in message.message


@given(
    st.sampled_from(SEQUENCES),
    st.booleans(),
    st.tuples(*[st.floats(-3, 3)] * 3),
    st.integers(0, 2),
)
def test_the_nearest_triple_keeps_two_of_three_angles(
    sequence: str, fixed: bool, angles: tuple[float, float, float], slipped: int
) -> None:
    # If one of three angles is wrong, the nearest correct triple keeps the other two angles.
    name = sequence.lower() if fixed else sequence
    rotation = Rotation.from_euler(name, angles).as_matrix()[None]
    written = np.array(angles)[:, None].copy()
    written[slipped] += 0.9
    nearest = nearest_triple(written, rotation, sequence, fixed=fixed)
    np.testing.assert_allclose(
        Rotation.from_euler(name, nearest[:, 0]).as_matrix(), rotation[0], atol=1e-6
    )
    outer = np.sin(angles[1]) if sequence in PROPER else np.cos(angles[1])
    if abs(outer) > 0.05 and abs(np.sin(angles[1] + 0.45)) > 0.1:
        off = np.abs(np.exp(1j * nearest[:, 0]) - np.exp(1j * written[:, 0]))
        assert (off < 1e-6).sum() == 2


# --- Grade lists of lengths, angles and numbers

TASK = ["a1 c1 + a2 c12", "a1 s1 + a2 s12"]


@pytest.mark.parametrize("angle", ["theta1 + theta2", "θ1 + θ2 - 2π", "atan2(s12, c12)"])
def test_an_angle_of_a_vector_counts_modulo_whole_turns(
    angle: str, catalogue: Mapping[str, Exercise]
) -> None:
    report = handed_in(catalogue["planar-rr"], {"task-space": [*TASK, angle]})
    assert full_marks(part(report, "task-space"))


@pytest.mark.parametrize(
    ("answer", "row", "code"),
    [
        ([*TASK, "-theta1 - theta2"], "3", "sign"),
        ([*TASK, "theta1 + theta2 + pi"], "3", "half_turn"),
        ([*TASK, "theta1 + theta2 + pi/2"], "3", "quarter_turn"),
        ([*TASK, "atan(s12/c12)"], "3", "lost_quadrant"),
        ([*TASK, "pi/2 - theta1 - theta2"], "3", "swapped_atan2"),
        ([*TASK, "theta2"], "3", "joint_variable_missing"),
        (["a1 c1 + a2 c2", TASK[1], "theta1 + theta2"], "1", "relative_angle"),
    ],
)
def test_a_slip_in_a_vector_is_named(
    answer: list[str], row: str, code: str, catalogue: Mapping[str, Exercise]
) -> None:
    report = part(handed_in(catalogue["planar-rr"], {"task-space": answer}), "task-space")
    assert not_correct(report) == {(row, "1"): Verdict.INCORRECT}
    assert report.points == 2
    assert [message.code for message in cell(report, row, "1").feedback] == [code]


def test_a_length_is_not_an_angle(catalogue: Mapping[str, Exercise]) -> None:
    answer = [f"{TASK[0]} + 2*pi", TASK[1], "theta1 + theta2"]
    report = part(handed_in(catalogue["planar-rr"], {"task-space": answer}), "task-space")
    assert not_correct(report) == {("1", "1"): Verdict.INCORRECT}


def test_the_twists_of_the_lecture_are_right(catalogue: Mapping[str, Exercise]) -> None:
    # Source: Screw Theory, Example: Simple Twist, with S_ω = (0, 0, 1) and S_v = (0, −2, 0).
    answers: dict[str, Any] = {
        "zero-pitch": [[0, 0, 1, 0, -2, 0]],
        "twist": [0, 0, "w", 0, "-2 w", 0],
        "pitch": [0, 0, 1, 0, -2, "h"],
        "infinite-pitch": [[0, 0, 0, 1, 0, 0]],
        "exponential": [
            ["cos theta", "-sin theta", 0, "2 - 2 cos theta"],
            ["sin theta", "cos theta", 0, "-2 sin theta"],
            [0, 0, 1, 0],
            [0, 0, 0, 1],
        ],
    }
    report = handed_in(catalogue["simple-twist"], answers)
    for part_id in answers:
        assert full_marks(part(report, part_id)), part(report, part_id)
