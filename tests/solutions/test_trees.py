"""Print SymPy expressions in students' notation."""

from collections.abc import Callable

import pytest
import sympy
from dh_grader.catalogue import Exercise
from dh_grader.expressions import read
from dh_grader.expressions.printing import to_text
from dh_grader.solutions.algebra import Algebra, Writer

ARM = """
title = "An arm"
source = "made for this test"
statement = "Three joints."
[robot]
structure = "RRP"
convention = "standard"
joints = ["q1", "q2", "q3"]
table = [["a", "0", "0", "q1"], ["b", "0", "0", "q2"], ["0", "0", "q3", "0"]]
[symbols]
a = { kind = "length", description = "a length" }
b = { kind = "length", description = "a length" }
s2 = { kind = "length", description = "takes the shorthand's place" }
phi = { kind = "angle", description = "an angle" }
[[parts]]
id = "pose"
kind = "transform"
title = "Pose"
"""


@pytest.fixture
def arm(make_exercise: Callable[[str], Exercise]) -> Exercise:
    return make_exercise(ARM)


# A formula, and how the model solution prints it.
FORMULAS = {
    "cos(q1 + q2)": "c12",
    "sin(q2)": "sin(q2)",  # s2 is a length here
    "cos(phi)": "cos(phi)",
    "cos(q1 - q2)": "cos(q1 - q2)",
    "-sin(q1)*cos(q2)": "-s1*c2",
    "cos(q1)*a": "a*c1",
    "b*cos(q1+q2) + a*cos(q1)": "a*c1 + b*c12",
    "q3 + a": "a + q3",
    "-a - b": "-a - b",
    "cos(q1)*(-a - b)": "-c1*(a + b)",
    "0.27035 + a": "0.27035 + a",
    "a/3": "a/3",
    "0.25*a": "a/4",
    "1/7": "1/7",
    "1e-3*a": "0.001*a",
    "3*a/2": "3*a/2",
    "sqrt(3)/2*a": "sqrt(3)*a/2",
    "a/sqrt(b)": "a/sqrt(b)",
    "1/a": "1/a",
    "a^2*b": "a^2*b",
    "cos(q1)^2": "c1^2",
    "tan(q1)": "tan(q1)",
    "abs(phi)": "abs(phi)",
    "atan2(a, cos(phi))": "atan2(a, cos(phi))",
    "exp(a)": "exp(a)",
    "acos(a/b)": "acos(a/b)",
    "cos(phi + 0.5)": "cos(phi + (1/2)rad)",
    "cos(phi + 30deg)": "cos(phi + pi/6)",
    "2 - 2*cos(phi)": "2 - 2*cos(phi)",
}


@pytest.mark.parametrize("formula", FORMULAS)
def test_a_formula_is_printed_in_a_textbooks_form(formula: str, arm: Exercise) -> None:
    algebra, writer = Algebra(arm), Writer(arm)
    written = to_text(writer.number(algebra.of(read(formula, arm.vocabulary))))
    assert written == FORMULAS[formula]
    again, first = (algebra.of(read(text, arm.vocabulary)) for text in (written, formula))
    assert sympy.expand(again - first) == 0


ANGLES = {
    "phi + 0.5": "phi + (1/2)rad",
    "phi - 0.7": "phi - 0.7rad",
    "-90deg": "-pi/2",
    "q1 - pi/2": "q1 - pi/2",
    "pi - phi": "pi - phi",
    "0": "0",
}


@pytest.mark.parametrize("formula", ANGLES)
def test_a_printed_angle_means_the_same_in_degrees(formula: str, arm: Exercise) -> None:
    algebra, writer = Algebra(arm), Writer(arm)
    expected = algebra.of(read(formula, arm.vocabulary, quantity="angle"))
    written = to_text(writer.angle(expected))
    assert written == ANGLES[formula]
    for unit in ("radians", "degrees"):
        again = read(written, arm.vocabulary, quantity="angle", angle_unit=unit)
        assert sympy.simplify(algebra.of(again) - expected) == 0


def test_the_meaning_of_each_shorthand_is_recorded(arm: Exercise) -> None:
    algebra, writer = Algebra(arm), Writer(arm)
    writer.number(algebra.of(read("cos(q1 + q2) + sin(q1)", arm.vocabulary)))
    assert writer.used == {"c12": "cos(q1 + q2)", "s1": "sin(q1)"}
