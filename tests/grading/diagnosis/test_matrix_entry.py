"""Misconceptions about single matrix entries: what each explains, and what it leaves alone."""

from collections.abc import Callable

import numpy as np
import pytest

from service.catalogue import Exercise
from service.expressions import AngleUnit, read
from service.grading.diagnosis import matrix_entry
from service.grading.diagnosis.formula_repair import WrongEntry
from service.grading.feedback import Finding
from service.grading.samples import SAMPLES, draw

Misconception = Callable[[WrongEntry], Finding | None]

ARM = """
title = "Arm of four turning joints"
source = "Made for this test."
statement = "An arm."

[robot]
structure = "RRRR"
convention = "standard"
joints = ["q1", "q2", "q3", "q4"]
table = [
    ["l1", "90deg", "0", "q1"],
    ["l2", "0", "0", "q2"],
    ["l3", "0", "0", "q3"],
    ["0", "0", "0", "q4"],
]

[symbols]
l1 = { kind = "length", description = "link 1" }
l2 = { kind = "length", description = "link 2" }
l3 = { kind = "length", description = "link 3" }

[[parts]]
id = "pose"
kind = "transform"
title = "Pose"
prompt = "Give the pose."
points = 1
"""

Case = Callable[..., WrongEntry]


@pytest.fixture
def wrong(make_exercise: Callable[[str], Exercise]) -> Case:
    """A wrong entry: what was written, what would be right."""
    exercise = make_exercise(ARM)
    samples = draw(exercise, "entries")

    def case(written: str, expected: str, degrees: bool = False) -> WrongEntry:
        unit: AngleUnit = "degrees" if degrees else "radians"
        texts = [read(written, exercise.vocabulary, angle_unit=unit)]
        texts.append(read(expected, exercise.vocabulary))
        actual, right = (
            np.array(np.broadcast_to(text.evaluate(samples.values), SAMPLES)) for text in texts
        )
        return WrongEntry(
            expression=texts[0],
            actual=actual,
            expected=right,
            expected_text="",
            samples=samples,
            scale=1.0,
            angle=False,
            turning=exercise.vocabulary.turning,
        )

    return case


EXPLAINED: list[tuple[Misconception, str, str, str]] = [
    (matrix_entry.sign, "-c12", "c12", ""),
    (matrix_entry.sine_for_cosine, "s12", "c12", "It should be cos(q1 + q2)."),
    (matrix_entry.sine_for_cosine, "-l1*c1", "-l1*s1", "It should be -l1*sin(q1)."),
    (matrix_entry.sine_for_cosine, "c1*s2", "s1*c2", "It should be sin(q1)*cos(q2)."),
    (
        matrix_entry.sine_for_cosine,
        "l1*c1 + l2*s12",
        "l1*c1 + l2*c12",
        "should be cos(q1 + q2).",
    ),
    (matrix_entry.sine_for_cosine, "s12", "-c12", "It should be -cos(q1 + q2)."),
    (matrix_entry.sum_of_cosines, "c1 + c2", "c12", "It should be cos(q1 + q2)."),
    (matrix_entry.sum_of_cosines, "s1 + s2 + s3", "s123", "sin(q1 + q2 + q3)."),
    (matrix_entry.sum_of_cosines, "c1 - c2", "cos(q1 - q2)", "It should be cos(q1 - q2)."),
    (matrix_entry.sum_of_cosines, "-s1 - s2", "-s12", "It should be -sin(q1 + q2)."),
    (matrix_entry.sum_of_cosines, "-c1 + c2", "-cos(q1 - q2)", "It should be -cos(q1 - q2)."),
    (matrix_entry.sum_of_cosines, "-(s1 + s2)", "-s12", "It should be -sin(q1 + q2)."),
    (
        matrix_entry.sum_of_cosines,
        "l1*c1 + l2*c1 + l2*c2",
        "l1*c1 + l2*c12",
        "It should be l1*cos(q1) + l2*cos(q1 + q2).",
    ),
    (matrix_entry.sum_of_cosines, "l1*c1 + l2*(c1 + c2)", "l1*c1 + l2*c12", "cos(q1 + q2)."),
    (matrix_entry.sum_of_cosines, "c1*(c2 + c3)", "c1*c23", "cos(q1)*cos(q2 + q3)."),
    (matrix_entry.product_for_sum_angle, "c1*c2", "c12", "It should be cos(q1 + q2)."),
    (matrix_entry.product_for_sum_angle, "-s1 s2", "-s12", "It should be -sin(q1 + q2)."),
    (matrix_entry.product_for_sum_angle, "c1 c2 c3", "c1 c23", "cos(q1)*cos(q2 + q3)."),
    (matrix_entry.product_for_sum_angle, "c1 c2 c3", "c123", "cos(q1 + q2 + q3)."),
    (
        matrix_entry.product_for_sum_angle,
        "l1 c1 + l2 c1 c2 + l3 c1 c2 c3",
        "l1 c1 + l2 c12 + l3 c123",
        "l2*cos(q1 + q2)",
    ),
    (matrix_entry.relative_angle, "c2", "c12", "It should be cos(q1 + q2)."),
    (matrix_entry.relative_angle, "l1*c1 + l2*c2 + l3*c3", "l1*c1 + l2*c12 + l3*c123", "l2*cos(q1"),
    (matrix_entry.relative_angle, "c1*(l3*c3 + l2*c2)", "c1*(l3*c23 + l2*c2)", "l3*cos(q2"),
    (matrix_entry.degrees_as_radians, "cos(90)*s1 + c1", "c1", "cos(90deg)"),
    (matrix_entry.degrees_as_radians, "sin(q1 + 45)", "sin(q1 + pi/4)", "sin(q1 + 45deg)"),
    (matrix_entry.term_sign, "l1*c1 - l2*c12", "l1*c1 + l2*c12", "l1*cos(q1) + l2*cos"),
    (matrix_entry.term_sign, "l1*c1 + l2*c12", "-l1*c1 + l2*c12", "-l1*cos(q1) + l2*cos"),
    (matrix_entry.term_sign, "c1*(l2*c2 - l3*c3)", "c1*(l2*c2 + l3*c3)", "l2*cos(q2) + l3*cos"),
]


