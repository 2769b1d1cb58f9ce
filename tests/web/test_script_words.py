"""Test the dictionaries for translations in the scripts of pages."""

import json
import re
from pathlib import Path

import pytest
from dh_grader.translations import LANGUAGES
from dh_grader.web.pages import FOLDER, dictionary, load_assets, sentences_in

from tests.translations.catalogues import extracted
from tests.translations.pseudo import PSEUDO, without_others

SCRIPTS = [file.read_text("utf-8") for file in FOLDER.rglob("*.js") if "vendor" not in file.parts]


def words_in(module: str) -> tuple[dict[str, str], dict[str, list[str]]]:
    found = json.loads(module.removeprefix("export default ").removesuffix(";\n"))
    assert found["tag"] == PSEUDO.tag
    return found["words"], found["counts"]


def test_a_dictionary_has_all_sentences_of_the_scripts_and_no_others() -> None:
    words, counts = words_in(dictionary(PSEUDO, sentences_in(SCRIPTS)))
    marked = [
        each.id
        for each in extracted("pages")
        if any(name.endswith(".js") for name, _ in each.locations)
    ]
    assert set(words) == {each for each in marked if isinstance(each, str)}
    assert set(counts) == {each[0] for each in marked if not isinstance(each, str)}
    assert all(any(letter > "\x7f" for letter in each) for each in words.values())


def test_strings_of_either_quotes_are_found() -> None:
    script = (
        """worded("A “b” \\"c\\"", { d }); wordedFor('one "x"', "it\\u2019s", 2); other("no")"""
    )
    words, counts = words_in(dictionary(PSEUDO, sentences_in([script])))
    assert set(words) == {'A “b” "c"'}
    assert set(counts) == {'one "x"'}


def test_the_script_with_the_words_names_the_dictionary(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "words.js").write_text('const FILES = {};\nworded("Check");\n', encoding="utf-8")
    without_others(monkeypatch)
    plain = load_assets(tmp_path)
    assert plain.words(PSEUDO) is None
    assert plain.by_plain_name["words.js"].content.startswith(b"const FILES = {};")
    monkeypatch.setitem(LANGUAGES, PSEUDO.code, PSEUDO)
    assets = load_assets(tmp_path)
    name = assets.words(PSEUDO)
    assert name is not None
    assert f'{{"qps": "./{name}"}}'.encode() in assets.by_plain_name["words.js"].content
    assert b'"Check": "' in assets.by_name[name].content
    assert plain.name("words.js") != assets.name("words.js")


def test_every_marked_sentence_is_a_constant() -> None:
    found = [
        match[0]
        for script in SCRIPTS
        for match in re.finditer(r"(?<!function )\bworded(?:For)?\(\s*(?![\s\"'])[^\n]*", script)
    ]
    assert found == []
