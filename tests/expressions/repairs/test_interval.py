import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("1..2", "interval", "..", None),
    ("[0, pi]", "interval", "[0, pi]", None),
    ("[0, 1)", "interval", "[0, 1)", None),
    ("(0, 1]", "interval", "(0, 1]", None),
    ("0 < q1 < pi", "interval", "<", None),
    ("q1 > 0", "interval", ">", None),
    ("-180..180", "interval", "..", None),
    ("0 to pi", "interval", "to", None),
    ("-180:180", "interval", ":", None),
    ("θ₁ ∈ [0, π]", "interval", "∈", None),
    ("l1 ≤ l2", "interval", "≤", None),
]

FINE = [
    ("[q1 + q2]*k", "(theta1 + theta2)*k"),
    ("[1]", "1"),
    ("atan2(l1, l2)", "atan2(l1, l2)"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
