import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("atan(l1, l2)", "wrong_number_of_arguments", "atan(l1, l2)", "atan2(l1, l2)"),
    ("arctan(l1, l2)", "wrong_number_of_arguments", "arctan(l1, l2)", "atan2(l1, l2)"),
    ("atan2(l1)", "wrong_number_of_arguments", "atan2(l1)", None),
    ("arctan2(l1)", "wrong_number_of_arguments", "arctan2(l1)", None),
    ("atan2 l1", "wrong_number_of_arguments", "atan2 l1", None),
    ("atan2(l1, l2, k)", "wrong_number_of_arguments", "atan2(l1, l2, k)", None),
    ("sin(q1, q2)", "wrong_number_of_arguments", "sin(q1, q2)", None),
    ("cos(1, 2)", "wrong_number_of_arguments", "cos(1, 2)", None),
    ("sqrt(1, 2)", "wrong_number_of_arguments", "sqrt(1, 2)", None),
    ("cos(0,5)", "decimal_comma", ",", "cos(0.5)"),
    ("atan2(0,5, 1,5)", "decimal_comma", ",", "atan2(0.5, 1.5)"),
]

FINE = [
    ("atan2(l1, l2)", "atan2(l1, l2)"),
    ("cos(0.5)", "cos(0.5)"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
