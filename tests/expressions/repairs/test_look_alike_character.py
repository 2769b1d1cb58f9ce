import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("а2", "look_alike_character", "а", "a2"),
    ("с1", "look_alike_character", "с", "c1"),
    ("2*а2 + с1", "look_alike_character", "а", "2*a2 + c1"),
    ("ß", "look_alike_character", "ß", "β"),
    ("ɑ1", "look_alike_character", "ɑ", "α1"),
]

FINE = [
    ("a2", "a2"),
    ("α₁", "alpha1"),
    ("ϑ₁", "theta1"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
