import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("q1 & q2", "unexpected_character", "&", None),
    ("q1 → q2", "unexpected_character", "→", None),
    ("q1 ! 2", "unexpected_character", "!", None),
    ("q1 @ q2", "unexpected_character", "@", None),
    ("q1 ~ q2 ?", "unexpected_character", "?", None),
    ("😀", "unexpected_character", "😀", None),
    ("∠q1", "unexpected_character", "∠", None),
    ("٣", "unexpected_character", "٣", None),
    ("q1.__class__", "unexpected_character", ".", None),
    ("50%", "unexpected_character", "%", None),
]

FINE = [
    ("k/2", "k/2"),
    ("q1 ~ q2", "theta1*theta2"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
