"""What needs no key."""

from dataclasses import dataclass
from typing import Final

from service.access.caller import Scope

UNTIL_KEYS: Final = "until-keys"
NOTHING: Final = "none"


@dataclass(frozen=True, slots=True)
class OpenAccess:
    """The scopes that need no key, ever, and whether all of them need none until there is a key.

    The latter holds only for requests to the machine's own loopback address, or ``anywhere``.
    """

    scopes: frozenset[Scope] = frozenset()
    until_keys: bool = True
    anywhere: bool = False


# Of a service that listens to this machine alone, and of one that was told to serve everybody.
OPEN_HERE: Final = OpenAccess()
OPEN_ANYWHERE: Final = OpenAccess(anywhere=True)


def open_access(text: str | None) -> OpenAccess:
    """What the setting says; None where it says nothing. Raises ValueError."""
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
            f"write {UNTIL_KEYS}, {NOTHING}, or what needs no key: {Scope.GRADE}, or "
            f"{Scope.GRADE},{Scope.RECORD}"
        )
    return OpenAccess(frozenset(map(Scope, scopes)) | {Scope.GRADE}, False, anywhere=True)
