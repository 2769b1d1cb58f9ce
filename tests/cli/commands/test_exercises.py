import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from dh_grader.authoring import exercise_template
from dh_grader.catalogue import shipped_folder
from typer.testing import Result

from tests.shipped import shipped_exercises

Run = Callable[..., Result]

BROKEN = """
title = "x"
source = "x"
statement = "x"
parts = [{ id = "pose", kind = "transform", title = "x" }]
[robot]
structure = "R"
convention = "standard"
joints = ["q1"]
table = [["0", "l9 +", "0", "q1"]]
"""


def test_the_list_has_a_line_for_each_exercise(run: Run) -> None:
    result = run("exercises", "list")
    assert result.exit_code == 0
    for exercise_id in shipped_exercises():
        assert [line for line in result.stdout.splitlines() if line.startswith(exercise_id)]
    assert max(map(len, result.stdout.splitlines())) <= 80


def test_the_list_keeps_titles_and_parts_with_points_on_one_line(run: Run) -> None:
    lines = run("exercises", "list").stdout.splitlines()
    assert lines[0].split() == ["id", "joints", "title,", "and", "parts", "(points)"]
    at = next(i for i, line in enumerate(lines) if line.startswith("planar-rr "))
    indent = lines[0].index("title,")
    assert [line[indent:] for line in lines[at : at + 3]] == [
        "Planar RR arm, standard, 20 min",
        "table (4), links (4), pose (4), position (2),",
        "task-space (3)",
    ]
    assert not [line for line in lines if line.strip().startswith("(")]


@pytest.mark.parametrize("columns", ["40", "200"])
def test_the_list_adapts_to_the_width_of_the_terminal(
    columns: str, run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", columns)
    text = run("exercises", "list").stdout
    one_line = "Planar RRR arm and its task space, standard, 25 min" in text
    assert one_line == (columns == "200")
    assert "(8)" in text


def test_show_prints_the_task_without_answers(run: Run) -> None:
    result = run("exercises", "show", "stanford-arm")
    assert result.exit_code == 0
    for expected in ("Stanford arm", "RRPRRR", "distance from the wrist centre", "table:", "pose:"):
        assert expected in result.stdout
    assert "Answer: a table with the rows 1, 2, 3, 4, 5, 6 and" in result.stdout
    assert "-90deg" not in result.stdout
    assert max(map(len, result.stdout.splitlines())) <= 80


def test_show_takes_a_path(run: Run, tmp_path: Path) -> None:
    file = tmp_path / "arm.toml"
    file.write_text(exercise_template("arm"), encoding="utf-8")
    assert run("exercises", "show", str(file), "--solution").stdout == SOLUTION
    absent = run("exercises", "show", str(tmp_path / "absent.toml"))
    assert absent.exit_code == 2
    assert "absent.toml" in absent.stderr


def test_show_solution_prints_answers_and_link_transforms(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "arm.toml").write_text(exercise_template("arm"), encoding="utf-8")
    monkeypatch.setenv("DH_GRADER_EXERCISES_DIR", str(tmp_path))
    result = run("exercises", "show", "arm", "--solution")
    assert result.exit_code == 0
    assert result.stdout == SOLUTION
    latex = run("exercises", "show", "arm", "--latex").stdout
    assert r"\begin{tabular}{c|cccc}" in latex
    assert "d_{2} s_{1}" in latex


SOLUTION = """\
table: Denavit-Hartenberg table (dh_table)
| i | a | alpha | d  | theta  |
| - | - | ----- | -- | ------ |
| 1 | 0 | 90deg | d1 | theta1 |
| 2 | 0 | 0     | d2 | 0      |

pose: Pose of the tool (transform)
[c1, 0, s1,  d2*s1;
 s1, 0, -c1, -d2*c1;
 0,  1, 0,   d1;
 0,  0, 0,   1]

Link transform A1
[c1, 0, s1,  0;
 s1, 0, -c1, 0;
 0,  1, 0,   d1;
 0,  0, 0,   1]

Link transform A2
[1, 0, 0, 0;
 0, 1, 0, 0;
 0, 0, 1, d2;
 0, 0, 0, 1]

Shorthand
c1 = cos(theta1)
s1 = sin(theta1)
"""


def test_show_solution_prints_the_pose_even_if_no_part_asks_for_it(run: Run) -> None:
    text = run("exercises", "show", "stanford-arm-drawn", "--solution").stdout
    assert "Pose of the tool in the base frame\n[c1*(c2*(c4*c5*c6" in text


def test_show_writes_the_figure(run: Run, tmp_path: Path) -> None:
    file = tmp_path / "arm.svg"
    assert run("exercises", "show", "scara", "--figure", file, "--theme", "dark").exit_code == 0
    plain = file.read_text(encoding="utf-8")
    assert plain.startswith("<svg ")
    # The names of the frames between base and tool have indices 1 to 3.
    assert ">{1}<" not in plain
    assert run("exercises", "show", "scara", "--figure", file, "--frames").exit_code == 0
    assert ">{1}<" in file.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("exercise", "more", "reason"),
    [
        ("dh-conditions", [], "has no robot to draw"),
        ("planar-rpr-poe", ["--frames"], "is given by screw axes"),
        ("scara", [], "cannot be written"),
    ],
)
def test_show_says_why_there_is_no_figure(
    run: Run, tmp_path: Path, exercise: str, more: list[str], reason: str
) -> None:
    file = tmp_path if exercise == "scara" else tmp_path / "arm.svg"
    result = run("exercises", "show", exercise, "--figure", file, *more)
    assert result.exit_code == 2
    assert reason in result.stderr.replace("\n", " ")


