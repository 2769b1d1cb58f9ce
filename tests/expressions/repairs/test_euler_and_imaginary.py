import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("e", "unknown_symbol", "e", None),
    ("e^2", "unknown_symbol", "e", None),
    ("2e", "unknown_symbol", "e", None),
    ("i", "unknown_symbol", "i", None),
    ("2j", "unknown_symbol", "j", None),
    ("1 + 2i", "unknown_symbol", "i", None),
]

FINE = [
    ("exp(1)", "exp(1)"),
    ("1e3", "1e3"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
