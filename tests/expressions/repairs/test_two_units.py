import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("90°°", "two_units", "90°°", None),
    ("90 deg rad", "two_units", "90 deg rad", None),
    ("deg(90°)", "two_units", "90°)", None),
]

FINE = [
    ("90deg + 1rad", "90deg + 1rad"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
