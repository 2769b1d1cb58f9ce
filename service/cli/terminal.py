"""The terminal that every command writes to, and the ways to give up."""

import os
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import NoReturn

from rich.console import Console

from service.catalogue import Exercise, exercise_files, load_catalogue, load_exercise
from service.settings import load_settings
from service.submissions.lookup import find_exercise

UNUSABLE = 2
# As a shell says it: 128 and the number of the signal of a pipe that nobody reads any more.
BROKEN_PIPE = 141


class _Terminal(Console):
    """A console that ends the program as a closed pipe ends others."""

    def on_broken_pipe(self) -> None:
        try:
            # Drops what is left: Python would fail over it again at its end.
            super().on_broken_pipe()
        except SystemExit:
            raise SystemExit(BROKEN_PIPE) from None


def stdout() -> Console:
    """The terminal, or 80 columns without colour where the output goes elsewhere."""
    width = None if sys.stdout.isatty() or "COLUMNS" in os.environ else 80
    return _Terminal(file=sys.stdout, width=width, highlight=False, markup=False, soft_wrap=False)


def complain(message: str) -> None:
    """Write a fault to standard error."""
    print(message, file=sys.stderr)  # noqa: T201 - a program's own error output


def give_up(message: str) -> NoReturn:
    """Write a fault and end with the exit code for unusable input."""
    complain(message)
    raise SystemExit(UNUSABLE)


def installed() -> Mapping[str, Exercise]:
    """The exercises of this installation. Raises SettingsError or CatalogueError."""
    return load_catalogue(*load_settings().exercises_dir)


def installed_exercise(exercise_id: str) -> Exercise:
    """The exercise of this installation with this id; the files of the others are not read.

    Raises SettingsError, CatalogueError or UnknownExerciseError.
    """
    return load_exercise(installed_file(exercise_id))


def installed_file(exercise_id: str) -> Path:
    """The file of the exercise of this installation with this id. Raises the same errors."""
    files = {file.stem: file for file in exercise_files(*load_settings().exercises_dir)}
    return find_exercise(files, exercise_id)
