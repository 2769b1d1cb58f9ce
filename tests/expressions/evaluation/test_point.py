"""Compute the value of a formula for one value of each symbol."""

import math

import numpy as np
import pytest
from dh_grader.expressions import Symbol, Vocabulary, joint_variable, read
from dh_grader.expressions.evaluate import known_values, value_at
from dh_grader.expressions.vocabulary import Binary, Number

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
