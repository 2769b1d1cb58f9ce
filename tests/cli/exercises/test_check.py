"""Test `dh-grader exercises new` and `check`."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from dh_grader.catalogue import shipped_folder
from typer.testing import Result

Run = Callable[..., Result]


@pytest.fixture
def arm(run: Run, tmp_path: Path) -> Path:
    run("exercises", "new", "arm", "--output", tmp_path)
    return tmp_path / "arm.toml"


def changed(file: Path, *changes: tuple[str, str]) -> Path:
    text = file.read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    file.write_text(text, encoding="utf-8")
    return file


def test_a_new_file_passes_as_it_is(run: Run, tmp_path: Path) -> None:
    folder = tmp_path / "course" / "exercises"
    made = run("exercises", "new", "elbow-arm", "--output", folder)
    assert made.exit_code == 0
    assert made.stdout == (
        f"{folder}/elbow-arm.toml is written. Edit it, then: "
        f"dh-grader exercises check {folder}/elbow-arm.toml\n"
    )
    result = run("exercises", "check", "--strict", folder)
    assert (result.exit_code, result.stderr) == (0, "")
    lazy = "Writing only zeros and joint variables earns 12 % of table, 7 % of pose."
    assert result.stdout == f"elbow-arm: ok, 2 parts, 4 checks. {lazy}\n"


def test_a_copy_of_an_exercise_is_graded_like_it(run: Run, tmp_path: Path) -> None:
    run("exercises", "new", "scara-2026", "--like", "scara", "--output", tmp_path)
    copy = tmp_path / "scara-2026.toml"
    assert copy.read_bytes() == (shipped_folder() / "scara.toml").read_bytes()
    assert run("exercises", "check", "--strict", copy).exit_code == 0
    unknown = run("exercises", "new", "scara-2027", "--like", "scra", "--output", tmp_path)
    assert (unknown.exit_code, "Known are: " in unknown.stderr) == (2, True)
    assert list(tmp_path.iterdir()) == [copy]


def test_new_does_not_overwrite_a_file(run: Run, arm: Path) -> None:
    arm.write_text("mine", encoding="utf-8")
    result = run("exercises", "new", "arm", "--output", arm.parent)
    assert result.exit_code == 2
    assert "arm.toml already exists" in result.stderr
    assert arm.read_text(encoding="utf-8") == "mine"


@pytest.mark.parametrize("exercise_id", ["../arm", "My arm", "arm.toml", "/tmp/arm"])
def test_an_invalid_id_is_refused(run: Run, tmp_path: Path, exercise_id: str) -> None:
    result = run("exercises", "new", exercise_id, "--output", tmp_path)
    assert result.exit_code == 2
    assert "cannot be an exercise's id: write small letters" in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_an_unwritable_folder_is_reported(run: Run, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    result = run("exercises", "new", "arm", "--output", tmp_path / "file")
    assert result.exit_code == 2
    assert "already exists" in result.stderr or "cannot be written" in result.stderr


def test_a_failed_check_gives_exit_code_1_and_its_line(run: Run, arm: Path) -> None:
    changed(arm, ("points = 2.25", "points = 3"))
    result = run("exercises", "check", arm)
    assert result.exit_code == 1
    first, second = result.stdout.splitlines()
    lazy = "Writing only zeros and joint variables earns 12 % of table, 7 % of pose."
    assert first == f"arm: failed, 2 parts, 4 checks. {lazy}"
    line = 1 + arm.read_text(encoding="utf-8").splitlines().index(
        'title = "The twist has the wrong sign"'
    )
    assert second.startswith(
        f"  failed: checks[2] (line {line - 1}): 'The twist has the wrong sign': table should get "
        f"3 points; it got partial, 2.25 of 4 points: "
    )


def test_a_warning_fails_only_with_strict(run: Run, arm: Path) -> None:
    changed(arm, ("range = [0.3, 0.9]", "range = [-0.3, 0.9]"))
    result = run("exercises", "check", arm)
    assert result.exit_code == 0
    assert "  warning: symbols.d1.range (line " in result.stdout
    assert run("exercises", "check", "--strict", arm).exit_code == 1


def test_an_unusable_file_gives_exit_code_2_and_the_others_are_checked(run: Run, arm: Path) -> None:
    run("exercises", "new", "broken", "--output", arm.parent)
    run("exercises", "new", "wrong", "--output", arm.parent)
    broken = changed(arm.parent / "broken.toml", ("[0.3, 0.9]", "[0.9, 0.3]"))
    changed(arm.parent / "wrong.toml", ("points = 2.25", "points = 3"))
    result = run("exercises", "check", arm.parent)
    assert result.exit_code == 2
    line = broken.read_text(encoding="utf-8").split("[0.9, 0.3]")[0].count("\n") + 1
    said = "must rise from low to high, not from 0.9 to 0.3"
    assert result.stderr == f"{broken}: symbols.d1.range (line {line}): {said}\n"
    assert "arm: ok" in result.stdout
    assert "wrong: failed" in result.stdout
    assert result.stdout.endswith("3 exercises: 1 ok, 1 failed, 1 cannot be used\n")


@pytest.mark.parametrize("place", ["nowhere.toml", "."])
def test_a_path_without_exercise_files_is_refused(run: Run, tmp_path: Path, place: str) -> None:
    result = run("exercises", "check", tmp_path / place)
    assert result.exit_code == 2
    assert "cannot be read" in result.stderr or "holds no exercise file" in result.stderr


def test_the_environment_may_name_several_folders(
    run: Run, arm: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DH_GRADER_EXERCISES_DIR", f"{arm.parent}{os.pathsep}shipped")
    listed = [line.split()[0] for line in run("exercises", "list").stdout.splitlines()]
    assert {"arm", "scara"} <= set(listed)


@pytest.mark.long
def test_in_a_pipe_lines_are_plain_and_not_wrapped(arm: Path) -> None:
    # The continuous integration of a course reads the output in a pipe.
    changed(arm, ("range = [0.3, 0.9]", "range = [-0.3, 0.9]"))
    result = subprocess.run(
        [sys.executable, "-m", "dh_grader", "exercises", "check", str(arm)],
        capture_output=True, text=True, check=False, env=os.environ | {"CI": "true"},
    )  # fmt: skip
    assert result.returncode == 0
    assert "\x1b" not in result.stdout
    assert len(result.stdout.splitlines()) == 2
