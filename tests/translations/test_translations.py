"""Test languages, sentences, and the sentences of reports."""

import copy
import pickle
import re
from collections.abc import Iterator, Mapping
from functools import cache
from gettext import NullTranslations
from itertools import islice
from string import Formatter
from typing import ClassVar
from unicodedata import lookup

import pytest
from dh_grader.grading import FeedbackLevel, Submission, grade
from dh_grader.grading.report import PartReport, messages_of
from dh_grader.translations import (
    ENGLISH,
    LANGUAGES,
    Language,
    Sentence,
    accepted_language,
    bulleted,
    joined,
    language_named,
    listed,
    say,
    say_count,
    told,
)

from tests.docs.sentences import answers, formulas, pasted_texts, said_of_formulas, said_of_pasted
from tests.grading.diagnosis.traces import exercises
from tests.translations.german import german

# --- Choose the language for a reader


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


# --- Translate a message (``Sentence``) from English into a second language


class German(NullTranslations):
    """Translates a few sentences into German."""

    words: ClassVar = {
        "{first} and {last}": "{first} und {last}",
        "Exchange {cells}.": "Vertauschen Sie {cells}.",
        "one row": "eine Zeile",
        "{count} rows": "{count} Zeilen",
    }

    def gettext(self, message: str) -> str:
        return self.words.get(message, message)

    def ngettext(self, one: str, many: str, count: int) -> str:
        return self.gettext(one if count == 1 else many)


def test_a_sentence_is_its_english_text() -> None:
    assert say("Joint {joint} slides: {name}.", joint=3, name="d3") == "Joint 3 slides: d3."
    assert listed(["a"]) == "a"
    assert listed(["a", "d", "α"]) == "a, d and α"


def test_the_words_of_a_list_may_be_sentences() -> None:
    words = [say("one row"), "a", say("one row"), "d"]
    assert listed(words) == "one row, a, one row and d"
    assert told(listed(words), German()) == "eine Zeile, a, eine Zeile und d"
    assert told(listed(words[:1]), German()) == "eine Zeile"
    assert listed([]) == ""


def test_paragraphs_and_items_are_told_in_the_language_too() -> None:
    text = joined(
        "\n\n", ["a {b}", bulleted([say("one row"), say("Exchange {cells}.", cells="d")])]
    )
    assert text == "a {b}\n\n- one row\n- Exchange d."
    assert told(text, German()) == "a {b}\n\n- eine Zeile\n- Vertauschen Sie d."


def test_sentences_within_a_sentence_are_told_in_the_language_too() -> None:
    sentence = say("Exchange {cells}.", cells=listed(["a", "d"]))
    assert sentence == "Exchange a and d."
    assert told(sentence, German()) == "Vertauschen Sie a und d."


def test_a_sentence_without_a_translation_and_a_plain_text_stay() -> None:
    assert told(say("Write {name}.", name="0"), German()) == "Write 0."
    assert told("one row", German()) == "one row"
    assert told(say("one row"), None) == "one row"


@pytest.mark.parametrize(
    ("count", "english", "german"),
    [(1, "one row", "eine Zeile"), (0, "0 rows", "0 Zeilen"), (3, "3 rows", "3 Zeilen")],
)
def test_a_sentence_counts(count: int, english: str, german: str) -> None:
    sentence = say_count("one row", "{count} rows", count=count)
    assert sentence == english
    assert told(sentence, German()) == german


def test_an_empty_sentence_stays_empty() -> None:
    german = LANGUAGES["de"].translation
    assert german is not None
    assert german.gettext("") != ""
    assert told(say(""), german) == ""


def test_braces_in_a_value_are_no_places() -> None:
    assert say("Write {name}.", name=r"c_{12}") == r"Write c_{12}."


def test_copies_keep_their_template() -> None:
    sentence = say("Exchange {cells}.", cells=listed(["a", "d"]))
    for same in (copy.deepcopy(sentence), pickle.loads(pickle.dumps(sentence))):  # noqa: S301
        assert same == sentence
        assert told(same, German()) == "Vertauschen Sie a und d."


# --- Every message of a report can be translated

# The names of values that quote a text of an author or a student.
QUOTED = {"part"}
# The example answers are divided into this many shares.
SHARES = 4
_WORDS = re.compile(r"[^\W\d_]{3,} [^\W\d_]{2,}")


