import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    (r"\frac", "missing_operand", r"\frac", None),
    (r"\frac{1}", "missing_operand", r"\frac{1}", None),
    (r"\sqrt", "missing_operand", r"\sqrt", None),
    (r"\foo", "unknown_command", r"\foo", None),
    (r"\foo{1}", "unknown_command", r"\foo", None),
    (r"\cosq", "unknown_command", r"\cosq", None),
    (r"\thetaone", "unknown_command", r"\thetaone", None),
    (r"\begin{matrix}1\end{matrix}", "unknown_command", r"\begin", None),
    (r"q1 \\ q2", "unknown_command", r"\\", None),
]

FINE = [
    (r"\cos q_1", "cos(theta1)"),
    (r"\frac{1}{2}", "1/2"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
