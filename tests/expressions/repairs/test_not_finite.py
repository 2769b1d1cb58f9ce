import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("∞", "not_finite", "∞", None),
    ("-∞", "not_finite", "∞", None),
    (r"\infty", "not_finite", r"\infty", None),
    ("inf", "not_finite", "inf", None),
    ("-Infinity", "not_finite", "Infinity", None),
    ("nan", "not_finite", "nan", None),
    ("NaN", "not_finite", "NaN", None),
    ("1e999", "not_finite", "1e999", None),
    ("9" * 400, "not_finite", "9" * 400, None),
]

FINE = [
    ("1e300", "1e300"),
    ("1/0", "1/0"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
