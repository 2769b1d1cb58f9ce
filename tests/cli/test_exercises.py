"""Test the commands of exercises."""

import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest
from dh_grader.authoring import exercise_template
from dh_grader.catalogue import shipped_folder
from dh_grader.variants import built
from typer.testing import Result

from tests.importing.urdf_texts import Part, urdf
from tests.shipped import shipped_exercises
from tests.variants.varied_files import shipped, varied_text

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


# --- Test `dh-grader exercises new` and `check`


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


# --- Import robot

ELBOW = [
    Part("revolute", [0, 0, 0.3], [0, 0, 0]),
    Part("revolute", [0, 0, 0.1], [1.5708, 0, 0]),
    Part("revolute", [0.4, 0, 0], [0, 0, 0]),
    Part("fixed", [0.3, 0, 0], [0, 0, 0]),
]


@pytest.fixture
def file(tmp_path: Path) -> Path:
    made = tmp_path / "elbow.urdf"
    made.write_bytes(urdf(ELBOW, 4))
    return made


def test_a_urdf_becomes_a_checked_exercise(run: Run, file: Path, tmp_path: Path) -> None:
    made = run("exercises", "import", file, "--letters", "--output", tmp_path)
    assert made.exit_code == 0
    # 90° were written as 1.5708: 3.7e-6 rad too much, 0.7 m from the tool.
    assert "Largest difference to the URDF at 100 poses: 0.002" in made.stdout
    assert run("exercises", "check", tmp_path / "elbow.toml").exit_code == 0


@pytest.mark.long
def test_the_files_of_both_conventions_pass(run: Run, file: Path, tmp_path: Path) -> None:
    for convention in ("standard", "modified"):
        made = run("exercises", "import", file, "--id", convention, "--convention", convention,
                   "--output", tmp_path)  # fmt: skip
        assert made.exit_code == 0
        assert run("exercises", "check", tmp_path / f"{convention}.toml").exit_code == 0


def test_a_file_that_exists_is_not_changed(run: Run, file: Path, tmp_path: Path) -> None:
    (tmp_path / "elbow.toml").write_text("mine", encoding="utf-8")
    made = run("exercises", "import", file, "--output", tmp_path)
    assert (made.exit_code, (tmp_path / "elbow.toml").read_text()) == (2, "mine")
    assert "already exists" in made.stderr


def test_several_ends_ask_for_the_tool(run: Run, file: Path) -> None:
    text = file.read_text().replace("</robot>", '<link name="camera"/></robot>')
    file.write_text(text)
    made = run("exercises", "import", file)
    assert made.exit_code == 2
    assert "name the tool's link; the tree ends at: l4, camera. Use --tip LINK." in made.stderr


def test_a_table_that_differs_too_much_is_refused(run: Run, file: Path) -> None:
    # The twist is rounded to 1.57 (0.0008 rad), and the arm is 9 m long.
    file.write_bytes(urdf([*ELBOW[:2], Part("fixed", [9, 0, 0], [0, 0, 0])], 2))
    made = run("exercises", "import", file)
    assert made.exit_code == 2
    assert "1 mm is allowed" in made.stderr


def test_an_unusable_file_is_named(run: Run, tmp_path: Path) -> None:
    assert "cannot be read" in run("exercises", "import", tmp_path / "no.urdf").stderr
    empty = tmp_path / "empty.urdf"
    empty.touch()
    assert "empty" in run("exercises", "import", empty).stderr
    assert "cannot be an exercise's id" in run("exercises", "import", empty, "--id", "../x").stderr


def test_a_device_is_no_file_to_import(run: Run) -> None:
    made = run("exercises", "import", "/dev/zero")
    assert (made.exit_code, "cannot be read" in made.stderr) == (2, True)


def test_an_exported_robot_can_be_imported_again(run: Run, tmp_path: Path) -> None:
    exported = run("exercises", "export", "stanford-arm")
    assert exported.exit_code == 0
    file = tmp_path / "stanford.urdf"
    file.write_text(exported.stdout, encoding="utf-8")
    made = run("exercises", "import", file, "--output", tmp_path)
    assert made.exit_code == 0
    assert 'structure = "RRPRRR"' in (tmp_path / "stanford.toml").read_text()


def test_a_robot_without_a_table_is_not_exported(run: Run) -> None:
    made = run("exercises", "export", "planar-rpr-poe")
    assert made.exit_code == 2
    assert "no robot with a DH table" in made.stderr


OPEN = "131.2 | 90 | 0 | q1\n100 | 0 | 0 | q2 - 90\n"


def test_what_a_table_leaves_open_is_asked_by_its_options(run: Run, tmp_path: Path) -> None:
    table = tmp_path / "arm.txt"
    table.write_text(OPEN, encoding="utf-8")
    command = ["exercises", "import", table, "--table", "--output", tmp_path / "made"]
    made = run(*command)
    assert made.exit_code == 2
    assert 'What is their order? Use one of these options: --order "a alpha' in made.stderr
    command += ["--order", "a alpha d theta"]
    made = run(*command)
    assert made.exit_code == 2
    assert "In which unit is the number 131.2 in row 1, column a?" in made.stderr
    assert "--unit m, --unit cm, --unit mm" in made.stderr
    assert "in degrees or in radians? Use one of these options: --degrees" in made.stderr
    assert not (tmp_path / "made").exists()
    made = run(*command, "--unit", "mm", "--degrees")
    assert made.exit_code == 0
    assert "The numbers of column a are in mm." in made.stdout
    text = (tmp_path / "made" / "arm.toml").read_text("utf-8")
    assert '["0.1312", "90deg", "0", "theta1"]' in text
    assert '["0.1",    "0",     "0", "theta2 - 90deg"]' in text
    assert "# The numbers of column a are in mm." in text
    assert "the unit furlong is not known" in run(*command, "--unit", "furlong").stderr


