"""Check the scripts of the pages: types, style, unit tests and imports."""

import re
from subprocess import CompletedProcess

import pytest
from dh_grader.app import app

from tests.front import deno
from tests.front.api_types import api_types

LINES = 1000
# A script may import from its own room and from these.
ROOMS = {
    "vendor": set[str](),
    "pages": set[str](),
    "shared": set[str](),
    "typeset": {"shared"},
    "robot": {"shared", "typeset", "vendor"},
    "catalogue": {"shared"},
    "student": {"shared", "typeset", "robot", "pages", "catalogue"},
    "play": {"shared", "robot", "student"},
    "ten_minutes": {"shared", "typeset", "robot"},
    "practice": {"student"},
    "tutor": {"shared", "student"},
    "learner": {"shared", "typeset", "student", "tutor"},
}


def passes(result: CompletedProcess[str]) -> None:
    if result.returncode:
        pytest.fail(result.stdout, pytrace=False)


def test_the_types_of_the_scripts_fit() -> None:
    passes(deno.types())


def test_the_linter_finds_nothing() -> None:
    passes(deno.linter())


def test_the_scripts_are_formatted() -> None:
    passes(deno.formatter("--check"))


def test_the_unit_tests_pass() -> None:
    passes(deno.units())


def test_the_types_of_the_interface_are_those_of_the_openapi_document() -> None:
    written = (deno.TYPES / "api.d.ts").read_text(encoding="utf-8")
    assert written == api_types(app.openapi()), (
        "python -m tests.front.api_types > service/dh_grader/web/types/api.d.ts"
    )


def test_a_room_imports_only_from_rooms_below_it() -> None:
    wrong = []
    for script in deno.scripts():
        room = script.relative_to(deno.STATIC).parts[0]
        for path in re.findall(r'"(\.\.?/[\w./-]+)"', script.read_text(encoding="utf-8")):
            target = (script.parent / path).resolve()
            if target.is_file():
                other = target.relative_to(deno.STATIC).parts[0]
                wrong += [f"{script.name}: {path}"] * (other not in {room, *ROOMS[room]})
    assert wrong == []


def test_scripts_stay_easy_to_survey() -> None:
    long = [
        script.name
        for script in deno.scripts()
        if len(script.read_text(encoding="utf-8").splitlines()) > LINES
    ]
    assert long == []


def test_no_comment_names_another_script() -> None:
    # The service takes a quoted script name for an import, even in a comment, and loads it.
    comments = re.compile(r"/\*.*?\*/|^\s*//[^\n]*", re.DOTALL | re.MULTILINE)
    naming = [
        script.name
        for script in deno.scripts()
        if any('.js"' in comment for comment in comments.findall(script.read_text("utf-8")))
    ]
    assert naming == []
