import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("(q1 + 90)deg", "unit_on_variable", "(q1 + 90)deg", None),
    ("q1 deg", "unit_on_variable", "q1 deg", "q1"),
    ("q1°", "unit_on_variable", "q1°", "q1"),
    ("θ₁°", "unit_on_variable", "θ₁°", "θ₁"),
    ("l1 deg", "unit_on_variable", "l1 deg", "l1"),
]

FINE = [
    ("q1 + 90deg", "theta1 + 90deg"),
    ("90k deg", "90*k deg"),
    ("k deg", "k deg"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
