import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("sin^-1(k)", "function_power", "sin^-1", "asin(k)"),
    ("sin^-1 k", "function_power", "sin^-1", "asin k"),
    ("sin^{-1}(k)", "function_power", "sin^{-1}", "asin(k)"),
    (r"\sin^{-1}(k)", "function_power", r"\sin^{-1}", "asin(k)"),
    ("cos⁻¹(k)", "function_power", "cos⁻¹", "acos(k)"),
    ("cos^(-1)(q1)", "function_power", "cos^(-1)", "acos(q1)"),
    ("tan^-1(q1/q2)", "function_power", "tan^-1", "atan(q1/q2)"),
    (r"\tan^{-1}\frac{l_1}{l_2}", "function_power", r"\tan^{-1}", r"atan\frac{l_1}{l_2}"),
    ("sqrt^-1(k)", "function_power", "sqrt^-1", None),
    ("sin^k(q1)", "function_power", "^", None),
    ("sin^0.5(q1)", "function_power", "^", None),
    ("sin^12345(q1)", "function_power", "^", None),
]

FINE = [
    ("sin^2(q1)", "sin(theta1)^2"),
    ("asin(k)", "asin(k)"),
    ("1/sin(k)", "1/sin(k)"),
    ("sin(k)^-1", "sin(k)^-1"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
