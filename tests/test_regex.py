"""Regular expressions that are compiled when they are first used."""

import re
from importlib import import_module

import pytest
from dh_grader.regex import regex

from tests.test_structure import trees


@pytest.mark.parametrize("flags", [0, re.IGNORECASE, re.MULTILINE | re.DOTALL])
def test_it_does_what_a_compiled_one_does(flags: int) -> None:
    text, pattern = "Ab\nab 12\n", r"^a(b)|(?P<digit>\d)"
    late, ready = regex(pattern, flags), re.compile(pattern, flags)
    assert (late.pattern, late.flags) == (ready.pattern, ready.flags)
    assert (late.groups, late.groupindex) == (ready.groups, ready.groupindex)
    for name in ("match", "fullmatch", "search"):
        for start in range(4):
            found, expected = (getattr(each, name)(text, start) for each in (late, ready))
            assert (found and found.span()) == (expected and expected.span())
    assert late.findall(text) == ready.findall(text)
    assert [each.span() for each in late.finditer(text)] == [
        each.span() for each in ready.finditer(text)
    ]
    assert late.split(text) == ready.split(text)
    assert late.sub("x", text) == ready.sub("x", text)
    assert late.subn("x", text, 1) == ready.subn("x", text, 1)


def test_it_is_compiled_at_its_first_use(monkeypatch: pytest.MonkeyPatch) -> None:
    compiled: list[object] = []
    really = re.compile

    def compile_and_note(text: str, flags: int) -> re.Pattern[str]:
        compiled.append((text, flags))
        return really(text, flags)

    monkeypatch.setattr(re, "compile", compile_and_note)
    late = regex(r"a+")
    assert (late.pattern, compiled) == (r"a+", [])
    assert late.match("aab")
    assert late.sub("b", "a") == "b"
    assert late.search("b") is None
    assert compiled == [(r"a+", 0)]
    assert not hasattr(late, "missing")


@pytest.mark.long
def test_each_one_of_the_program_is_valid() -> None:
    count = 0
    for module in trees():
        if not {"app", "__main__", "migrations"} & set(module.split(".")):
            for each in vars(import_module(module)).values():
                if type(each) is type(regex("")):
                    assert each.groups >= 0
                    count += 1
    assert count > 300
