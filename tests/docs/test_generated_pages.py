"""Test that generated pages are up to date."""

import ast
import re
import subprocess
import tomllib
from collections import Counter
from http import HTTPStatus
from json import loads
from pathlib import Path

import pytest
from dh_grader.api.http import ProblemError
from dh_grader.catalogue.kinds import SPECS
from dh_grader.catalogue.part import PartSpec
from dh_grader.catalogue.schema import (
    CheckSpec,
    ExerciseSpec,
    ExpectSpec,
    RobotSpec,
    ScrewRobotSpec,
    SymbolSpec,
)
from dh_grader.catalogue.schema_fields import AttemptsSpec
from dh_grader.contract import PROBLEM_TYPES
from dh_grader.grading.diagnosis.lists import WrongPosition
from dh_grader.grading.misconception import all_records
from dh_grader.settings import Settings, load_settings

from tests.docs.exercise_fields import page
from tests.docs.misconception_records import DOCS, PAGES, kinds_in, records_in, written
from tests.docs.notice import BUNDLED, ROOT, VENDORED, looks_vendored, notice
from tests.docs.problems import page as problems_page
from tests.docs.settings import page as settings_page
from tests.together import together

# --- docs/exercise-fields.md is up to date with the schema

FILE = Path(__file__).parents[2] / "docs" / "exercise-fields.md"
MODELS = (
    ExerciseSpec,
    AttemptsSpec,
    RobotSpec,
    ScrewRobotSpec,
    SymbolSpec,
    PartSpec,
    *SPECS.values(),
    CheckSpec,
    ExpectSpec,
)


def test_the_page_is_up_to_date() -> None:
    assert FILE.read_text(encoding="utf-8") == page(), (
        "The keys have changed; run python -m tests.docs.exercise_fields > docs/exercise-fields.md"
    )


def test_the_examples_are_toml() -> None:
    blocks = re.findall(r"```toml\n(.*?)```", page(), re.DOTALL)
    assert len(blocks) > len(SPECS)
    assert all(tomllib.loads(block) for block in blocks)


@pytest.mark.parametrize("model", MODELS, ids=lambda model: str(model.__name__))
def test_every_key_has_its_meaning(model: type[PartSpec]) -> None:
    written = FILE.read_text(encoding="utf-8")
    for name, field in model.model_fields.items():
        key = field.alias or name
        assert f"| `{key}` |" in written or key == "kind"


# --- The page of problems lists every type, and the program has no other types

PROBLEMS_PAGE_ROOT = Path(__file__).parents[2]
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
    written = (PROBLEMS_PAGE_ROOT / "docs" / "problems.md").read_text(encoding="utf-8")
    assert written == problems_page(), "Run python -m tests.docs.problems > docs/problems.md"


def test_the_page_lists_exactly_the_types_of_the_program() -> None:
    texts = {
        file: file.read_text(encoding="utf-8")
        for file in (PROBLEMS_PAGE_ROOT / "service" / "dh_grader").rglob("*.py")
    }
    used = set().union(*map(names_in, texts))
    assert len(used) > 30
    assert used - PROBLEM_TYPES.keys() == set()
    # Each name is written somewhere; some are keys of tables.
    others = [text for file, text in texts.items() if file.name != "problems.py"]
    others.append(texts[PROBLEMS_PAGE_ROOT / "service" / "dh_grader" / "api" / "http.py"])
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


# --- docs/settings.md lists every setting once, and is up to date

SETTINGS_FILE = Path(__file__).parents[2] / "docs" / "settings.md"
_ROW = re.compile(r"^\| `DH_GRADER_([A-Z_]+)` \| (not set|`[^`]+`) \| (.+) \|$", re.MULTILINE)


def test_the_page_of_settings_is_up_to_date() -> None:
    assert SETTINGS_FILE.read_text(encoding="utf-8") == settings_page(), (
        "The settings have changed; run python -m tests.docs.settings > docs/settings.md"
    )


