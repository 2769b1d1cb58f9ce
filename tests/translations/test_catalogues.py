"""The translations of all languages match the sentences in the source."""

import os
import re
import subprocess
import sys
from gettext import GNUTranslations
from io import BytesIO
from pathlib import Path

import pytest
from babel.messages.catalog import Catalog
from babel.messages.mofile import write_mo
from babel.messages.pofile import read_po
from dh_grader.translations import DOMAINS, compiled_catalogue, read_catalogue

from tests.translations.catalogues import (
    CODES,
    FOLDER,
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
def test_a_compiled_catalogue_has_the_translations_of_its_text(code: str, domain: str) -> None:
    text = (FOLDER / code / f"{domain}.po").read_bytes()
    compiled = GNUTranslations(BytesIO(compiled_catalogue(text, domain)))
    out = BytesIO()
    write_mo(out, read_po(BytesIO(text), locale=code, domain=domain))
    out.seek(0)
    by_babel = GNUTranslations(out)
    for each in catalogue(code, domain):
        if isinstance(each.id, tuple):
            one, many = each.id
            for count in range(12):
                told = compiled.ngettext(one, many, count)
                assert told == by_babel.ngettext(one, many, count)
        elif isinstance(each.id, str) and each.id:
            assert compiled.gettext(each.id) == by_babel.gettext(each.id) == each.string


def test_all_that_a_text_may_hold_is_compiled() -> None:
    text = r"""# A remark
msgid ""
msgstr ""
"Content-Type: text/plain; charset=utf-8\n"
"Plural-Forms: nplurals=2; plural=(n != 1);\n"

#, fuzzy, python-format
msgid "guessed"
msgstr "geraten"

msgid "two "
"lines"
msgstr ""
"zwei\n"
"\"Zeilen\"\t\\nu\r\n"

msgctxt "chess"
msgid "bishop"
msgstr "Läufer"

msgid "none"
msgstr ""

msgid "one row"
msgid_plural "rows"
msgstr[0] "eine Zeile"
msgstr[1] "Zeilen"

#~ msgid "left out"
#~ msgstr "weggelassen"
""".replace("\n", "\r\n")
    found = GNUTranslations(BytesIO(compiled_catalogue(text.encode(), "a.po")))
    assert found.gettext("two lines") == 'zwei\n"Zeilen"\t\\nu\r\n'
    assert found.pgettext("chess", "bishop") == "Läufer"
    assert [found.ngettext("one row", "rows", count) for count in (1, 2)] == [
        "eine Zeile",
        "Zeilen",
    ]
    for kept in ("guessed", "none", "left out", "bishop"):
        assert found.gettext(kept) == kept


@pytest.mark.parametrize(
    "text",
    [
        'msgid "a"\nmsgstr "b"\n<<<<<<< HEAD\n',
        'msgid "a"\nmsgstr "b"\nmsgid "c"\nmsgstr "d"\n',
        'msgid "a\nmsgstr "b"\n',
        '"a"\n',
    ],
)
def test_a_text_that_is_no_catalogue_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match=r"a\.po: "):
        compiled_catalogue(text.encode(), "a.po")


def written(folder: Path, translation: str) -> Path:
    header = '"Content-Type: text/plain; charset=utf-8\\n"'
    text = f'msgid ""\nmsgstr ""\n{header}\n\nmsgid "row"\nmsgstr "{translation}"\n'
    (folder / "pages.po").write_text(text, encoding="utf-8")
    return folder / "pages.mo"


def row(folder: Path) -> str:
    found = read_catalogue(folder, "pages")
    assert found is not None
    return found.gettext("row")


def test_a_catalogue_is_compiled_when_it_is_first_read_and_after_a_change(tmp_path: Path) -> None:
    assert read_catalogue(tmp_path, "pages") is None
    compiled = written(tmp_path, "Zeile")
    assert row(tmp_path) == "Zeile"
    first = compiled.stat()
    assert row(tmp_path) == "Zeile"
    assert compiled.stat().st_mtime_ns == first.st_mtime_ns
    # As long, and not newer: a copy may keep the time of an older file.
    os.utime(written(tmp_path, "Reihe").with_suffix(".po"), (0, 0))
    assert row(tmp_path) == "Reihe"
    assert {file.name for file in tmp_path.iterdir()} == {"pages.po", "pages.mo"}
    # In a wheel, there is no text.
    (tmp_path / "pages.po").unlink()
    assert row(tmp_path) == "Reihe"


@pytest.mark.parametrize("end", [0, 3, 30, -1])
def test_half_a_compiled_catalogue_is_written_again(tmp_path: Path, end: int) -> None:
    compiled = written(tmp_path, "Zeile")
    row(tmp_path)
    whole = compiled.read_bytes()
    compiled.write_bytes(whole[:end])
    assert row(tmp_path) == "Zeile"
    assert compiled.read_bytes() == whole


def test_a_catalogue_is_read_where_nothing_can_be_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    written(tmp_path, "Zeile")

    def refused(*args: object) -> None:
        raise PermissionError

    # The owner of the machine may write to any folder, so that its mode does not help here.
    monkeypatch.setattr(Path, "write_bytes", refused)
    assert row(tmp_path) == "Zeile"
    monkeypatch.undo()
    monkeypatch.setattr(Path, "replace", refused)
    assert row(tmp_path) == "Zeile"
    assert [file.name for file in tmp_path.iterdir()] == ["pages.po"]


def test_several_processes_compile_a_catalogue_at_once(tmp_path: Path) -> None:
    (tmp_path / "sentences.po").write_bytes((FOLDER / "de" / "sentences.po").read_bytes())
    ask = (
        "import sys, pathlib; from dh_grader.translations import read_catalogue;"
        "sys.stdin.readline(); found = read_catalogue(pathlib.Path(sys.argv[1]), 'sentences');"
        "print(found.gettext('The key was revoked.'))"
    )
    processes = [
        subprocess.Popen(
            [sys.executable, "-c", ask, tmp_path],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, encoding="utf-8",
            cwd=FOLDER.parents[1],
        )
        for _ in range(4)
    ]  # fmt: skip
    for each in processes:
        assert each.stdin
        each.stdin.write("\n")
        each.stdin.flush()
    assert {each.communicate()[0].strip() for each in processes} == {
        "Der Schlüssel wurde widerrufen."
    }
    assert sorted(file.name for file in tmp_path.iterdir()) == ["sentences.mo", "sentences.po"]


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
