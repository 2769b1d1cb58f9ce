import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    (r"c_{\theta_1+\theta_2}", "subscript", r"_{\theta_1+\theta_2}", r"cos(\theta_1+\theta_2)"),
    ("s_{1+2}", "subscript", "_{1+2}", None),
    ("l_{1+2}", "subscript", "_{1+2}", None),
    ("θ₁₊₂", "subscript", "₁₊", None),
    ("q_{}", "subscript", "_{}", None),
]

FINE = [
    ("c_{12}", "cos(theta1 + theta2)"),
    (r"c_{\theta_1}", "cos(theta1)"),
    ("l_{base}", "l_base"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
