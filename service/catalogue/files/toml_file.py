"""Read a tutor's TOML file and report faults with field and line."""

import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, TypeVar

from pydantic import ValidationError

from service.catalogue.files.lines import line_of, value_lines, with_line
from service.catalogue.files.refusals import TableAt, refusals
from service.catalogue.files.regular_file import read_regular
from service.catalogue.robots.formulas import FieldError
from service.translations import joined, say

# The largest shipped exercise has 8 kB.
_LARGEST: Final = 1024 * 1024

Built = TypeVar("Built")


@dataclass(frozen=True, slots=True)
class Fault:
    """A fault in a tutor's file: its place and its reason."""

    file: Path
    field: str
    reason: str
    line: int | None = None

    def __str__(self) -> str:
        """File, field and reason on one line."""
        place = with_line(self.field, self.line)
        return joined(": ", list(filter(None, (str(self.file), place, self.reason))))


class CatalogueError(Exception):
    """One or more files of a tutor cannot be used; ``faults`` are the reasons."""

    def __init__(self, faults: list[Fault]) -> None:
        super().__init__(joined("\n", list(map(str, faults))))
        self.faults = faults


def load_toml(file: Path, build: Callable[[dict[str, Any]], Built], table_at: TableAt) -> Built:
    """Read a TOML file, and return what ``build`` makes of its content. Raises CatalogueError."""
    return built_of(file, toml_content(file), build, table_at)


def toml_content(file: Path) -> bytes:
    """Return the bytes of a TOML file. Raises CatalogueError."""
    try:
        return read_regular(file, _LARGEST)
    except OSError as error:
        raise CatalogueError([Fault(file, "", fault_reason(error))]) from error


def built_of(
    file: Path, content: bytes, build: Callable[[dict[str, Any]], Built], table_at: TableAt
) -> Built:
    """Return what ``build`` makes of the bytes of a TOML file. Raises CatalogueError."""
    try:
        text = content.decode()
    except ValueError as error:
        raise CatalogueError([Fault(file, "", fault_reason(error))]) from error
    return read_toml(file, text, build, table_at)


def read_toml(
    file: Path, text: str, build: Callable[[dict[str, Any]], Built], table_at: TableAt
) -> Built:
    """Return what ``build`` makes of a TOML text. Raises CatalogueError, which names ``file``."""
    # Normalize line ends as in a file that is opened in text mode.
    text = text.replace("\r\n", "\n")
    try:
        return build(tomllib.loads(text))
    except (ValidationError, FieldError, ExceptionGroup) as error:
        lines = value_lines(text)
        found = refusals(error, table_at)
        faults = [Fault(file, *fault, line_of(fault[0], lines)) for fault in found]
        raise CatalogueError(faults) from error
    except (ValueError, RecursionError) as error:
        raise CatalogueError([Fault(file, "", fault_reason(error))]) from error


def fault_reason(error: Exception) -> str:
    """Return the reason why a file cannot be read, or is not TOML."""
    match error:
        case OSError():
            return say("cannot be read: {reason}", reason=str(error.strerror))
        case UnicodeDecodeError():
            return say("is not UTF-8 text: {reason}", reason=error.reason)
        case RecursionError():
            return say("has tables or lists nested too deep")
        case _:  # of TOML itself, or of a number with thousands of digits
            return say("is not TOML: {reason}", reason=str(error))
