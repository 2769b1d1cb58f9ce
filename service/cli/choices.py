"""Options of the command line that take one of several words."""

from collections.abc import Callable, Iterable
from enum import StrEnum
from typing import TypeVar

import typer

from service.cli.terminal import give_up
from service.submissions.lookup import nearest
from service.translations import LANGUAGES, Language, language_named

_Choice = TypeVar("_Choice", bound=StrEnum)


def one_of(name: str, known: Iterable[str]) -> str:
    """Return the word if it is known. Raises typer.BadParameter with the nearest known word."""
    names = list(known)
    if name in names:
        return name
    meant = nearest(name, names)
    hint = f" Did you mean {meant}?" if meant else ""
    raise typer.BadParameter(f"{name!r} is not one of {', '.join(names)}.{hint}")


def choice(of: type[_Choice]) -> Callable[[str], _Choice]:
    """Return the parser of an option that takes one of the values of an enumeration."""
    return lambda text: of(one_of(text, [each.value for each in of]))


def listed(of: type[StrEnum]) -> str:
    """The values of an enumeration as ``--help`` shows them: ``[a|b]``."""
    return f"[{'|'.join(each.value for each in of)}]"


def report_language(tag: str) -> Language:
    """Return the language of this tag; end the program if reports are not in this language."""
    found = language_named(tag)
    if found is None:
        give_up(f"{tag!r} is no language of the reports: write one of {', '.join(LANGUAGES)}.")
    return found
