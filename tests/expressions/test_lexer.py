"""Test how a formula is cut into words, signs and notes."""

import numpy as np
import pytest
from dh_grader.expressions import ExpressionError, Symbol, Vocabulary, read

from tests.together import together

# --- Read words of letters and digits: names, functions and abbreviations


def test_a_declared_symbol_comes_before_the_shorthand() -> None:
    vocabulary = Vocabulary([Symbol("theta1", "angle", ("q1",), joint=1), Symbol("c1", "length")])
    assert read("c1 + s1", vocabulary).symbols == {"c1", "theta1"}
    assert read("c1", vocabulary).evaluate({"c1": np.array([5.0])}) == [5.0]


def test_a_declared_c_is_a_factor() -> None:
    vocabulary = Vocabulary([Symbol("theta1", "angle", ("q1",), joint=1), Symbol("c", "length")])
    assert read("cθ1", vocabulary).tree == read("c*θ1", vocabulary).tree


def test_the_longest_name_that_leaves_a_readable_rest_is_read() -> None:
    vocabulary = Vocabulary([Symbol(name, "number") for name in ("a", "b", "ab", "bc", "d")])
    assert read("abd", vocabulary).tree == read("ab*d", vocabulary).tree
    assert read("abc", vocabulary).tree == read("a*bc", vocabulary).tree


# --- Test the notes on ambiguous formulas

CASES = [
    ("θ1*", [("joint_marker", (2, 3))]),
    (" q1 * ", [("joint_marker", (4, 5))]),
    ("θ₂* + 90°", [("joint_marker", (2, 3))]),
    ("q1* - 90", [("marker_or_product", (2, 3)), ("bare_radians", (6, 8))]),
    ("q1*-pi/2", [("marker_or_product", (2, 3))]),
    ("k + q1*+q2", [("joint_marker", (6, 7))]),
    ("q1*-q2", [("marker_or_product", (2, 3))]),
    ("q1 * -q2", []),
    ("q1 · -q2", []),
    ("q1*+q2*", [("joint_marker", (2, 3)), ("joint_marker", (6, 7))]),
    ("q2*-1", [("marker_or_product", (2, 3))]),
    ("q1*q2", []),
    ("1/2q1", [("division_then_product", (0, 5))]),
    ("1/2*q1", []),
    ("(1/2)q1", []),
    ("½q1", []),
    ("q1/2 c1", [("division_then_product", (0, 7))]),
    ("sin q1/2", [("bare_argument", (4, 6))]),
    ("l1 sin q1/2", [("bare_argument", (7, 9))]),
    ("sin^2 q1/2", [("bare_argument", (6, 8))]),
    ("sin(q1)/2", []),
    ("(sin q1)/2", []),
    ("sin q1 l1", [("bare_argument", (4, 6))]),
    ("sin q1 cos q2", []),
    ("sin q1^2", [("bare_argument", (4, 8))]),
    ("sin 2(q1)", [("bare_argument", (4, 9))]),
    ("√2 q1", [("bare_argument", (1, 2))]),
    ("cos12", [("shorthand", (0, 5))]),
    ("cos_12", []),
    ("c12", []),
]


@together(("text", "expected"), CASES)
def test_an_ambiguous_reading_has_a_note(
    text: str, expected: list[tuple[str, tuple[int, int]]], arm: Vocabulary
) -> None:
    assert [(note.code, note.span) for note in read(text, arm).notes] == expected


def test_digits_after_a_sine_are_ambiguous_in_degrees(six: Vocabulary) -> None:
    assert read("sin45", six).notes[0].code == "shorthand"
    with pytest.raises(ExpressionError) as caught:
        read("sin45", six, angle_unit="degrees")
    assert caught.value.code == "ambiguous_shorthand"


