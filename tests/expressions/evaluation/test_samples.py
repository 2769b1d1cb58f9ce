"""Evaluate formulas for many values of their symbols at once."""

from math import cos, isinf, isnan

import numpy as np
import pytest
from dh_grader.expressions import Symbol, Vocabulary, evaluate_all, read

from tests.expressions.conftest import Values
from tests.expressions.corpus_files import ROBOT

L2, Q1, Q2 = 1.2, 0.3, 0.5
SAMPLES = {symbol.name: np.linspace(-2, 2, 16) for symbol in ROBOT.symbols}


def test_all_samples_are_evaluated_at_once(arm: Vocabulary) -> None:
    angles = np.linspace(-3, 3, 32)
    result = read("2 s1 c1", arm).evaluate({"theta1": angles})
    assert result == pytest.approx(np.sin(2 * angles))


@pytest.mark.parametrize(
    "text", ["sqrt(-1)", "0/0", "asin(2)", "(-8)^(1/3)", "sqrt(-l1)", "acos(k)"]
)
def test_an_undefined_value_is_nan(text: str, arm: Vocabulary, values: Values) -> None:
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
