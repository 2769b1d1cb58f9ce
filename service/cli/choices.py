"""Options of the command line that take one of several words."""

from collections.abc import Callable, Iterable
from enum import StrEnum
from typing import TypeVar

import typer

from service.cli.language import spoken, user_language
from service.settings import Settings
from service.submissions.lookup import nearest
from service.translations import Language, language_named, paragraph, say

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


def report_language(settings: Settings, output_format: str) -> Language:
    """Return the language of reports."""
    # Without a setting, reports in the format ``text`` are in the language of the user.
    if output_format == "text" and "language" not in settings.model_fields_set:
        return user_language()
    found = language_named(settings.language)
    assert found is not None, "the settings have only known languages"
    return found
