"""The right answer to a part, by its kind: one module for one kind.

A module ``<kind>.py`` has a function ``answer(part, work)``; it is found here by its name.
"""

from collections.abc import Callable, Mapping
from importlib import import_module
from pkgutil import iter_modules
from typing import Any, Final

from service.solutions.model_solution import PrintedAnswer
from service.solutions.work import Work

ANSWERS: Final[Mapping[str, Callable[[Any, Work], PrintedAnswer]]] = {
    module.name: import_module(f"{__name__}.{module.name}").answer
    for module in iter_modules(__path__)
}
