"""Test `dh-grader grade --assignment` and `dh-grader assignments check`."""

import json
from pathlib import Path

import pytest

from tests.cli.conftest import Run

ASSIGNMENT = """\
title = "Homework"
pass_mark = 0.4
[[exercises]]
id = "planar-rrr"
parts = ["table"]
points = 30
[[exercises]]
id = "scara"
points = 10
"""
ROWS = [
    ["0", "0", "0", "q1"],
    ["l1", "0", "0", "q2"],
    ["l2", "0", "0", "q3"],
    ["l3", "0", "0", "0"],
]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "hw.toml").write_text(ASSIGNMENT, encoding="utf-8")
    anna, bert = tmp_path / "class/anna", tmp_path / "class/bert.json"
    anna.mkdir(parents=True)
    lines = ["a, alpha, d, theta", *map(", ".join, ROWS)]
    (anna / "planar-rrr.csv").write_text("\n".join(lines), encoding="utf-8")
    body = {"exercise": "scara", "answers": {}}
    bert.write_text(json.dumps(body), encoding="utf-8")
    return tmp_path


def test_points_and_pass_mark_are_the_assignment_s(run: Run, folder: Path) -> None:
    common = ["grade", "--assignment", folder / "hw.toml", "--format", "csv"]
    result = run(*common, folder / "class")
    assert result.exit_code == 1
    head, anna, bert = (line.split(",") for line in result.stdout.splitlines())
    assert head[1:5] == ["points", "max_points", "score", "passed"]
    assert anna[1:5] == ["30", "40", "0.75", "yes"]
    # Bert's file has no answers, so that a person must see it.
    assert bert[1:5] == ["", "40", "", "no"]
    assert run(*common, folder / "class/anna", "--one-student").exit_code == 0
    above = run(*common, folder / "class/anna", "--one-student", "--pass-mark", "0.8")
    assert above.exit_code == 1


def test_each_exercise_has_an_entry_in_json(run: Run, folder: Path) -> None:
    result = run("grade", folder / "class", "--assignment", folder / "hw.toml", "--format", "json")
    entries = json.loads(result.stdout)
    assert [(entry["exercise"], entry["report"]["score"]) for entry in entries] == [
        ("planar-rrr", 1), ("scara", 0), ("planar-rrr", 0), ("scara", 0),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        ([], "--exercise ID or FILE, or --assignment F"),
        (["--exercise", "scara", "--assignment", "hw.toml"], "ID or FILE, or --assignment F"),
        (["--assignment", "hw.toml", "--part", "table"], "--part goes with --exercise"),
        (["--assignment", "none.toml"], "none.toml: cannot be read: No such file"),
        (["--assignment", "."], "cannot be read: Is a directory"),
    ],
)
def test_exactly_one_of_exercise_and_assignment_is_required(
    run: Run, folder: Path, options: list[str], reason: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder)
    result = run("grade", "class", *options)
    assert result.exit_code == 2
    assert reason in result.stderr


def test_an_empty_folder_is_refused(run: Run, folder: Path) -> None:
    (folder / "empty").mkdir()
    result = run("grade", folder / "empty", "--assignment", folder / "hw.toml")
    assert (result.exit_code, "no submission was found" in result.stderr) == (2, True)


def test_check_lists_which_file_answers_which_exercise(run: Run, folder: Path) -> None:
    (folder / "class/carl.csv").write_text("1", encoding="utf-8")
    result = run("assignments", "check", folder / "hw.toml", folder / "class")
    assert result.exit_code == 0
    assert "Homework: 2 exercises, 40 points, pass mark 40 %" in result.stdout
    assert f"planar-rrr: table from {folder}/class/anna/planar-rrr.csv" in result.stdout
    assert "scara: missing" in result.stdout
    assert "carl.csv is a pasted answer, whose name does not say the exercise" in result.stdout


def test_check_names_the_line_of_a_fault(run: Run, folder: Path) -> None:
    (folder / "hw.toml").write_text(ASSIGNMENT.replace("scara", "skara"), encoding="utf-8")
    result = run("assignments", "check", folder / "hw.toml")
    assert result.exit_code == 2
    assert "exercises[1].id (line 8): There is no exercise 'skara'. Did you mean 'scara'?" in (
        result.stderr
    )


def test_an_unusable_file_is_named_beside_the_report_on_the_others(run: Run, folder: Path) -> None:
    (folder / "class/anna/scara").mkdir()
    (folder / "class/anna/scara/table.csv").write_text("0, 0, 0, q1", encoding="utf-8")
    (folder / "class/anna/scara/pose.csv").write_bytes(b"\x81")
    common = ["grade", folder / "class", "--assignment", folder / "hw.toml", "--format"]
    result = run(*common, "json")
    assert result.exit_code == 2
    first, second, *others = json.loads(result.stdout)
    assert "error" not in first
    assert second["error"].startswith("scara/pose.csv is not text")
    assert second["report"]["parts"][0]["verdict"] != "missing"
    assert [entry.get("error") for entry in others] == [None, "Nothing is answered."]
    assert "scara/pose.csv is not text" in run(*common, "csv").stdout


def test_check_speaks_the_language_of_the_user(
    run: Run, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DH_GRADER_LANGUAGE", "es")
    lines = run("assignments", "check", folder / "hw.toml", folder / "class").stdout.splitlines()
    assert lines[0] == "Homework: 2 ejercicios, 40 puntos, se aprueba con 40 %"
    assert lines[1].startswith("  planar-rrr, 30 puntos: table; comentarios hints; archivos planar")
    assert lines[1].endswith(", y similares")
    assert f"  planar-rrr: table de {folder}/class/anna/planar-rrr.csv" in lines
    assert "  scara: falta" in lines
