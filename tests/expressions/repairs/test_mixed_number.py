import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("2½", "two_values", "½", "2 + 1/2"),
    ("2 ½", "two_values", "½", "2 + 1/2"),
    ("1½ l1", "two_values", "½", "(1 + 1/2) l1"),
    (r"2\frac{1}{2}", "two_values", r"\frac{1}{2}", "2 + 1/2"),
]

FINE = [
    ("½", "1/2"),
    ("2*½", "2*(1/2)"),
    ("½ l1", "1/2*l1"),
    (r"l_1\frac{1}{2}", "l1*(1/2)"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
