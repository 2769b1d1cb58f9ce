"""One of several words on the command line."""

from collections.abc import Callable, Iterable
from enum import StrEnum
from typing import TypeVar

import typer

from service.submissions.lookup import nearest

_Choice = TypeVar("_Choice", bound=StrEnum)


def one_of(name: str, known: Iterable[str]) -> str:
    """The word, if it is known. Raises typer.BadParameter, which names the nearest."""
    names = list(known)
    if name in names:
        return name
    meant = nearest(name, names)
    hint = f" Did you mean {meant}?" if meant else ""
    raise typer.BadParameter(f"{name!r} is not one of {', '.join(names)}.{hint}")


def choice(of: type[_Choice]) -> Callable[[str], _Choice]:
    """The parser of an option that takes one of these."""
    return lambda text: of(one_of(text, [each.value for each in of]))


def listed(of: type[StrEnum]) -> str:
    """The words, as a help shows them."""
    return f"[{'|'.join(each.value for each in of)}]"
