"""A bundle with variants gives each student different numbers."""

import json
import os
import re
import runpy
import shutil
from collections.abc import Mapping
from html import escape
from pathlib import Path
from typing import Any

import pytest
from dh_grader.bundles import platform_seeds
from dh_grader.catalogue import Exercise, load_exercise
from dh_grader.solutions import solve
from dh_grader.variants import hidden_variant

from tests.installed.environment import checked, run, unpack
from tests.variants.varied_files import varied_text

ASSIGNMENT = """
title = "Arms"
variants = true
[[exercises]]
path = "arm.toml"
"""


def bundle(programs: Path, folder: Path, platform: str, *options: str) -> Path:
    (folder / "arm.toml").write_text(varied_text(), encoding="utf-8")
    (folder / "hw.toml").write_text(ASSIGNMENT, encoding="utf-8")
    file = folder / f"{platform}.zip"
    what = ("bundle", platform, "--assignment", "hw.toml", "--output", file, *options)
    checked(programs / "dh-grader", *what, "--secret", "hw.secret", cwd=folder)
    return file


def variant_of(folder: Path, seeds: Mapping[str, str]) -> Exercise:
    return hidden_variant(load_exercise(folder / "arm.toml"), seeds["arm"])


def answers(folder: Path, seeds: Mapping[str, str]) -> dict[str, Any]:
    return {"answers": {"table": solve(variant_of(folder, seeds)).parts[0].answer}}


@pytest.mark.long
def test_gradescope_gives_each_account_a_variant(programs: Path, tmp_path: Path) -> None:
    file = bundle(programs, tmp_path, "gradescope")
    assert (tmp_path / "hw.secret").stat().st_mode & 0o077 == 0
    place = tmp_path / "autograder"
    unpack(file, place / "source")
    # Another test runs the script that installs the program.
    (place / "source" / "venv").symlink_to(programs.parent)
    shutil.copy(place / "source" / "run_autograder", place)
    about, handed_in = place / "submission_metadata.json", place / "submission" / "arm.json"
    handed_in.parent.mkdir()
    about.write_text(json.dumps({"users": [{"id": 1}]}))
    seeds = platform_seeds(about, place / "source" / "variants.json")
    handed_in.write_text(json.dumps(answers(tmp_path, seeds)), encoding="utf-8")
    mine = variant_of(tmp_path, seeds).title

    def differs(account: int) -> bool:
        about.write_text(json.dumps({"users": [{"id": account}]}))
        other = platform_seeds(about, place / "source" / "variants.json")
        return variant_of(tmp_path, other).title != mine

    # The secret is random, so some accounts get the same lengths. The lengths are in the title.
    other = next(filter(differs, range(2, 100)))
    numbers = {}
    for account in (1, other):
        about.write_text(json.dumps({"users": [{"id": account, "email": "a@b.c"}]}))
        done = run(place / "run_autograder", cwd=place)
        assert done.returncode == 0, done.stderr
        result = json.loads((place / "results" / "results.json").read_bytes())
        # The answer of the one is wrong for the other.
        assert (result["score"] == 8) is (account == 1), result
        # Gradescope has no page with the exercise: the result tells each student the numbers.
        [numbers[account]] = re.findall(r"An arm with links of .* m", result["output"])
        assert seeds["arm"] not in json.dumps(result)
    assert numbers[1] != numbers[other]


@pytest.mark.long
def test_prairielearn_chooses_by_its_own_variant_seed(programs: Path, tmp_path: Path) -> None:
    file = bundle(programs, tmp_path, "prairielearn", "--image", "course/grader")
    unpack(file, tmp_path)
    question = tmp_path / "question"
    info = json.loads((question / "info.json").read_text(encoding="utf-8"))
    assert info["singleVariant"] is False
    assert "{{{params.page_1}}}" in (question / "question.html").read_text(encoding="utf-8")
    generate = runpy.run_path(str(question / "server.py"))["generate"]

    def data(variant_seed: int) -> dict[str, Any]:
        options = {"question_path": str(question)}
        made: dict[str, Any] = {"params": {}, "variant_seed": variant_seed, "options": options}
        generate(made)
        return made

    made = [data(variant_seed) for variant_seed in range(60)]
    assert made[7] == data(7)
    assert len({each["params"]["page_1"] for each in made}) > 10
    one = made[7]["params"]
    other = next(each["params"] for each in made if each["params"]["page_1"] != one["page_1"])
    exercise = load_exercise(tmp_path / "arm.toml")
    assert escape(hidden_variant(exercise, one["seeds"]["arm"]).title) in one["page_1"]
    assert "arm.json" in one["page_1"]
    assert one["seeds"]["arm"] not in one["page_1"]

    grade = tmp_path / "grade"
    shutil.copytree(question / "tests", grade / "tests")
    for folder in ("student", "data"):
        (grade / folder).mkdir()
    handed_in = json.dumps(answers(tmp_path, one["seeds"]))
    (grade / "student" / "arm.json").write_text(handed_in, encoding="utf-8")
    path = f"{programs}{os.pathsep}{os.environ['PATH']}"
    for params, is_right in ((one, True), (other, False)):
        (grade / "data" / "data.json").write_text(json.dumps({"params": params}))
        done = run(tmp_path / "image" / "grade-submission", grade, cwd=grade, PATH=path)
        assert done.returncode == 0, done.stderr
        result = json.loads((grade / "results" / "results.json").read_bytes())
        assert (result["score"] == 1) is is_right, result
