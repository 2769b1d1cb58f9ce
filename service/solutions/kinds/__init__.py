"""The right answer to a part, with one module for each kind.

A module has the functions ``answer``, which returns the right answer, and ``lazy``, which returns
answers that need no knowledge.
"""

# The module ``<kind>.py`` is found by its name.

from collections.abc import Callable, Mapping
from importlib import import_module
from pkgutil import iter_modules
from typing import Any, Final

from service.catalogue import Exercise
from service.solutions.model_solution import PrintedAnswer
from service.solutions.work import Work

_MODULES: Final = {
    module.name: import_module(f"{__name__}.{module.name}") for module in iter_modules(__path__)
}
ANSWERS: Final[Mapping[str, Callable[[Any, Work], PrintedAnswer]]] = {
    name: module.answer for name, module in _MODULES.items()
}
LAZY: Final[Mapping[str, Callable[[Any, Exercise], list[object]]]] = {
    name: module.lazy for name, module in _MODULES.items()
}
