"""Test the program, its help, and the list of licences."""

import importlib.metadata
import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from typing import Any

import pytest
import typer
from dh_grader.cli import COMMANDS, commands_of
from dh_grader.cli.licences import licence_of, licences, needed
from typer.testing import CliRunner

from tests.submissions import office_documents as office

# --- Test the program as a process: its version, help, imports and output

ROOT = Path(__file__).parents[2]
DATABASES = {"sqlalchemy", "alembic", "psycopg", "sqlite3"}
TABLE = {"answers": {"table": {"rows": [{"a": "l1 +", "alpha": 0, "d": 0, "theta": "q1"}]}}}
# Libraries that read files of office programs.
OFFICE = {"openpyxl", "xlrd", "striprtf", "docx", "odf", "lxml", "defusedxml", "xlsxwriter"}


def process(
    *arguments: object, python: tuple[str, ...] = ("-m", "dh_grader"), **environment: str
) -> subprocess.CompletedProcess[bytes]:
    command = [sys.executable, *python, *map(str, arguments)]
    return subprocess.run(
        command,
        cwd=ROOT,
        env=os.environ | environment,
        capture_output=True,
        check=False,
    )


@pytest.fixture
def answer(tmp_path: Path) -> Path:
    file = tmp_path / "answer.json"
    file.write_text(json.dumps(TABLE), encoding="utf-8")
    return file


def test_the_version_is_the_installed_one() -> None:
    result = process("--version")
    assert result.returncode == 0
    assert result.stdout.decode().split() == ["dh-grader", importlib.metadata.version("dh-grader")]


def test_help_names_every_command_and_the_program() -> None:
    text = process("--help", NO_COLOR="1", PYTHONIOENCODING="utf-8").stdout.decode()
    for word in ("dh-grader", "serve", "grade", "exercises"):
        assert word in text


def loaded(*arguments: object) -> tuple[set[str], bytes]:
    probe = (
        "import sys; from dh_grader.cli import main\n"
        "try: main()\n"
        "finally: print(*sys.modules, file=sys.stderr)"
    )
    result = process(*arguments, python=("-c", probe))
    return set(result.stderr.decode().split()), result.stdout


def test_help_and_version_do_not_import_the_grader() -> None:
    for option in ("--help", "--version"):
        modules, _ = loaded(option)
        assert {name for name in modules if f"{name}.".startswith("dh_grader.")} <= {
            "dh_grader.cli", "dh_grader.cli.terminal", "dh_grader.regex",
            "dh_grader",
            "dh_grader.translations",
        }  # fmt: skip
        heavy = {"numpy", "pydantic", "fastapi", "jinja2", "sympy", "httpx", *DATABASES}
        assert heavy & modules == set()


def test_grading_imports_no_unneeded_packages(answer: Path) -> None:
    modules, output = loaded("grade", answer, "--exercise", "planar-rrr", "--format", "json")
    assert json.loads(output)[0]["exercise"] == "planar-rrr"
    assert {"numpy", "pydantic", "dh_grader.grading.kinds.tables"} <= modules
    heavy = {"fastapi", "httptools", "httpx", "starlette", "sympy", "mpmath", "uvicorn", "uvloop"}
    heavy |= DATABASES
    # http.client would import the whole email package.
    slow = {"http.client", "jinja2", "rich.markdown", "rich.table", "scipy", "unittest"}
    unused = {
        f"dh_grader.{name}"
        for name in (
            "api",
            "authoring",
            "client",
            "contract",
            "courses",
            "figures",
            "hints",
            "lti",
            "server",
            "solutions",
            "store",
            "web",
        )
    }
    assert modules & (heavy | slow | unused | OFFICE) == set()


@pytest.mark.long
def test_a_library_for_office_files_is_loaded_only_for_such_a_file(tmp_path: Path) -> None:
    rows: office.Rows = [["a", "alpha", "d", "theta"], ["l1", 0, 0, "q1"]]
    own: dict[str, set[str]] = {
        "xlsx": {"openpyxl"}, "xls": {"xlrd"}, "ods": set(), "docx": set(), "rtf": {"striprtf"},
    }  # fmt: skip
    for ending, libraries in own.items():
        file = tmp_path / f"table.{ending}"
        file.write_bytes(office.KINDS[ending][1](rows))
        asked = ("--exercise", "planar-rr", "--part", "table", "--format", "json")
        modules, output = loaded("grade", file, *asked)
        assert json.loads(output)[0]["report"]["points"] > 0
        # openpyxl loads lxml where it is installed, as in the environment of the tests.
        assert modules & (OFFICE - {"lxml", "defusedxml"}) == libraries


@pytest.mark.long
def test_the_program_help_repeats_the_help_of_each_command() -> None:
    assert len(COMMANDS) >= 3
    for name, line in COMMANDS.items():
        command = typer.main.get_command(commands_of(name))
        assert (command.help or "").partition("\n")[0] == line
        assert "completion" not in command.get_help(typer.Context(command))


@pytest.mark.long
def test_the_service_does_not_import_optional_packages() -> None:
    unwanted = {"sympy", "scipy", "jinja2", "prometheus_client", *DATABASES, *OFFICE}
    probe = f"import sys, dh_grader.app; print(sorted({unwanted} & set(sys.modules)))"
    assert process(python=("-c", probe)).stdout.decode().strip() == "[]"


