"""Recorded reports: JSON in English, with the sentences that can be translated.

A recorded report begins with ``sentences``, a list of templates with their values. The rest is the
report as it was sent.
"""

import json
from collections.abc import Callable, Mapping
from typing import Any, Final

from pydantic import ValidationError

from service.formats.documents.json import read_report, rendered
from service.formats.told_report import with_texts
from service.grading import Report
from service.translations import Language, Sentence, told

_START: Final = '{"sentences":'
_BRACES: Final = frozenset("{}")
_DECODER: Final = json.JSONDecoder()


def recorded_report(report: Report) -> str:
    """Return a report as JSON for the database, with its translatable sentences."""
    text = rendered(report).decode()
    found: dict[str, Sentence] = {}

    def collect(text: str) -> str:
        if isinstance(text, Sentence):
            found[text] = text
        return text

    with_texts(report, collect)
    if not found:
        return text
    kept = [_written(each) for each in found.values() if each.values or _BRACES & set(each)]
    listed = json.dumps(kept, ensure_ascii=False, separators=(",", ":"))
    return f"{_START}{listed},{text[1:]}"


def shown_report(recorded: str, language: Language) -> str:
    """Return a recorded report as JSON in a language."""
    sentences, text = _divided(recorded)
    translation = language.translation
    if translation is None or sentences is None:
        return text
    known = _known(sentences)
    try:
        report = read_report(text.encode())
    except ValidationError:
        # A report of another version may have another shape.
        return text
    return rendered(with_texts(report, lambda each: told(known(each), translation))).decode()


def sentence_in(report: Mapping[str, Any], text: str) -> str:
    """Find the sentence that has this English text in a recorded report."""
    sentences = report.get("sentences")
    return text if sentences is None else _known(sentences)(text)


def _divided(recorded: str) -> tuple[list[Any] | None, str]:
    if not recorded.startswith(_START):
        return None, recorded
    sentences, end = _DECODER.raw_decode(recorded, len(_START))
    return sentences, "{" + recorded[end + 1 :]


def _known(sentences: list[Any]) -> Callable[[str], str]:
    known = {str(each): each for each in map(_read, sentences)}

    def sentence(text: str) -> str:
        if text in known or not text or _BRACES & set(text):
            return known.get(text, text)
        return Sentence(text)

    return sentence


def _written(sentence: Sentence) -> list[Any]:
    values = {
        name: _written(value) if isinstance(value, Sentence) else value
        for name, value in sentence.values.items()
    }
    return [sentence.template, values, *filter(None, [sentence.plural])]


def _read(written: list[Any]) -> Sentence:
    template, values, *plural = written
    read = {
        name: _read(value) if isinstance(value, list) else value for name, value in values.items()
    }
    return Sentence(template, read, *plural)
