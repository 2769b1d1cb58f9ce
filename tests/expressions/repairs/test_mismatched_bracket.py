import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("(q1]", "mismatched_bracket", "]", "(q1)"),
    ("[q1)", "mismatched_bracket", ")", "[q1]"),
    ("2*[q1 + (q2 - k]", "mismatched_bracket", "]", "2*[q1 + (q2 - k)]"),
    ("cos(q1]", "mismatched_bracket", "]", "cos(q1)"),
    ("cos[q1)", "mismatched_bracket", ")", "cos[q1]"),
    ("(q1}", "mismatched_bracket", "}", "(q1)"),
    (r"\left(q_1\right]", "mismatched_bracket", "]", r"\left(q_1\right)"),
]

FINE = [
    ("2*[q1 + (q2 - k)]", "2*(theta1 + (theta2 - k))"),
    ("cos[q1]", "cos(theta1)"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
