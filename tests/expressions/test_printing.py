"""Test how formulas are written."""

import re
import xml.etree.ElementTree as ET

import pytest
from dh_grader.expressions import AngleUnit, Symbol, Vocabulary, joint_variable, read
from dh_grader.expressions.printing import (
    Spelling,
    habits_of,
    spelling_for,
    spelling_of,
    to_latex,
    to_text,
)

# --- Formulas in three forms: as typed, as plain text and as LaTeX

FORMULAS = [
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
    ("k*-2", "k*(-2)", r"k \cdot \left(-2\right)"),
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


# --- Print formulas in the student's notation

ARM = Vocabulary(
    [
        *(joint_variable(i) for i in (1, 2, 4)),
        joint_variable(3, sliding=True),
        Symbol("l1", "length"),
        Symbol("alpha", "angle"),
    ]
)


def spelling(*typed: str, unit: AngleUnit = "radians") -> Spelling:
    read_as = [read(text, ARM, quantity="angle", angle_unit=unit).typed for text in typed]
    habits = [habits_of(each, ARM) for each in read_as]
    return spelling_of(habits, ARM, degrees=unit == "degrees")


def printed(formula: str, *typed: str, unit: AngleUnit = "radians") -> str:
    return to_text(read(formula, ARM).tree, spelling(*typed, unit=unit))


@pytest.mark.parametrize(
    ("typed", "text"),
    [
        ("theta1", "theta1 + theta2*d3"),
        ("q1", "q1 + q2*q3"),
        ("θ1", "θ1 + θ2*d3"),
        ("θ_1*", "θ_1 + θ_2*d3"),
        ("θ₁", "θ₁ + θ₂*d3"),
        (r"\theta_1", "theta1 + theta2*d3"),
        ("q[0]", "theta1 + theta2*d3"),
        ("(q1)", "q1 + q2*q3"),
        ("0", "theta1 + theta2*d3"),
    ],
)
def test_joint_variables_have_the_names_that_were_typed(typed: str, text: str) -> None:
    assert printed("theta1 + theta2*d3", typed) == text
    assert read(text, ARM).tree == read("theta1 + theta2*d3", ARM).tree


def test_a_typed_name_precedes_a_derived_name() -> None:
    assert printed("theta1 + theta2 + theta4", "q1", "θ2") == "q1 + θ2 + q4"


def test_other_symbols_have_the_names_that_were_typed() -> None:
    assert printed("l1 + alpha", "l_1 + α") == "l_1 + α"


@pytest.mark.parametrize(
    ("typed", "in_degrees", "degree", "pi"),
    [
        (("pi/2",), False, "deg", "pi"),
        (("π/2", "90deg", "π"), False, "deg", "π"),
        (("90°", "pi/2", "-90°"), True, "°", "pi"),
        (("90deg",), True, "deg", "pi"),
        ((r"90^\circ",), True, "°", "pi"),
        ((r"\pi/2",), False, "deg", "pi"),
        (("theta1", "0"), False, "deg", "pi"),
        (("-90",), True, "deg", "pi"),  # read as radians, but meant in degrees
        (("1.5708",), False, "deg", "pi"),
    ],
)
def test_the_unit_of_angles_is_that_of_most_entries(
    typed: tuple[str, ...], in_degrees: bool, degree: str, pi: str
) -> None:
    found = spelling(*typed)
    assert (found.in_degrees, found.degree, found.pi) == (in_degrees, degree, pi)


def test_a_student_who_works_in_degrees_gets_bare_degrees() -> None:
    found = spelling("theta1", "90", unit="degrees")
    assert found.in_degrees
    assert to_text(read("90deg", ARM).tree, found) == "90"
    assert spelling("theta1", unit="degrees").in_degrees
    assert not spelling("pi/2", unit="degrees").in_degrees
    assert spelling("90°", unit="degrees").degree == "°"


def test_the_spelling_for_one_entry_has_its_own_unit_and_names() -> None:
    common = spelling("pi/2", "pi/2", "90°")
    assert spelling_for(read("90°", ARM).typed, common, ARM).degree == "°"
    assert spelling_for(read("90°", ARM).typed, common, ARM).in_degrees
    assert spelling_for(read("q1", ARM).typed, spelling("θ1"), ARM).names["theta1"] == "q1"
    assert spelling_for(read("d3", ARM).typed, common, ARM).pi == common.pi


@pytest.mark.parametrize(
    ("formula", "text"),
    [
        ("cos(theta1 + theta2)", "c12"),
        ("-l1*sin(theta4)", "-l1*s4"),
        ("cos(theta1 - theta2)", "cos(theta1 - theta2)"),
        ("cos(alpha)", "cos(alpha)"),
        ("sin(2*theta1)", "sin(2*theta1)"),
        ("cos(theta1 + theta1)", "cos(theta1 + theta1)"),
    ],
)
def test_only_students_who_write_shorthand_get_it(formula: str, text: str) -> None:
    assert printed(formula, "s1") == text
    assert printed(formula, "sin(theta1)") == formula
    assert read(text, ARM).tree == read(formula, ARM).tree


def test_no_shorthand_if_a_symbol_has_such_a_name() -> None:
    words = Vocabulary([*ARM.symbols, Symbol("c2", "length")])
    found = spelling_of([habits_of(read("s1", words).typed, words)], words, degrees=False)
    assert not found.shorthand


def test_latex_has_the_student_s_letters() -> None:
    tree = read("theta1 + l1*cos(theta2)", ARM).tree
    assert to_latex(spelling("q1").renamed(tree)) == r"q_{1} + l_{1} \cos\left(q_{2}\right)"
    assert to_latex(spelling("θ_1").renamed(tree)) == to_latex(tree)


# --- Test where printed formulas have brackets


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


# --- Print formulas as plain text


@pytest.mark.parametrize(("source", "text"), [formula[:2] for formula in FORMULAS])
def test_text_reads_back_to_the_same_tree(source: str, text: str, arm: Vocabulary) -> None:
    expression = read(source, arm)
    assert expression.text() == text
    assert read(text, arm).tree == expression.tree


# --- Print formulas as LaTeX


@pytest.mark.parametrize(("source", "text", "latex"), FORMULAS)
def test_latex_is_as_typed(source: str, text: str, latex: str, arm: Vocabulary) -> None:
    assert read(source, arm).latex() == read(text, arm).latex() == latex


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
def test_a_symbol_is_printed_with_its_index(symbol: Symbol, latex: str) -> None:
    assert read(symbol.name, Vocabulary([symbol])).latex() == latex


# --- Print formulas as MathML


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
