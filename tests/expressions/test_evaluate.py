"""Test the values of formulas."""

import math
from math import cos, isinf, isnan

import numpy as np
import pytest
from dh_grader.expressions import (
    Symbol,
    Vocabulary,
    decimals_of,
    evaluate_all,
    joint_variable,
    read,
)
from dh_grader.expressions.evaluate import known_values, value_at
from dh_grader.expressions.vocabulary import Binary, Number

from tests.expressions.conftest import Values
from tests.expressions.corpus_files import ROBOT

# --- Compute the value of a formula for one value of each symbol

VOCABULARY = Vocabulary([joint_variable(1), joint_variable(2), Symbol("l1", "length")])
AT = {"theta1": 0.7, "theta2": -1.9, "l1": 0.4}


@pytest.mark.parametrize(
    "text",
    [
        "3",
        "pi/2",
        "-q1 + q2*l1 - 2",
        "l1*c12 - s1^2/2",
        "sqrt(l1) + abs(q2) + exp(q1)",
        "atan2(l1, q2) + tan(q1) + asin(l1) + acos(l1) + atan(q2)",
        "cos(90deg - q1) + sin(2 rad)",
        "2^-3 + q1^3",
    ],
)
def test_the_value_is_that_of_the_program(text: str) -> None:
    expression = read(text, VOCABULARY)
    expected = expression.evaluate({name: np.array([value]) for name, value in AT.items()})
    assert value_at(expression.tree, AT, {}) == pytest.approx(float(np.ravel(expected)[0]))
    known = known_values(expression.tree, AT)
    assert known[id(expression.tree)] == pytest.approx(float(np.ravel(expected)[0]))


@pytest.mark.parametrize(
    "text", ["1/0", "sqrt(-1)", "q2^0.5", "asin(2)", "exp(1000)", "10^400", "q1 + 1/(q2 - q2)"]
)
def test_an_undefined_value_is_nan(text: str) -> None:
    tree = read(text, VOCABULARY).tree
    assert math.isnan(value_at(tree, AT, {}))
    assert math.isnan(value_at(tree, AT, known_values(tree, AT)))


def test_a_known_value_is_not_computed_again() -> None:
    tree = read("l1*c1", VOCABULARY).tree
    known = {id(tree): 40.0}
    assert value_at(Binary("+", tree, Number(2.0, "2")), {}, known) == 42.0


# --- Find the rounded decimals in a formula

ARM = Vocabulary([joint_variable(1)])


@pytest.mark.parametrize(
    ("text", "units"),
    [
        ("1.57", [0.01]),
        ("0.100", [0.001]),
        ("0.0505", [0.0001]),
        ("1.57e-2", [0.0001]),
        ("q1 + 1.5708", [0.0001]),
        ("0.866 c1 + 2.50 s1", [0.001, 0.01]),
        ("1.6", []),
        ("0.05", []),
        ("0.000", []),
        ("57", []),
        ("1000", []),
        ("1000.", []),
        ("1e-3", []),
    ],
)
def test_the_unit_of_a_decimal_is_one_in_its_last_place(text: str, units: list[float]) -> None:
    assert decimals_of(read(text, ARM)).units == pytest.approx(units)


def test_a_shift_moves_a_decimal_by_units() -> None:
    decimals = decimals_of(read("2*cos(q1) + 0.125*q1 - 57.3deg", ARM))
    q1 = np.array([0.0, 1.0])
    found = decimals.shifted(np.array([[0.0, 0.0], [1.0, 0.0], [0.0, -0.5]]), {"theta1": q1})
    written = 2 * np.cos(q1) + 0.125 * q1 - np.radians(57.3)
    assert found[0] == pytest.approx(written)
    assert found[1] == pytest.approx(written + 0.001 * q1)
    assert found[2] == pytest.approx(written + np.radians(0.05))


@pytest.mark.parametrize(
    ("text", "sign"),
    [
        ("1.571", 1), ("-1.571", -1), ("(1.571)", 1), ("1.571 + 0", 0), ("2*1.571", 0),
        ("1.571*q1", 0), ("sin(1.571)", 0), ("90.0deg", 0), ("1.57 + 1.57", 0), ("q1", 0),
    ],
)  # fmt: skip
def test_only_a_single_decimal_has_a_sign(text: str, sign: int) -> None:
    assert decimals_of(read(text, ARM)).sign == sign


# --- Evaluate formulas for many values of their symbols at once

