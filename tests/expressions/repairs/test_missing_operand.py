import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("*q1", "missing_operand", "*", None),
    ("/2", "missing_operand", "/", None),
    ("^2", "missing_operand", "^", None),
    ("q1 */ q2", "missing_operand", "*", None),
    ("q1 + * q2", "missing_operand", "+", None),
    ("2*(+)", "missing_operand", "+", None),
    ("()", "missing_operand", "()", None),
    ("deg", "missing_operand", "deg", None),
    ("°", "missing_operand", "°", None),
    (r"\frac{}{2}", "missing_operand", "{}", None),
    (r"\frac{1}{}", "missing_operand", "{}", None),
    ("PI()", "missing_operand", "()", "PI"),
    ("PI()/2", "missing_operand", "()", "PI/2"),
]

FINE = [
    ("+q1", "theta1"),
    ("k*-2", "k*(-2)"),
    ("pi", "pi"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
