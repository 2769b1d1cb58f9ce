"""The command line uses the user's language."""

import ast
import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest
from dh_grader.catalogue import shipped_folder
from dh_grader.cli.terminal import user_language

from tests.translations.catalogues import CODES, catalogue, help_texts

ROOT = Path(__file__).parents[2]
VARIABLES = ("LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG", "DH_GRADER_LANGUAGE")
# Prints the help of every command, in one process for each language.
ALL_HELP = """
import sys, typer
from typer.testing import CliRunner
from dh_grader.cli import COMMANDS, program
from dh_grader.cli import commands_of
if sys.argv[1] == "qps":
    from tests.translations.pseudo import offer_pseudo
    offer_pseudo()
def paths(found, *path):
    yield path
    for name, each in getattr(found, "commands", {}).items():
        yield from paths(each, *path, name)
runner = CliRunner()
print(runner.invoke(program, ["--help"]).output)
for name in COMMANDS:
    for path in paths(typer.main.get_command(commands_of(name)), name):
        print(runner.invoke(program, [*path, "--help"]).output)
"""
# What is the same in all languages.
SAME = re.compile(r"\\?\[[^\]]*\]")


def process(*arguments: object, **environment: str) -> subprocess.CompletedProcess[str]:
    kept = {name: value for name, value in os.environ.items() if name not in VARIABLES}
    return subprocess.run(
        [sys.executable, *map(str, arguments)],
        cwd=ROOT,
        env=kept | {"PYTHONIOENCODING": "utf-8"} | environment,
        capture_output=True,
        encoding="utf-8",
        check=False,
    )


def all_help(code: str) -> str:
    # Wide enough for each text to stay on one line.
    wide = {"COLUMNS": "2000", "DH_GRADER_LANGUAGE": code}
    result = process("-c", ALL_HELP, code, **wide)
    assert result.returncode == 0, result.stderr
    return " ".join(result.stdout.split())


def shown(text: str) -> str:
    return " ".join(text.replace("\\[", "[").split())


@pytest.mark.parametrize(
    ("variables", "code"),
    [
        ({}, "en"),
        ({"LANG": "de_AT.UTF-8"}, "de"),
        ({"LANG": "de.UTF-8"}, "de"),
        ({"LANG": "zh_CN.GB18030"}, "zh"),
        ({"LANG": "fr_BE@euro"}, "fr"),
        ({"LANG": "C"}, "en"),
        ({"LANG": "C.UTF-8", "LANGUAGE": "de"}, "en"),
        ({"LC_ALL": "POSIX", "LANG": "de_DE"}, "en"),
        ({"LANG": "xx"}, "en"),
        ({"LC_ALL": "", "LC_MESSAGES": "es_MX.UTF-8", "LANG": "de_DE"}, "es"),
        ({"LANGUAGE": "it:fr:de", "LANG": "de_DE.UTF-8"}, "fr"),
        ({"LANGUAGE": "en:de", "LANG": "de_DE.UTF-8"}, "en"),
        ({"DH_GRADER_LANGUAGE": "es", "LC_ALL": "de_DE"}, "es"),
        ({"DH_GRADER_LANGUAGE": "en", "LC_ALL": "de_DE"}, "en"),
    ],
)
def test_the_environment_names_the_language(variables: Mapping[str, str], code: str) -> None:
    assert user_language(variables).code == code


@pytest.mark.long
@pytest.mark.parametrize("code", CODES)
def test_all_help_is_in_the_language(code: str) -> None:
    printed = all_help(code)
    words = catalogue(code, "commands")
    texts = {text for text, _ in help_texts()}
    assert len(texts) > 150
    told = {text: str(words[text].string) for text in texts}
    assert [text for text, by in told.items() if shown(by) not in printed] == []
    # A text in English may be part of one in the language, if it is a word or two.
    left = [text for text, by in told.items() if text not in by and shown(text) in printed]
    assert [text for text in left if len(text.split()) > 2] == []
    for typer_word in ("Usage:", "Show this message and exit.", "[required]", "─ Commands ─"):
        assert typer_word not in printed


@pytest.mark.long
def test_the_pseudo_language_covers_all_help() -> None:
    printed = all_help("qps")
    texts = {SAME.sub("", text) for text, _ in help_texts()}
    left = [text for text in texts if len(text.split()) > 2 and shown(text) in printed]
    assert left == []


