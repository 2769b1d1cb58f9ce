import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("c7", "not_revolute", "c7", None),
    ("s0", "not_revolute", "s0", None),
    ("c3", "not_revolute", "c3", None),
    ("c123", "not_revolute", "c123", "c12"),
    ("s13", "not_revolute", "s13", "s1"),
    ("c_{123}", "not_revolute", "c_{123}", "c_{12}"),
    ("c₁₂₃", "not_revolute", "c₁₂₃", "c₁₂"),
    (r"c\theta_{123}", "not_revolute", r"c\theta_{123}", r"c\theta_{12}"),
    ("a1*c123 + a2*s123", "not_revolute", "c123", "a1*c12 + a2*s12"),
    ("c127", "not_revolute", "c127", None),
    ("c1237", "not_revolute", "c1237", None),
    ("c1233", "not_revolute", "c1233", None),
    ("c1123", "not_revolute", "c1123", None),
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
