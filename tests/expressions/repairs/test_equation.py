import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("θ1 = q1", "equation", "=", "q1"),
    ("theta1 = q1 + 90deg", "equation", "=", "q1 + 90deg"),
    ("q1 == 0", "equation", "==", "0"),
    ("a = l1", "equation", "=", "l1"),
    ("=COS(q1)", "equation", "=", "COS(q1)"),
    ("= l1", "equation", "=", "l1"),
    ("d := 0.5", "equation", ":=", "0.5"),
    ("l1 = 0.5 = k", "equation", "=", "k"),
    ("q1 =", "equation", "=", "q1"),
    (r"\theta_1 = q_1", "equation", "=", "q_1"),
    ("x ≈ 0.5", "equation", "≈", "0.5"),
]

FINE = [
    ("q1 + pi", "theta1 + pi"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
