"""Reports in the forms that people and programs take them in: one file for each format.

A format ``<name>.py`` has a ``FORMAT``; it is found here by its name, and loaded when it is asked
for. What formats share stands in ``shared/``.
"""

from importlib import import_module
from pkgutil import iter_modules
from typing import Final

from service.formats.shared.report_format import ReportFormat

FORMAT_NAMES: Final[tuple[str, ...]] = tuple(
    name for _, name, is_package in iter_modules(__path__) if not is_package
)


def report_format(name: str) -> ReportFormat:
    """The format of this name, one of ``FORMAT_NAMES``."""
    found: ReportFormat = import_module(f"{__name__}.{name}").FORMAT
    return found
