"""A failing case fails the whole test, and the error names the case."""

import pytest

from tests.together import together


@pytest.fixture
def limit() -> int:
    return 3


@together("number", range(3))
@together(("text", "size"), [("", 0), ("ab", 2)])
def test_every_case_runs_with_the_fixtures(number: int, text: str, size: int, limit: int) -> None:
    assert number < limit
    assert len(text) == size


def test_each_failed_case_is_reported_and_none_stops_the_others() -> None:
    tried = []

    @together(("number", "how"), [(1, "raises"), (2, "passes"), (3, "raises not"), (4, "is wrong")])
    def each(number: int, how: str) -> None:
        tried.append(number)
        if how == "raises":
            raise ValueError(number)
        if how == "raises not":
            with pytest.raises(ValueError, match="x"):
                pass
        assert how != "is wrong"

    with pytest.raises(BaseExceptionGroup, match="3 of 4 cases failed") as caught:
        each()
    assert tried == [1, 2, 3, 4]
    assert [failure.__notes__ for failure in caught.value.exceptions] == [
        ["The case: 1, 'raises'"], ["The case: 3, 'raises not'"], ["The case: 4, 'is wrong'"],
    ]  # fmt: skip


def test_at_least_one_case_is_required() -> None:
    with pytest.raises(AssertionError, match="no case"):
        together("number", [])(print)
