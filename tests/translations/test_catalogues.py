"""The translations of all languages match the sentences in the source."""

import re
from io import BytesIO

import pytest
from babel.messages.catalog import Catalog
from babel.messages.pofile import read_po

from service.translations.languages import DOMAINS
from tests.translations.catalogues import (
    CODES,
    FOLDER,
    as_mo,
    as_po,
    catalogue,
    faults,
    filled,
    updated,
)

COMMITTED = [
    (code, domain)
    for code in CODES
    for domain in DOMAINS
    if (FOLDER / code / f"{domain}.po").is_file()
]


@pytest.mark.parametrize(("code", "domain"), COMMITTED)
def test_a_catalogue_has_exactly_the_sentences_of_the_source(code: str, domain: str) -> None:
    old, new = catalogue(code, domain), updated(code, domain)
    assert {each.id for each in old} == {each.id for each in new}


@pytest.mark.parametrize(("code", "domain"), COMMITTED)
def test_every_sentence_is_translated(code: str, domain: str) -> None:
    missing = [
        each.id
        for each in catalogue(code, domain)
        if each.id and (each.fuzzy or not all(_texts(each.string)))
    ]
    assert missing == []


@pytest.mark.parametrize(("code", "domain"), COMMITTED)
def test_translations_have_the_places_and_quotations_of_their_sentences(
    code: str, domain: str
) -> None:
    assert list(faults(catalogue(code, domain))) == []


@pytest.mark.parametrize(("code", "domain"), COMMITTED)
def test_the_compiled_catalogue_is_that_of_the_text(code: str, domain: str) -> None:
    text = (FOLDER / code / f"{domain}.po").read_bytes()
    compiled = as_mo(read_po(BytesIO(text), locale=code, domain=domain))
    assert (FOLDER / code / f"{domain}.mo").read_bytes() == compiled


def test_a_translation_without_a_place_is_a_fault() -> None:
    found = Catalog(locale="de")
    found.add("Write `{name}` in row {row}.", "Schreiben Sie `{name}` in Zeile {zeile}.")
    found.add("Write `pi`.", "Schreiben Sie `π`.")
    found.add("Check the sign.", "Prüfen Sie das Vorzeichen.")
    assert [fault.split()[0] for fault in faults(found)] == ["places", "quotations"]
    assert b"Vorzeichen" in as_po(found)


def test_translations_are_filled_in_by_sentence() -> None:
    found = Catalog(locale="de")
    found.add("Check the sign.")
    found.add(("{count} row", "{count} rows"))
    found.add("Write 0.", "Schreiben Sie 0.")
    plural = ["{count} Zeile", "{count} Zeilen"]
    filled(
        found,
        [
            ("Check the sign.", "Prüfen Sie das Vorzeichen."),
            (["{count} row", "{count} rows"], plural),
            ("Write 0.", ""),
        ],
    )
    assert found["Check the sign."].string == "Prüfen Sie das Vorzeichen."
    assert found[("{count} row", "{count} rows")].string == tuple(plural)
    assert found["Write 0."].string == "Schreiben Sie 0."


def _texts(string: object) -> tuple[str, ...]:
    return tuple(string) if isinstance(string, tuple | list) else (str(string),)


# Another form of address than the glossary's, words that it does not take for a term, and in
# French the straight apostrophe.
OTHER_WORDS = {
    "de": r"\b([Dd]u|[Dd]ein\w*|[Dd]ich|[Dd]ir|[Ll]ernende\w*|Bericht(en?|s)?)\b",
    "es": r"(?i)(?<!que )(?<!quien )(?<!apartados que )\b(usted|indique|elija|escriba|añada|omita|"
    r"use|corrija|pida|defina|guárdelo|consérvelo|vínculos?|tramas?)\b",
    "fr": r"(?i)\b(tu|ton|tes|liaisons?|organe terminal|tentatives?|premier corps|"
    r"corps de l.outil)\b|\b([cdjlmnst]|qu|jusqu|lorsqu|puisqu|quelqu)'\w",
    "zh": r"您|你|(?<![邀申])请(?!求)|旋转关节",
}


@pytest.mark.parametrize("code", CODES)
def test_translations_speak_to_the_reader_as_their_glossary_says(code: str) -> None:
    found = [
        text
        for domain in DOMAINS
        for message in catalogue(code, domain)
        for text in _texts(message.string)
        if message.id and re.search(OTHER_WORDS[code], text)
    ]
    assert found == []
