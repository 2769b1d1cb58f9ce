import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("q1'", "transpose", "'", "q1"),
    ("l1'", "transpose", "'", "l1"),
    ("θ₁′", "transpose", "′", "θ₁"),
    ("q1.'", "transpose", ".'", "q1"),
    ("q1^T", "transpose", "^T", "q1"),
    ("l1^{T}", "transpose", "^{T}", "l1"),
    ("qᵀ", "transpose", "ᵀ", None),
]

FINE = [
    ("q1^2", "theta1^2"),
    ("l1.*k", "l1*k"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