L2, Q1, Q2 = 1.2, 0.3, 0.5
SAMPLES = {symbol.name: np.linspace(-2, 2, 16) for symbol in ROBOT.symbols}


def test_all_samples_are_evaluated_at_once(arm: Vocabulary) -> None:
    angles = np.linspace(-3, 3, 32)
    result = read("2 s1 c1", arm).evaluate({"theta1": angles})
    assert result == pytest.approx(np.sin(2 * angles))


@pytest.mark.parametrize(
    "text", ["sqrt(-1)", "0/0", "asin(2)", "(-8)^(1/3)", "sqrt(-l1)", "acos(k)"]
)
def test_an_undefined_value_is_nan_in_its_sample(
    text: str, arm: Vocabulary, values: Values
) -> None:
    assert all(map(isnan, np.ravel(read(text, arm).evaluate(values))))


UNDEFINED_WITHIN = [
    *("1/(1/0)", "sqrt(-1)^0", "1^sqrt(-1)", "exp(-1/0)", "atan(1/0)", "2^(-1/0)", "atan2(1, 1/0)"),
    *("1/(1/(k-k))", "sqrt(-l1)^0", "1^asin(k)", "exp(-1/(k-k))", "atan(l1/(k-k))"),
    *("l1/(l2 + 1/(k-k))", "atan2(1/(k-k), 1)", "abs(1/(1/(k-k)))", "cos(1/(1/0))"),
]


@pytest.mark.parametrize("text", UNDEFINED_WITHIN)
def test_a_formula_with_an_undefined_part_is_undefined(
    text: str, arm: Vocabulary, values: Values
) -> None:
    # 1/(1/0) is not 0; Python raises an error there, too.
    assert all(map(isnan, np.ravel(read(text, arm).evaluate(values))))


def test_an_undefined_sample_does_not_affect_other_samples(arm: Vocabulary) -> None:
    result = read("1/(1/k) + sqrt(k)^0", arm).evaluate({"k": np.array([-1.0, 0.0, 2.0])})
    np.testing.assert_array_equal(result, [np.nan, np.nan, 3.0])


@pytest.mark.parametrize("text", ["1/0", "exp(10^9)", "l1/(k-k)", "10^300*10^300", "0^-1"])
def test_an_overflow_is_infinite(text: str, arm: Vocabulary, values: Values) -> None:
    assert all(map(isinf, np.ravel(read(text, arm).evaluate(values))))


def test_expressions_share_a_memo(arm: Vocabulary, values: Values) -> None:
    memo: dict[str, object] = {}
    first = read("l1 cos(q1 + q2)", arm).evaluate(values, memo)
    known = len(memo)
    second = read("l1*c12", arm).evaluate(values, memo)
    assert second is first
    assert len(memo) == known
    third = read("l2 c12", arm).evaluate(values, memo)
    assert third == pytest.approx([L2 * cos(Q1 + Q2)])
    assert len(memo) == known + 1


def test_constants_are_folded(arm: Vocabulary, values: Values) -> None:
    memo: dict[str, object] = {}
    assert read("sin(30deg)*2^3", arm).evaluate(values, memo) == pytest.approx(4.0)
    assert not memo


def test_a_part_that_two_texts_share_is_computed_once() -> None:
    memo: dict[str, object] = {}
    product = read("l1*c1", ROBOT).evaluate(SAMPLES, memo)
    assert read("l1 cos(θ1)", ROBOT).evaluate(SAMPLES, memo) is product
    assert read("l1*c1", ROBOT).evaluate(SAMPLES, {}) is not product


def test_a_symbol_called_inf_is_not_infinite() -> None:
    vocabulary = Vocabulary([Symbol("inf", "number"), Symbol("nan", "number")])
    values = {"inf": np.array([2.0]), "nan": np.array([3.0])}
    assert read("inf - 10^400", vocabulary).evaluate(values) == [-np.inf]
    assert read("inf*nan", vocabulary).evaluate(values) == [6.0]


def test_evaluating_all_at_once_gives_the_same_values() -> None:
    texts = ["2", "k", "k/0", "sqrt(k)", "1/0", "l1*c1"]
    expressions = [read(text, ROBOT) for text in texts]
    found = evaluate_all([*expressions, None], SAMPLES, {})
    for expression, value in zip(expressions, found, strict=False):
        np.testing.assert_array_equal(value, expression.evaluate(SAMPLES))
    assert np.isnan(found[-1])
