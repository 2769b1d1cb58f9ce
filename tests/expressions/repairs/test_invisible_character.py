import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("q\u200b1", "invisible_character", "\u200b", "q1"),
    ("\u200bq\u200b1\u200b", "invisible_character", "\u200b", "q1"),
    ("1\u202e- 2", "invisible_character", "\u202e", "1- 2"),
    ("\ufeff1", "invisible_character", "\ufeff", "1"),
    ("2\u2062q1", "invisible_character", "\u2062", "2*q1"),
    ("cos\u2061(q1)", "invisible_character", "\u2061", "cos(q1)"),
    ("q̇1", "invisible_character", "̇", None),
]

FINE = [
    ("q1\xa0+\u2009q2", "theta1 + theta2"),
    ("q1 + q2", "theta1 + theta2"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
