import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("c11", "repeated_joint", "c11", None),
    ("s22", "repeated_joint", "s22", None),
    ("c_{11}", "repeated_joint", "c_{11}", None),
]

FINE = [
    ("c12", "cos(theta1 + theta2)"),
    ("cos(2*q1)", "cos(2*theta1)"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
