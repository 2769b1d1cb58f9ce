"""Report formats for people and programs: one file for each format.

A format is a file ``<name>.py`` with a ``FORMAT`` in ``documents/`` or ``platforms/``. A format is
found by its name, and loaded when it is used. ``shared/`` has helpers of several formats.
"""

from importlib import import_module
from pkgutil import iter_modules
from typing import Final

from service.formats import documents, platforms
from service.formats.shared.report_format import ReportFormat

_PACKAGES: Final = {
    module.name: package.__name__
    for package in (documents, platforms)
    for module in iter_modules(package.__path__)
}
FORMAT_NAMES: Final[tuple[str, ...]] = tuple(sorted(_PACKAGES))


def report_format(name: str) -> ReportFormat:
    """Return the format of this name, one of ``FORMAT_NAMES``."""
    found: ReportFormat = import_module(f"{_PACKAGES[name]}.{name}").FORMAT
    return found
