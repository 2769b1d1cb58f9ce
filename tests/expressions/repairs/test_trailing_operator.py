import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("q1 +", "trailing_operator", "+", "q1"),
    ("q1 -", "trailing_operator", "-", "q1"),
    ("k /", "trailing_operator", "/", "k"),
    ("k^", "trailing_operator", "^", "k"),
    ("l1*cos(q1) +", "trailing_operator", "+", "l1*cos(q1)"),
]

FINE = [
    ("q1*", "theta1"),
    ("q1 + 0", "theta1 + 0"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
