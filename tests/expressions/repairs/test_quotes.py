import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("'q1'", "quotes", "'q1'", "q1"),
    ('"q1"', "quotes", '"q1"', "q1"),
    ("“q1”", "quotes", "“q1”", "q1"),
    ("Symbol('q1')", "quotes", "Symbol('q1')", "q1"),
    ('sp.Symbol("q1")', "quotes", 'sp.Symbol("q1")', "q1"),
    ("Symbol('l1')*cos(Symbol('q1'))", "quotes", "Symbol('l1')", "l1*cos(q1)"),
    ('__import__("os").system("ls")', "quotes", '"os")', None),
]

FINE = [
    ("q1", "theta1"),
    ("l1*cos(q1)", "l1*cos(theta1)"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
