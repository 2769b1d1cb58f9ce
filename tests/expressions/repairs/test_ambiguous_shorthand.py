import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("sin2q1", "ambiguous_shorthand", "sin2", "sin(2q1)"),
    ("cos12(q1)", "ambiguous_shorthand", "cos12", None),
    ("sin12.5", "ambiguous_shorthand", "sin12", "sin(12.5)"),
]

FINE = [
    ("sin(2q1)", "sin(2*theta1)"),
    ("sin12", "sin(theta1 + theta2)"),
    ("sin 12", "sin(12)"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
