"""The formats of a report, one module for each.

A module ``<format>.py`` has a function ``page(results, console)``; it is found here by its name.
"""

from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from pkgutil import iter_modules
from typing import Final

from rich.console import Console

from service.grading import Report

# The name of each file graded, with its report, or the reason why there is none.
Results = Sequence[tuple[str, Report | str]]
# The console tells width, colours and encoding to a format for people.
Page = Callable[[Results, Console], bytes]

FORMATS: Final[Mapping[str, Page]] = {
    module.name: import_module(f"{__name__}.{module.name}").page
    for module in iter_modules(__path__)
}
