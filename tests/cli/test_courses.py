"""Test the commands of courses and assignments."""

import json
from pathlib import Path

import pytest
from dh_grader.cli import program
from typer.testing import CliRunner, Result

from tests.cli.conftest import Run

# --- Test `dh-grader courses`: counts, error messages and links


def run(*words: str) -> Result:
    return CliRunner().invoke(program, ["courses", *words])


@pytest.fixture
def course(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """Create a course in a new database, and return its id."""
    monkeypatch.setenv("DH_GRADER_DATABASE", str(tmp_path / "attempts.db"))
    monkeypatch.setenv("DH_GRADER_SECRET", "0123456789abcdef" * 2)
    assert run("new", "robots", "--title", "Robots", "--zone", "UTC").exit_code == 0
    return "robots"


def learners(course: str, file: Path, *names: str) -> str:
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
    question = "Kurs robots endgültig löschen? Studierende: 1 ["
    assert run("delete", course).stdout.startswith(question)
    assert run("delete", course, "--yes").stdout == "Kurs robots gelöscht: Studierende: 1.\n"
    monkeypatch.setenv("DH_GRADER_DATABASE", str(tmp_path / "none.db"))
    assert run("list").stderr.endswith("none.db: diese Datei gibt es nicht\n")


def test_links_without_an_address_say_that_they_are_local(
    course: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    learners(course, tmp_path / "c.csv", "ada")
    local = run("links", course)
    assert "127.0.0.1" in local.stdout
    assert "127.0.0.1" in local.stderr
    assert "--address" in local.stderr
    assert run("links", course, "--address", "https://grader.example.edu").stderr == ""
    monkeypatch.setenv("DH_GRADER_PUBLIC_URL", "https://grader.example.edu/robotics/")
    public = run("links", course)
    assert "https://grader.example.edu/robotics/learn#dhg_" in public.stdout
    assert public.stderr == ""


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


def test_an_assignment_is_shown_in_the_language(
    course: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    options = {"exercise": "scara=10", "limit": "3", "due": "2030-10-15 23:59"}
    options |= {"hint-prices": "0,0.05,0.1"}
    words = [word for name, value in options.items() for word in (f"--{name}", value)]
    shown = run("assignments", "add", course, "hw-1", "--variants", *words)
    assert shown.stdout.splitlines() == [
        "hw-1: hw-1, 10 points",
        "  scara, 10 points",
        "  due 2030-10-15 23:59 UTC",
        "  attempts at most 3; no late attempts",
        "  feedback that of each exercise",
        "  practice none; solution never",
        "  the steps of a hint cost 0%, 5%, 10% of the points",
        "  each learner has variants of their own",
        "  but not in scara: no variants there",
    ]
    monkeypatch.setenv("DH_GRADER_LANGUAGE", "de")
    assert run("assignments", "list", course).stdout.splitlines() == [
        "hw-1: hw-1, 10 Punkte",
        "  scara, 10 Punkte",
        "  fällig 2030-10-15 23:59 UTC",
        "  höchstens 3 Versuche; keine verspäteten Versuche",
        "  Rückmeldung: die jeder Aufgabe",
        "  Üben: none; Lösung: never",
        "  die Schritte eines Tipps kosten 0%, 5%, 10% der Punkte",
        "  jede Person hat eigene Varianten",
        "  aber nicht bei scara: dort gibt es keine Varianten",
    ]
    wrong = run("assignments", "add", course, "hw-2", "--exercise", "scara=-1").stderr
    assert wrong == "exercises.0.points: Der Wert muss größer als 0 sein.\n"


def test_dates_without_a_time_are_whole_days(course: str) -> None:
    dates = ("--opens", "2026-12-01", "--due", "2026-12-08", "--closes", "2026-12-09")
    added = run("assignments", "add", course, "hw", "--exercise", "scara=20", *dates)
    assert "opens 2026-12-01 00:00 UTC" in added.stdout, added.stderr
    assert "due 2026-12-08 23:59 UTC" in added.stdout
    assert "closes 2026-12-09 23:59 UTC" in added.stdout
    for option in ("--opens", "--due", "--closes"):
        wrong = run("assignments", "change", course, "hw", option, "20261201")
        assert wrong.exit_code == 2
        assert wrong.stderr.startswith(f"{option[2:]}: This must be a date, such as 2026-12-01")


def test_an_extension_is_told_with_the_dates_that_hold(course: str, tmp_path: Path) -> None:
    (tmp_path / "c.csv").write_text("id,name\nu1,Ada\nu2,Bo\n", "utf-8")
    assert run("learners", "import", course, str(tmp_path / "c.csv")).exit_code == 0
    dates = ("--due", "2026-12-08", "--closes", "2026-12-09")
    run("assignments", "add", course, "hw", "--exercise", "scara=20", *dates)
    # The due date moves the closing date, too.
    later = run("assignments", "extend", course, "hw", "u1", "--due", "2026-12-20")
    assert "u1: due 2026-12-20 23:59 UTC; closes 2026-12-20 23:59 UTC" in later.stdout
    more = run("assignments", "extend", course, "hw", "u2", "--limit", "3")
    assert "u2: due 2026-12-08 23:59 UTC; closes 2026-12-09 23:59 UTC; at most 3" in more.stdout
    run("assignments", "extend", course, "hw", "u1", "--closes", "2026-12-20")
    none = run("assignments", "change", course, "hw", "--due", "none", "--closes", "none")
    assert "u1" not in none.stdout


def test_the_learners_of_a_course_are_listed(course: str, tmp_path: Path) -> None:
    (tmp_path / "c.csv").write_text("id,name,email\nu1,Ada,a@x.org\nu2,Bo,\n", "utf-8")
    assert run("learners", "list", course).stdout == ""
    assert run("learners", "import", course, str(tmp_path / "c.csv")).exit_code == 0
    lines = ["u1  Ada  a@x.org  no link", "u2  Bo  no link"]
    assert run("learners", "list", course).stdout.splitlines() == lines
    unknown = run("learners", "list", "robotic")
    assert unknown.exit_code == 2
    assert "robotic" in unknown.stderr


# --- Test `dh-grader grade --assignment` and `dh-grader assignments check`

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
