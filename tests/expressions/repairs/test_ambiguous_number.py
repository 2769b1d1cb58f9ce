import pytest

from service.expressions import ExpressionError, Symbol, Vocabulary, read
from tests.expressions.corpus_files import ROBOT
from tests.expressions.repairs.pairs import accept

WITH_E = Vocabulary([Symbol("e1", "length"), Symbol("e", "number"), *ROBOT.symbols])


@pytest.mark.parametrize(
    ("text", "suggestion"), [("2e1", "2*e1"), ("2e-1", "2*e-1"), ("q1 + 2e1", "q1 + 2*e1")]
)
def test_refused(text: str, suggestion: str) -> None:
    with pytest.raises(ExpressionError) as caught:
        read(text, WITH_E)
    assert (caught.value.code, caught.value.suggestion) == ("ambiguous_number", suggestion)
    read(suggestion, WITH_E)


@pytest.mark.parametrize("text", ["2e1", "2e-1"])
def test_accepted(text: str) -> None:
    """Where no symbol is called e, it is a power of ten."""
    accept(text, text)


@pytest.mark.parametrize("number", [1e-7, 2e-1, 1e22])
def test_a_json_number_is_one_whatever_the_symbols_are_called(number: float) -> None:
    assert read(number, WITH_E).evaluate({}) == number
