"""Grade Euler angles: every triple that gives the rotation is correct."""

# A slip costs as few of the angles as possible.

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading import Correction, FeedbackLevel, Verdict
from dh_grader.grading.kinds.motions import nearest_triple
from dh_grader.kinematics import PROPER, SEQUENCES
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tests.grading.support.exercise_texts import SPATIAL_RRR, Make, all_codes, graded, one_part
from tests.grading.support.submitting import full_marks, handed_in, not_correct, part

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
def test_an_answer_of_another_shape_is_unreadable(answer: object, spatial: Exercise) -> None:
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
