import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("1" * 501, "too_long", "1", None),
    ("-" * 41 + "1", "too_deep", "-" * 41 + "1", None),
    ("k+" * 110 + "k", "too_many_nodes", "k+" * 110 + "k", None),
    ("(" * 41 + "1" + ")" * 41, "too_deep", "(", None),
]

FINE = [
    ("(" * 40 + "1" + ")" * 40, "1"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
