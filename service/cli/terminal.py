"""Output to the terminal, errors that end the program, and the installed exercises."""

import os
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import NoReturn

import typer
from rich.cells import cell_len, set_cell_size
from rich.console import Console

from service.catalogue import Exercise, exercise_files, load_catalogue, load_exercise
from service.cli.language import spoken
from service.settings import load_settings
from service.submissions.lookup import find_exercise
from service.translations import Language, Sentence, say

BELOW_PASS_MARK = 1
UNUSABLE = 2
# The exit code of a shell for SIGPIPE (the reader of a pipe has gone): 128 plus its number.
BROKEN_PIPE = 141


class _Terminal(Console):
    def on_broken_pipe(self) -> None:
        try:
            # Discards buffered output: Python would fail again when it flushes it at exit.
            super().on_broken_pipe()
        except SystemExit:
            raise SystemExit(BROKEN_PIPE) from None


def stdout() -> Console:
    """Return a console for standard output."""
    # Without a terminal and without COLUMNS, the console has 80 columns.
    width = None if sys.stdout.isatty() or "COLUMNS" in os.environ else 80
    return _Terminal(file=sys.stdout, width=width, highlight=False, markup=False, soft_wrap=False)


def unwritable(file: Path | str, error: OSError) -> Sentence:
    """Return the message that a file cannot be written."""
    return say("{file}: cannot be written: {reason}", file=str(file), reason=str(error.strerror))


def unreadable(file: Path | str, error: OSError) -> Sentence:
    """Return the message that a file cannot be read."""
    return say("{file}: cannot be read: {reason}", file=str(file), reason=str(error.strerror))


def tell(message: str) -> None:
    """Print a message in the language of the user."""
    typer.echo(spoken(message))


def tell_verdict(is_fine: bool | None, message: str) -> None:
    """Print the result of a check; ``is_fine`` is None if the message only informs."""
    words = {True: spoken(say("ok")), False: spoken(say("WRONG")), None: ""}
    width = max(map(cell_len, words.values())) + 2
    typer.echo(set_cell_size(words[is_fine], width) + spoken(message))


def complain(message: str | Exception, language: Language | None = None) -> None:
    """Print a message to standard error, in a language, by default that of the user."""
    text = str(message)
    # The ``str`` of an error forgets the template of its sentence.
    if isinstance(message, Exception) and message.args and message.args[0] == text:
        text = message.args[0]
    said = text if isinstance(message, Exception) else message
    print(spoken(said, language), file=sys.stderr)  # noqa: T201 - a program's own error output


def give_up(message: str | Exception) -> NoReturn:
    """Print a message to standard error, and exit because the input is unusable."""
    complain(message)
    raise SystemExit(UNUSABLE)


def installed() -> Mapping[str, Exercise]:
    """Return the exercises of this installation. Raises SettingsError or CatalogueError."""
    return load_catalogue(*load_settings().exercises_dir)


def installed_exercise(exercise_id: str) -> Exercise:
    """Return the installed exercise or variant with this id.

    Raises SettingsError, CatalogueError or UnknownExerciseError.
    """
    # Only the file of this exercise is read.
    plain_id = exercise_id.partition("~")[0]
    plain = load_exercise(installed_file(plain_id))
    return find_exercise({plain_id: plain}, exercise_id)


def named_exercise(name: str) -> Exercise:
    """Return the exercise in a file ``….toml``, or the installed exercise with this id.

    Raises SettingsError, CatalogueError or UnknownExerciseError.
    """
    own = own_file(name)
    return installed_exercise(name) if own is None else load_exercise(own)


def own_file(name: str) -> Path | None:
    """Return the path of an exercise file if ``name`` is ``….toml``; None for an id."""
    return Path(name) if name.endswith(".toml") else None


def installed_file(exercise_id: str) -> Path:
    """Return the path of the file of an installed exercise.

    Raises SettingsError, CatalogueError or UnknownExerciseError.
    """
    files = {file.stem: file for file in exercise_files(*load_settings().exercises_dir)}
    return find_exercise(files, exercise_id)
