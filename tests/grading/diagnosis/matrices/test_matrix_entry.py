"""Test the misconceptions about a single matrix entry."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from dh_grader.expressions import AngleUnit, Symbol, Vocabulary, read
from dh_grader.grading.diagnosis import matrices as matrix_entry
from dh_grader.grading.diagnosis.formulas import WrongEntry
from dh_grader.grading.misconception import Hypothesis, records_of, undefined
from dh_grader.grading.numbers import SAMPLES, Samples
from dh_grader.grading.report import Correction

from tests.grading.diagnosis.pairs import Pair, assert_explains_only_the_first, each_pair, explained
from tests.together import together

Misconception = Callable[[WrongEntry], Iterator[Hypothesis[Any]]]

RNG = np.random.default_rng(4)
ANGLES = [Symbol(f"q{i}", "angle", joint=i) for i in range(1, 5)]
LENGTHS = [Symbol(f"l{i}", "length") for i in range(1, 4)]
WORDS = Vocabulary([*ANGLES, *LENGTHS])
SAMPLE = Samples(
    {angle.name: RNG.uniform(-3, 3, SAMPLES) for angle in ANGLES}
    | {length.name: RNG.uniform(0.3, 0.9, SAMPLES) for length in LENGTHS}
)


def wrong(written: str, expected: str, unit: AngleUnit = "radians") -> WrongEntry:
    expression = read(written, WORDS, angle_unit=unit)
    actual, right = (
        np.array(np.broadcast_to(text.evaluate(SAMPLE.values), SAMPLES))
        for text in (expression, read(expected, WORDS))
    )
    return WrongEntry(
        expression=expression,
        actual=actual,
        expected=right,
        samples=SAMPLE,
        scale=1.0,
        angle=False,
        turning=WORDS.turning,
    )


PAIRS = [
    Pair(undefined, wrong("1/0", "c12"), wrong("c1", "c12")),
    Pair(matrix_entry.sign, wrong("-c12", "c12"), wrong("-c12", "s12")),
    Pair(matrix_entry.degrees_as_radians, wrong("sin(q1 + 90)", "c1"), wrong("90*c1", "c1")),
    Pair(
        matrix_entry.radians_as_degrees,
        wrong("cos(q1 + 1.5708)", "-s1", "degrees"),
        wrong("cos(q1 + 1.5708)", "-s1"),
    ),
    Pair(matrix_entry.sine_for_cosine, wrong("s12", "c12"), wrong("tan(q1)", "c1")),
    Pair(matrix_entry.sum_of_cosines, wrong("c1 + c2", "c12"), wrong("c1 + s2", "c12")),
    Pair(matrix_entry.product_for_sum_angle, wrong("c1*c2", "c12"), wrong("c1*s2", "c12")),
    Pair(matrix_entry.relative_angle, wrong("c2", "c12"), wrong("c1", "c12")),
    Pair(
        matrix_entry.angle_left_out,
        wrong("c1 s23", "c1 s123"),
        wrong("c1 s24", "c1 s123"),
        "joint_variable_missing",
    ),
    Pair(
        matrix_entry.angle_too_many,
        wrong("l1 c123 - l2 s3", "l1 c12 - l2 s3"),
        wrong("l1 c124", "l1 c23"),
        "joint_variable_extra",
    ),
    Pair(matrix_entry.term_sign, wrong("l1 - l2*c1", "l1 + l2*c1"), wrong("l1 - l2", "l3")),
]


@each_pair(PAIRS)
def test_a_misconception_explains_only_its_case(pair: Pair) -> None:
    assert_explains_only_the_first(pair)


EXPLAINED: list[tuple[Misconception, str, str, str]] = [
    (matrix_entry.sign, "-c12", "c12", ""),
    (matrix_entry.sine_for_cosine, "s12", "c12", "cos(q1 + q2)"),
    (matrix_entry.sine_for_cosine, "-l1*c1", "-l1*s1", "-l1*sin(q1)"),
    (matrix_entry.sine_for_cosine, "c1*s2", "s1*c2", "sin(q1)*cos(q2)"),
    (
        matrix_entry.sine_for_cosine,
        "l1*c1 + l2*s12",
        "l1*c1 + l2*c12",
        "cos(q1 + q2)",
    ),
    (matrix_entry.sine_for_cosine, "s12", "-c12", "-cos(q1 + q2)"),
    (matrix_entry.sum_of_cosines, "c1 + c2", "c12", "cos(q1 + q2)"),
    (matrix_entry.sum_of_cosines, "s1 + s2 + s3", "s123", "sin(q1 + q2 + q3)"),
    (matrix_entry.sum_of_cosines, "c1 - c2", "cos(q1 - q2)", "cos(q1 - q2)"),
    (matrix_entry.sum_of_cosines, "-s1 - s2", "-s12", "-sin(q1 + q2)"),
    (matrix_entry.sum_of_cosines, "-c1 + c2", "-cos(q1 - q2)", "-cos(q1 - q2)"),
    (matrix_entry.sum_of_cosines, "-(s1 + s2)", "-s12", "-sin(q1 + q2)"),
    (
        matrix_entry.sum_of_cosines,
        "l1*c1 + l2*c1 + l2*c2",
        "l1*c1 + l2*c12",
        "l1*cos(q1) + l2*cos(q1 + q2)",
    ),
    (matrix_entry.sum_of_cosines, "l1*c1 + l2*(c1 + c2)", "l1*c1 + l2*c12", "cos(q1 + q2)"),
    (matrix_entry.sum_of_cosines, "c1*(c2 + c3)", "c1*c23", "cos(q1)*cos(q2 + q3)"),
    (matrix_entry.product_for_sum_angle, "c1*c2", "c12", "cos(q1 + q2)"),
    (matrix_entry.product_for_sum_angle, "-s1 s2", "-s12", "-sin(q1 + q2)"),
    (matrix_entry.product_for_sum_angle, "c1 c2 c3", "c1 c23", "cos(q1)*cos(q2 + q3)"),
    (matrix_entry.product_for_sum_angle, "c1 c2 c3", "c123", "cos(q1 + q2 + q3)"),
    (
        matrix_entry.product_for_sum_angle,
        "l1 c1 + l2 c1 c2 + l3 c1 c2 c3",
        "l1 c1 + l2 c12 + l3 c123",
        "l2*cos(q1 + q2)",
    ),
    (matrix_entry.relative_angle, "c2", "c12", "cos(q1 + q2)"),
    (matrix_entry.relative_angle, "l1*c1 + l2*c2 + l3*c3", "l1*c1 + l2*c12 + l3*c123", "l2*cos(q1"),
    (matrix_entry.relative_angle, "c1*(l3*c3 + l2*c2)", "c1*(l3*c23 + l2*c2)", "l3*cos(q2"),
    (matrix_entry.degrees_as_radians, "cos(90)*s1 + c1", "c1", "cos(90deg)"),
    (matrix_entry.degrees_as_radians, "sin(q1 + 45)", "sin(q1 + pi/4)", "sin(q1 + 45deg)"),
    (matrix_entry.term_sign, "l1*c1 - l2*c12", "l1*c1 + l2*c12", "l1*cos(q1) + l2*cos"),
    (matrix_entry.term_sign, "l1*c1 + l2*c12", "-l1*c1 + l2*c12", "-l1*cos(q1) + l2*cos"),
    (matrix_entry.term_sign, "c1*(l2*c2 - l3*c3)", "c1*(l2*c2 + l3*c3)", "l2*cos(q2) + l3*cos"),
]


@together(("misconception", "written", "expected", "correction"), EXPLAINED)
def test_a_misconception_explains_its_entry(
    misconception: Misconception, written: str, expected: str, correction: str
) -> None:
    case = wrong(written, expected)
    found = explained(case, misconception)
    assert found is not None
    [finding] = found.findings
    assert finding.code == misconception.__name__
    found_text = finding.correction.text if isinstance(finding.correction, Correction) else ""
    assert correction in found_text
    assert matrix_entry.diagnose(case) == finding


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
def test_a_misconception_does_not_explain_other_entries(
    misconception: Misconception, written: str, expected: str
) -> None:
    assert explained(wrong(written, expected), misconception) is None


@pytest.mark.parametrize(
    "misconception",
    [each.function for each in records_of(WrongEntry) if not each.is_check],
)
def test_a_misconception_that_changes_nothing_explains_nothing(
    misconception: Misconception,
) -> None:
    # The test treats the answer as wrong, although it is correct within rounding.
    case = wrong("l1*c1*c2 + cos(0) + s1*s2/1000000", "l1*c1*c2 + cos(0)")
    assert explained(case, misconception) is None


@pytest.mark.parametrize(
    "written",
    ["1/(q1 - q1) + c1 + c2", "sqrt(-1)*s1", "sqrt(-abs(q1)) + c1*c2", "10^400*c1", "asin(2 + c1)"],
)
def test_an_entry_without_a_value_is_undefined(written: str) -> None:
    assert matrix_entry.diagnose(wrong(written, "c12")).code == "undefined"


def test_a_repair_without_a_value_explains_nothing() -> None:
    assert matrix_entry.diagnose(wrong("c1/(s2 + l1) + c2/c1", "c12")).code == "value"


def test_long_formulas_are_only_compared() -> None:
    padding = "".join(f" + 0*c{i % 4 + 1}" for i in range(30))
    assert matrix_entry.diagnose(wrong(f"s1{padding}", "c1")).code == "value"
    assert matrix_entry.diagnose(wrong(f"-c1{padding}", "c1")).code == "sign"
    short = padding[: len(padding) // 4]
    assert matrix_entry.diagnose(wrong(f"s1{short[: short.rindex('+')]}", "c1")).code != "value"


def test_without_work_budget_a_formula_is_only_compared() -> None:
    wrong_entries = {(0, 0): wrong("s1", "c1"), (0, 1): wrong("-c1", "c1")}
    findings = matrix_entry.diagnose_entries(wrong_entries, lambda _: True, work_budget=0)
    assert [finding.code for finding in findings.values()] == ["value", "sign"]
