import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("(q1", "unbalanced_bracket", "(", "(q1)"),
    ("q1)", "unbalanced_bracket", ")", "q1"),
    ("((q1)", "unbalanced_bracket", "(", "((q1))"),
    ("(q1))", "unbalanced_bracket", ")", "(q1)"),
    ("cos(q1", "unbalanced_bracket", "(", "cos(q1)"),
    ("l1*cos(q1 + q2", "unbalanced_bracket", "(", "l1*cos(q1 + q2)"),
    ("l1*(cos(q1) + (q2)", "unbalanced_bracket", "(", "l1*(cos(q1) + (q2))"),
    ("2*[q1 + q2", "unbalanced_bracket", "[", "2*[q1 + q2]"),
    ("{q1", "unbalanced_bracket", "{", "{q1}"),
    ("|q1", "unbalanced_bracket", "|", "|q1|"),
    ("|q1 + (k|", "unbalanced_bracket", "|", None),
    (r"\frac{1}{2", "unbalanced_bracket", "{", r"\frac{1}{2}"),
    (r"\sqrt{", "unbalanced_bracket", "{", None),
    (r"\left(q_1", "unbalanced_bracket", "(", r"\left(q_1)"),
]

FINE = [
    ("((q1))", "theta1"),
    ("|k|", "abs(k)"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