def test_a_terminal_is_asked(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    table = tmp_path / "arm.txt"
    table.write_text(OPEN, encoding="utf-8")
    answers = iter(["a alpha d theta", "mm", "degrees"])
    monkeypatch.setattr("dh_grader.cli.exercises.is_terminal", lambda: True)
    monkeypatch.setattr("typer.prompt", lambda *_, **__: next(answers))
    made = run("exercises", "import", table, "--table", "--output", tmp_path)
    assert made.exit_code == 0
    assert '["0.1312", "90deg", "0", "theta1"]' in (tmp_path / "arm.toml").read_text("utf-8")


def test_each_snap_is_listed_on_the_screen_and_in_the_file(run: Run, tmp_path: Path) -> None:
    table = tmp_path / "arm.txt"
    table.write_text("a | alpha | d | theta\nh | 1.5708 | 0 | q1\nh | 0 | 0 | q2 - 1.57\n")
    made = run("exercises", "import", table, "--table", "--output", tmp_path)
    text = (tmp_path / "arm.toml").read_text("utf-8")
    for snap in (
        "row 1, column alpha: 1.5708 became 90deg.",
        "row 2, column theta: -1.57 became -90deg.",
    ):
        assert snap in made.stdout
        assert f"# {snap}" in text


def test_each_snap_of_a_urdf_is_listed(run: Run, file: Path, tmp_path: Path) -> None:
    made = run("exercises", "import", file, "--output", tmp_path)
    snap = "joint 'j1', rpy: 1.5708 became 90deg."
    assert snap in made.stdout
    assert f"# {snap}" in (tmp_path / "elbow.toml").read_text("utf-8")


def test_letters_for_tenths_of_a_millimetre_pass_the_check(run: Run, tmp_path: Path) -> None:
    made = tmp_path / "short.urdf"
    parts = [ELBOW[0], Part("revolute", [0.0001, 0, 0.1], [1.5708, 0, 0]), *ELBOW[2:]]
    made.write_bytes(urdf(parts, 4))
    assert run("exercises", "import", made, "--letters", "--output", tmp_path).exit_code == 0
    checked = run("exercises", "check", tmp_path / "short.toml")
    assert checked.exit_code == 0, checked.output


# --- Test the commands for variants of an exercise


@pytest.fixture
def varied_arm(tmp_path: Path) -> Path:
    file = tmp_path / "arm.toml"
    file.write_text(varied_text(), encoding="utf-8")
    return file


def test_check_counts_seeds_and_what_differs(run: Run, varied_arm: Path) -> None:
    checked = run("exercises", "check", varied_arm, "--seeds", 4)
    assert checked.exit_code == 0, checked.output
    assert re.search(r"arm: 4 seeds, [1-4] different", checked.stdout)
    assert re.search(r"lengths +2 +2 +2 \(4 of 4\)", checked.stdout)


def test_what_differs_is_in_the_language(
    run: Run, varied_arm: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DH_GRADER_LANGUAGE", "de")
    checked = run("exercises", "check", varied_arm, "--seeds", 4)
    assert re.search(r"arm: 4 Seeds, [1-4] verschiedene", checked.stdout)
    assert re.search(r"kleinster Wert +größter Wert +häufigster Wert", checked.stdout)
    assert re.search(r"Längen +2 +2 +2 \(4 von 4\)", checked.stdout)


@pytest.mark.long
def test_check_names_a_variant_in_which_a_check_fails(run: Run, varied_arm: Path) -> None:
    # Right for the first choice of a1 only.
    text = varied_arm.read_text(encoding="utf-8")
    check = (
        '[[checks]]\ntitle = "T"\nkind = "right"\n'
        'answers.table = "0.3 {{j2.sign}}90deg 0 theta1\\n{{a2}} 0 0 theta2"\n'
    )
    varied_arm.write_text(text + check, encoding="utf-8")
    checked = run("exercises", "check", varied_arm, "--seeds", 8)
    assert checked.exit_code == 1
    named = re.search(
        r"failed: (\d) variants, such as arm~(\d): checks\[0\]: 'T': table", checked.stdout
    )
    assert named, checked.stdout


@pytest.mark.long
def test_deploy_writes_the_seeds_and_draws_the_variants(
    run: Run, varied_arm: Path, tmp_path: Path
) -> None:
    deployed = run(
        "exercises", "deploy", varied_arm, "--count", 3, "--figures", tmp_path / "pictures"
    )
    assert deployed.exit_code == 0, deployed.output
    seeds = tomllib.loads(varied_arm.read_text(encoding="utf-8"))["vary"]["deployed"]
    assert len(seeds) == 3
    pictures = sorted(file.name for file in (tmp_path / "pictures").iterdir())
    assert pictures == sorted(f"arm~{seed}.svg" for seed in seeds)
    again = run("exercises", "deploy", varied_arm, "--count", 3, "--without", seeds[0], "--print")
    assert f"arm~{seeds[1]}" in again.stdout
    assert f"arm~{seeds[0]}" not in again.stdout
    assert tomllib.loads(varied_arm.read_text(encoding="utf-8"))["vary"]["deployed"] == seeds


@pytest.mark.long
def test_deploy_says_if_there_are_too_few_variants(run: Run, varied_arm: Path) -> None:
    varied_arm.write_text(varied_text(), encoding="utf-8")
    refused = run("exercises", "deploy", varied_arm, "--count", 40)
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
