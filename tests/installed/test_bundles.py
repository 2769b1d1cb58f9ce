"""Unpack and run bundles as their platforms do."""

import json
import os
import shutil
import subprocess
from pathlib import Path
from typing import Any

import jsonschema
import pytest
import yaml

from tests.installed.environment import ROOT, checked, environment, run, unpack
from tests.installed.handed_in import EXERCISE, SORTS, assert_nothing_ran, points_of

SCHEMAS = ROOT / "tests" / "formats" / "schemas"
# A wrong α costs 2.1 of the table's 8 points, a wrong sign in the rotation 1 of the pose's 8.
POINTS = {"right": 16.0, "wrong": 12.894737, "unreadable": 0.0, "missing": 0.0, "hostile": 8.0}


# A process starts for each submission, so the suite tries two of each bundle.
ALL = pytest.param(tuple(SORTS), id="all", marks=pytest.mark.campaign)


def bundle(programs: Path, folder: Path, platform: str, *options: str) -> Path:
    """Return the bundle that the installed program writes."""
    file = folder / f"{platform}.zip"
    what = ("bundle", platform, "--exercise", EXERCISE, "--output", file, *options)
    checked(programs / "dh-grader", *what, cwd=folder)
    return file


def valid(file: Path, platform: str) -> dict[str, Any]:
    """Return the JSON result in a file after checking it against its schema."""
    schema = json.loads((SCHEMAS / f"{platform}.json").read_text(encoding="utf-8"))
    result: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator(schema).validate(result)
    return result


@pytest.mark.parametrize("sorts", [ALL])
def test_gradescope_gets_a_valid_result(
    sorts: tuple[str, ...], programs: Path, tmp_path: Path
) -> None:
    place = tmp_path / "autograder"
    unpack(bundle(programs, tmp_path, "gradescope"), place / "source")
    # The packages that the script would download come from this environment.
    venv = environment(place / "source" / "venv")
    checked(place / "source" / "setup.sh", cwd=tmp_path, PYTHON=os.fspath(venv / "python"))
    shutil.copy(place / "source" / "run_autograder", place)
    submission, results = place / "submission", place / "results"
    for sort in sorts:
        for folder in (submission, results):
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir()
        SORTS[sort](submission)
        done = run(place / "run_autograder", cwd=place)
        assert done.returncode == 0, done.stderr
        result = valid(results / "results.json", "gradescope")
        assert (sort, result["score"]) == (sort, POINTS[sort])
        assert points_of(result) == pytest.approx(POINTS[sort], abs=1e-5)
        text = (results / "results.json").read_text(encoding="utf-8")
        assert_nothing_ran(place, text, done.stdout, done.stderr)


@pytest.mark.long
@pytest.mark.parametrize("sorts", [("hostile",), ALL])
def test_prairielearn_gets_a_valid_result(
    sorts: tuple[str, ...], programs: Path, tmp_path: Path
) -> None:
    options = ("--image", "course/grader")
    unpack(bundle(programs, tmp_path, "prairielearn", *options), tmp_path)
    check_question(tmp_path / "question", tmp_path / "image")
    # In the image the program is on the path.
    path = f"{programs}{os.pathsep}{os.environ['PATH']}"
    for sort in sorts:
        grade = tmp_path / sort / "grade"
        shutil.copytree(tmp_path / "question" / "tests", grade / "tests")
        (grade / "student").mkdir()
        SORTS[sort](grade / "student")
        done = run(tmp_path / "image" / "grade-submission", grade, cwd=grade.parent, PATH=path)
        assert done.returncode == 0, done.stderr
        result = valid(grade / "results" / "results.json", "prairielearn")
        assert result["gradable"] is (sort not in {"unreadable", "missing"})
        assert result["score"] == pytest.approx(POINTS[sort] / 16, abs=1e-6)
        text = (grade / "results" / "results.json").read_text(encoding="utf-8")
        assert_nothing_ran(grade.parent, text, done.stdout, done.stderr)


def check_question(question: Path, image: Path) -> None:
    info = json.loads((question / "info.json").read_text(encoding="utf-8"))
    assert info["gradingMethod"] == "External"
    options = info["externalGradingOptions"]
    assert (options["image"], options["enabled"]) == ("course/grader", True)
    assert options["entrypoint"] == "/usr/local/bin/grade-submission"
    dockerfile = (image / "Dockerfile").read_text(encoding="utf-8")
    assert f"grade-submission {options['entrypoint']}" in dockerfile
    for line in dockerfile.splitlines():
        if line.startswith("COPY"):
            for source in line.split()[1:-1]:
                assert source.startswith("--") or list(image.glob(source))
    page = (question / "question.html").read_text(encoding="utf-8")
    assert "An arm of three links moves in the plane" in page
    assert "{" not in page


@pytest.mark.campaign
@pytest.mark.parametrize("platform", ["github", "gitlab"])
def test_the_job_of_a_repository_runs(platform: str, programs: Path, tmp_path: Path) -> None:
    grader, work = tmp_path / "grader", tmp_path / "work"
    unpack(bundle(programs, tmp_path, "ci"), grader)
    work.mkdir()
    SORTS["wrong"](work)
    job = yaml.safe_load((ROOT / "docs" / "ci" / f"{platform}.yml").read_text(encoding="utf-8"))
    if platform == "github":
        shutil.copytree(grader, work / ".grader")
        steps = [step["run"] for step in job["jobs"]["grade"]["steps"] if "run" in step]
    else:
        for command in ("init -q", "add -A", "-c user.name=x -c user.email=x commit -qm x"):
            checked("git", *command.split(), cwd=grader)
        clone, *steps = job["grade"]["script"]
        checked("bash", "-ec", clone, cwd=work, GRADER_URL=grader.as_uri())
    install, *grading = steps
    assert install == "bash .grader/setup.sh"
    # Another test runs the script that installs the program.
    (work / ".grader" / "venv").symlink_to(programs.parent)
    summary = tmp_path / "summary.md"
    done: list[subprocess.CompletedProcess[str]] = [
        run("bash", "-ec", step, cwd=work, GITHUB_STEP_SUMMARY=str(summary)) for step in grading
    ]
    assert done[-1].returncode == 0, done[-1].stderr
    if platform == "github":
        assert "| 12.89 / 16 |" in summary.read_text(encoding="utf-8")
        assert f"::warning file={EXERCISE}.json,title=Denavit-Hartenberg table" in done[-1].stdout
    else:
        assert 'failures="2"' in (work / "report.xml").read_text(encoding="utf-8")
