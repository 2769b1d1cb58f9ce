"""Each misconception and each check is listed in its file and has its pair of test cases."""

import inspect
from collections.abc import Iterator
from importlib import import_module
from pkgutil import walk_packages
from types import ModuleType
from typing import Any, get_args, get_origin, get_type_hints

import pytest

from service.grading import diagnosis
from service.grading.judging.own_frames import written_table
from service.grading.misconception import Hypothesis
from tests.together import together

NAMES = [each.name for each in walk_packages(diagnosis.__path__, f"{diagnosis.__name__}.")]
FILES = [*(import_module(name) for name in NAMES), written_table]


def listed(file: ModuleType) -> list[Any]:
    """The misconceptions and checks that a file lists."""
    return [*getattr(file, "MISCONCEPTIONS", ()), *getattr(file, "CHECKS", ())]


def yields_hypotheses(function: Any) -> bool:
    """Whether the function is annotated as a misconception."""
    returned = get_type_hints(function).get("return")
    [kind] = get_args(returned) if get_origin(returned) is Iterator else [None]
    origin = get_origin(kind) or kind
    return isinstance(origin, type) and issubclass(origin, Hypothesis)


@together("file", FILES)
def test_every_misconception_is_listed(file: ModuleType) -> None:
    functions = inspect.getmembers(file, inspect.isfunction)
    misconceptions = {
        name
        for name, function in functions
        if function.__module__ == file.__name__
        and not name.startswith("_")
        and yields_hypotheses(function)
    }
    assert misconceptions <= {function.__name__ for function in listed(file)}


@pytest.mark.parametrize(
    "file", [file for file in FILES if listed(file)], ids=lambda file: file.__name__
)
def test_every_misconception_has_its_pair(file: ModuleType) -> None:
    diagnosed = (
        f"{diagnosis.__name__}.tables.whole_table" if file is written_table else file.__name__
    )
    room, _, name = diagnosed.removeprefix("service.").rpartition(".")
    tests = import_module(f"tests.{room}.test_{name}")
    assert {pair.function for pair in tests.PAIRS} >= set(listed(file))
