"""Every rule is registered, has its paired cases, and answers only what it can."""

import inspect
from pathlib import Path

from service.expressions import repairs
from service.expressions.repairs import RULES

SOURCES = {file.stem for file in Path(repairs.__file__).parent.glob("*.py")}
TESTS = {file.stem.removeprefix("test_") for file in Path(__file__).parent.glob("test_*.py")}


def test_every_rule_is_registered_once_and_paired() -> None:
    names = [
        module.__name__.rsplit(".", 1)[1] for module in map(inspect.getmodule, RULES) if module
    ]
    assert len(names) == len(set(names)) == len(RULES)
    assert set(names) == SOURCES - {"__init__", "failure", "nearest_name"}
    assert set(names) == TESTS - {"registry"}
