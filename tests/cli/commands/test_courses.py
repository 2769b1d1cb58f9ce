"""`dh-grader courses`: counts, refusals in words, and the note about links to this machine."""

from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from service.cli.program import program


def run(*words: str) -> Result:
    return CliRunner().invoke(program, ["courses", *words])


@pytest.fixture
def course(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """Return the id of a course, in a new database."""
    monkeypatch.setenv("DH_GRADER_DATABASE", str(tmp_path / "attempts.db"))
    monkeypatch.setenv("DH_GRADER_SECRET", "0123456789abcdef" * 2)
    assert run("new", "robots", "--title", "Robots", "--zone", "UTC").exit_code == 0
    return "robots"


def learners(course: str, file: Path, *names: str) -> str:
    """Import a class list; return what the command prints."""
    file.write_text("\n".join(["name,email", *(f"{n},{n}@example.edu" for n in names)]), "utf-8")
    return run("learners", "import", course, str(file)).stdout


def test_counts_have_the_right_number(course: str, tmp_path: Path) -> None:
    assert learners(course, tmp_path / "c.csv", "ada") == "1 learner, 1 of them new.\n"
    assert run("list").stdout.endswith("  1 learner, 0 assignments\n")
    assert run("links", course).exit_code == 0
    assert run("links", course, "--revoke").stdout.startswith("1 link ended. ")
    assert learners(course, tmp_path / "c.csv", "ada", "bo") == "2 learners, 1 of them new.\n"


def test_counts_and_questions_are_in_the_language(
    course: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DH_GRADER_LANGUAGE", "de")
    assert learners(course, tmp_path / "c.csv", "ada") == "1 Person, davon neu: 1.\n"
    assert run("list").stdout.endswith("  1 Person, 0 Übungsblätter\n")
    # Nobody answers the question.
    assert run("delete", course).stdout.startswith("Kurs robots endgültig löschen? Lernende: 1 [")
    assert run("delete", course, "--yes").stdout == "Kurs robots gelöscht: Lernende: 1.\n"
    monkeypatch.setenv("DH_GRADER_DATABASE", str(tmp_path / "none.db"))
    assert run("list").stderr.endswith("none.db: diese Datei gibt es nicht\n")


def test_links_without_an_address_say_that_they_are_local(course: str, tmp_path: Path) -> None:
    learners(course, tmp_path / "c.csv", "ada")
    local = run("links", course)
    assert "127.0.0.1" in local.stdout
    assert "127.0.0.1" in local.stderr
    assert "--address" in local.stderr
    assert run("links", course, "--address", "https://grader.example.edu").stderr == ""


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["HW 9", "--exercise", "scara=1"], ["The id has small letters, digits and hyphens"]),
        (["hw-9"], ["Choose at least one exercise."]),
        (["HW 9"], ["The id has small letters, digits", "Choose at least one exercise."]),
        (["hw-9", "--exercise", "scara=-1"], ["exercises.0.points: This must be greater than 0."]),
    ],
)
def test_a_wrong_assignment_is_refused_in_words(
    words: list[str], said: list[str], course: str
) -> None:
    refused = run("assignments", "add", course, *words)
    assert refused.exit_code == 2
    assert [part for part in said if part not in refused.stderr] == []
    assert "should match" not in refused.stderr
