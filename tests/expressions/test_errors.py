"""Unreadable texts get an error code, the place of the error, and a suggested correction."""

from copy import deepcopy

import pytest
from dh_grader.expressions import ExpressionError, Symbol, Vocabulary, read
from dh_grader.translations import Sentence

from tests.together import together

CASES = [
    ("", "empty", (0, 0), None),
    ("  \t", "empty", (0, 3), None),
    ("1,5", "decimal_comma", (1, 2), "1.5"),
    ("cos(q1) + (1,5)", "decimal_comma", (12, 13), "cos(q1) + (1.5)"),
    ("q1, q2", "two_values", (2, 3), None),
    ("q1; q2", "two_values", (2, 3), None),
    ("±1", "two_values", (0, 1), None),
    ("2 3", "two_values", (0, 3), None),
    ("q1 2", "two_values", (0, 4), None),
    ("(q1)2", "two_values", (3, 5), None),
    ("q₁2", "two_values", (0, 3), None),
    ("q_{1}2", "two_values", (0, 6), None),
    ("l1²3", "two_values", (2, 4), None),
    ("2½", "two_values", (1, 2), "2 + 1/2"),
    ("1.2.3", "malformed_number", (0, 5), None),
    ("θ1 ≈ 90", "equation", (3, 4), "90"),
    ("(", "unbalanced_bracket", (0, 1), None),
    ("sin(q1", "unbalanced_bracket", (3, 4), "sin(q1)"),
    ("2*(q1 + (q2)", "unbalanced_bracket", (2, 3), "2*(q1 + (q2))"),
    ("q1)", "unbalanced_bracket", (2, 3), "q1"),
    (")", "unbalanced_bracket", (0, 1), None),
    ("q1 +", "trailing_operator", (3, 4), "q1"),
    ("k*", "trailing_operator", (1, 2), "k"),
    ("c1*", "trailing_operator", (2, 3), "c1"),
    ("*q1", "missing_operand", (0, 1), None),
    ("q1 */ q2", "missing_operand", (3, 4), None),
    ("()", "missing_operand", (0, 2), None),
    ("(*2)", "missing_operand", (1, 2), None),
    ("deg", "missing_operand", (0, 3), None),
    ("°", "missing_operand", (0, 1), None),
    ("sin", "function_without_argument", (0, 3), None),
    ("2 + sin()", "function_without_argument", (4, 7), None),
    ("sin * q1", "function_without_argument", (0, 3), None),
    ("sin - q1", "function_without_argument", (0, 3), None),
    ("sin^2", "function_without_argument", (0, 3), None),
    ("atan(1, 2)", "wrong_number_of_arguments", (0, 10), "atan2(1, 2)"),
    ("atan2(1)", "wrong_number_of_arguments", (0, 8), None),
    ("atan2 q1", "wrong_number_of_arguments", (0, 8), None),
    ("sin(1, 2, 3)", "wrong_number_of_arguments", (0, 12), None),
    ("deg(1, 2)", "wrong_number_of_arguments", (0, 9), None),
    ("2^3^2", "chained_power", (3, 4), None),
    ("2^-3^2", "chained_power", (4, 5), None),
    ("sin^-1(q1)", "function_power", (0, 6), "asin(q1)"),
    ("l1*cos⁻¹(k)", "function_power", (3, 8), "l1*acos(k)"),
    ("sin^(-1) q1", "function_power", (0, 8), "asin q1"),
    ("sin^k(q1)", "function_power", (3, 4), None),
    ("nan", "not_finite", (0, 3), None),
    ("-Infinity", "not_finite", (1, 9), None),
    ("1 + 1e999", "not_finite", (4, 9), None),
    ("9" * 400, "not_finite", (0, 400), None),
    ("2*sIn(q1)", "wrong_case", (2, 5), "2*sin(q1)"),
    ("sine(q1)", "unknown_function", (0, 4), "sin(q1)"),
    ("c(q1)", "unknown_function", (0, 1), "cos(q1)"),
    ("thetta1", "unknown_symbol", (0, 7), "theta1"),
    ("2e", "unknown_symbol", (1, 2), None),
    ("e^2", "unknown_symbol", (0, 1), None),
    ("i", "unknown_symbol", (0, 1), None),
    ("2j", "unknown_symbol", (1, 2), None),
    ("l1 + q12", "unknown_joint", (5, 8), "l1 + (theta1 + theta2)"),
    ("c13", "not_revolute", (0, 3), None),
    ("l1c3", "not_revolute", (2, 4), None),
    ("2 s_7", "not_revolute", (2, 5), None),
    ("c10", "not_revolute", (0, 3), None),
    ("c11", "repeated_joint", (0, 3), None),
    ("sin2q1", "ambiguous_shorthand", (0, 4), "sin(2q1)"),
    ("cos12(q1)", "ambiguous_shorthand", (0, 5), None),
    ("2deg(q1)", "ambiguous_unit", (1, 4), None),
    ("degrees(pi)", "ambiguous_unit", (0, 7), None),
    ("rad(90)", "ambiguous_unit", (0, 3), None),
    ("q1 + rad(-22.5)", "ambiguous_unit", (5, 8), None),
    ("(q1 + 90)deg", "unit_on_variable", (0, 12), None),
    ("l1 deg", "unit_on_variable", (0, 6), None),
    ("90°°", "two_units", (0, 4), None),
    ("2 # 3", "comment", (2, 5), None),
    ("2 # three", "comment", (2, 9), "2"),
    ("q1_", "unexpected_character", (2, 3), None),
    ("2 + 😀", "unexpected_character", (4, 5), None),
    ("\ud800", "unexpected_character", (0, 1), None),
    (r"\foo{1}{2}", "unknown_command", (0, 4), None),
    ("\\", "unknown_command", (0, 1), None),
    ("а2", "look_alike_character", (0, 1), "a2"),
    ("2*с1", "look_alike_character", (2, 3), "2*c1"),
    ("q\u200b1", "invisible_character", (1, 2), "q1"),
    ("1 \u202e- 2", "invisible_character", (2, 3), "1 - 2"),
    ("\ufeff1", "invisible_character", (0, 1), "1"),
    ("q1\x00", "invisible_character", (2, 3), "q1"),
]


