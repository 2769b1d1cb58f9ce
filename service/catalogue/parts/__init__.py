"""The answer kinds in exercise files.

A module ``<kind>.py`` has one subclass of ``PartSpec``. This package finds all kinds by their
modules; nothing else lists them.
"""

import inspect
from collections.abc import Mapping
from functools import reduce
from importlib import import_module
from operator import or_
from pkgutil import iter_modules
from types import ModuleType
from typing import TYPE_CHECKING, Annotated, Final, get_args, get_type_hints

from pydantic import Field

from service.catalogue.part import PartSpec
from service.catalogue.shapes import AnswerShape


class KindError(RuntimeError):
    """A file of an answer kind is missing or unusable, so that the program cannot start."""


def _spec(module: ModuleType) -> type[PartSpec]:
    kind = module.__name__.rpartition(".")[2]
    found = [
        member
        for member in vars(module).values()
        if inspect.isclass(member)
        and issubclass(member, PartSpec)
        and member.__module__ == module.__name__
        and not inspect.isabstract(member)
    ]
    named = [get_args(spec.model_fields["kind"].annotation) for spec in found]
    if named != [(kind,)]:
        raise KindError(
            f"{module.__file__}: write one subclass of PartSpec with a shape(…) and with "
            f'kind: Literal["{kind}"], the name of the file'
        )
    return found[0]


SPECS: Final[Mapping[str, type[PartSpec]]] = {
    module.name: _spec(import_module(f"{__name__}.{module.name}"))
    for module in iter_modules(__path__)
}

_SHAPES: Final[Mapping[str, type[AnswerShape]]] = {
    kind: get_type_hints(spec.shape)["return"] for kind, spec in SPECS.items()
}

if TYPE_CHECKING:
    AnyPartSpec = PartSpec
    AnyShape = AnswerShape
else:
    # Discriminated by kind, so that faults are reported for the intended model only.
    AnyPartSpec = Annotated[reduce(or_, SPECS.values()), Field(discriminator="kind")]
    AnyShape = Annotated[reduce(or_, dict.fromkeys(_SHAPES.values())), Field(discriminator="form")]


def posted_forms() -> str:
    """Describe the JSON form of each kind of answer: "`transform`: a list of rows, …"."""
    kinds: dict[str, list[str]] = {}
    for kind, shape in _SHAPES.items():
        kinds.setdefault(shape.posted, []).append(f"`{kind}`")
    return "; ".join(f"{', '.join(names)}: {form}" for form, names in kinds.items())
