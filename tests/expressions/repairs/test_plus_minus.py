import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("±90", "two_values", "±", None),
    ("± q1", "two_values", "±", None),
    ("∓1", "two_values", "∓", None),
    (r"\pm 90", "two_values", r"\pm", None),
    (r"\mp q_1", "two_values", r"\mp", None),
    ("+/- 90", "two_values", "+/-", None),
    ("+/-q1", "two_values", "+/-", None),
]

FINE = [
    ("+90", "90"),
    ("-90", "-90"),
    ("1 + -2", "1 + (-2)"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
