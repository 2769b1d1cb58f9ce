"""Create an assignment from a file or options, or refuse it with a reason."""

from pathlib import Path

import pytest
from dh_grader.catalogue import shipped_folder
from dh_grader.cli import program
from typer.testing import CliRunner

from tests.courses.conftest import Class

FILE = """
title = "Homework 5"
feedback = "verdicts"

[[exercises]]
id = "scara"
points = 30
"""
OWN = '[[exercises]]\npath = "{path}"\n'


@pytest.mark.sampled(2)
@pytest.mark.parametrize(
    ("more", "said"),
    [
        ("", ""),
        ('[[exercises]]\nid = "planar-rr"\nparts = ["table"]\n', "planar-rr: an assignment of a"),
        (OWN, "planar-rrr: an assignment of a course has whole exercises"),
        ('[[exercises]]\nid = "no-such"\n', "no-such"),
    ],
)
def test_an_assignment_file_is_taken_whole_or_refused(
    class_: Class, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, more: str, said: str
) -> None:
    monkeypatch.setenv("DH_GRADER_DATABASE", str(class_.store.engine.url.database))
    own = tmp_path / "planar-rrr.toml"
    shipped = Path(__file__).parents[2] / "exercises/planar-rrr.toml"
    own.write_bytes(shipped.read_bytes())
    file = tmp_path / "homework.toml"
    file.write_text(FILE + more.format(path=own.name), encoding="utf-8")
    words = ["courses", "assignments", "add", "robots", "homework-5", "--file", str(file)]
    told = CliRunner().invoke(program, words)
    assert told.exit_code == (2 if said else 0), told.output
    assert said in " ".join(told.output.split())
    if not said:
        assert "homework-5: Homework 5, 30 points" in told.output
        assert "feedback verdicts" in told.output
    listed = CliRunner().invoke(program, ["courses", "assignments", "list", "robots"]).output
    assert ("homework-5" in listed) is (said == "")


@pytest.mark.long
def test_an_assignment_file_may_set_variants(
    class_: Class, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DH_GRADER_DATABASE", str(class_.store.engine.url.database))
    file = tmp_path / "homework.toml"
    varied = '[[exercises]]\nid = "planar-rr-numbers"\n'
    file.write_text(f'title = "Numbers"\nvariants = true\n{varied}', encoding="utf-8")
    add = ["courses", "assignments", "add", "robots"]
    done = CliRunner().invoke(program, [*add, "one", "--file", str(file)])
    assert "each learner has variants of their own" in done.output
    done = CliRunner().invoke(program, [*add, "two", "--file", str(file), "--no-variants"])
    assert "Numbers" in done.output
    assert "variants" not in done.output
    checked = CliRunner().invoke(program, ["assignments", "check", str(file)])
    assert "each learner has variants of their own" in checked.output


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (
            ["--exercise", "scara=10", "--due", "15.10.2026"],
            "This must be a date, such as 2026-12-01",
        ),
        (["--exercise", "skara=10"], "There is no exercise skara. Did you mean scara?"),
    ],
)
def test_a_mistyped_assignment_is_refused_with_advice(
    class_: Class, monkeypatch: pytest.MonkeyPatch, options: list[str], said: str
) -> None:
    monkeypatch.setenv("DH_GRADER_DATABASE", str(class_.store.engine.url.database))
    words = ["courses", "assignments", "add", "robots", "hw", "--title", "Homework", *options]
    told = CliRunner().invoke(program, words)
    assert told.exit_code == 2
    assert said in " ".join(told.output.split())


@pytest.mark.long
def test_the_command_says_when_a_service_reads_a_new_file(
    class_: Class, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("DH_GRADER_DATABASE", str(class_.store.engine.url.database))
    folder = tmp_path / "own"
    folder.mkdir()
    text = (shipped_folder() / "planar-rr.toml").read_text(encoding="utf-8")
    (folder / "brand-new.toml").write_text(text, encoding="utf-8")
    monkeypatch.setenv("DH_GRADER_EXERCISES_DIR", f"{folder}:shipped")
    add = ["courses", "assignments", "add", "robots"]
    said = CliRunner().invoke(program, [*add, "one", "--exercise", "brand-new=3"]).output
    assert "brand-new: if the file is new, restart the service." in said
    assert "restart" not in CliRunner().invoke(program, [*add, "two", "--exercise", "scara"]).output
    monkeypatch.setenv("DH_GRADER_RELOAD_EXERCISES", "true")
    said = CliRunner().invoke(program, [*add, "three", "--exercise", "brand-new=3"]).output
    assert "restart" not in said


@pytest.mark.long
def test_the_command_says_which_rules_have_no_effect(
    class_: Class, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DH_GRADER_DATABASE", str(class_.store.engine.url.database))
    add = ["courses", "assignments", "add", "robots", "hw", "--exercise", "scara", "--variants"]
    said = CliRunner().invoke(program, [*add, "--due", "2026-10-15 23:59"]).output
    assert "no late attempts" in said
    assert "but not in scara: no variants there" in said
    change = ["courses", "assignments", "change", "robots", "hw"]
    said = CliRunner().invoke(program, [*change, "--closes", "2026-10-17 23:59"]).output
    assert "late attempts earn 50%" in said
    said = CliRunner().invoke(program, [*change, "--closes", "none", "--due", "none"]).output
    assert "no due date" in said
