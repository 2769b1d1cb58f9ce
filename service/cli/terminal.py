"""The terminal that every command writes to, and the ways to give up."""

import os
import sys
from collections.abc import Mapping
from typing import NoReturn

from rich.console import Console

from service.catalogue import CatalogueError, Exercise, load_catalogue
from service.settings import Settings, SettingsError, load_settings
from service.submissions import UnknownExerciseError, find_exercise

UNUSABLE = 2


def stdout() -> Console:
    """The terminal, or 80 columns without colour where the output goes elsewhere."""
    width = None if sys.stdout.isatty() or "COLUMNS" in os.environ else 80
    return Console(file=sys.stdout, width=width, highlight=False, markup=False, soft_wrap=False)


def complain(message: str) -> None:
    """Write a fault to standard error."""
    print(message, file=sys.stderr)  # noqa: T201 - a program's own error output


def give_up(message: str) -> NoReturn:
    """Write a fault and end with the exit code for unusable input."""
    complain(message)
    raise SystemExit(UNUSABLE)


def settings_or_exit() -> Settings:
    """The settings of this process; ends it where one is unusable."""
    try:
        return load_settings()
    except SettingsError as error:
        give_up(str(error))


def catalogue_or_exit() -> Mapping[str, Exercise]:
    """The exercises of this installation; ends the process where a file is unusable."""
    try:
        return load_catalogue(*settings_or_exit().exercises_dir)
    except CatalogueError as error:
        give_up(str(error))


def exercise_or_exit(exercise_id: str) -> Exercise:
    """The exercise with this id; ends the process where there is none."""
    try:
        return find_exercise(catalogue_or_exit(), exercise_id)
    except UnknownExerciseError as error:
        give_up(f"{error} Known are: {', '.join(error.known)}.")
