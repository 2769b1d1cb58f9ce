import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("1.2.3", "malformed_number", "1.2.3", None),
    ("1.2.3 + q1", "malformed_number", "1.2.3", None),
]

FINE = [
    ("1.23", "1.23"),
    ("1.5*2.5", "1.5*2.5"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
