import pytest

from service.expressions import ExpressionError, read
from tests.expressions.corpus_files import ROBOT


@pytest.mark.parametrize("value", [True, False])
def test_refused(value: bool) -> None:
    with pytest.raises(ExpressionError, match="write 1 or 0") as caught:
        read(value, ROBOT)
    assert (caught.value.code, caught.value.span) == ("not_a_number", (0, 0))


@pytest.mark.parametrize("value", [1, 0, 1.0])
def test_accepted(value: float) -> None:
    assert read(value, ROBOT).evaluate({}) == value
