"""Print formulas in the student's notation."""

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
