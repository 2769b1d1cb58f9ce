"""The answer kinds.

Each kind has a module with its name, which reads and judges its answers.
"""

# The functions ``read`` and ``judge`` in each file have the interface ``AnswerKind``.

from collections.abc import Mapping
from importlib import import_module
from pkgutil import iter_modules

from service.grading.part import AnswerKind


def _found() -> dict[str, AnswerKind]:
    modules = {
        found.name: import_module(f"{__name__}.{found.name}") for found in iter_modules(__path__)
    }
    return {name: module for name, module in modules.items() if hasattr(module, "judge")}


KINDS: Mapping[str, AnswerKind] = _found()