@pytest.mark.long
@pytest.mark.parametrize("locale", ["C", "C.UTF-8", "xx", "it_IT.UTF-8", ""])
def test_other_locales_give_english(locale: str) -> None:
    arguments = ("-m", "dh_grader", "exercises", "check", "--help")
    printed = process(*arguments, LANG=locale).stdout
    assert printed == process(*arguments).stdout
    assert "Check exercise files: their fields" in printed
    assert "Usage: dh-grader" in printed


@pytest.mark.long
def test_names_of_commands_and_options_stay() -> None:
    english, german = all_help("en"), all_help("de")
    options = [set(re.findall(r"--[a-z-]+", text)) for text in (english, german)]
    assert options[0] == options[1]


@pytest.mark.long
def test_json_is_the_same_in_every_locale(tmp_path: Path) -> None:
    file = tmp_path / "a.json"
    file.write_text(json.dumps({"answers": {"table": "nonsense"}}), encoding="utf-8")
    grade = ("-m", "dh_grader", "grade", file, "--exercise", "planar-rrr", "--format", "json")
    german, english = process(*grade, LANG="de_DE.UTF-8"), process(*grade)
    assert german.stdout == english.stdout
    assert german.returncode == english.returncode


def wrong_table(folder: Path) -> tuple[object, ...]:
    rows = [[0, 0, 0, "q1"], ["l1 +", "90deg", 0, "q2"], ["l2", 0, 0, "-q3"], ["l3", 0, 0, 0]]
    named = [dict(zip(("a", "alpha", "d", "theta"), map(str, row), strict=True)) for row in rows]
    file = folder / "a.json"
    answers = {"table": {"rows": named}, "pose": "[[1]]"}
    file.write_text(json.dumps({"answers": answers}), encoding="utf-8")
    return "-m", "dh_grader", "grade", file, "--exercise", "planar-rrr"


@pytest.mark.long
def test_a_report_on_the_screen_is_in_the_language_throughout(tmp_path: Path) -> None:
    grade = wrong_table(tmp_path)
    english = process(*grade, LANG="C").stdout.splitlines()
    german = process(*grade, LANG="de_AT.UTF-8").stdout.splitlines()
    assert "Nicht bestanden: Die Bestehensgrenze ist 80 %." in german
    assert process(*grade, "--lang", "de").stdout.splitlines() == german
    assert process(*grade, LANG="xx").stdout.splitlines() == english
    assert [line for line in german if line in english and line.strip()] == []


@pytest.mark.long
@pytest.mark.parametrize("form", ["json", "jsonl", "csv", "markdown", "junit"])
def test_other_formats_do_not_follow_the_locale(form: str, tmp_path: Path) -> None:
    grade = (*wrong_table(tmp_path), "--format", form)
    assert process(*grade, LANG="de_AT.UTF-8").stdout == process(*grade, LANG="C").stdout


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("arguments", "german"),
    [
        ("grade a.json", "Nennen Sie, was beantwortet wird: --exercise ID"),
        ("grade a.json --exercise planar-rx", "Eine Aufgabe 'planar-rx' gibt es nicht. Meinten"),
        ("grade a.json --exercise scara --format xml", "'xml' ist keines von text"),
        ("exercises check scara --seeds 3 --output", "Hilfe: 'dh-grader exercises check --help'"),
        ("exercises show scara --figure /nowhere/a.svg", "/nowhere/a.svg kann nicht geschrieben"),
        ("attempts list", "Hier werden keine Versuche aufgezeichnet"),
        ("merge /nowhere/a.jsonl", "/nowhere/a.jsonl kann nicht gelesen werden"),
        ("keys create tutor --scope tutor", "Schlüssel brauchen ein Geheimnis, das auch"),
    ],
)
def test_errors_are_in_the_language(arguments: str, german: str) -> None:
    result = process("-m", "dh_grader", *arguments.split(), LANG="de_DE.UTF-8")
    assert result.returncode == 2
    assert german in result.stderr


