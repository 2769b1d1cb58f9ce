"""What a text is worth. Expected values are Python's own arithmetic at the samples of conftest."""

from math import acos, asin, atan2, cos, exp, isinf, isnan, pi, sin, sqrt, tan

import numpy as np
import pytest
from numpy.typing import NDArray

from service.expressions import Symbol, Vocabulary, read

Values = dict[str, NDArray[np.float64]]

Q1, Q2, D3, Q4, L1, L2, A2, K, BETA = 0.3, 0.5, 0.7, 0.9, 1.1, 1.2, 1.3, 2.0, 0.25

NUMBERS = [
    ("0", 0.0),
    ("1e-3", 1e-3),
    ("2E3", 2000.0),
    (".5", 0.5),
    ("5.", 5.0),
    ("-0.25", -0.25),
    ("½", 0.5),
    ("pi", pi),
    ("π", pi),
    ("3pi", 3 * pi),
    ("-π/2", -pi / 2),
    ("90deg", pi / 2),
    ("90°", pi / 2),
    ("90 degrees", pi / 2),
    ("90º", pi / 2),
    (r"90^\circ", pi / 2),
    (r"90^{\circ}", pi / 2),
    ("deg(90)", pi / 2),
    ("(180/2)deg", pi / 2),
    ("-90°", -pi / 2),
    ("1.57rad", 1.57),
    ("rad(1.57)", 1.57),
    ("2^-1", 0.5),
    ("2**3", 8.0),
    ("-2^2", -4.0),
    ("(-2)^2", 4.0),
    ("2^(3^2)", 512.0),
    ("2--1", 3.0),
    ("+3", 3.0),
    ("2*-3", -6.0),
    ("8/4/2", 1.0),
    ("2−3", -1.0),
    ("2–3", -1.0),
    ("2×3·4", 24.0),
    ("√2", sqrt(2)),
    ("2√(9)", 6.0),
    ("exp(1)", exp(1)),
    ("abs(-3)", 3.0),
    ("tan(1)", tan(1)),
    ("asin(0.5)", asin(0.5)),
    ("arcsin(0.5)", asin(0.5)),
    ("arccos(0.5)", acos(0.5)),
    ("atan2(1, -1)", atan2(1, -1)),
    ("arctan2(1,-1)", atan2(1, -1)),
    ("10" * 50, float("10" * 50)),
]

SYMBOLS = [
    ("2q1", 2 * Q1),
    ("2 q1", 2 * Q1),
    ("l1c1", L1 * cos(Q1)),
    ("l2cos(q1)", L2 * cos(Q1)),
    ("a2(c1+c2)", A2 * (cos(Q1) + cos(Q2))),
    ("(q1)(q2)", Q1 * Q2),
    ("θ1θ2", Q1 * Q2),
    ("sinq1", sin(Q1)),
    ("sin q1", sin(Q1)),
    ("sin θ1 cos θ2", sin(Q1) * cos(Q2)),
    ("sinθ1cosθ2", sin(Q1) * cos(Q2)),
    ("sin 2q1", sin(2 * Q1)),
    ("sin 2 q1 * l1", sin(2 * Q1) * L1),
    ("sin q1 * l1", sin(Q1) * L1),
    ("sin q1 + l1", sin(Q1) + L1),
    ("sin(q1)^2", sin(Q1) ** 2),
    ("sin^2(q1)", sin(Q1) ** 2),
    ("sin^2 q1", sin(Q1) ** 2),
    ("sin²q1", sin(Q1) ** 2),
    ("sin**2(q1)", sin(Q1) ** 2),
    ("sin^2q1 + cos^2q1", 1.0),
    ("sin cos q1", sin(cos(Q1))),
    ("sin 90° cos q1", cos(Q1)),
    ("l1²c1", L1**2 * cos(Q1)),
    ("2q1²", 2 * Q1**2),
    ("-q1^2", -(Q1**2)),
    ("l1^-1", 1 / L1),
    ("l1⁻¹", 1 / L1),
    ("√(l1²+l2²)", sqrt(L1**2 + L2**2)),
    ("√2q1", sqrt(2) * Q1),
    ("½q1", Q1 / 2),
    ("1/2q1", Q1 / 2),
    ("l1/l2/k", L1 / L2 / K),
    ("atan2(s1, c1)", Q1),
    ("abs(-l1)", L1),
    ("β + beta", 2 * BETA),
    ("-s1*(a2*s24 + a2*c2) + l2*c1", -sin(Q1) * (A2 * sin(Q2 + Q4) + A2 * cos(Q2)) + L2 * cos(Q1)),
]

