import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("1,5", "decimal_comma", ",", "1.5"),
    ("0,5", "decimal_comma", ",", "0.5"),
    ("-0,25", "decimal_comma", ",", "-0.25"),
    ("1,5 + 2,5", "decimal_comma", ",", "1.5 + 2.5"),
    ("0,5*l1", "decimal_comma", ",", "0.5*l1"),
    ("l1*0,5", "decimal_comma", ",", "l1*0.5"),
    ("(1,5)", "decimal_comma", ",", "(1.5)"),
    ("1,000", "decimal_comma", ",", None),
    ("12,000", "decimal_comma", ",", None),
    ("１２３，５", "decimal_comma", "，", None),
]

FINE = [
    ("1.5", "1.5"),
    ("atan2(1,5)", "atan2(1, 5)"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
