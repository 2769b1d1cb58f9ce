import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("cos()", "function_without_argument", "cos", None),
    ("sin", "function_without_argument", "sin", None),
    ("sin + 1", "function_without_argument", "sin", None),
    ("l1 cos", "function_without_argument", "cos", None),
    ("2 sin()", "function_without_argument", "sin", None),
    ("sin -q1", "function_without_argument", "sin", "sin(-q1)"),
    ("cos -theta1", "function_without_argument", "cos", "cos(-theta1)"),
    ("sin * q1", "function_without_argument", "sin", None),
    ("sin^2", "function_without_argument", "sin", None),
    ("tan^2 + 1", "function_without_argument", "tan", None),
    ("atan2()", "function_without_argument", "atan2", None),
    ("cos(q1)sin", "function_without_argument", "sin", None),
]

FINE = [
    ("sin(-q1)", "sin(-theta1)"),
    ("sin q1", "sin(theta1)"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
