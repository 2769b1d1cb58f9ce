"""Recognise whether a formula is a length, an angle or a number."""

import pytest
from dh_grader.expressions import Symbol, Vocabulary, joint_variable, read
from dh_grader.grading.diagnosis.formulas import quantity_of

WORDS = Vocabulary([joint_variable(1), joint_variable(2), Symbol("l1", "length")])


@pytest.mark.parametrize(
    ("text", "quantity"),
    [
        ("90deg", "angle"),
        ("-pi/2", "angle"),
        ("q1 + 90", "angle"),
        ("2*q1", "angle"),
        ("atan2(l1, 2)", "angle"),
        ("l1", "length"),
        ("-l1/2", "length"),
        ("l1 c1", "length"),
        ("l1 + 0.3", "length"),
        ("1.6", "number"),
        ("l1/l1", "number"),
        ("sin(q1)", "number"),
        ("2^3", "number"),
        ("l1*l1", None),
        ("l1^2", None),
        ("l1 + q1", None),
        ("sqrt(l1)", None),
        ("+".join(["l1"] * 80), None),
    ],
)
def test_the_quantity_of_a_formula(text: str, quantity: str | None) -> None:
    assert quantity_of(read(text, WORDS).tree) == quantity
