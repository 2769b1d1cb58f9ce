import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("sec(q1)", "unknown_function", "sec", "(1/cos(q1))"),
    ("l1/sec(q1)", "unknown_function", "sec", "l1/(1/cos(q1))"),
    ("csc(q1)^2", "unknown_function", "csc", "(1/sin(q1))^2"),
    ("cot(q1)", "unknown_function", "cot", "(1/tan(q1))"),
    ("cosec(q1)", "unknown_function", "cosec", "(1/sin(q1))"),
    ("ln(k)", "unknown_function", "ln", None),
    ("log(k)", "unknown_function", "log", None),
    ("sinh(k)", "unknown_function", "sinh", None),
    ("hypot(l1, l2)", "unknown_function", "hypot", None),
    ("norm(l1)", "unknown_function", "norm", None),
    ("cosine(q1)", "unknown_function", "cosine", "cos(q1)"),
    ("sine(q1)", "unknown_function", "sine", "sin(q1)"),
    ("c(q1)", "unknown_function", "c", "cos(q1)"),
    ("s(q1 + q2)", "unknown_function", "s", "sin(q1 + q2)"),
    ("fabs(q5)", "unknown_function", "fabs", "abs(q5)"),
    ("sen(q1)", "unknown_function", "sen", "sin(q1)"),
    ("sinus(q1)", "unknown_function", "sinus", "sin(q1)"),
]

FINE = [
    ("1/cos(q1)", "1/cos(theta1)"),
    ("c1", "cos(theta1)"),
    ("tg(q1)", "tan(theta1)"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