def test_show_suggests_the_nearest_exercise(run: Run) -> None:
    result = run("exercises", "show", "skara")
    assert result.exit_code == 2
    assert "Did you mean 'scara'?" in result.stderr


@pytest.mark.long
def test_check_accepts_a_file_a_folder_and_by_default_the_catalogue(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("scara.toml", "simple-twist.toml"):
        shutil.copy(shipped_folder() / name, tmp_path)
    one = run("exercises", "check", tmp_path / "scara.toml")
    assert (one.exit_code, one.stdout.split(":")[0]) == (0, "scara")
    lazy = "Writing only zeros and joint variables earns"
    assert re.fullmatch(rf"scara: ok, \d parts, \d checks\. {lazy} .*\n", one.stdout)
    monkeypatch.setenv("DH_GRADER_EXERCISES_DIR", str(tmp_path))
    folder = run("exercises", "check", tmp_path).stdout
    assert folder == run("exercises", "check").stdout
    assert folder.endswith("2 exercises: 2 ok\n")


@pytest.mark.parametrize("whole_folder", [True, False])
def test_check_names_file_field_and_reason(run: Run, tmp_path: Path, whole_folder: bool) -> None:
    file = tmp_path / "broken.toml"
    file.write_text(BROKEN, encoding="utf-8")
    result = run("exercises", "check", tmp_path if whole_folder else file)
    assert result.exit_code == 2
    assert f"{file}: robot.table[0].alpha (line 10): " in result.stderr
    assert result.stdout == ""


def test_a_broken_exercise_stops_every_command_that_needs_it(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "broken.toml").write_text(BROKEN, encoding="utf-8")
    monkeypatch.setenv("DH_GRADER_EXERCISES_DIR", str(tmp_path))
    for command in (["exercises", "list"], ["grade", "x.json", "--exercise", "broken"], ["serve"]):
        result = run(*command)
        assert result.exit_code == 2
        assert "broken.toml: robot.table[0].alpha" in result.stderr


def test_an_unusable_setting_stops_every_command(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DH_GRADER_PORT", "x")
    for command in (["exercises", "list"], ["serve"]):
        result = run(*command)
        assert result.exit_code == 2
        assert "DH_GRADER_PORT" in result.stderr
