"""Test the commands for variants of an exercise."""

import json
import re
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest
from dh_grader.variants import built
from typer.testing import Result

from tests.variants.varied_files import shipped, varied_text

Run = Callable[..., Result]


@pytest.fixture
def arm(tmp_path: Path) -> Path:
    file = tmp_path / "arm.toml"
    file.write_text(varied_text(), encoding="utf-8")
    return file


def test_check_counts_seeds_and_what_differs(run: Run, arm: Path) -> None:
    checked = run("exercises", "check", arm, "--seeds", 4)
    assert checked.exit_code == 0, checked.output
    assert re.search(r"arm: 4 seeds, [1-4] different", checked.stdout)
    assert re.search(r"lengths +2 +2 +2 \(4 of 4\)", checked.stdout)


def test_what_differs_is_in_the_language(
    run: Run, arm: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DH_GRADER_LANGUAGE", "de")
    checked = run("exercises", "check", arm, "--seeds", 4)
    assert re.search(r"arm: 4 Seeds, [1-4] verschiedene", checked.stdout)
    assert re.search(r"kleinster Wert +größter Wert +häufigster Wert", checked.stdout)
    assert re.search(r"Längen +2 +2 +2 \(4 von 4\)", checked.stdout)


@pytest.mark.long
def test_check_names_a_variant_in_which_a_check_fails(run: Run, arm: Path) -> None:
    # Right for the first choice of a1 only.
    text = arm.read_text(encoding="utf-8")
    check = (
        '[[checks]]\ntitle = "T"\nkind = "right"\n'
        'answers.table = "0.3 {{j2.sign}}90deg 0 theta1\\n{{a2}} 0 0 theta2"\n'
    )
    arm.write_text(text + check, encoding="utf-8")
    checked = run("exercises", "check", arm, "--seeds", 8)
    assert checked.exit_code == 1
    named = re.search(
        r"failed: (\d) variants, such as arm~(\d): checks\[0\]: 'T': table", checked.stdout
    )
    assert named, checked.stdout


@pytest.mark.long
def test_deploy_writes_the_seeds_and_draws_the_variants(
    run: Run, arm: Path, tmp_path: Path
) -> None:
    deployed = run("exercises", "deploy", arm, "--count", 3, "--figures", tmp_path / "pictures")
    assert deployed.exit_code == 0, deployed.output
    seeds = tomllib.loads(arm.read_text(encoding="utf-8"))["vary"]["deployed"]
    assert len(seeds) == 3
    pictures = sorted(file.name for file in (tmp_path / "pictures").iterdir())
    assert pictures == sorted(f"arm~{seed}.svg" for seed in seeds)
    again = run("exercises", "deploy", arm, "--count", 3, "--without", seeds[0], "--print")
    assert f"arm~{seeds[1]}" in again.stdout
    assert f"arm~{seeds[0]}" not in again.stdout
    assert tomllib.loads(arm.read_text(encoding="utf-8"))["vary"]["deployed"] == seeds


@pytest.mark.long
def test_deploy_says_if_there_are_too_few_variants(run: Run, arm: Path) -> None:
    arm.write_text(varied_text(), encoding="utf-8")
    refused = run("exercises", "deploy", arm, "--count", 40)
    assert refused.exit_code == 2
    assert "different variants of one difficulty" in refused.stderr
    plain = run("exercises", "deploy", "scara")
    assert "The exercise scara has no variants: its file has no [vary]." in plain.stderr


def test_show_and_grade_take_the_id_of_a_variant(run: Run, tmp_path: Path) -> None:
    variant = built(shipped("planar-rr-numbers"), "k7")
    shown = run("exercises", "show", "planar-rr-numbers~k7")
    length = re.search(r"length\s+(0\.\d+) m", variant.statement)
    assert length
    assert f"{length[1]} m" in shown.stdout
    rows = variant.robot.tables[variant.robot.convention].rows
    answers = {"table": {"rows": [[cell.text() for cell in row] for row in rows]}}
    file = tmp_path / "ada.json"
    file.write_text(json.dumps({"answers": answers}), encoding="utf-8")
    graded = run("grade", file, "--exercise", "planar-rr-numbers~k7", "--format", "json")
    [graded_file] = json.loads(graded.stdout)
    assert graded_file["exercise"] == "planar-rr-numbers~k7"
    assert graded_file["report"]["points"] == 4
    refused = run("exercises", "show", "scara~1")
    assert "The exercise scara has no variants." in refused.stderr
