"""The shipped exercises, loaded once in each process."""

from collections.abc import Mapping
from functools import cache
from types import MappingProxyType

from service.catalogue import Exercise, load_catalogue, shipped_folder


@cache
def shipped_exercises() -> Mapping[str, Exercise]:
    """Return the shipped exercises by id."""
    return MappingProxyType(load_catalogue(shipped_folder()))
