"""Options of commands: exercises, words of a list, and the language of reports.

Options that only one group of commands has are with those commands.
"""

from collections.abc import Callable, Iterable, Mapping
from enum import StrEnum
from pathlib import Path
from typing import TypeVar

import typer

from dh_grader.catalogue import Exercise, exercise_files, load_catalogue, load_exercise
from dh_grader.cli.terminal import spoken, user_language
from dh_grader.settings import Settings, load_settings
from dh_grader.submissions.bodies import find_exercise, nearest
from dh_grader.translations import Language, language_named, paragraph, say

# --- Exercises of this installation, and files of exercises


def installed() -> Mapping[str, Exercise]:
    """Return the exercises of this installation. Raises SettingsError or CatalogueError."""
    return load_catalogue(*load_settings().exercises_dir)


def installed_exercise(exercise_id: str) -> Exercise:
    """Return the installed exercise or variant with this id.

    Reads only the file of this exercise. Raises SettingsError, CatalogueError or
    UnknownExerciseError.
    """
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


# --- Options that take one of several words


_Choice = TypeVar("_Choice", bound=StrEnum)


def one_of(name: str, known: Iterable[str]) -> str:
    """Return ``name`` if it is a known word. Raises typer.BadParameter."""
    names = list(known)
    if name in names:
        return name
    meant = nearest(name, names)
    unknown = say("{name!r} is not one of {names}.", name=name, names=", ".join(names))
    hint = say("Did you mean {meant}?", meant=meant) if meant else ""
    raise typer.BadParameter(spoken(paragraph(unknown, hint)))


def choice(of: type[_Choice]) -> Callable[[str], _Choice]:
    """Return a parser for an option whose values are those of an enumeration."""
    return lambda text: of(one_of(text, [each.value for each in of]))


def listed(of: type[StrEnum]) -> str:
    """Return the values of an enumeration as ``--help`` shows them: ``[a|b]``."""
    return f"[{'|'.join(each.value for each in of)}]"


# --- The language of reports


def report_language(settings: Settings, output_format: str) -> Language:
    """Return the language of reports: the setting, or for ``text`` that of the user."""
    if output_format == "text" and "language" not in settings.model_fields_set:
        return user_language()
    found = language_named(settings.language)
    assert found is not None, "the settings have only known languages"
    return found
