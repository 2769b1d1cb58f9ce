"""Graded files in the forms that people and programs take them in: one file for each format.

A format ``<name>.py`` has a function ``document``; it is found here by its name.
"""

from collections.abc import Mapping, Sequence
from importlib import import_module
from pkgutil import iter_modules
from typing import Final, Protocol

from rich.console import Console

from service.formats.graded_file import GradedFile


class ReportFormat(Protocol):
    """One format of reports."""

    def document(self, graded: Sequence[GradedFile], console: Console) -> bytes:
        """The files as one document, for ``console`` or for a file of its width and encoding."""
        ...


def _found() -> dict[str, ReportFormat]:
    modules = {name: import_module(f"{__name__}.{name}") for _, name, _ in iter_modules(__path__)}
    return {name: module for name, module in modules.items() if hasattr(module, "document")}


FORMATS: Final[Mapping[str, ReportFormat]] = _found()
