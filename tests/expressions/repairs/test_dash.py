import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("-", "dash", "-", "0"),
    ("–", "dash", "–", "0"),
    ("—", "dash", "—", "0"),
    ("--", "dash", "--", "0"),
]

FINE = [
    ("-1", "-1"),
    ("0 - 0", "0 - 0"),
    ("−k", "-k"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
