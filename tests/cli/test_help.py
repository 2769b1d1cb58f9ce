"""The help of all commands shows square brackets."""

import re
from collections.abc import Iterator
from typing import Any

import pytest
import typer
from dh_grader.cli import COMMANDS, commands_of
from typer.testing import CliRunner


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
