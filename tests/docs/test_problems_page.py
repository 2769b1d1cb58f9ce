"""The page of problems lists every type, and the program has no other types."""

import ast
from http import HTTPStatus
from json import loads
from pathlib import Path

from dh_grader.api.http import ProblemError
from dh_grader.contract import PROBLEM_TYPES

from tests.docs.problems import page

ROOT = Path(__file__).parents[2]
# The types by the number of the argument that is their name.
NAMED = {
    "ProblemError": 2,
    "access_problem": 0,
    "CourseError": 0,
    "AttemptRefusedError": 0,
    "HintRefusedError": 0,
    "_refused": 0,
}


def names_in(file: Path) -> set[str]:
    """Return the names of problems that are written in a file of the program."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    found = set()
    for call in (each for each in ast.walk(tree) if isinstance(each, ast.Call)):
        place = NAMED.get(getattr(call.func, "id", ""))
        given = [] if place is None else call.args[place : place + 1]
        given += [each.value for each in call.keywords if each.arg == "name" and place is not None]
        found |= {
            each.value
            for each in given
            if isinstance(each, ast.Constant) and isinstance(each.value, str)
        }
    return found


def test_the_page_is_generated() -> None:
    written = (ROOT / "docs" / "problems.md").read_text(encoding="utf-8")
    assert written == page(), "Run python -m tests.docs.problems > docs/problems.md"


def test_the_page_lists_exactly_the_types_of_the_program() -> None:
    texts = {
        file: file.read_text(encoding="utf-8")
        for file in (ROOT / "service" / "dh_grader").rglob("*.py")
    }
    used = set().union(*map(names_in, texts))
    assert len(used) > 30
    assert used - PROBLEM_TYPES.keys() == set()
    # Each name is written somewhere; some are keys of tables.
    others = [text for file, text in texts.items() if file.name != "problems.py"]
    others.append(texts[ROOT / "service" / "dh_grader" / "api" / "http.py"])
    named = {name for name, each in PROBLEM_TYPES.items() if not each.is_general} - {"refused"}
    assert {name for name in named if not any(f'"{name}"' in text for text in others)} == set()


def test_a_problem_without_a_name_has_the_type_of_its_status() -> None:
    for status in (each for each in HTTPStatus if each >= 400):
        found = loads(ProblemError(status, "No.").content("/"))["type"]
        name = found.removeprefix("urn:dh-grader:problem:")
        assert name in PROBLEM_TYPES
        general = {each.status for each in PROBLEM_TYPES.values() if each.is_general}
        expected = status if status in general else 400 if status < 500 else 500
        assert PROBLEM_TYPES[name].status == expected
