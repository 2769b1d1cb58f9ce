"""The grammar and its builders fit together."""

import logging
from importlib.resources import files
from inspect import isfunction

import pytest
from lark import Lark, logger

from service.expressions.parsing.parser import Table
from service.expressions.parsing.tree_builder import Builder

GRAMMAR = files("service.expressions.parsing").joinpath("grammar.lark").read_text("utf-8")


def _conflicts(grammar: str, caplog: pytest.LogCaptureFixture) -> bool:
    """Tell whether lark had to settle a conflict. It does so silently, unless asked to debug."""
    caplog.clear()
    with caplog.at_level(logging.DEBUG, logger=logger.name):
        # The terminals need some pattern for lark's own lexer, which is not used.
        names = [line.split()[1:] for line in grammar.splitlines() if line.startswith("%declare")]
        patterns = "\n".join(f'{name}: "{name}"' for name in names[0])
        Lark(grammar.replace("%declare", "//") + "\n" + patterns, parser="lalr", debug=True)
    return "conflict" in caplog.text.lower()


def test_every_rule_has_its_builder() -> None:
    public = {name for name, member in vars(Builder).items() if isfunction(member)}
    assert Table(Builder).rules == {name for name in public if not name.startswith("_")}


def test_the_grammar_has_one_reading(caplog: pytest.LogCaptureFixture) -> None:
    assert not _conflicts(GRAMMAR, caplog)
    assert _conflicts(GRAMMAR + "\n%extend power: bare_call POWER exponent\n", caplog)
