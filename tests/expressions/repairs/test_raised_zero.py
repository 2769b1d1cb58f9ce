import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("90⁰", "raised_zero", "⁰", "90°"),
    ("90^o", "raised_zero", "^o", "90°"),
    ("90^{o}", "raised_zero", "^{o}", "90°"),
    ("θ₁ + 90⁰", "raised_zero", "⁰", "θ₁ + 90°"),
    (r"45^{\text{o}}", "raised_zero", r"^{\text{o}}", "45°"),
    (r"45^\mathrm{o}", "raised_zero", r"^\mathrm{o}", "45°"),
    ("θ1 + 90o", "raised_zero", "o", "θ1 + 90°"),
    ("90^0", "raised_zero", "^0", "90°"),
    ("90^{0}", "raised_zero", "^{0}", "90°"),
    ("90 ^ 0", "raised_zero", "^ 0", "90 °"),
    ("90**0", "raised_zero", "**0", "90°"),
    ("-90^0", "raised_zero", "^0", "-90°"),
    ("22.5^0", "raised_zero", "^0", "22.5°"),
    ("0^0", "raised_zero", "^0", "0°"),
    ("10^0", "raised_zero", "^0", "10°"),
    ("(-90)^0", "raised_zero", "^0", "(-90)°"),
    ("(-90)⁰", "raised_zero", "⁰", "(-90)°"),
    ("90 ⁰", "raised_zero", "⁰", "90 °"),
    ("(180/2)^0", "raised_zero", "^0", "(180/2)°"),
    (r"\frac{180^0}{2}", "raised_zero", "^0", r"\frac{180°}{2}"),
    ("cos(30^{0})", "raised_zero", "^{0}", "cos(30°)"),
    ("cos 30^0", "raised_zero", "^0", "cos 30°"),
    ("theta1 + 90^{0}", "raised_zero", "^{0}", "theta1 + 90°"),
    # An O that stands on the line may be a nought.
    ("9O", "unknown_symbol", "O", None),
]

FINE = [
    ("90°", "90deg"),
    ("k^0", "k^0"),
    ("(l1 + l2)^0", "(l1 + l2)^0"),
    ("cos(q1)^0", "cos(theta1)^0"),
    ("3*10^0", "3*10^0"),
    (r"1 \cdot 10^{0}", "1*10^0"),
    ("2^3", "2^3"),
    ("0^2", "0^2"),
    ("10^-1", "10^-1"),
    (r"90^\circ", "90deg"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
