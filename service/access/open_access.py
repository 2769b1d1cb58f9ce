"""The operations that need no API key."""

from dataclasses import dataclass
from typing import Final

from service.access.caller import Scope
from service.translations import say

UNTIL_KEYS: Final = "until-keys"
NOTHING: Final = "none"


@dataclass(frozen=True, slots=True)
class OpenAccess:
    """The scopes (rights of a key) that never need a key.

    With ``until_keys``, nothing needs a key as long as no key exists.
    """

    # ``until_keys`` applies only to requests to the loopback address, unless ``anywhere`` is set.

    scopes: frozenset[Scope] = frozenset()
    until_keys: bool = True
    anywhere: bool = False


# For a service that listens on localhost only, and for one that is configured to be open.
OPEN_HERE: Final = OpenAccess()
OPEN_ANYWHERE: Final = OpenAccess(anywhere=True)


def open_access(text: str | None) -> OpenAccess:
    """Parse the setting ``open``; None means the default. Raises ValueError."""
    match text:
        case None:
            return OPEN_HERE
        case "until-keys":
            return OPEN_ANYWHERE
        case "none":
            return OpenAccess(until_keys=False, anywhere=True)
    scopes = {word.strip() for word in text.split(",")}
    if not scopes <= {Scope.GRADE, Scope.RECORD}:
        raise ValueError(
            say(
                "write {until_keys}, {nothing}, or what needs no key: {grade}, or {grade},{record}",
                until_keys=UNTIL_KEYS,
                nothing=NOTHING,
                grade=Scope.GRADE.value,
                record=Scope.RECORD.value,
            )
        )
    return OpenAccess(frozenset(map(Scope, scopes)) | {Scope.GRADE}, False, anywhere=True)
