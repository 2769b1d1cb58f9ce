"""The README is one page, and names only targets that exist."""

import html
import re
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

import pytest
from dh_grader.cli import program
from typer.testing import CliRunner

from tests.docs.walkthrough import blocks
from tests.shipped import shipped_exercises

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "README.md").read_text(encoding="utf-8")
COMMANDS = [
    line.removeprefix("$ ")
    for block in blocks(PAGE)
    for line in block.text.splitlines()
    if line.startswith("$ ")
]


def test_the_readme_is_one_page() -> None:
    assert len(PAGE.splitlines()) <= 100
    assert len(PAGE.split()) <= 650


def test_the_readme_has_the_number_of_exercises() -> None:
    assert f" {len(shipped_exercises())} exercises" in " ".join(PAGE.split())


@pytest.mark.long
def test_the_size_of_the_packages_is_true() -> None:
    lock = (ROOT / "requirements.lock").read_text(encoding="utf-8")
    size = 0
    for name in set(re.findall(r"^([\w.-]+)==", lock, re.MULTILINE)):
        # Some packages are only for other platforms.
        with suppress(PackageNotFoundError):
            files = [Path(str(each.locate())) for each in distribution(name).files or ()]
            size += sum(each.stat().st_size for each in files if each.is_file())
    # Compiled packages and byte code differ between platforms and versions of Python.
    megabytes = pytest.approx(size / 1e6, rel=0.2)
    for page in ("deployment", "performance"):
        text = (ROOT / f"docs/{page}.md").read_text(encoding="utf-8")
        told, *_ = re.findall(r"about (\d+) MB[ ,]", text)
        assert int(told) == megabytes
    # The program, pip and the blocks of the disk add 20 % to the packages.
    [told] = re.findall(r"about (\d+) MB", PAGE)
    assert int(told) / 1.2 == megabytes


def test_the_commands_of_the_installation_are_first() -> None:
    # `make wheel` runs these commands in a fresh clone; see tests/installed.
    install = ["python3 -m venv .venv", ".venv/bin/pip install .", ".venv/bin/dh-grader serve"]
    assert COMMANDS[:3] == install


def test_the_picture_shows_the_output_of_the_command(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    [command] = [each for each in COMMANDS if " grade " in each]
    result = CliRunner().invoke(program, command.split()[1:])
    assert result.exit_code == 1
    [picture] = re.findall(r"\]\((docs/\S+\.svg)\)", PAGE)
    drawn = re.findall(r"<text[^>]*>(.*?)</text>", (ROOT / picture).read_text(encoding="utf-8"))
    shown = "".join("".join(map(html.unescape, drawn)).split())
    printed = ["".join(line.split()) for line in result.output.splitlines()]
    assert len(printed) > 10
    assert [line for line in printed if line not in shown] == []


def test_the_targets_of_the_readme_exist() -> None:
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for target in re.findall(r"make (\w+)", " ".join(re.findall(r"`[^`]+`", PAGE) + COMMANDS)):
        assert re.search(rf"^{target}:", makefile, re.MULTILINE), target
