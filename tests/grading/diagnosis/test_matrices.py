"""Test misconceptions in matrices and their entries."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from dh_grader.catalogue import Exercise
from dh_grader.expressions import AngleUnit, Symbol, Vocabulary, read
from dh_grader.grading import FeedbackLevel, PartReport
from dh_grader.grading.diagnosis import matrices as inverse_slips
from dh_grader.grading.diagnosis import matrices as line_signs
from dh_grader.grading.diagnosis import matrices as matrix_entry
from dh_grader.grading.diagnosis import matrices as whole_matrix
from dh_grader.grading.diagnosis.formulas import WrongEntry
from dh_grader.grading.diagnosis.matrices import WrongAxes, explain
from dh_grader.grading.diagnosis.motions import Chain, MatrixCase
from dh_grader.grading.misconception import Hypothesis, records_of, undefined
from dh_grader.grading.numbers import SAMPLES, Samples
from dh_grader.grading.report import Correction
from dh_grader.kinematics import Convention, Numbers, inverse

from tests.grading.diagnosis.pairs import (
    A1,
    A2,
    POSE,
    Pair,
    assert_explains_only_the_first,
    each_pair,
    explained,
    product,
    wrong_matrix,
    wrong_pose,
)
from tests.grading.support.submitting import Make, all_codes, handed_in, one_part, part
from tests.together import together

# --- Test the misconceptions about a single matrix entry

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


# --- Test the misconceptions about a whole matrix

R, P = POSE[:, :3, :3], POSE[:, :3, 3]


def with_rotation(rotation: Numbers) -> MatrixCase:
    """Return the correct pose with a wrong rotation ``(COUNT, 3, 3)``."""
    matrix = POSE.copy()
    matrix[:, :3, :3] = rotation
    return wrong_pose(matrix)


def with_position(position: Numbers) -> MatrixCase:
    """Return the correct pose with a wrong position ``(COUNT, 3)``."""
    matrix = POSE.copy()
    matrix[:, :3, 3] = position
    return wrong_pose(matrix)


WHOLE_MATRIX_PAIRS = [
    Pair(
        whole_matrix.length_unit,
        with_position(P / 100),
        with_position(P / 90),
        "other_length_unit",
    ),
    Pair(
        whole_matrix.transposed_matrix,
        wrong_pose(np.swapaxes(POSE, 1, 2)),
        wrong_pose(np.swapaxes(A1, 1, 2)),
    ),
    Pair(whole_matrix.inverse_transform, wrong_pose(inverse(POSE)), wrong_pose(A1)),
    Pair(whole_matrix.other_pose, wrong_pose(product(A1, A2)), wrong_pose(A2), "wrong_frame"),
    Pair(
        whole_matrix.inverse_of_other_pose,
        wrong_pose(inverse(product(A1, A2))),
        wrong_pose(product(A1, A2)),
        "wrong_frame",
    ),
    Pair(
        whole_matrix.transposed_rotation,
        with_rotation(np.swapaxes(R, 1, 2)),
        with_rotation(np.swapaxes(A1[:, :3, :3], 1, 2)),
    ),
    Pair(
        whole_matrix.columns_exchanged,
        with_rotation(R[:, :, [1, 0, 2]]),
        with_rotation(R[:, [1, 0, 2]]),
    ),
    Pair(
        whole_matrix.other_rotation,
        with_rotation(A1[:, :3, :3]),
        with_rotation(A2[:, :3, :3]),
        "wrong_frame",
    ),
    Pair(
        whole_matrix.other_position,
        with_position(A1[:, :3, 3]),
        with_position(0 * P),
        "wrong_frame",
    ),
    Pair(
        line_signs.line_sign,
        with_rotation(R * [1, -1, 1]),
        with_rotation(R * [[1, -1, 1], [1, 1, 1], [1, 1, 1]]),
        "column_sign",
    ),
    Pair(
        whole_matrix.bottom_row,
        wrong_pose(np.array([[1], [1], [1], [2]]) * POSE),
        wrong_pose(np.array([[1], [1], [2], [1]]) * POSE),
    ),
    Pair(whole_matrix.left_handed_rotation, WrongAxes(-R, []), WrongAxes(R, [])),
    Pair(whole_matrix.rotation_not_orthonormal, WrongAxes(2 * R, []), WrongAxes(-R, [])),
]


@each_pair(WHOLE_MATRIX_PAIRS)
def test_a_misconception_or_check_explains_only_its_case(pair: Pair) -> None:
    assert_explains_only_the_first(pair)


@pytest.mark.parametrize(
    "rows",
    [
        [[0.4, 0.3, 0.2, 0.5], [0, 0, 0, 0], [0.1, -0.7, 0.3, 0.9]],
        [[0.4, np.pi, 0.2, 0], [0.1, 0, 0.3, 0]],
        [[0, 0, 0, 0], [0.4, 0.3, 0.2, 0.5]],
        [[0.3, np.pi, 0.2, np.pi]],
    ],
)
def test_an_alternative_that_is_right_explains_nothing(rows: list[list[float]]) -> None:
    # With these tables, a link can be left out, exchanged or transposed without effect.
    lengths = np.linspace(1.0, 2.0, 8)
    table = np.array(rows)[..., None] * np.array([lengths, 0 * lengths + 1] * 2)
    chain = Chain(table, Convention.STANDARD, tuple("0123"[: len(rows) + 1]))
    right = chain.from_base[-1]
    case = replace(
        wrong_matrix(right * (1 + 1e-5), right, chain), wrong=np.ones((4, 4), dtype=np.bool_)
    )
    assert [found.finding.code for found in explain(case)] == ["bottom_row"]


# --- Test the misconceptions about the inverse of a homogeneous transform

BACK = np.swapaxes(R, 1, 2)
TURNED: Numbers = (BACK @ P[..., None])[..., 0]
RIGHT: Numbers = np.asarray(np.linalg.inv(POSE), dtype=np.float64)


def case(rotation: Numbers, position: Numbers) -> MatrixCase:
    matrix = RIGHT.copy()
    matrix[:, :3, :3], matrix[:, :3, 3] = rotation, position
    return wrong_matrix(matrix, RIGHT)


INVERSE_SLIPS_PAIRS = [
    Pair(
        inverse_slips.transposed_for_inverse,
        wrong_matrix(np.swapaxes(POSE, 1, 2), RIGHT),
        wrong_matrix(np.swapaxes(RIGHT, 1, 2), RIGHT),
    ),
    Pair(inverse_slips.negated_for_inverse, case(-R, -P), case(-R, P)),
    Pair(
        inverse_slips.negated_rotation, case(-R, -TURNED), case(R, -TURNED), "negated_for_inverse"
    ),
    Pair(inverse_slips.position_not_turned, case(BACK, -P), case(BACK, P)),
    Pair(inverse_slips.position_not_inverted, case(BACK, P), case(BACK, -P)),
    Pair(inverse_slips.position_reversed, case(BACK, TURNED), case(BACK, -P), "reversed_position"),
    Pair(
        inverse_slips.position_turned_back,
        case(BACK, -(R @ P[..., None])[..., 0]),
        case(BACK, TURNED),
    ),
]


@each_pair(INVERSE_SLIPS_PAIRS)
def test_a_misconception_explains_only_its_inverse(pair: Pair) -> None:
    assert_explains_only_the_first(pair)


# The inverse of Rot_x(phi) Trans(a, 0, b), which no exercise has: [Rᵀ, −(a, 0, b)]; and of a
# transform in numbers, Rot_z(90°) with p = (3, 1, 2): −Rᵀp = (−1, 3, −2).
SYMBOLS = """
[symbols]
phi = { kind = "angle", description = "a turn" }
px = { kind = "length", description = "x" }
py = { kind = "length", description = "y" }
pz = { kind = "length", description = "z" }
"""
ABOUT_X = one_part(
    "transform",
    """expected = [
    ["1", "0", "0", "-px"],
    ["0", "cos(phi)", "sin(phi)", "-py*cos(phi) - pz*sin(phi)"],
    ["0", "-sin(phi)", "cos(phi)", "py*sin(phi) - pz*cos(phi)"],
    ["0", "0", "0", "1"],
]""",
    SYMBOLS,
)
IN_NUMBERS = one_part(
    "transform",
    """expected = [
    ["0", "1", "0", "-1"], ["-1", "0", "0", "3"], ["0", "0", "1", "-2"], ["0", "0", "0", "1"],
]""",
    SYMBOLS,
)
X_TURNED = [["1", "0", "0"], ["0", "cφ", "-sφ"], ["0", "sφ", "cφ"]]
X_BACK = [["1", "0", "0"], ["0", "cφ", "sφ"], ["0", "-sφ", "cφ"]]
Z_TURNED = [["0", "-1", "0"], ["1", "0", "0"], ["0", "0", "1"]]
Z_BACK = [["0", "1", "0"], ["-1", "0", "0"], ["0", "0", "1"]]
Answer = tuple[str, list[list[str]], list[str], str]
WRONG: dict[str, Answer] = {
    "−p": (ABOUT_X, X_BACK, ["-px", "-py", "-pz"], "position_not_turned"),
    "p": (ABOUT_X, X_BACK, ["px", "py", "pz"], "position_not_inverted"),
    "no minus": (ABOUT_X, X_BACK, ["px", "py cφ + pz sφ", "pz cφ - py sφ"], "reversed_position"),
    "−R p": (ABOUT_X, X_BACK, ["-px", "pz sφ - py cφ", "-py sφ - pz cφ"], "position_turned_back"),
    "R, −p": (ABOUT_X, X_TURNED, ["-px", "-py", "-pz"], "negated_for_inverse"),
    "−p in numbers": (IN_NUMBERS, Z_BACK, ["-3", "-1", "-2"], "position_not_turned"),
    "p in numbers": (IN_NUMBERS, Z_BACK, ["3", "1", "2"], "position_not_inverted"),
    "no minus in numbers": (IN_NUMBERS, Z_BACK, ["1", "-3", "2"], "reversed_position"),
    "R, −p in numbers": (IN_NUMBERS, Z_TURNED, ["-3", "-1", "-2"], "negated_for_inverse"),
    "T in numbers": (IN_NUMBERS, Z_TURNED, ["3", "1", "2"], "inverse_transform"),
}


def graded(exercise: Exercise, answer: object) -> PartReport:
    return part(handed_in(exercise, {"it": answer}, feedback=FeedbackLevel.HINTS), "it")


@pytest.mark.parametrize("name", WRONG)
def test_a_slip_in_an_inverse_gets_one_message(name: str, make_exercise: Make) -> None:
    text, rotation, position, code = WRONG[name]
    upper = [[*row, number] for row, number in zip(rotation, position, strict=True)]
    answer = [*upper, ["0", "0", "0", "1"]]
    assert all_codes(graded(make_exercise(text), answer)) == {code}
    if text is IN_NUMBERS:
        bare = make_exercise(text.replace(SYMBOLS, ""))
        assert all_codes(graded(bare, answer)) == {code}


def test_the_transpose_gets_one_message(make_exercise: Make) -> None:
    upper = [[*row, "0"] for row in X_BACK]
    report = graded(make_exercise(ABOUT_X), [*upper, ["px", "py", "pz", "1"]])
    assert all_codes(report) == {"transposed_for_inverse"}


def test_an_inverse_with_the_position_only_negated_is_named(
    catalogue: Mapping[str, Exercise],
) -> None:
    rotation = [["cφ", "sφ", "0"], ["-sφ", "cφ", "0"], ["0", "0", "1"]]
    upper = [[*row, p] for row, p in zip(rotation, ["-px", "-py", "-pz"], strict=True)]
    report = handed_in(catalogue["homogeneous-inverse"], {"about-z": [*upper, [0, 0, 0, 1]]})
    [message] = part(report, "about-z").feedback
    assert message.code == "position_not_turned"
    assert {place.cell for place in message.places or ()} == {"4"}
