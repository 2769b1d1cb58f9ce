"""Print formulas as MathML."""

import xml.etree.ElementTree as ET

import pytest
from dh_grader.expressions import Symbol, Vocabulary, read

from tests.expressions.printing.formulas import FORMULAS


@pytest.mark.parametrize("source", [formula[0] for formula in FORMULAS])
def test_mathml_is_well_formed(source: str, arm: Vocabulary) -> None:
    element = ET.fromstring(read(source, arm).mathml())
    assert element.tag == "{http://www.w3.org/1998/Math/MathML}math"
    assert len(element) == 1


@pytest.mark.parametrize(
    ("source", "characters"),
    [
        ("q1 + 90°", "θ1+90°"),
        ("-q1/2", "−θ12"),
        ("k*(-q1/2)", "k\u2062(−θ12)"),
        ("-l1*2", "−l1⋅2"),
        ("k*(l1-l2)", "k\u2062(l1−l2)"),
        ("atan2(k, 2)", "atan2\u2061(k,2)"),
        ("abs(k)", "|k|"),
        ("(k°)^2", "(k°)2"),
        ("1e-3", "1⋅10-3"),
        ("2rad", "2rad"),
    ],
)
def test_mathml_is_as_typed(source: str, characters: str, arm: Vocabulary) -> None:
    element = ET.fromstring(read(source, arm).mathml())
    assert "".join(element.itertext()) == characters


@pytest.mark.parametrize(
    ("latex", "characters", "elements"),
    [
        (None, "d3", "msub mi mn"),
        ("d_3^*", "d3*", "msubsup mi mn mo"),
        (r"\theta_{1}", "θ1", "msub mi mn"),
        (r"\theta^{*}_{12}", "θ12*", "msubsup mi mn mo"),
        (r"l_{\mathrm{base}}", "lbase", "msub mi mi"),
        (r"\mathrm{off}", "off", "mi"),
        ("R", "R", "mi"),
        (r"\hat{d}_3", "d3", "msub mi mn"),
    ],
)
def test_mathml_shows_a_symbol_as_its_latex_does(
    latex: str | None, characters: str, elements: str
) -> None:
    # If the LaTeX has more than letters, indices and stars, MathML uses the symbol's name.
    symbol = Symbol("d3", "length", latex=latex)
    element = ET.fromstring(read("d3", Vocabulary([symbol])).mathml())
    assert "".join(element.itertext()) == characters
    tags = [part.tag.rpartition("}")[2] for part in element.iter()]
    assert " ".join(tags[1:]) == elements
