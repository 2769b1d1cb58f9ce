"""Graded files in the forms that people and programs take them in: one file for each format.

A format ``<name>.py`` has a function ``document``; it is found here by its name.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from typing import Final, Protocol

from rich.console import Console

from service.grading import Report


@dataclass(frozen=True, slots=True)
class GradedFile:
    """A file with its report, or with the reason why there is none."""

    file: Path
    report: Report | None
    error: str = ""


class ReportFormat(Protocol):
    """One format of reports."""

    def document(self, graded: Sequence[GradedFile], console: Console) -> bytes:
        """The files as one document, for ``console`` or for a file of its width and encoding."""
        ...


FORMATS: Final[Mapping[str, ReportFormat]] = {
    name: import_module(f"{__name__}.{name}") for _, name, _ in iter_modules(__path__)
}
