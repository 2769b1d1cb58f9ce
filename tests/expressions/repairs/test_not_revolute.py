import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("c7", "not_revolute", "c7", None),
    ("s0", "not_revolute", "s0", None),
    ("c3", "not_revolute", "c3", None),
    ("s13", "not_revolute", "s13", None),
    ("c_{13}", "not_revolute", "c_{13}", None),
    ("l1c3", "not_revolute", "c3", None),
    ("C7", "not_revolute", "C7", None),
]

FINE = [
    ("c1", "cos(theta1)"),
    ("s456", "sin(theta4 + theta5 + theta6)"),
    ("d3", "d3"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
