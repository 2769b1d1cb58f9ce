"""Choose the language for a reader."""

import pickle

import pytest
from dh_grader.translations import (
    ENGLISH,
    LANGUAGES,
    Language,
    accepted_language,
    language_named,
    say,
    told,
)

from tests.translations.german import german


@pytest.mark.parametrize(
    "header",
    [None, "", "*", "tlh", "tlh,*;q=0.1", ";;;", "q=1", "en;q=nan", ",".join(["x"] * 10000)],
)
def test_any_header_has_a_language(header: str | None) -> None:
    assert accepted_language(header) is ENGLISH


def test_a_tag_may_name_a_region() -> None:
    for tag in ("en", "en-GB", "EN_us", " en "):
        assert language_named(tag) is LANGUAGES["en"]
    assert not any(map(language_named, (None, "", "tlh", "english")))


def test_a_sentence_that_no_catalogue_has_stays_in_english() -> None:
    found = Language("xx", "Nobody's", "xx").translation
    assert found is not None
    assert told(say("Joint {joint} slides.", joint=3), found) == "Joint 3 slides."


def test_a_language_goes_to_another_process_without_its_catalogue() -> None:
    language = german({})
    assert pickle.loads(pickle.dumps(language)) == language  # noqa: S301
