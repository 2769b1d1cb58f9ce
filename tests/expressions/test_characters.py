"""Test how characters are normalised before a formula is read."""

import pytest
from dh_grader.expressions import ExpressionError, Symbol, Vocabulary, read
from dh_grader.expressions.characters import with_points

# --- Read LaTeX commands next to letters and digits


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
def test_a_command_does_not_merge_with_adjacent_letters(text: str, meaning: str) -> None:
    vocabulary = Vocabulary(
        [
            Symbol("theta1", "angle", ("q1",), joint=1),
            Symbol("a", "length"),
            Symbol("d", "length"),
        ]
    )
    assert read(text, vocabulary).text() == meaning


# --- Decimal comma

SYMBOLS = [Symbol("l1", "length"), Symbol("theta1", "angle", joint=1)]
WITH_COMMA = Vocabulary(SYMBOLS, decimal_comma=True)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1,5", 1.5),
        ("-0,25", -0.25),
        ("1.5", 1.5),
        ("2*0,5 + 1,25", 2.25),
        ("0,5e-1", 0.05),
        ("1,000", 1.0),
        ("sqrt(2,25)", 1.5),
        ("atan2(0,5; 0,5)*4", 3.141592653589793),
        ("atan2(1, 1)*4", 3.141592653589793),
        ("atan2(sin(0,5); cos(0,5))", 0.5),
        ("3,", None),
        ("1,2,3", None),
        ("0.1,90", None),
        ("1,5; 2", None),
        ("l1,5", None),
    ],
)
def test_a_number_with_a_comma_is_read(text: str, value: float | None) -> None:
    if value is None:
        with pytest.raises(ExpressionError):
            read(text, WITH_COMMA)
    else:
        assert read(text, WITH_COMMA).evaluate({}) == pytest.approx(value, abs=1e-12)


def test_without_leave_a_comma_separates_values() -> None:
    with pytest.raises(ExpressionError) as failure:
        read("1,5", Vocabulary(SYMBOLS))
    assert failure.value.suggestion == "1.5"


def test_a_degree_sign_and_a_name_may_follow() -> None:
    assert read("22,5°", WITH_COMMA).evaluate({}) == pytest.approx(0.392699081698724)
    assert read("0,5 l1", WITH_COMMA).evaluate({"l1": 3.0}) == pytest.approx(1.5)  # type: ignore[dict-item]


@pytest.mark.parametrize(
    "text", ["0,5; 0,3", "0,5\t0,3", "0,5, 0,3", "| 0,5 | 0,3 |", "{0,5; 0,3}"]
)
def test_each_character_keeps_its_place(text: str) -> None:
    found = with_points(text)
    assert len(found) == len(text)
    assert found.replace(".", "") == text.replace("0,5", "05").replace("0,3", "03")


# --- Read Greek letters and their names


def test_a_greek_letter_is_not_replaced_by_its_name_inside_a_word() -> None:
    vocabulary = Vocabulary([Symbol(name, "number") for name in ("b", "eta", "beta")])
    assert read("bη", vocabulary).tree == read("b*eta", vocabulary).tree
    assert read("β", vocabulary).tree == read("beta", vocabulary).tree
