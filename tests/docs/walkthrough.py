"""Run the commands of a page of docs/ from top to bottom, in an empty folder."""

# The words after the three backticks say what a code block does:
#
#     console           each line `$ dh-grader …` is run, and the lines below it are what it prints
#     console exit=1    is run like console; the last command must end with exit code 1
#     toml FILE         is added to the end of the file
#     toml FILE instead replaces the text that the previous toml block has added
#     json FILE         becomes the file, and so does csv FILE; a name with blanks is in quotes
#     csv FILE expected is the text of a file that an earlier command has written
#     toml, json, yaml, sh  is only read
#
# In the output, `…` matches any text within a line. A line with only `…` matches any lines.
# `$ export NAME=VALUE` sets a variable for the commands that follow.

import json
import re
import shlex
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
import yaml
from dh_grader.cli import program
from typer.testing import CliRunner

_FENCE = re.compile(r"^```(\w+)([^\n]*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
_ANYTHING = "…"


@dataclass(frozen=True, slots=True)
class Block:
    """A code block of a page: language, options, text and line number."""

    language: str
    words: tuple[str, ...]
    text: str
    line: int


def blocks(page: str) -> Iterator[Block]:
    """Yield the code blocks of a page, in order."""
    for found in _FENCE.finditer(page):
        line = page.count("\n", 0, found.start()) + 1
        yield Block(found[1], tuple(shlex.split(found[2])), found[3], line)


class Reader:
    """Runs the code blocks of a page in a folder."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self._folder = folder
        self._environment = monkeypatch
        self._before = ""
        self.commands = 0
        monkeypatch.chdir(folder)

    def follow(self, page: str) -> None:
        """Run all blocks of the page; fail at the first wrong block."""
        for block in blocks(page):
            match block.language:
                case "console":
                    self._run(block)
                case "toml":
                    self._write_toml(block)
                case "csv" if "expected" in block.words:
                    written = (self._folder / block.words[0]).read_text(encoding="utf-8")
                    assert matches(block.text, written), f"line {block.line}: there is\n{written}"
                case "json" | "csv":
                    if block.language == "json":
                        json.loads(block.text)
                    for name in block.words:
                        file = self._folder / name
                        file.parent.mkdir(parents=True, exist_ok=True)
                        file.write_text(block.text, encoding="utf-8")
                case "yaml":
                    yaml.safe_load(block.text)
                case "sh":
                    pass
                case other:
                    pytest.fail(f"line {block.line}: unknown language of a block: {other}")

    def _write_toml(self, block: Block) -> None:
        if not block.words:
            tomllib.loads(block.text)
            return
        file = self._folder / block.words[0]
        if "instead" not in block.words:
            self._before = file.read_text(encoding="utf-8") + "\n" if file.exists() else ""
        file.write_text(self._before + block.text, encoding="utf-8")
        tomllib.loads(file.read_text(encoding="utf-8"))

    def _run(self, block: Block) -> None:
        wanted = next((int(w.removeprefix("exit=")) for w in block.words if "exit=" in w), 0)
        steps = re.split(r"^\$ ", block.text, flags=re.MULTILINE)[1:]
        assert steps, f"line {block.line}: no command"
        for i, step in enumerate(steps):
            command, _, expected = step.partition("\n")
            printed, code = self._printed(shlex.split(command), block)
            assert matches(expected, printed), f"line {block.line}: {command} printed\n{printed}"
            assert code == (wanted if i == len(steps) - 1 else 0), f"line {block.line}: exit {code}"

    def _printed(self, words: list[str], block: Block) -> tuple[str, int]:
        self.commands += 1
        if words[0] == "export":
            name, _, value = words[1].partition("=")
            self._environment.setenv(name, value)
            return "", 0
        assert words[0] == "dh-grader", f"line {block.line}: {words[0]} is not run here"
        result = CliRunner().invoke(program, words[1:])
        return result.output, result.exit_code


def matches(expected: str, printed: str) -> bool:
    """True if the output of a command is as expected."""
    pattern = ""
    for line in expected.strip("\n").split("\n"):
        if line.strip() == _ANYTHING:
            pattern += r"(?:.*\n)*?"
        else:
            pattern += ".*".join(map(re.escape, line.rstrip().split(_ANYTHING))) + r"[ ]*\n"
    return re.fullmatch(pattern, printed.strip("\n") + "\n") is not None
