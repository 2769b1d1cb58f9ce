import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("2^3^2", "chained_power", "^", None),
    ("q1^2^3", "chained_power", "^", None),
    ("2**3**2", "chained_power", "**", None),
    ("k^-2^3", "chained_power", "^", None),
    ("9**9**9", "chained_power", "**", None),
]

FINE = [
    ("(2^3)^2", "(2^3)^2"),
    ("2^(3^2)", "2^(3^2)"),
    ("2^-3", "2^-3"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
