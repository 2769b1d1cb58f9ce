import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("90⁰", "raised_zero", "⁰", "90°"),
    ("90^o", "raised_zero", "^o", "90°"),
    ("90^{o}", "raised_zero", "^{o}", "90°"),
    ("θ₁ + 90⁰", "raised_zero", "⁰", "θ₁ + 90°"),
]

FINE = [
    ("90°", "90deg"),
    ("k^0", "k^0"),
    (r"90^\circ", "90deg"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
