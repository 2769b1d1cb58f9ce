"""Compare values on both sides of a tolerance, in the functions that have it."""

from collections.abc import Mapping

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.grading.judging import Grading, StudentChain
from dh_grader.grading.kinds.motions import nearest_triple
from dh_grader.grading.marks import can_carry, stands_still
from dh_grader.grading.misconception import multiples, number_formula
from dh_grader.grading.numbers import HALF, SAMPLES, Samples, draw, joint_counts, moves_with
from dh_grader.grading.reading.entries import Reader
from dh_grader.kinematics import (
    Convention,
    Matrices,
    Numbers,
    from_angles,
    links,
    other_triple,
    products,
)

from tests.grading.support.submitting import graded_table
from tests.together import together


def grading_of(exercise: Exercise) -> Grading:
    samples = draw(exercise, None)
    return Grading(exercise, samples, Reader.of(exercise, samples, "radians"))


@together(("error", "is_same"), [(0.5e-6, True), (2e-6, False)])
def test_a_motion_is_that_of_a_joint_up_to_a_millionth(
    catalogue: Mapping[str, Exercise], error: float, is_same: bool
) -> None:
    exercise = catalogue["stanford-arm"]
    samples = draw(exercise, None)
    variable = samples.values["theta1"].copy()
    motion = variable[HALF:] - variable[:HALF]
    # One sample is in error, also after a whole turn.
    for turn in (0.0, 2 * np.pi):
        values = variable.copy()
        values[HALF + 3] += error + turn
        is_angle = np.array([True])
        assert moves_with(values[None], motion, True).tolist() == [is_same]
        _, linear = joint_counts(values[None], exercise.joints, samples, is_angle)
        assert linear.tolist() == [is_same]


@together(
    ("motion", "quantity", "is_still"),
    [
        (0.0075, "angle", True), (0.015, "angle", False), (np.nan, "angle", False),
        (0.0075, "length", True), (0.015, "length", False),
    ],
)  # fmt: skip
def test_an_answer_that_moves_by_less_than_a_hundredth_stands_still(
    catalogue: Mapping[str, Exercise], motion: float, quantity: str, is_still: bool
) -> None:
    grading = grading_of(catalogue["scara"])
    scale = grading.exercise.length_scale if quantity == "length" else 1.0
    values = np.full((2, 1, SAMPLES), 0.3)
    values[1, 0, -1] += motion * scale
    assert stands_still(values, (quantity,), grading) is is_still  # type: ignore[arg-type]


@together(
    ("scale", "first_row", "carries"),
    [
        # A frame whose axes are longer by a thousandth, or by five, has products of twice that.
        (1.0, {}, True), (1.001, {}, True), (1.005, {}, False),
        # The first joint turns by 1.5 %, or by 3 %, more than its variable says.
        (1.0, {"gain": 1.015}, True), (1.0, {"gain": 1.03}, False),
        # Two axes with a distance d coincide if d / 2, the ratio of singular values, is too small.
        (1.0, {"length": 6e-3}, True), (1.0, {"length": 6e-4}, False),
    ],
)  # fmt: skip
def test_an_arm_carries_later_answers_if_it_is_rigid_and_moves(
    catalogue: Mapping[str, Exercise], scale: float, first_row: dict[str, float], carries: bool
) -> None:
    exercise = catalogue["planar-rr"]
    grading = grading_of(exercise)

    def frames_at(samples: Samples) -> Matrices:
        table = exercise.robot.tables[Convention.STANDARD]
        values = table.values(samples.values, SAMPLES).copy()
        values[0, 3] *= first_row.get("gain", 1.0)
        if "length" in first_row:
            values[0, 0] = first_row["length"] * exercise.length_scale
        return np.asarray(products(links(values, Convention.STANDARD)))

    frames = frames_at(grading.samples).copy()
    frames[1, :, :3, :3] *= scale
    assert can_carry(StudentChain(frames, frames_at), grading) is carries


@together(("error", "side"), [(0.5e-6, 0), (2e-6, 1)])
def test_angles_within_a_millionth_belong_to_a_triple(error: float, side: int) -> None:
    # Two angles are nearly those of one triple, the third is that of the other triple.
    one = np.tile(np.array([0.3, 0.7, -1.1])[:, None], SAMPLES)
    rotation = from_angles("ZYX", one.T)
    other = other_triple("ZYX", one.T).T
    angles = np.array([one[0] + error, one[1] + error, other[2]])
    nearest = nearest_triple(angles, rotation, "ZYX")
    assert nearest == pytest.approx((one, other)[side])


@together(
    ("angle", "vary", "noise", "found"),
    [
        # A constant is one to a billionth, and no letter of the arm is an angle.
        (True, 0.0, 0.5e-9, ([], 0.4)), (True, 0.0, 2e-9, None),
        # The rest of a sum of letters is constant to a millionth.
        (False, 0.0, 2e-9, ([], 0.4)), (False, 1.0, 0.5e-6, ([(1, "a1")], 0.4)),
        (False, 1.0, 2e-6, None),
    ],
)  # fmt: skip
def test_a_constant_is_a_sum_of_letters_and_a_number(
    catalogue: Mapping[str, Exercise],
    angle: bool,
    vary: float,
    noise: float,
    found: tuple[list[tuple[int, str]], float] | None,
) -> None:
    exercise = catalogue["scara"]
    samples = draw(exercise, None)
    values: Numbers = 0.4 + vary * samples.values["a1"][:HALF]
    values[5] += noise
    told = multiples(values, angle, exercise, samples)
    assert (told is None) == (found is None)
    if told is not None and found is not None:
        assert told[0] == found[0]
        assert told[1] == pytest.approx(found[1], abs=1e-6)


def test_only_a_value_that_does_not_vary_is_printed_as_a_number() -> None:
    for spread, is_number in ((0.5e-12, True), (2e-12, False)):
        values = np.full(SAMPLES, 0.25)
        values[7] += spread
        assert (number_formula(values) is not None) is is_number
    for value, text in ((0.5e-12, "0"), (2e-12, "2e-12")):
        formula = number_formula(np.full(SAMPLES, value))
        assert formula is not None
        assert formula.text == text


@together(("error", "is_right"), [(0.5e-6, True), (2e-6, False)])
def test_a_huge_offset_does_not_enlarge_the_tolerance(
    catalogue: Mapping[str, Exercise], error: float, is_right: bool
) -> None:
    # Offsets along parallel axes cancel; with ten million lengths, seven figures are left.
    exercise = catalogue["planar-rrr"]
    rest = round(error * exercise.length_scale * 1e12)
    rows = [
        ("0", "0", "10^7", "q1"),
        ("l1", "0", f"{rest}/10^12 - 10^7", "q2"),
        ("l2", "0", "0", "q3"),
        ("l3", "0", "0", "0"),
    ]
    report = graded_table(exercise, rows)
    assert (report.points == report.max_points) is is_right
