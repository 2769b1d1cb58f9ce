import pytest

from tests.expressions.repairs.pairs import accept, refuse

BROKEN = [
    ("q1 // joint variable", "comment", "// joint variable", "q1"),
    ("l3", "unknown_symbol", "l3", None),
    ("l9", "unknown_symbol", "l9", None),
    ("a3", "unknown_symbol", "a3", None),
    ("l1 + l7", "unknown_symbol", "l7", None),
    ("thet1", "unknown_symbol", "thet1", "theta1"),
    ("thetta1", "unknown_symbol", "thetta1", "theta1"),
    ("tehta1", "unknown_symbol", "tehta1", "theta1"),
    ("bta", "unknown_symbol", "bta", "beta"),
    ("alpa1", "unknown_symbol", "alpa1", "alpha1"),
    ("lbse", "unknown_symbol", "lbse", "l_base"),
    ("x", "unknown_symbol", "x", None),
    ("zz", "unknown_symbol", "zz", None),
    ("foo", "unknown_symbol", "foo", None),
    ("px", "unknown_symbol", "px", None),
    ("foo(q1)", "unknown_symbol", "foo", None),
    ("f(q1)", "unknown_symbol", "f", None),
    ("θ₁ + α", "unknown_symbol", "α", None),
    ("eval(1)", "unknown_symbol", "eval", None),
    ("lambda: 0", "unknown_symbol", "lambda", None),
    ("[x for x in q]", "unknown_symbol", "x", None),
]

FINE = [
    ("l1", "l1"),
    ("beta", "beta"),
    ("lbase", "l_base"),
]


@pytest.mark.parametrize(("text", "code", "part", "suggestion"), BROKEN)
def test_refused(text: str, code: str, part: str, suggestion: str | None) -> None:
    refuse(text, code, part, suggestion)


@pytest.mark.parametrize(("text", "meaning"), FINE)
def test_accepted(text: str, meaning: str) -> None:
    accept(text, meaning)
