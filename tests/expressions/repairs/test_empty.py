import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("", "empty", "", None),
    ("  ", "empty", "  ", None),
]

FINE = [
    ("0", "0"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
