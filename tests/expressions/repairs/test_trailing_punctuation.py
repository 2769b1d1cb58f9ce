import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("q1,", "trailing_punctuation", ",", "q1"),
    ("q1.", "trailing_punctuation", ".", "q1"),
    ("l1*cos(q1),", "trailing_punctuation", ",", "l1*cos(q1)"),
    ("q1:", "trailing_punctuation", ":", "q1"),
    ("q1 q1.", "trailing_punctuation", ".", "q1 q1"),
]

FINE = [
    ("5.", "5."),
    ("q1;", "theta1"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