def test_a_pipe_gets_text_without_colour_in_80_columns(answer: Path) -> None:
    result = process("grade", answer, "--exercise", "planar-rrr", PYTHONIOENCODING="utf-8")
    text = result.stdout.decode()
    assert result.returncode == 1
    assert "✓" in text
    assert "\x1b" not in text
    assert max(map(len, text.splitlines())) <= 80


@pytest.mark.long
def test_an_ascii_terminal_gets_the_whole_report(answer: Path) -> None:
    greek = answer.rename(answer.with_name("θ.json"))
    arguments = ("grade", greek, greek, "--exercise", "planar-rrr")
    result = process(*arguments, PYTHONIOENCODING="ascii")
    assert result.returncode == 1
    assert result.stdout.isascii()
    assert b"?.json" in result.stdout
    assert b"+ correct   x incorrect" in result.stdout


@pytest.mark.long
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is always full")
@pytest.mark.parametrize("arguments", [("exercises", "list"), ("--help",)])
def test_a_full_disk_is_reported_in_one_line(arguments: tuple[str, ...]) -> None:
    with Path("/dev/full").open("wb") as full:
        done = subprocess.run(
            [sys.executable, "-m", "dh_grader", *arguments],
            cwd=ROOT,
            stdout=full,
            stderr=subprocess.PIPE,
            check=False,
        )
    assert done.stderr.decode().splitlines() == [
        "The output cannot be written: No space left on device"
    ]
    assert done.returncode == 2


@pytest.mark.long
@pytest.mark.skipif(os.name == "nt", reason="needs a POSIX shell")
def test_closed_streams_do_not_prevent_the_output_file(answer: Path, tmp_path: Path) -> None:
    output = tmp_path / "points.csv"
    command = f'"$@" --exercise planar-rrr --format csv --output {output} >&- 2>&-'
    grade = (sys.executable, "-m", "dh_grader", "grade", str(answer))
    done = subprocess.run(["sh", "-c", command, "sh", *grade], cwd=ROOT, check=False)
    assert done.returncode == 1
    assert output.read_text(encoding="utf-8").count("\n") == 2


@pytest.mark.long
@pytest.mark.skipif(os.name == "nt", reason="needs a POSIX pipe")
@pytest.mark.parametrize("arguments", [("exercises", "list"), ("grade", "--exercise", "rrrp")])
def test_a_closed_pipe_ends_the_program_quietly(arguments: tuple[str, ...], answer: Path) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    files = (str(answer),) * (arguments[0] == "grade")
    with open(writer, "wb") as gone:  # noqa: PTH123 - it has no path
        command = [sys.executable, "-m", "dh_grader", *arguments, *files]
        done = subprocess.run(command, cwd=ROOT, stdout=gone, stderr=subprocess.PIPE, check=False)
    # The exit code of a shell for a program that SIGPIPE has ended.
    assert (done.returncode, done.stderr) == (141, b"")


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("words", "expected"),
    [("dh-grader gr", "grade"), ("dh-grader grade x --quie", "--quiet"),
     ("dh-grader keys cr", "create")],
)  # fmt: skip
def test_a_shell_completes_commands_and_their_options(words: str, expected: str) -> None:
    result = process(
        _DH_GRADER_COMPLETE="complete_bash",
        COMP_WORDS=words,
        COMP_CWORD=str(len(words.split()) - 1),
    )
    assert result.stdout.decode().split() == [expected]


# --- The help of all commands shows square brackets


def commands(found: Any, *path: str) -> Iterator[tuple[tuple[str, ...], Any]]:
    yield path, found
    for name, each in getattr(found, "commands", {}).items():
        yield from commands(each, *path, name)


def bracketed(texts: list[str]) -> set[str]:
    return {word for text in texts for word in re.findall(r"\[[a-z][^\[\]]*\]", text)}


@pytest.mark.parametrize("name", COMMANDS)
def test_help_shows_the_words_in_brackets(name: str) -> None:
    program = commands_of(name)
    root = typer.main.get_command(program)
    for path, command in commands(root):
        result = CliRunner().invoke(program, [*path, "--help"], env={"COLUMNS": "200"})
        assert result.exit_code == 0
        assert "``" not in result.output, path
        texts = [command.help or "", *(getattr(each, "help", "") or "" for each in command.params)]
        assert [w for w in bracketed(texts) if w not in result.output] == [], path


# --- Test the list of installed packages and their licences

LOCK = (Path(__file__).parents[2] / "requirements.lock").read_text(encoding="utf-8")


def test_every_locked_package_that_is_installed_is_listed_with_its_licence() -> None:
    locked = set(re.findall(r"^([a-z0-9-]+)(?:\[[a-z0-9,-]+\])?==", LOCK, re.MULTILINE))
    installed = set()
    for name in locked:
        try:
            distribution(name)
        except PackageNotFoundError:  # of another platform
            continue
        installed.add(name)
    listed = needed("dh-grader")
    assert len(installed) > 20
    assert installed <= listed.keys()
    unclear = {name for name, each in listed.items() if licence_of(each) == "see its files"}
    text = "\n".join(licences())
    for name, package in listed.items():
        assert f"{package.name} {package.version}\n" in text
        has_file = any("licen" in str(file).lower() for file in package.files or ())
        assert has_file or name not in unclear


def test_the_list_includes_the_texts_of_licences() -> None:
    text = "\n".join(licences())
    assert "Permission is hereby granted, free of charge" in text
    assert "Redistributions of source code must retain" in text
