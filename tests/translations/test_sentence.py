"""Translate a message (``Sentence``) from English into a second language."""

import copy
import pickle
from gettext import NullTranslations
from typing import ClassVar

import pytest
from dh_grader.translations import LANGUAGES, bulleted, joined, listed, say, say_count, told


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