class Pseudo:
    """A language for tests: English in capital letters."""

    def gettext(self, message: str, /) -> str:
        pieces = []
        for text, name, _, _ in Formatter().parse(message):
            pieces.append(text.upper().replace("{", "{{").replace("}", "}}"))
            pieces.append("" if name is None else f"{{{name}}}")
        return "".join(pieces)

    def ngettext(self, one: str, many: str, count: int, /) -> str:
        return self.gettext(one if count == 1 else many)


@cache
def reports(share: int) -> tuple[PartReport, ...]:
    """Return the reports on some of the example answers in docs/sentences.md.

    The answers are divided into shares for parallel tests; ``share`` is the number of a share.
    """
    catalogue = exercises()
    return tuple(
        part
        for each in islice(answers(catalogue), share, None, SHARES)
        for part in grade(
            catalogue[each.exercise],
            Submission(each.answers, each.angle_unit, FeedbackLevel.FULL),
        ).parts
    )


def said_of(part: PartReport) -> Iterator[tuple[str, str]]:
    for message, _, _ in messages_of(part):
        yield message.message, message.code
        for correction in (message.correction, *(each.correction for each in message.places or ())):
            # A direction such as +x is a value, not an instruction.
            if correction and correction.latex is None and _WORDS.search(correction.text):
                yield correction.text, message.code
    for lost in part.lost:
        # A row of its own has only a label.
        if lost.message != lost.row:
            yield lost.message, lost.code
    if part.little_worth:
        yield part.little_worth.message, "little_worth"


@cache
def said(share: int) -> tuple[tuple[str, str], ...]:
    """Return some messages and corrections in docs/sentences.md, with their codes.

    ``share`` is the number of a share (a subset for parallel tests).
    """
    given = [*said_of_formulas(formulas())]
    given += said_of_pasted(pasted_texts(), exercises()["planar-rr"])
    return (
        *((each.sentence, each.code) for each in given[share::SHARES]),
        *(each for part in reports(share) for each in said_of(part)),
    )


@cache
def texts() -> Mapping[str, str]:
    """Return all messages and corrections in docs/sentences.md, with their codes.

    A plain text replaces a ``Sentence`` with the same text.
    """
    pairs = [each for share in range(SHARES) for each in said(share)]
    pairs.sort(key=lambda each: isinstance(each[0], Sentence))
    found: dict[str, str] = {}
    for text, code in pairs:
        found.setdefault(text, code)
    return found


def sentences(share: int) -> list[Sentence]:
    """Return the different sentences in a share (subset) of the messages and corrections."""
    return [text for text in dict.fromkeys(t for t, _ in said(share)) if isinstance(text, Sentence)]


each_share = pytest.mark.parametrize("share", range(SHARES))


def leaves(sentence: Sentence) -> Iterator[tuple[str, str]]:
    is_plural = sentence.plural and sentence.values["count"] != 1
    template = sentence.plural if is_plural else sentence.template
    for name, value in sentence.values.items():
        if isinstance(value, Sentence):
            yield from leaves(value)
        elif f"{{{name}}}" in template:
            yield name, str(value)


def is_prose(value: str) -> bool:
    try:
        lookup(value)
    except KeyError:
        return _WORDS.search(value) is not None
    return False


@pytest.mark.long
def test_every_message_and_correction_is_a_sentence() -> None:
    assert [text for text in texts() if not isinstance(text, Sentence)] == []


@pytest.mark.sampled(SHARES)
@each_share
def test_another_language_keeps_the_values_and_no_english_words(share: int) -> None:
    assert sentences(share)
    for sentence in sentences(share):
        values = [value for _, value in leaves(sentence)]
        text = told(sentence, Pseudo())
        assert all(value in text for value in values), sentence
        for value in sorted(values, key=len, reverse=True):
            text = text.replace(value, "")
        assert not re.search(r"[a-z]{2}", text), sentence


@pytest.mark.sampled(SHARES)
@each_share
def test_values_of_sentences_contain_no_prose(share: int) -> None:
    found = {
        (sentence.template, value)
        for sentence in sentences(share)
        for name, value in leaves(sentence)
        if name not in QUOTED and is_prose(value)
    }
    assert found == set()