def test_every_setting_has_one_row() -> None:
    rows = _ROW.findall(SETTINGS_FILE.read_text(encoding="utf-8"))
    assert sorted(name.lower() for name, _, _ in rows) == sorted(Settings.model_fields)


def test_a_printed_default_is_the_default(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in Settings.model_fields:
        monkeypatch.delenv(f"DH_GRADER_{name.upper()}", raising=False)
    usual = load_settings()
    for name, default, _ in _ROW.findall(SETTINGS_FILE.read_text(encoding="utf-8")):
        if default != "not set":
            monkeypatch.setenv(f"DH_GRADER_{name}", default.strip("`"))
    assert load_settings() == usual


# --- NOTICE names every third-party work in the repository, with its licence

# The files with licences, and other files that belong to third-party works.
BESIDE = {each.text for each in VENDORED} | {
    BUNDLED,
    "LICENSE",
    "NOTICE",
    "service/dh_grader/api/swagger_ui/NOTICE",
    "service/dh_grader/web/static/vendor/three-0.185.1.README.md",
    # Types for our checks, written in this project.
    "service/dh_grader/web/static/vendor/three-0.185.1.module.min.d.ts",
    "service/dh_grader/web/static/vendor/three-0.185.1.orbit-controls.d.ts",
    "tests/docs/notice.py",
}


def test_the_notice_is_up_to_date() -> None:
    written = (ROOT / "NOTICE").read_text(encoding="utf-8")
    assert written == notice(), "run `python -m tests.docs.notice > NOTICE`"


def test_each_vendored_file_has_an_entry() -> None:
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, check=False)
    files = [name for name in listed.stdout.decode().splitlines() if (ROOT / name).is_file()]
    if not files:
        pytest.skip("this is no clone of the repository")
    carried = {
        name
        for name in files
        if name.startswith(("service/", "exercises/", "tests/")) and looks_vendored(ROOT / name)
    }
    named = {file for each in VENDORED for file in each.files}
    assert named <= carried, "looks_vendored() finds less than it must"
    assert carried - named - BESIDE == set()


def test_each_entry_has_the_text_of_its_licence() -> None:
    phrases = {"MIT": "MIT License", "Apache-2.0": "Apache License", "MPL-2.0": "Mozilla Public"}
    phrases["BSD-3-Clause"] = "Redistribution and use in source and binary forms"
    phrases["BSD-2-Clause"] = "BSD 2-Clause License"
    for each in VENDORED:
        assert phrases[each.licence] in (ROOT / each.text).read_text(encoding="utf-8")
        assert all((ROOT / file).is_file() for file in each.files)
        assert all(each.version in file for file in each.files)
        # Files in the wheel are inside the package.
        assert each.shipped == each.text.startswith("service/")


# --- The lists of misconceptions in docs/ are complete and current

MESSAGES = (DOCS / "messages.md").read_text(encoding="utf-8")


@together("page", PAGES)
def test_a_page_is_what_the_records_say(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert written(text) == text, "run `python -m tests.docs.misconception_records`"


def test_every_record_is_in_a_table() -> None:
    listed = records_in([name for name, _ in kinds_in(MESSAGES)])
    left_out = {record.name for record in all_records() if record.codes} - {
        record.name for record in listed
    }
    assert left_out == set(), "name the kind of case in a mark of docs/messages.md"


def test_no_kind_is_in_two_tables() -> None:
    names = Counter(name for name, _ in kinds_in(MESSAGES))
    assert [name for name, count in names.items() if count > 1] == []


def test_a_list_is_written_between_its_marks() -> None:
    page = "## A\n<!-- codes: WrongPosition -->\nold\n<!-- end -->\nkept\n"
    own = {code for each in all_records() if each.of is WrongPosition for code in each.codes}
    codes = ", ".join(f"`{code}`" for code in sorted(own))
    assert written(page) == page.replace("old\n", f"{codes}.\n")
