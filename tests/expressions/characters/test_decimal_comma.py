import pytest
from dh_grader.expressions import ExpressionError, Symbol, Vocabulary, read
from dh_grader.expressions.characters import with_points

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
