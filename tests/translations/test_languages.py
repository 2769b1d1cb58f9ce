"""The choice of a language for a reader."""

import pytest

from service.translations import ENGLISH, LANGUAGES, accepted_language, language_named


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
