"""Text, LaTeX and MathML, as typed and not rearranged."""

import xml.etree.ElementTree as ET

import pytest

from service.expressions import Symbol, Vocabulary, read

CASES = [
    ("2q1", "2*theta1", r"2 \theta_{1}"),
    ("l1 c12", "l1*cos(theta1 + theta2)", r"l_{1} \cos\left(\theta_{1} + \theta_{2}\right)"),
    ("q1 + 90°", "theta1 + 90deg", r"\theta_{1} + 90^{\circ}"),
    ("pi/2", "pi/2", r"\frac{\pi}{2}"),
    ("-π/2", "-pi/2", r"-\frac{\pi}{2}"),
    ("sin²q1", "sin(theta1)^2", r"\sin^{2}\left(\theta_{1}\right)"),
    ("√(l1²+1)", "sqrt(l1^2 + 1)", r"\sqrt{l_{1}^{2} + 1}"),
    ("abs(k)", "abs(k)", r"\left|k\right|"),
    ("atan2(s1,c1)", "atan2(sin(theta1), cos(theta1))",
     r"\operatorname{atan2}\left(\sin\left(\theta_{1}\right), \cos\left(\theta_{1}\right)\right)"),
    ("1e-3", "1e-3", r"1 \cdot 10^{-3}"),
    ("2*3", "2*3", r"2 \cdot 3"),
    ("k*-2", "k*(-2)", r"k \left(-2\right)"),
    ("k-(l1-l2)", "k - (l1 - l2)", r"k - \left(l_{1} - l_{2}\right)"),
    ("k*(-l1/2)", "k*(-l1/2)", r"k \left(-\frac{l_{1}}{2}\right)"),
    ("k-(-l1*2)", "k - (-l1*2)", r"k - \left(-l_{1} \cdot 2\right)"),
    ("k-(-l1)", "k - (-l1)", r"k - \left(-l_{1}\right)"),
    ("-(l1+l2)", "-(l1 + l2)", r"-\left(l_{1} + l_{2}\right)"),
    ("(l1/l2)^2", "(l1/l2)^2", r"\left(\frac{l_{1}}{l_{2}}\right)^{2}"),
    ("l1/(l2/k)", "l1/(l2/k)", r"\frac{l_{1}}{\frac{l_{2}}{k}}"),
    ("2^(k+1)", "2^(k + 1)", "2^{k + 1}"),
    ("k^-2", "k^-2", "k^{-2}"),
    ("k deg", "k deg", r"k^{\circ}"),
    ("2rad", "2rad", r"2\,\mathrm{rad}"),
]  # fmt: skip


@pytest.mark.parametrize(("source", "text", "latex"), CASES)
def test_text_and_latex(source: str, text: str, latex: str, arm: Vocabulary) -> None:
    expression = read(source, arm)
    assert (expression.text(), expression.latex()) == (text, latex)
    assert read(text, arm).tree == expression.tree


@pytest.mark.parametrize("source", [case[0] for case in CASES])
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
def test_mathml_characters(source: str, characters: str, arm: Vocabulary) -> None:
    element = ET.fromstring(read(source, arm).mathml())
    assert "".join(element.itertext()) == characters


@pytest.mark.parametrize(
    ("symbol", "latex"),
    [
        (Symbol("theta12", "angle"), r"\theta_{12}"),
        (Symbol("R", "length"), "R"),
        (Symbol("l_base", "length"), r"l_{\mathrm{base}}"),
        (Symbol("offset", "length"), r"\mathrm{offset}"),
        (Symbol("d3", "length", latex="d_3^*"), "d_3^*"),
    ],
)
def test_symbols(symbol: Symbol, latex: str) -> None:
    assert read(symbol.name, Vocabulary([symbol])).latex() == latex


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
    """What the LaTeX says beyond letters, indices and stars, MathML takes from the name."""
    symbol = Symbol("d3", "length", latex=latex)
    element = ET.fromstring(read("d3", Vocabulary([symbol])).mathml())
    assert "".join(element.itertext()) == characters
    tags = [part.tag.rpartition("}")[2] for part in element.iter()]
    assert " ".join(tags[1:]) == elements
