"""Test translated texts in an exercise file."""

import re
from pathlib import Path

import pytest
from dh_grader.catalogue import CatalogueError, in_language, read_exercise
from dh_grader.translations import ENGLISH, Language
from dh_grader.variants import built

from tests.translations.german import german
from tests.variants.varied_files import varied_text

ARM = r"""
title = "An arm"
source = "made for this test"
summary = "Two joints."
statement = "The angle $\\theta_1$ and the length $a_1$; then $a_1$ again."

[robot]
structure = "RP"
convention = "standard"
joints = ["theta1", "d2"]
table = [["a1", "90deg", "0", "theta1"], ["0", "0", "d2", "0"]]

[symbols]
a1 = { kind = "length", description = "length of link 1" }

[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
prompt = "Give the table."
convention = "standard"
"""
GERMAN = r"""
[translations.de]
title = "Ein Arm"
statement = "Die Länge $a_1$, der Winkel $ \\theta_1 $, und noch einmal $a_1$."

[translations.de.symbols]
a1 = "Länge von Glied 1"
theta1 = "Winkel von Gelenk 1"

[translations.de.parts.table]
prompt = "Geben Sie die Tabelle an."
"""
FILE = Path("arm.toml")
GERMAN_WORDS = german({})


def test_missing_texts_stay_in_english() -> None:
    arm = read_exercise(FILE, ARM + GERMAN)
    translated = in_language(arm, GERMAN_WORDS)
    assert (translated.title, translated.summary) == ("Ein Arm", "Two joints.")
    assert translated.statement.startswith("Die Länge $a_1$")
    assert (translated.parts[0].title, translated.parts[0].prompt) == (
        "Table",
        "Geben Sie die Tabelle an.",
    )
    assert {each.name: each.description for each in translated.variables} == {
        "theta1": "Winkel von Gelenk 1",
        "d2": "joint displacement of joint 2",
        "a1": "Länge von Glied 1",
    }
    assert in_language(arm, GERMAN_WORDS) is translated
    assert in_language(arm, ENGLISH) is arm
    assert in_language(arm, Language("nl", "Nederlands", "nl")) == arm
    assert (arm.id, arm.version) == (translated.id, translated.version)
    assert arm.version == read_exercise(FILE, ARM).version


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        ("translations.de", "translations.at", "translations.at: there is no such language; write"),
        ("parts.table", "parts.pose", "translations.de.parts.pose: there is no such name; write"),
        ("a1 =", "a2 =", "translations.de.symbols.a2: there is no such name; write one of theta1"),
        ("$a_1$,", "a_1,", "translations.de.statement: lacks the formula $a_1$ of the English"),
        ("$a_1$,", "$a_2$, $a_1$,", "translations.de.statement: has a formula $a_2$ that the"),
        ("title =", "titel =", "did you mean 'title'? The keys are title, summary, statement"),
        ("prompt =", "promt =", "did you mean 'prompt'? The keys are title, prompt"),
        ('"Ein Arm"', "1", "translations.de.title: "),
    ],
)
def test_faults_are_named(old: str, new: str, fault: str) -> None:
    with pytest.raises(CatalogueError) as refused:
        read_exercise(FILE, ARM + GERMAN.replace(old, new))
    assert fault in re.sub(r" \(line \d+\)", "", str(refused.value))


def test_variants_keep_the_translation_with_their_values() -> None:
    text = varied_text() + '[translations.de]\ntitle = "Arm {{a1}}"\n'
    arm = read_exercise(FILE, text)
    variant = built(arm, "x7")
    value = arm.vary and arm.vary.written("x7")["a1"]
    assert in_language(variant, GERMAN_WORDS).title == f"Arm {value}"
    assert variant.version == built(read_exercise(FILE, varied_text()), "x7").version