NAMES = [
    *((name, Q1) for name in ("q1", "theta1", "θ1", "θ_1", "θ₁", "ϑ1", r"\theta_1", r"\theta_{1}")),
    *((name, Q1) for name in ("q_1", "q_{1}", "q_{ 1 }", "q₁", "theta_1", "𝜃₁", "q1")),
    *((name, D3) for name in ("d3", "q3", "d_3", "q₃")),
]

SHORTHAND = [
    *((name, cos(Q1 + Q2)) for name in ("c12", "c_12", "c_{12}", "c₁₂", "cθ12", "cθ_{12}", "cq12")),
    *((name, cos(Q1 + Q2)) for name in ("cos_12", r"\cos_{12}", "cosθ12", "ctheta12")),
    ("s1", sin(Q1)),
    ("cθ1", cos(Q1)),
    ("s124", sin(Q1 + Q2 + Q4)),
    ("c1s2", cos(Q1) * sin(Q2)),
    ("c1^2", cos(Q1) ** 2),
    ("cosθ1", cos(Q1)),
    ("cos12", cos(Q1 + Q2)),
    ("sin90", sin(90)),
]

MARKED = [
    ("θ1*", Q1),
    ("q1 *", Q1),
    ("d3*", D3),
    ("(q2*)", Q2),
    ("-q2*", -Q2),
    ("θ2* + 90°", Q2 + pi / 2),
    ("θ2*+90°", Q2 + pi / 2),
    ("q1* - 1", Q1 - 1),
    ("q2*-1", -Q2),
    ("q1*q2", Q1 * Q2),
    ("q1* 2", 2 * Q1),
    ("q1**2", Q1**2),
    ("sin(q1*)", sin(Q1)),
]


@pytest.mark.parametrize(("text", "expected"), [*NUMBERS, *SYMBOLS, *NAMES, *SHORTHAND, *MARKED])
def test_value(text: str, expected: float, arm: Vocabulary, values: Values) -> None:
    assert np.ravel(read(text, arm).evaluate(values)) == pytest.approx([expected], rel=1e-14)


@pytest.mark.parametrize("number", [0, -7, 90, 0.5, -1e-9, 1e300, 10**300])
def test_a_json_number_is_itself(number: float, arm: Vocabulary) -> None:
    assert read(number, arm).evaluate({}) == float(number)


def test_all_samples_are_evaluated_at_once(arm: Vocabulary) -> None:
    angles = np.linspace(-3, 3, 32)
    result = read("2 s1 c1", arm).evaluate({"theta1": angles})
    assert result == pytest.approx(np.sin(2 * angles))


def test_a_declared_symbol_comes_before_the_shorthand() -> None:
    vocabulary = Vocabulary([Symbol("theta1", "angle", ("q1",), joint=1), Symbol("c1", "length")])
    assert read("c1 + s1", vocabulary).symbols == {"c1", "theta1"}
    assert read("c1", vocabulary).evaluate({"c1": np.array([5.0])}) == [5.0]


def test_a_declared_c_is_a_factor() -> None:
    vocabulary = Vocabulary([Symbol("theta1", "angle", ("q1",), joint=1), Symbol("c", "length")])
    assert read("cθ1", vocabulary).tree == read("c*θ1", vocabulary).tree


def test_the_longest_name_is_read_but_a_shorter_one_where_that_makes_sense() -> None:
    vocabulary = Vocabulary([Symbol(name, "number") for name in ("a", "b", "ab", "bc", "d")])
    assert read("abd", vocabulary).tree == read("ab*d", vocabulary).tree
    assert read("abc", vocabulary).tree == read("a*bc", vocabulary).tree


