"""Test where printed formulas have brackets."""

import re
import xml.etree.ElementTree as ET

import pytest
from dh_grader.expressions import Vocabulary, read


@pytest.mark.parametrize(
    ("source", "text", "drawn"),
    [
        ("k*(-2)", "k*(-2)", "k(-2)"),
        ("(-k)*2", "-k*2", "-k2"),
        ("k-(-l1*2)", "k - (-l1*2)", "k-(-l12)"),
        ("k*(l1/l2)", "k*(l1/l2)", "kl1l2"),
        ("k*(-l1/l2)", "k*(-l1/l2)", "k(-l1l2)"),
        ("(l1/l2)^2", "(l1/l2)^2", "(l1l2)2"),
        ("(90deg)^2", "90deg^2", "(90°)2"),
        ("1e3^2", "1e3^2", "(1103)2"),
        ("k*1e3", "k*1e3", "k1103"),
        ("-(l1*2)", "-(l1*2)", "-l12"),
        ("-(l1+l2)", "-(l1 + l2)", "-(l1+l2)"),
    ],
)
def test_all_printers_put_brackets_where_needed(
    source: str, text: str, drawn: str, arm: Vocabulary
) -> None:
    expression = read(source, arm)
    latex = re.sub(
        r"\\(?:left|right|cdot|frac|circ)|[ {}_^]", "", expression.latex().replace(r"^{\circ}", "°")
    )
    mathml = "".join(ET.fromstring(expression.mathml()).itertext())
    assert expression.text() == text
    assert latex == drawn
    assert re.sub("[\u2062⋅]", "", mathml).replace("−", "-") == drawn


@pytest.mark.parametrize(
    ("source", "latex", "mathml"),
    [
        ("k-((-l1+l2)*2)", r"k - \left(-l_{1} + l_{2}\right) \cdot 2", "k−((−l1+l2)⋅2)"),
        ("k*(-l1*2/l2)", r"k \cdot \frac{-l_{1} \cdot 2}{l_{2}}", "k⋅(−l1⋅2l2)"),
    ],
)
def test_mathml_brackets_a_sign_inside_brackets_or_above_a_bar(
    source: str, latex: str, mathml: str, arm: Vocabulary
) -> None:
    expression = read(source, arm)
    assert expression.latex() == latex
    assert "".join(ET.fromstring(expression.mathml()).itertext()) == mathml
