"""Test the text of exercise files: lines, refusals, translations."""

import re
import tomllib
from pathlib import Path

import pytest
from dh_grader.catalogue import (
    CatalogueError,
    in_language,
    load_exercise,
    read_exercise,
    shipped_folder,
)
from dh_grader.catalogue.files import line_of, value_lines
from dh_grader.catalogue.kinds import SPECS
from dh_grader.translations import ENGLISH, Language
from dh_grader.variants import built

from tests.catalogue.test_faults import VALID, write
from tests.translations.german import german
from tests.variants.varied_files import varied_text

# --- Find the line number of each value in an exercise file

TEXT = '''\
title = "A # no comment" # a comment

[robot]  # the robot
table = [
    # a comment with ] and "
    ["a", "b"], ["c", 'd]'],
    ["""e
"f\\" """, "g"],
]
joints = ["q1",
          "q2"]
[symbols]
"a b" = { kind = "length", range = [0.1,
  2] }
c.kind = "angle"
[[parts]]
id = 1
points = 1979-05-27T07:32:00
[[parts.steps]]
axis = "x"
[[parts.steps]]
axis = "y"
[parts.more]
x = \'\'\'
'quoted' [[parts]]
\'\'\'
y = 5
[[parts]]
id = 2
'''

LINES = {
    "title": 1,
    "robot": 3,
    "robot.table": 4,
    "robot.table[0]": 6,
    "robot.table[1][1]": 6,
    "robot.table[2]": 7,
    "robot.table[2][1]": 8,
    "robot.joints[1]": 11,
    "symbols.a b": 13,
    "symbols.a b.range[1]": 14,
    "symbols.c.kind": 15,
    "parts[0]": 16,
    "parts[0].points": 18,
    "parts[0].steps[1]": 21,
    "parts[0].steps[1].axis": 22,
    "parts[0].more.x": 24,
    "parts[0].more.y": 27,
    "parts[1].id": 29,
}


def test_the_text_is_toml() -> None:
    assert tomllib.loads(TEXT)["parts"][0]["more"]["y"] == 5


@pytest.mark.parametrize("field", LINES)
def test_the_line_of_each_value_is_found(field: str) -> None:
    assert value_lines(TEXT)[field] == LINES[field]


@pytest.mark.parametrize(
    ("field", "line"),
    [
        ("robot.table[1].alpha", 6),
        ("parts[1].points", 28),
        ("symbols.nothing.kind", 12),
        ("parts[0].from.literal['base','tool']", 16),
        ("nothing", None),
        ("", None),
    ],
)
def test_a_missing_field_has_the_line_of_the_field_around_it(field: str, line: int | None) -> None:
    assert line_of(field, value_lines(TEXT)) == line


@pytest.mark.parametrize("file", sorted(shipped_folder().glob("*.toml")), ids=lambda f: f.stem)
def test_each_value_of_a_shipped_file_is_on_its_line(file: Path) -> None:
    text = file.read_text(encoding="utf-8")
    lines = text.splitlines()
    found = value_lines(text)
    for path, value in leaves(tomllib.loads(text), ""):
        if isinstance(value, str) and "\n" not in value and "\\" not in value:
            assert value in lines[found[path] - 1], path
            key = re.split(r"[.\[]", path)[-1]
            assert key[0].isdigit() or key in lines[found[path] - 1]


def leaves(value: object, path: str) -> list[tuple[str, object]]:
    if isinstance(value, dict):
        pairs = [(f"{path}.{key}".lstrip("."), child) for key, child in value.items()]
    elif isinstance(value, list):
        pairs = [(f"{path}[{i}]", child) for i, child in enumerate(value)]
    else:
        return [(path, value)]
    return [leaf for name, child in pairs for leaf in leaves(child, name)]


# --- Test the messages about unknown values in an exercise file

*_FIRST, _LAST = map(repr, sorted(SPECS))
KINDS = f"{', '.join(_FIRST)} or {_LAST}"
CONVENTIONS = "'standard', 'modified' or 'either'"
FRAMES = "'base' or 'tool', or input should be a valid integer"
SEQUENCES = (
    "'RPY', 'XYZ', 'XZY', 'YXZ', 'YZX', 'ZXY', 'ZYX', 'XYX', 'XZX', 'YXY', 'YZY', 'ZXZ' or 'ZYZ'"
)
TABLE = 'kind = "dh_table"'
POSE = 'kind = "transform"'


def told(tmp_path: Path, text: str) -> list[tuple[str, str]]:
    with pytest.raises(CatalogueError) as caught:
        load_exercise(write(tmp_path, text))
    return [(fault.field, fault.reason) for fault in caught.value.faults]


@pytest.mark.parametrize(
    ("old", "new", "field", "reason"),
    [
        (TABLE, 'kind = "dh_tabel"', "parts[0].kind",
         f"is 'dh_tabel'; did you mean 'dh_table'? Write {KINDS}"),
        (TABLE, 'kind = "DH_Table"', "parts[0].kind",
         f"is 'DH_Table'; did you mean 'dh_table'? Write {KINDS}"),
        (TABLE, 'kind = "quiz"', "parts[0].kind", f"is 'quiz'; write {KINDS}"),
        (TABLE, "kind = 3", "parts[0].kind", f"is 3; write {KINDS}"),
        (TABLE, f'kind = "{"x" * 500}"', "parts[0].kind",
         f"is 'xxxxxxxxxxxx...xxxxxxxxxxxxx'; write {KINDS}"),
        (POSE, 'kind = "euler_angles"\nsequence = "zyZ"', "parts[1].sequence",
         f"is 'zyZ'; did you mean 'ZYZ'? Write {SEQUENCES}"),
        ('k = { kind = "number"', 'k = { kind = "nummber"', "symbols.k.kind",
         "is 'nummber'; did you mean 'number'? Write 'angle', 'length' or 'number'"),
        # One fault, although pydantic has a finding for each type.
        ('convention = "standard"\n\n[[parts]]', 'convention = "standart"\n\n[[parts]]',
         "parts[0].convention",
         f"is 'standart'; did you mean 'standard'? Write {CONVENTIONS}"),
        (POSE, f'{POSE}\nfrom = "bas"', "parts[1].from",
         f"is 'bas'; did you mean 'base'? Write {FRAMES}"),
        ('["0", "0", "d2 + a1"', '["0", [], "d2 + a1"', "robot.table[1][1]",
         "Input should be a valid string, or input should be a valid number"),
    ],
)  # fmt: skip
def test_an_unknown_value_gets_a_suggestion(
    old: str, new: str, field: str, reason: str, tmp_path: Path
) -> None:
    assert VALID.count(old) == 1
    assert told(tmp_path, VALID.replace(old, new)) == [(field, reason)]


def test_all_faults_of_a_file_are_reported_together(tmp_path: Path) -> None:
    text = VALID.replace(TABLE, 'kind = "tabel"').replace("points = 4", 'points = "four"')
    assert [field for field, _ in told(tmp_path, text)] == ["parts[0].kind", "parts[1].points"]


def test_a_symbol_may_have_the_name_of_a_pydantic_type(tmp_path: Path) -> None:
    text = VALID.replace("[symbols]", "[symbols]\nfloat = 3")
    assert [field for field, _ in told(tmp_path, text)] == ["symbols.float"]


# --- Test translated texts in an exercise file

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