@pytest.mark.parametrize(
    ("text", "meaning"),
    [
        (r"a\sin q_1", "a*sin(theta1)"),
        (r"a\cos q_1", "a*cos(theta1)"),
        (r"a\,\mathrm{cos}\,q_1", "a*cos(theta1)"),
        (r"a\operatorname{sin}q_1", "a*sin(theta1)"),
        (r"a\mathrm{sin}(q_1)", "a*sin(theta1)"),
        (r"\sin\mathrm{d}", "sin(d)"),
        (r"\cos d", "cos(d)"),
        (r"\arctan2(a, d)", "atan2(a, d)"),
        (r"\arctan 2a", "atan(2*a)"),
        ("a cos q1", "a*cos(theta1)"),
        ("acos(d)", "acos(d)"),
        ("sind 30", "sin(30deg)"),
        ("sin d", "sin(d)"),
    ],
)
def test_a_command_does_not_run_into_the_letters_beside_it(text: str, meaning: str) -> None:
    vocabulary = Vocabulary(
        [
            Symbol("theta1", "angle", ("q1",), joint=1),
            Symbol("a", "length"),
            Symbol("d", "length"),
        ]
    )
    assert read(text, vocabulary).text() == meaning


def test_greek_letters_are_not_spelled_out_inside_a_word() -> None:
    vocabulary = Vocabulary([Symbol(name, "number") for name in ("b", "eta", "beta")])
    assert read("bη", vocabulary).tree == read("b*eta", vocabulary).tree
    assert read("β", vocabulary).tree == read("beta", vocabulary).tree


@pytest.mark.parametrize(
    "text", ["sqrt(-1)", "0/0", "asin(2)", "(-8)^(1/3)", "sqrt(-l1)", "acos(k)"]
)
def test_undefined_is_nan(text: str, arm: Vocabulary, values: Values) -> None:
    assert all(map(isnan, np.ravel(read(text, arm).evaluate(values))))


UNDEFINED_WITHIN = [
    *("1/(1/0)", "sqrt(-1)^0", "1^sqrt(-1)", "exp(-1/0)", "atan(1/0)", "2^(-1/0)", "atan2(1, 1/0)"),
    *("1/(1/(k-k))", "sqrt(-l1)^0", "1^asin(k)", "exp(-1/(k-k))", "atan(l1/(k-k))"),
    *("l1/(l2 + 1/(k-k))", "atan2(1/(k-k), 1)", "abs(1/(1/(k-k)))", "cos(1/(1/0))"),
]


@pytest.mark.parametrize("text", UNDEFINED_WITHIN)
def test_what_holds_something_undefined_is_undefined(
    text: str, arm: Vocabulary, values: Values
) -> None:
    """1/(1/0) is no 0: Python, too, raises an error there instead of going on."""
    assert all(map(isnan, np.ravel(read(text, arm).evaluate(values))))


def test_only_the_undefined_samples_are_undefined(arm: Vocabulary) -> None:
    result = read("1/(1/k) + sqrt(k)^0", arm).evaluate({"k": np.array([-1.0, 0.0, 2.0])})
    np.testing.assert_array_equal(result, [np.nan, np.nan, 3.0])


@pytest.mark.parametrize("text", ["1/0", "exp(10^9)", "l1/(k-k)", "10^300*10^300", "0^-1"])
def test_unbounded_is_infinite(text: str, arm: Vocabulary, values: Values) -> None:
    assert all(map(isinf, np.ravel(read(text, arm).evaluate(values))))


def test_expressions_share_a_memo(arm: Vocabulary, values: Values) -> None:
    memo: dict[str, object] = {}
    first = read("l1 cos(q1 + q2)", arm).evaluate(values, memo)
    known = len(memo)
    second = read("l1*c12", arm).evaluate(values, memo)
    assert second is first
    assert len(memo) == known
    third = read("l2 c12", arm).evaluate(values, memo)
    assert third == pytest.approx([L2 * cos(Q1 + Q2)])
    assert len(memo) == known + 1


def test_constants_are_folded(arm: Vocabulary, values: Values) -> None:
    memo: dict[str, object] = {}
    assert read("sin(30deg)*2^3", arm).evaluate(values, memo) == pytest.approx(4.0)
    assert not memo


def test_symbols_are_canonical(arm: Vocabulary) -> None:
    assert read("q3 + s12*l1 + π", arm).symbols == {"d3", "theta1", "theta2", "l1"}