@pytest.mark.parametrize(("misconception", "written", "expected", "correction"), EXPLAINED)
def test_a_misconception_explains_its_entry(
    misconception: Misconception, written: str, expected: str, correction: str, wrong: Case
) -> None:
    case = wrong(written, expected)
    finding = misconception(case)
    assert finding is not None
    assert finding.code == misconception.__name__
    assert correction in finding.correction
    assert matrix_entry.diagnose(case) == finding


def test_degrees_where_radians_were_meant(wrong: Case) -> None:
    finding = matrix_entry.diagnose(wrong("cos(q1 + 1.5708)", "-s1", degrees=True))
    assert finding.code == "radians_as_degrees"


LEFT_ALONE: list[tuple[Misconception, str, str]] = [
    (matrix_entry.sign, "-c12", "s12"),
    (matrix_entry.sine_for_cosine, "tan(q1)", "c1"),
    (matrix_entry.sine_for_cosine, "s1", "c2"),
    (matrix_entry.sine_for_cosine, "0", "1"),
    (matrix_entry.sum_of_cosines, "c1 + s2", "c12"),
    (matrix_entry.sum_of_cosines, "l1*c1 + l2*c2", "c12"),
    (matrix_entry.sum_of_cosines, "c1 + c2", "c1 c2"),
    (matrix_entry.product_for_sum_angle, "c1*s2", "c12"),
    (matrix_entry.product_for_sum_angle, "c1*c2", "c1*s2"),
    (matrix_entry.relative_angle, "c1", "c12"),
    (matrix_entry.relative_angle, "c12", "c2"),
    (matrix_entry.degrees_as_radians, "cos(90)", "1"),
    (matrix_entry.degrees_as_radians, "cos(90deg)", "1"),
    (matrix_entry.degrees_as_radians, "90*c1", "c1"),
    (matrix_entry.radians_as_degrees, "cos(q1 + 1.5708)", "-s1"),
    (matrix_entry.term_sign, "l1*c1 - l2*c12", "l1*s1 + l2*c12"),
    (matrix_entry.term_sign, "l1 - l2", "l3"),
]


@pytest.mark.parametrize(("misconception", "written", "expected"), LEFT_ALONE)
def test_a_misconception_leaves_other_entries_alone(
    misconception: Misconception, written: str, expected: str, wrong: Case
) -> None:
    assert misconception(wrong(written, expected)) is None


@pytest.mark.parametrize("misconception", matrix_entry.MISCONCEPTIONS)
def test_what_changes_nothing_explains_nothing(misconception: Misconception, wrong: Case) -> None:
    """An answer within rounding of the right one, but not allowed to be."""
    case = wrong("l1*c1*c2 + cos(0) + s1*s2/1000000", "l1*c1*c2 + cos(0)")
    finding = misconception(case)
    assert finding is None


@pytest.mark.parametrize(
    "written",
    ["1/(q1 - q1) + c1 + c2", "sqrt(-1)*s1", "sqrt(-abs(q1)) + c1*c2", "10^400*c1", "asin(2 + c1)"],
)
def test_an_entry_without_a_value_is_not_taken_apart(written: str, wrong: Case) -> None:
    finding = matrix_entry.diagnose(wrong(written, "c12"))
    assert finding.code == "undefined"


def test_a_repair_that_has_no_value_is_none(wrong: Case) -> None:
    assert matrix_entry.diagnose(wrong("c1/(s2 + l1) + c2/c1", "c12")).code == "value"


def test_long_formulas_are_only_compared(wrong: Case) -> None:
    padding = "".join(f" + 0*c{i % 4 + 1}" for i in range(30))
    assert matrix_entry.diagnose(wrong(f"s1{padding}", "c1")).code == "value"
    assert matrix_entry.diagnose(wrong(f"-c1{padding}", "c1")).code == "sign"
    short = padding[: len(padding) // 4]
    assert matrix_entry.diagnose(wrong(f"s1{short[: short.rindex('+')]}", "c1")).code != "value"


def test_without_patience_a_formula_is_only_compared(wrong: Case) -> None:
    case = wrong("s1", "c1")
    assert matrix_entry.diagnose(case, patient=False).code == "value"
    assert matrix_entry.diagnose(wrong("-c1", "c1"), patient=False).code == "sign"
