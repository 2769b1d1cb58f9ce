"""Run the scripts of the GitHub Action, the GitLab component and the release workflow."""

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml

ROOT = Path(__file__).parents[2]
ACTION: dict[str, Any] = yaml.safe_load((ROOT / "action.yml").read_text(encoding="utf-8"))
SPEC, COMPONENT = yaml.safe_load_all((ROOT / "templates/grade.yml").read_text(encoding="utf-8"))
RELEASE: dict[str, Any] = yaml.safe_load(
    (ROOT / ".github/workflows/release.yml").read_text(encoding="utf-8")
)
TEST: dict[str, Any] = yaml.safe_load(
    (ROOT / ".github/workflows/test.yml").read_text(encoding="utf-8")
)
RIGHT = "a, alpha, d, theta\n0, 0, 0, q1\nl1, 0, 0, q2\nl2, 0, 0, q3\nl3, 0, 0, 0\n"
pytestmark = pytest.mark.skipif(os.name == "nt", reason="needs bash")


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    folder = tmp_path / "my answers"
    folder.mkdir()
    (folder / "table.csv").write_text(RIGHT, encoding="utf-8")
    program = tmp_path / "bin" / "dh-grader"
    program.parent.mkdir()
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m dh_grader "$@"\n', encoding="utf-8")
    program.chmod(0o755)
    return tmp_path


def bash(script: str, folder: Path, **variables: str) -> subprocess.CompletedProcess[str]:
    path = f"{folder / 'bin'}{os.pathsep}{os.environ['PATH']}"
    return subprocess.run(
        ["bash", "-e", "-o", "pipefail", "-c", script],
        cwd=folder,
        env=os.environ | variables | {"PATH": path, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.long
def test_the_action_grades_a_repository(repository: Path) -> None:
    step = ACTION["runs"]["steps"][-1]
    inputs = {name: f"${{{{ inputs.{name} }}}}" for name in ACTION["inputs"]}
    assert sorted(step["env"].values()) == sorted(inputs.values())
    assert "${{" not in step["run"]
    summary = repository / "summary.md"
    given = {
        "EXERCISE": "planar-rrr",
        "ASSIGNMENT": "",
        "FOLDER": "my answers",
        "PASS_MARK": "0.5",
        "GITHUB_STEP_SUMMARY": str(summary),
    }
    done = bash(step["run"], repository, **given)
    assert done.returncode == 0, done.stderr
    assert "8 / 16" in summary.read_text(encoding="utf-8")


@pytest.mark.long
def test_the_component_grades_a_project(repository: Path) -> None:
    job = COMPONENT["grade"]
    [script] = job["script"]
    assert "$[[" not in script
    used = set(
        re.findall(r"\$\[\[ inputs\.([\w-]+) \]\]", (ROOT / "templates/grade.yml").read_text())
    )
    assert used == SPEC["spec"]["inputs"].keys()
    given = {"EXERCISE": "planar-rrr", "FOLDER": "my answers", "PASS_MARK": "0.5"}
    assert given.keys() == job["variables"].keys()
    done = bash(script, repository, **given)
    assert done.returncode == 0, done.stderr
    report = (repository / job["artifacts"]["reports"]["junit"]).read_text("utf-8")
    assert report.count("<testcase") == report.count("<failure") + 1


def test_a_release_has_both_platforms_an_sbom_and_a_signature() -> None:
    steps = RELEASE["jobs"]["image"]["steps"]
    [build] = [step for step in steps if "build-push" in step.get("uses", "")]
    assert build["with"]["platforms"] == "linux/amd64,linux/arm64"
    assert (build["with"]["sbom"], build["with"]["provenance"]) == (True, "mode=max")
    assert steps[-1]["run"] == 'cosign sign --yes "$NAME@$DIGEST"'
    assert steps[-1]["env"]["DIGEST"] == f"${{{{ steps.{build['id']}.outputs.digest }}}}"


@pytest.mark.parametrize(("tag", "code"), [("{}", 1), ("v{}", 0), ("v{}1", 1)])
def test_a_release_has_the_tag_of_its_version(tag: str, code: int, tmp_path: Path) -> None:
    [script] = [step["run"] for step in RELEASE["jobs"]["image"]["steps"]
                if step.get("id") == "version"]  # fmt: skip
    content = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    (tmp_path / "pyproject.toml").write_text(content, encoding="utf-8")
    version = re.findall(r'^version = "(.+)"$', content, re.MULTILINE)[0]
    output = tmp_path / "output"
    done = bash(script, tmp_path, TAG=tag.format(version), GITHUB_OUTPUT=str(output))
    assert done.returncode == code
    assert output.exists() is (code == 0)


def test_a_push_runs_the_tests_with_read_only_permissions() -> None:
    # YAML 1.1 reads the key "on" as true.
    assert TEST[True].keys() == {"push", "pull_request"}  # type: ignore[index]
    assert TEST["permissions"] == {"contents": "read"}
    jobs = TEST["jobs"]
    assert all("permissions" not in job for job in jobs.values())
    commands = {name: [each.get("run") for each in job["steps"]] for name, job in jobs.items()}
    assert {name: list(filter(None, found)) for name, found in commands.items()} == {
        "quick": ["make install", "make test"],
        "all": [".ci/run"],
    }
    oldest = re.search(r'requires-python = ">=([\d.]+)"', read("pyproject.toml"))
    assert oldest is not None
    assert jobs["quick"]["strategy"]["matrix"]["python"] == [oldest[1], "3.x"]
    for job in jobs.values():
        assert job["steps"][0]["with"]["persist-credentials"] is False
        assert job["timeout-minutes"] <= 90


def read(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")
