import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("q[6]", "index", "q[6]", "q6"),
    ("q[9]", "index", "q[9]", None),
    ("q(7)", "index", "q(7)", None),
    ("q(0)", "index", "q(0)", None),
    ("theta(9)", "index", "theta(9)", None),
    ("q[-1]", "index", "q[", None),
    ("q[i]", "index", "q[", None),
    ("q[0] + q(1)", "mixed_index", "q(1)", None),
    ("q[0] + q1", "mixed_index", "q[0]", None),
    ("q(1) + q[1]", "mixed_index", "q[1]", None),
    ("l1[2]", "index", "[2]", "l1*2"),
    ("c[0]", "index", "c[0]", "c1"),
    ("c(1)", "index", "c(1)", "c1"),
    ("s[1]", "index", "s[1]", "s2"),
    ("l[5]", "index", "l[5]", None),
]

FINE = [
    ("q[0]", "theta1"),
    ("q[5]", "theta6"),
    ("q(1)", "theta1"),
    ("k(2)", "k*2"),
    ("l1[k + 1]", "l1*(k + 1)"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
