"""Reading a TOML file that a tutor wrote, with the field and line of each fault."""

import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, TypeVar

from pydantic import ValidationError

from service.catalogue.files.lines import line_of, value_lines
from service.catalogue.files.refusals import TableAt, refusals
from service.catalogue.files.regular_file import read_regular
from service.catalogue.robots.formulas import FieldError

# The largest exercise that comes with the program has 8 kB.
_LARGEST: Final = 1024 * 1024

Built = TypeVar("Built")


@dataclass(frozen=True, slots=True)
class Fault:
    """One reason why a tutor's file is refused: where in the file, and why."""

    file: Path
    field: str
    reason: str
    line: int | None = None

    def __str__(self) -> str:
        """File, field and reason on one line."""
        place = self.field if self.line is None else f"{self.field} (line {self.line})"
        return ": ".join(filter(None, (str(self.file), place, self.reason)))


class CatalogueError(Exception):
    """One or more files of a tutor cannot be used; ``faults`` says which and why."""

    def __init__(self, faults: list[Fault]) -> None:
        super().__init__("\n".join(str(fault) for fault in faults))
        self.faults = faults


def load_toml(file: Path, build: Callable[[dict[str, Any]], Built], table_at: TableAt) -> Built:
    """The result of ``build`` on the content of the file. Raises CatalogueError.

    ``build`` may raise a ValidationError of pydantic, or a FieldError or a group of them.
    ``table_at`` is the table that a location of pydantic lies in.
    """
    try:
        text = read_regular(file, _LARGEST).decode()
    except (OSError, ValueError) as error:
        raise CatalogueError([Fault(file, "", fault_reason(error))]) from error
    return read_toml(file, text, build, table_at)


def read_toml(
    file: Path, text: str, build: Callable[[dict[str, Any]], Built], table_at: TableAt
) -> Built:
    """The same of the text that a file holds, or would hold. Raises CatalogueError."""
    # As a file opened for text does.
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
    """The reason why a file could not be read, or is no TOML."""
    match error:
        case OSError():
            return f"cannot be read: {error.strerror}"
        case UnicodeDecodeError():
            return f"is not UTF-8 text: {error.reason}"
        case RecursionError():
            return "has tables or lists too deep in each other"
        case _:  # of TOML itself, or of a number with thousands of digits
            return f"is not TOML: {error}"
