from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import Result

from tests.importing.urdf_texts import Part, urdf

Run = Callable[..., Result]

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
