import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("2 x q1", "letter_x", "x", "2 * q1"),
    ("2x3", "letter_x", "x", "2*3"),
    ("l1 x l2", "letter_x", "x", "l1 * l2"),
    ("2 X k", "letter_x", "X", "2 * k"),
]

FINE = [
    ("2 × k", "2*k"),
    ("2*k", "2*k"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
