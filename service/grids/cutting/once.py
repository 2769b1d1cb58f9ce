"""Search a pasted text for the same thing only once, though several formats ask for it."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import wraps
from typing import Any, Final, ParamSpec, TypeVar

from service.time_slices import checkpoint

P = ParamSpec("P")
R = TypeVar("R")

# To search a shorter text again costs no more than to remember what was found.
_WORTH_IT: Final = 200

# What was found in each text, while pasted texts are read.
_found: ContextVar[dict[tuple[object, str], Any] | None] = ContextVar("found", default=None)


@contextmanager
def remembering(found: dict[tuple[object, str], Any]) -> Iterator[None]:
    """Let each search ``once`` remember in ``found`` what it finds."""
    token = _found.set(found)
    try:
        yield
    finally:
        _found.reset(token)


def remembers(read: Callable[P, R]) -> Callable[P, R]:
    """Let a function that reads a pasted text make each search ``once``."""

    @wraps(read)
    def reads(*args: P.args, **named: P.kwargs) -> R:
        if _found.get() is not None:
            return read(*args, **named)
        with remembering({}):
            return read(*args, **named)

    return reads


def once(search: Callable[[str], R]) -> Callable[[str], R]:
    """Let a search remember what it finds in each text, until the pasted texts are read.

    The search takes linear time and gives way before it begins. Nobody may change its result.
    """

    @wraps(search)
    def searches(text: str) -> R:
        checkpoint()
        found = _found.get()
        if found is None or len(text) < _WORTH_IT:
            return search(text)
        key = search, text
        if key not in found:
            found[key] = search(text)
        result: R = found[key]
        return result

    return searches
