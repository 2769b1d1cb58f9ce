"""Words that several messages share."""

import pytest

from service.grading.diagnosis.wording import listed


@pytest.mark.parametrize(
    ("words", "text"),
    [(["1"], "1"), (["1", "2"], "1 and 2"), (["1", "2", "3"], "1, 2 and 3"), ([], "")],
)
def test_words_in_a_list(words: list[str], text: str) -> None:
    assert listed(words) == text