@together(("text", "code", "span", "suggestion"), CASES)
def test_an_unreadable_text_has_a_code_a_place_and_a_repair(
    text: str, code: str, span: tuple[int, int], suggestion: str | None, arm: Vocabulary
) -> None:
    with pytest.raises(ExpressionError) as caught:
        read(text, arm)
    error = caught.value
    assert (error.code, error.span) == (code, span), error.message
    if suggestion is not None:
        assert error.suggestion == suggestion


@together("text", [case[0] for case in CASES])
def test_a_message_can_be_translated(text: str, arm: Vocabulary) -> None:
    with pytest.raises(ExpressionError) as caught:
        read(text, arm)
    for error in (caught.value, deepcopy(caught.value)):
        assert isinstance(error.message, Sentence)
        assert error.message == Sentence(
            error.message.template, error.message.values, error.message.plural
        )


REPAIRED = [case[0] for case in CASES if case[3] is not None and "\ufeff" not in case[0]]


@together("text", REPAIRED)
def test_a_suggestion_can_be_read(text: str, arm: Vocabulary) -> None:
    with pytest.raises(ExpressionError) as caught:
        read(text, arm)
    assert caught.value.suggestion is not None
    read(caught.value.suggestion, arm)


@pytest.mark.parametrize(
    "number",
    [float("nan"), float("inf"), -float("inf"), 10**400, -(10**9999)],
    ids=["nan", "inf", "-inf", "400 digits", "9999 digits"],
)
def test_an_infinite_number_is_refused(number: float, arm: Vocabulary) -> None:
    with pytest.raises(ExpressionError) as caught:
        read(number, arm)
    assert caught.value.code == "not_finite"


@pytest.mark.parametrize("boolean", [True, False])
def test_a_boolean_is_refused(boolean: bool, arm: Vocabulary) -> None:
    with pytest.raises(ExpressionError, match="not true or false") as caught:
        read(boolean, arm)
    assert caught.value.code == "not_a_number"


def test_a_name_that_looks_like_a_power_of_ten_is_ambiguous() -> None:
    vocabulary = Vocabulary([Symbol("e1", "length"), Symbol("e", "number")])
    for text, product in (("2e1", "2*e1"), ("2e-1", "2*e-1")):
        with pytest.raises(ExpressionError) as caught:
            read(text, vocabulary)
        assert (caught.value.code, caught.value.suggestion) == ("ambiguous_number", product)


def test_a_memoized_error_is_raised_as_a_new_object(arm: Vocabulary) -> None:
    errors = []
    for _ in range(2):
        with pytest.raises(ExpressionError) as caught:
            read("1 +", arm)
        errors.append(caught.value)
    assert errors[0] is not errors[1]
    assert errors[0].args == errors[1].args


def test_a_message_names_the_trailing_operator(arm: Vocabulary) -> None:
    with pytest.raises(ExpressionError, match="after the `\\+` at the end"):
        read("1 +", arm)


def test_a_message_names_the_joined_index(arm: Vocabulary) -> None:
    message = "Write the name and its index without a space: theta1."
    with pytest.raises(ExpressionError, match=message):
        read("l1 + theta 1", arm)


@pytest.mark.parametrize("text", ["q1q2q7", "zz", "x"])
def test_no_name_is_suggested_if_none_is_similar(text: str, arm: Vocabulary) -> None:
    with pytest.raises(ExpressionError) as caught:
        read(text, arm)
    assert (caught.value.code, caught.value.suggestion) == ("unknown_symbol", None)


def test_without_joints_there_is_no_shorthand() -> None:
    with pytest.raises(ExpressionError) as caught:
        read("c1", Vocabulary([Symbol("l1", "length")]))
    assert caught.value.code == "unknown_symbol"
