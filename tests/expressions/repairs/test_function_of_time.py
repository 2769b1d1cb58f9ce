import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("q1(t)", "function_of_time", "t", "q1"),
    ("cos(q1(t))", "function_of_time", "t", "cos(q1)"),
    ("theta1(t) + theta2(t)", "function_of_time", "t", "theta1 + theta2"),
    ("l1*cos(q1(t) + q2(t))", "function_of_time", "t", "l1*cos(q1 + q2)"),
]

FINE = [
    ("q1*k", "theta1*k"),
    ("q1(k)", "theta1*k"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