MORE: list[tuple[str, list[tuple[str, tuple[int, int]]]]] = [
    ("√2/2", []),
    (r"\sqrt{2} q_1", []),
    ("√(2) q1", []),
    ("sqrt 2 q1", [("bare_argument", (5, 9))]),
    ("sin ½ q1", []),
    (r"\sin\frac{\pi}{2} q_1", [("bare_argument", (4, 17))]),
    (r"\frac{1}{2} q_1", []),
    ("C1", [("shorthand", (0, 2))]),
    ("l1S12", [("shorthand", (2, 5))]),
    ("Cos(q1)", [("letter_case", (0, 3))]),
    ("2 PI", [("letter_case", (2, 4))]),
    ("ArcTan2(k, 1)", [("letter_case", (0, 7))]),
    ("cosd(60)", [("degrees_function", (0, 4))]),
    ("q[0]", [("zero_based_index", (0, 4))]),
    ("l1*np.cos(q[1])", [("zero_based_index", (10, 14))]),
    ("q(1)", [("one_based_index", (0, 4))]),
    ("cos q{1}", [("one_based_index", (4, 8))]),
    ("θ^*_1", [("joint_marker", (1, 3))]),
    (r"\theta_1^{*}", [("joint_marker", (8, 12))]),
    ("90 + 45°", [("mixed_units", (0, 2))]),
    ("45° - 90", [("mixed_units", (6, 8))]),
    ("0 + 45°", []),
    ("0·5", [("raised_dot", (0, 3))]),
    ("l1 + 2⋅5", [("raised_dot", (5, 8))]),
    ("2·10^-3", []),
    ("2 · 5", []),
    ("2*5", []),
    ("2·l1", []),
    ("θ1 +90", [("bare_radians", (4, 6))]),
    ("-90 + q1", [("bare_radians", (1, 3))]),
    ("q1 + q2 - 22.5", [("bare_radians", (10, 14))]),
    ("cos(2q1 + 45)", [("bare_radians", (10, 12))]),
    ("cos(90)", [("bare_radians", (4, 6))]),
    ("sin 30", [("bare_radians", (4, 6))]),
    ("l1cos(1)", [("bare_radians", (6, 7))]),
    ("cos(-2)", [("bare_radians", (5, 6))]),
    # Joint 3 does not turn, and the other numbers are usual angles in radians.
    ("cos(3)", []),
    ("q1 + 1.5708", []),
    ("q1 + 7.854", []),
    ("q1 + 90°", []),
    ("d3 + 90", []),
    ("l1 + 90", []),
    ("cos(0)", []),
    ("q1 + 90 rad", []),
    ("sind(q1 + 90)", [("degrees_function", (0, 4))]),
    ("sind(90 + 45°)", [("degrees_function", (0, 4))]),
    ("q1 + 90 + sind(q2 + 90)", [("degrees_function", (10, 14)), ("bare_radians", (5, 7))]),
    ("s1+2", [("shorthand", (0, 4))]),
    ("l1c1 + l2c1+2", [("shorthand", (9, 13))]),
    ("c_12+4", [("shorthand", (0, 6))]),
    # With spaces, or if there is no such sum of joint angles, 2 is a length.
    ("s1 + 2", []),
    ("s2+1", []),
    ("s1+3", []),
    ("s_{1}+2", []),
    ("sin(q1)+2", []),
    ("s1+2*l1", []),
    ("s1+2c1", []),
    ("s1-2", []),
    ("45° + 90°", []),
    ("atan2(c1, s1)", [("atan2_order", (0, 13))]),
    ("atan2(s1, c1)", []),
    ("atan2(l1 c1, l1 c1 + s1)", []),
]


@together(("text", "expected"), MORE)
def test_an_ambiguous_spelling_has_a_note(
    text: str, expected: list[tuple[str, tuple[int, int]]], arm: Vocabulary
) -> None:
    assert [(note.code, note.span) for note in read(text, arm).notes] == expected


def test_a_bare_number_next_to_degrees_has_no_note_in_degrees(arm: Vocabulary) -> None:
    expression = read("90 + 45°", arm, quantity="angle", angle_unit="degrees")
    assert expression.notes == ()


def test_in_degrees_only_a_joint_number_has_a_note(arm: Vocabulary) -> None:
    notes = {
        text: [note.code for note in read(text, arm, angle_unit="degrees").notes]
        for text in ("q1 + 90", "cos(90)", "cos(q1 + 90)", "cos(1)")
    }
    assert notes == {
        "q1 + 90": [], "cos(90)": [], "cos(q1 + 90)": [], "cos(1)": ["bare_radians"],
    }  # fmt: skip


def test_in_degrees_the_inverse_functions_of_degrees_are_read(arm: Vocabulary) -> None:
    expression = read("acosd(0.5) + 30", arm, quantity="angle", angle_unit="degrees")
    assert [note.code for note in expression.notes] == ["degrees_function"]


def test_acos_is_not_a_product_even_if_a_is_a_symbol() -> None:
    vocabulary = Vocabulary([Symbol("a", "length"), Symbol("k", "number")])
    [note] = read("acos(k)", vocabulary).notes
    assert (note.code, note.span) == ("function_name", (0, 4))
    assert read("a cos(k)", vocabulary).notes == ()
