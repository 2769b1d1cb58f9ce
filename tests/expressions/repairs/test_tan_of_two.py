import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("tan2(l1, l2)", "tan_of_two", "tan2", "atan2(l1, l2)"),
    ("tan2(s1, c1)", "tan_of_two", "tan2", "atan2(s1, c1)"),
    (r"\tan2(l_1, l_2)", "tan_of_two", r"\tan2", "atan2(l_1, l_2)"),
]

FINE = [
    ("atan2(l1, l2)", "atan2(l1, l2)"),
    ("tan(k)", "tan(k)"),
    ("tan 2k", "tan(2*k)"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