@pytest.mark.long
def test_findings_on_an_exercise_are_in_the_language(tmp_path: Path) -> None:
    text = (shipped_folder() / "scara.toml").read_text(encoding="utf-8")
    texts = {
        "bad": text.replace("points = ", "pionts = ", 1),
        "short": text.partition("[[checks")[0],
    }
    for name, each in texts.items():
        (tmp_path / f"{name}.toml").write_text(each, encoding="utf-8")
    check = ("-m", "dh_grader", "exercises", "check", tmp_path)
    german, english = process(*check, LANG="de_DE.UTF-8"), process(*check)
    assert ": hier gibt es keinen Schlüssel 'pionts'; meinten Sie 'points'?" in german.stderr
    assert re.search(r"bad\.toml: parts\[0\]\.pionts \(Zeile \d+\): ", german.stderr)
    assert "short: ok, 3 Teilaufgaben, 0 Prüfungen. Nur Nullen und" in german.stdout
    assert german.stdout.endswith("2 Aufgaben: 1 ok, 1 nicht verwendbar, 1 mit Warnungen\n")
    assert "0 right, 0 equivalent, 0 wrong; schreiben Sie 1 right, 1 " in german.stdout
    assert german.returncode == english.returncode == 2
    assert "there is no key 'pionts' here; did you mean 'points'?" in english.stderr


@pytest.mark.long
def test_problems_of_files_are_in_the_language(tmp_path: Path) -> None:
    handed = {"anna/table.csv": b"\x81", "anna/pose.csv": b" ", "ben/a.zzz": b"PK"}
    for name, content in handed.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(content)
    grade = ("-m", "dh_grader", "grade", tmp_path, "--exercise", "planar-rrr", "--format", "json")
    german, english = process(*grade, "--lang", "de"), process(*grade, LANG="de_DE.UTF-8")
    told = [entry["error"] for entry in json.loads(german.stdout)]
    assert told[0] == (
        "pose.csv ist leer; table.csv ist kein Text in UTF-8 oder Windows-1252; wenn sie ein Text "
        "ist, speichern Sie sie als UTF-8, und geben Sie sie noch einmal ab"
    )
    assert told[1].startswith(
        "a.zzz ist eine Datei einer Art, die dieses Programm nicht liest (.zzz)"
    )
    # The format does not follow the locale, but complaints do.
    assert [entry["error"][:22] for entry in json.loads(english.stdout)] == [
        "pose.csv is empty; tab",
        "a.zzz is a file of a k",
    ]
    assert english.stderr == german.stderr
    assert german.stderr == f"{tmp_path / 'anna'}: {told[0]}\n{tmp_path / 'ben/a.zzz'}: {told[1]}\n"


@pytest.mark.long
def test_the_list_of_exercises_is_in_the_language() -> None:
    result = process("-m", "dh_grader", "exercises", "list", LANG="de_DE.UTF-8")
    assert "Gelenke  Titel und Teilaufgaben (Punkte)\nHier beginnen\n" in result.stdout


@pytest.mark.long
def test_what_the_operating_system_says_is_in_the_language(tmp_path: Path) -> None:
    missing = tmp_path / "nichts.csv"
    command = ("-m", "dh_grader", "grade", missing, "--exercise", "scara", "--part", "table")
    result = process(*command, DH_GRADER_LANGUAGE="de")
    assert "Datei oder Ordner nicht vorhanden" in result.stderr
    assert "No such file" not in result.stderr


def plain_words(node: ast.AST) -> Iterator[str]:
    match node:
        case ast.Call(func=ast.Name(id="Text"), args=[text, *_]):
            yield from plain_words(text)
        case ast.Call():
            return
        case ast.Constant(value=str(text)) if re.search("[a-z]{3}", text):
            yield text
        case _:
            for each in ast.iter_child_nodes(node):
                yield from plain_words(each)


def test_nothing_is_printed_that_is_no_sentence() -> None:
    printers = {"echo", "print", "tell", "tell_verdict", "complain", "give_up"}
    found = []
    for file in sorted((ROOT / "service" / "dh_grader" / "cli").rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call):
                name = getattr(node.func, "attr", getattr(node.func, "id", ""))
                if name in printers:
                    found += [(file.name, text) for each in node.args for text in plain_words(each)]
    assert found == [("__init__.py", "dh-grader ")]  # before the version
