"""Test the reader of formulas, and what it remembers."""

import gc
import threading
from math import acos, asin, atan2, cos, exp, pi, sin, sqrt, tan

import numpy as np
import pytest
from dh_grader.expressions import Expression, ExpressionError, Vocabulary, read, reader
from numpy.typing import NDArray

from tests.expressions.conftest import Values
from tests.expressions.corpus_files import ROBOT, cases, names
from tests.together import together

# --- Compare the values of formulas with Python's own arithmetic

ValuesOf = dict[str, NDArray[np.float64]]

Q1, Q2, D3, Q4, L1, L2, A2, K, BETA = 0.3, 0.5, 0.7, 0.9, 1.1, 1.2, 1.3, 2.0, 0.25

NUMBERS = [
    ("0", 0.0),
    ("1e-3", 1e-3),
    ("2E3", 2000.0),
    (".5", 0.5),
    ("5.", 5.0),
    ("-0.25", -0.25),
    ("½", 0.5),
    ("pi", pi),
    ("π", pi),
    ("3pi", 3 * pi),
    ("-π/2", -pi / 2),
    ("90deg", pi / 2),
    ("90°", pi / 2),
    ("90 degrees", pi / 2),
    ("90º", pi / 2),
    (r"90^\circ", pi / 2),
    (r"90^{\circ}", pi / 2),
    ("deg(90)", pi / 2),
    ("(180/2)deg", pi / 2),
    ("-90°", -pi / 2),
    ("1.57rad", 1.57),
    ("rad(1.57)", 1.57),
    ("2^-1", 0.5),
    ("2**3", 8.0),
    ("-2^2", -4.0),
    ("(-2)^2", 4.0),
    ("2^(3^2)", 512.0),
    ("2--1", 3.0),
    ("+3", 3.0),
    ("2*-3", -6.0),
    ("8/4/2", 1.0),
    ("2−3", -1.0),
    ("2–3", -1.0),
    ("2×3·4", 24.0),
    ("√2", sqrt(2)),
    ("2√(9)", 6.0),
    ("exp(1)", exp(1)),
    ("abs(-3)", 3.0),
    ("tan(1)", tan(1)),
    ("asin(0.5)", asin(0.5)),
    ("arcsin(0.5)", asin(0.5)),
    ("arccos(0.5)", acos(0.5)),
    ("atan2(1, -1)", atan2(1, -1)),
    ("arctan2(1,-1)", atan2(1, -1)),
    ("10" * 50, float("10" * 50)),
]

SYMBOLS = [
    ("2q1", 2 * Q1),
    ("2 q1", 2 * Q1),
    ("l1c1", L1 * cos(Q1)),
    ("l2cos(q1)", L2 * cos(Q1)),
    ("a2(c1+c2)", A2 * (cos(Q1) + cos(Q2))),
    ("(q1)(q2)", Q1 * Q2),
    ("θ1θ2", Q1 * Q2),
    ("sinq1", sin(Q1)),
    ("sin q1", sin(Q1)),
    ("sin θ1 cos θ2", sin(Q1) * cos(Q2)),
    ("sinθ1cosθ2", sin(Q1) * cos(Q2)),
    ("sin 2q1", sin(2 * Q1)),
    ("sin 2 q1 * l1", sin(2 * Q1) * L1),
    ("sin q1 * l1", sin(Q1) * L1),
    ("sin q1 + l1", sin(Q1) + L1),
    ("sin(q1)^2", sin(Q1) ** 2),
    ("sin^2(q1)", sin(Q1) ** 2),
    ("sin^2 q1", sin(Q1) ** 2),
    ("sin²q1", sin(Q1) ** 2),
    ("sin**2(q1)", sin(Q1) ** 2),
    ("sin^2q1 + cos^2q1", 1.0),
    ("sin cos q1", sin(cos(Q1))),
    ("sin 90° cos q1", cos(Q1)),
    ("l1²c1", L1**2 * cos(Q1)),
    ("2q1²", 2 * Q1**2),
    ("-q1^2", -(Q1**2)),
    ("l1^-1", 1 / L1),
    ("l1⁻¹", 1 / L1),
    ("√(l1²+l2²)", sqrt(L1**2 + L2**2)),
    ("√2q1", sqrt(2) * Q1),
    ("½q1", Q1 / 2),
    ("1/2q1", Q1 / 2),
    ("l1/l2/k", L1 / L2 / K),
    ("atan2(s1, c1)", Q1),
    ("abs(-l1)", L1),
    ("β + beta", 2 * BETA),
    ("-s1*(a2*s24 + a2*c2) + l2*c1", -sin(Q1) * (A2 * sin(Q2 + Q4) + A2 * cos(Q2)) + L2 * cos(Q1)),
]

NAMES = [
    *((name, Q1) for name in ("q1", "theta1", "θ1", "θ_1", "θ₁", "ϑ1", r"\theta_1", r"\theta_{1}")),
    *((name, Q1) for name in ("q_1", "q_{1}", "q_{ 1 }", "q₁", "theta_1", "𝜃₁", "q1")),
    *((name, D3) for name in ("d3", "q3", "d_3", "q₃")),
]

SHORTHAND = [
    *((name, cos(Q1 + Q2)) for name in ("c12", "c_12", "c_{12}", "c₁₂", "cθ12", "cθ_{12}", "cq12")),
    *((name, cos(Q1 + Q2)) for name in ("cos_12", r"\cos_{12}", "cosθ12", "ctheta12")),
    ("s1", sin(Q1)),
    ("cθ1", cos(Q1)),
    ("s124", sin(Q1 + Q2 + Q4)),
    ("c1s2", cos(Q1) * sin(Q2)),
    ("c1^2", cos(Q1) ** 2),
    ("cosθ1", cos(Q1)),
    ("cos12", cos(Q1 + Q2)),
    ("sin90", sin(90)),
]

