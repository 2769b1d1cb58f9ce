"""Convert the formulas in a text to MathML."""

import re

import pytest
from dh_grader.typeset import formula


def shown(html: str) -> str:
    html = html.replace("<math>", "[").replace("</math>", "]")
    return re.sub("<[^>]*>|&#x206[12];", "", html)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("-pi/2", "[−π2]"),
        ("theta1 + 90deg", "[θ1] [+90°]"),
        ("a - (b - c)*2", "[a] [−(b−c)⋅2]"),
        ("a - (b - c)", "[a−(b−c)]"),
        ("a + (-b)", "[a+(−b)]"),
        ("1e-3", "[1⋅10-3]"),
        ("a +", "a +"),
        ("theta_1 + theta1", "theta_1 + theta1"),
        ("<b>", "&lt;b&gt;"),
        ("c*" * 20 + "theta1", "[c] ⋅ " * 20 + "[θ1]"),
    ],
)
def test_each_term_of_a_sum_is_a_formula(text: str, expected: str) -> None:
    assert shown(formula(text)) == expected
