"""A German translation of a few sentences, for tests."""

from collections.abc import Mapping
from gettext import NullTranslations
from typing import Any, cast

import pytest
from dh_grader.grading import Report
from dh_grader.translations import LANGUAGES, Language, Sentence


class _Words(NullTranslations):
    def __init__(self, words: Mapping[str, str]) -> None:
        super().__init__()
        self._words = words

    def gettext(self, message: str) -> str:
        return self._words.get(message, message)

    def ngettext(self, one: str, many: str, count: int) -> str:
        return self.gettext(one if count == 1 else many)


def german(words: Mapping[str, str]) -> Language:
    """Return the language German with only these translations."""
    # Another name: templates are cached by language, and later tests need the whole German.
    made = Language("de", "Deutsch in Tests", "de")
    made.__dict__["translation"] = _Words(words)
    return made


def offer_german(patch: pytest.MonkeyPatch, words: Mapping[str, str]) -> Language:
    """Let the service offer German with only these translations."""
    made = german(words)
    patch.setitem(cast("dict[str, Language]", LANGUAGES), "de", made)
    return made


def as_sentence(text: str) -> str:
    is_plain = not isinstance(text, Sentence) and not {"{", "}"} & set(text)
    return Sentence(text) if is_plain else text


def messages_in(report: Report | Mapping[str, Any]) -> list[str]:
    if isinstance(report, Report):
        return [each.message for part in report.parts for each in part.lost]
    return [each["message"] for part in report["parts"] for each in part["lost"]]
