import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("L1", "wrong_case", "L1", "l1"),
    ("2*L1", "wrong_case", "L1", "2*l1"),
    ("L1*cos(q1)", "wrong_case", "L1", "l1*cos(q1)"),
    ("Theta1", "wrong_case", "Theta1", "theta1"),
    ("THETA1", "wrong_case", "THETA1", "theta1"),
    ("Q1", "wrong_case", "Q1", "q1"),
    ("A2", "wrong_case", "A2", "a2"),
    ("L1C1 + L2C12", "wrong_case", "L1C1", "l1c1 + l2c12"),
    ("K", "wrong_case", "K", "k"),
]

FINE = [
    ("l1", "l1"),
    ("C1", "cos(theta1)"),
    ("COS(q1)", "cos(theta1)"),
    ("PI", "pi"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
