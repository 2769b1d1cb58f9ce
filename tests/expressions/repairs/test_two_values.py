import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("q1, q2", "two_values", ",", None),
    ("q1; q2", "two_values", ";", None),
    ("q1 ; q2", "two_values", ";", None),
    ("1 2", "two_values", "1 2", None),
    ("2 3", "two_values", "2 3", None),
    ("2 3 4", "two_values", "2 3", None),
    ("q1 2", "two_values", "q1 2", None),
    ("2 q1 3", "two_values", "q1 3", None),
    ("(q1)2", "two_values", ")2", None),
    ("cos(q1)2", "two_values", ")2", None),
    ("q1\tq2", "two_values", "q1\tq2", None),
]

FINE = [
    ("q1 q2", "theta1*theta2"),
    ("2 k", "2*k"),
    ("(2)(3)", "2*3"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