MARKED = [
    ("θ1*", Q1),
    ("q1 *", Q1),
    ("d3*", D3),
    ("(q2*)", Q2),
    ("-q2*", -Q2),
    ("θ2* + 90°", Q2 + pi / 2),
    ("θ2*+90°", Q2 + pi / 2),
    ("q1* - 1", Q1 - 1),
    ("q2*-1", -Q2),
    ("q1*q2", Q1 * Q2),
    ("q1* 2", 2 * Q1),
    ("q1**2", Q1**2),
    ("sin(q1*)", sin(Q1)),
]


@together(("text", "expected"), [*NUMBERS, *SYMBOLS, *NAMES, *SHORTHAND, *MARKED])
def test_a_text_has_its_value(
    text: str, expected: float, arm: Vocabulary, values: ValuesOf
) -> None:
    assert np.ravel(read(text, arm).evaluate(values)) == pytest.approx([expected], rel=1e-14)


@pytest.mark.parametrize("number", [0, -7, 90, 0.5, -1e-9, 1e300, 10**300])
def test_a_json_number_keeps_its_value(number: float, arm: Vocabulary) -> None:
    assert read(number, arm).evaluate({}) == float(number)


def test_an_expression_has_the_canonical_names_of_its_symbols(arm: Vocabulary) -> None:
    assert read("q3 + s12*l1 + π", arm).symbols == {"d3", "theta1", "theta2", "l1"}


# --- Test which expressions are memoized

LONG = "c1*(c2*(c4*d3 - s4*l1) - s2*k*l2) - s1*(s4*l1 + c4*d3) + 0.{}"
READABLE = [case.text for name in names() for case in cases(name)]
SAMPLES = {symbol.name: np.linspace(-2, 2, 16) for symbol in ROBOT.symbols}


def _tracked() -> int:
    for _ in range(3):
        gc.collect()
    return len(gc.get_objects())


def _readable(text: str) -> Expression | None:
    try:
        return read(text, ROBOT)
    except ExpressionError:
        return None


def test_a_memoized_text_is_at_most_five_objects(arm: Vocabulary, values: Values) -> None:
    # A formula with fifty nodes must cost the garbage collector no more than a name.
    before = _tracked()
    for number in range(100, 600):
        read(LONG.format(number), arm).evaluate(values)
    reader._parsed.cache_clear()
    assert _tracked() - before < 5 * 500


@pytest.mark.parametrize(
    ("text", "quantity", "angle_unit"),
    [
        ("-s1*(d3*s2 + 2 k) + θ_1", "number", "radians"),
        (r"\frac{\pi}{2} - \cos\theta_1", "number", "radians"),
        ("cosd(60) + q1", "number", "radians"),
        ("2*(q1 + 45) - 90", "angle", "degrees"),
        ("2*(q1 + 45) - 90", "number", "degrees"),
        ("sin(30)", "number", "degrees"),
        (0.25, "length", "radians"),
    ],
)
def test_a_tree_that_is_parsed_again_is_the_same(
    text: str | float, quantity: object, angle_unit: object, arm: Vocabulary
) -> None:
    expression = read(text, arm, quantity=quantity, angle_unit=angle_unit)  # type: ignore[arg-type]
    first = expression.tree
    reader._parsed.cache_clear()
    again = expression.tree
    assert again is not first
    # Equality ignores places in the text, but the repr contains them.
    assert repr(again) == repr(first)


def test_a_tree_given_without_options_is_stored(arm: Vocabulary) -> None:
    tree = read("2*l1", arm).tree
    expression = Expression("l1", tree, (), frozenset({"l1"}))
    assert expression.tree is tree
    assert expression.evaluate({"l1": np.array([3.0])}) == [6.0]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("0.5", True),
        (".5", True),
        ("5.*q1", True),
        ("l1 + 0.707*c1", True),
        (0.5, True),
        ("5", False),
        (5, False),
        ("1/2", False),
        ("np.cos(q1)", False),
    ],
)
def test_has_decimal_is_true_for_decimal_numbers(
    text: str | float, expected: bool, arm: Vocabulary
) -> None:
    assert read(text, arm).has_decimal is expected


def test_a_shared_memo_changes_no_value() -> None:
    # Values are equal to the last bit, with and without a memo, in any order.
    expressions = [each for text in READABLE if (each := _readable(text)) is not None]
    assert len(expressions) > 100
    alone = [np.asarray(each.evaluate(SAMPLES)) for each in expressions]
    for order in (expressions, expressions[::-1]):
        memo: dict[str, object] = {}
        shared = {id(each): np.asarray(each.evaluate(SAMPLES, memo)) for each in order}
        for each, value in zip(expressions, alone, strict=True):
            np.testing.assert_array_equal(shared[id(each)], value, each.source)


def test_threads_that_read_the_same_texts_agree() -> None:
    texts = [f"{text} + 0*{number}" for number, text in enumerate(READABLE[:60])]
    expected = [None if (each := _readable(text)) is None else str(each.text()) for text in texts]
    for memoized in reader._reader_memoized:
        memoized.cache_clear()
    reader._parsed.cache_clear()
    together = threading.Barrier(4)
    found: list[list[str | None]] = []

    def read_all() -> None:
        together.wait()
        expressions = [_readable(text) for text in texts]
        found.append([None if each is None else each.text() for each in expressions])

    threads = [threading.Thread(target=read_all) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [expected] * 4
