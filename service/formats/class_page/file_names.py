"""Safe file names made from the names of submissions, which are untrusted."""

import unicodedata
from collections.abc import Callable
from itertools import chain, count
from typing import Final

# Characters. A file name has 255 bytes on most systems, and a letter up to four bytes.
LONGEST: Final = 50
_SIGNS: Final = "-_"
_RESERVED: Final = frozenset(
    {"con", "prn", "aux", "nul"} | {f"{port}{i}" for port in ("com", "lpt") for i in range(10)}
)


def distinct_file_names(ending: str) -> Callable[[str], str]:
    """Return a function that makes distinct, safe file names for one folder."""
    # The names are distinct even on systems that ignore case or the form of accented letters.
    used: set[str] = set()

    def distinct(name: str) -> str:
        stem = file_stem(name)
        numbered = (f"{stem}-{i}" for i in count(2))
        free = next(each for each in chain([stem], numbered) if _compared(each) not in used)
        used.add(_compared(free))
        return f"{free}{ending}"

    return distinct


def file_stem(name: str) -> str:
    """Return a name as a safe file name without an ending."""
    composed = unicodedata.normalize("NFC", name)
    kept = "".join(c if c.isalnum() or c in _SIGNS else " " for c in composed)
    stem = "-".join(kept.split())[:LONGEST].strip(_SIGNS)
    if not stem:
        return "submission"
    return f"{stem}-" if stem.lower() in _RESERVED else stem


def _compared(stem: str) -> str:
    return unicodedata.normalize("NFKC", stem).casefold()
