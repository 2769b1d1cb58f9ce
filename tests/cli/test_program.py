"""The program as a process: its name, its weight, its streams."""

import importlib.metadata
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TABLE = {"answers": {"table": {"rows": [{"a": "l1 +", "alpha": 0, "d": 0, "theta": "q1"}]}}}


def process(
    *arguments: object, python: tuple[str, ...] = ("-m", "service"), **environment: str
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


def test_grading_loads_neither_the_web_framework_nor_a_computer_algebra_system(
    answer: Path,
) -> None:
    probe = (
        "import sys; from service.cli import main\n"
        "try: main()\n"
        "except SystemExit: pass\n"
        "heavy = {'sympy', 'scipy', 'fastapi', 'starlette', 'uvicorn', 'httpx'}\n"
        "print(sorted(heavy & set(sys.modules)), file=sys.stderr)"
    )
    result = process(
        "grade", answer, "--exercise", "planar-rrr", "--format", "json", python=("-c", probe)
    )
    assert json.loads(result.stdout)[0]["exercise"] == "planar-rrr"
    assert result.stderr.decode().strip() == "[]"


def test_the_service_loads_no_computer_algebra_system() -> None:
    probe = "import sys, service.app; print(sorted({'sympy', 'scipy'} & set(sys.modules)))"
    assert process(python=("-c", probe)).stdout.decode().strip() == "[]"


def test_a_pipe_gets_text_without_colour_in_80_columns(answer: Path) -> None:
    result = process("grade", answer, "--exercise", "planar-rrr", PYTHONIOENCODING="utf-8")
    text = result.stdout.decode()
    assert result.returncode == 1
    assert "✓" in text
    assert "\x1b" not in text
    assert max(map(len, text.splitlines())) <= 80


def test_an_old_terminal_gets_the_whole_report_in_its_own_letters(answer: Path) -> None:
    greek = answer.rename(answer.with_name("θ.json"))
    arguments = ("grade", greek, greek, "--exercise", "planar-rrr")
    result = process(*arguments, PYTHONIOENCODING="ascii")
    assert result.returncode == 1
    assert result.stdout.isascii()
    assert b"?.json" in result.stdout
    assert b"+ correct   x incorrect" in result.stdout
