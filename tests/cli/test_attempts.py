import json
import sqlite3
from collections.abc import Mapping
from contextlib import closing
from pathlib import Path

import pytest
from dh_grader.catalogue import Exercise, shipped_folder
from dh_grader.store.attempt_store import AttemptStore

from tests.cli.conftest import Run
from tests.store.recorded import NO_TWIST, RIGHT, files_with, new_attempt, reader, recorded_all
from tests.store.test_migrations import MIGRATIONS, make_old


@pytest.fixture
def course(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, catalogue: Mapping[str, Exercise]
) -> list[str]:
    file = tmp_path / "attempts.db"
    monkeypatch.setenv("DH_GRADER_DATABASE", str(file))
    store = AttemptStore.open(str(file))
    scara = catalogue["scara"]
    written = recorded_all(
        store,
        [
            new_attempt(scara, "ada", RIGHT),
            new_attempt(scara, "ada", NO_TWIST, 2, hours=1),
            new_attempt(scara, "grace", NO_TWIST, hours=2, is_late=True),
        ],
    )
    store.close()
    return [each.id for each in written]


def test_without_a_database_the_commands_say_so(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("DH_GRADER_DATABASE", raising=False)
    result = run("attempts", "list")
    assert (result.exit_code, "DH_GRADER_DATABASE" in result.output) == (2, True)


@pytest.mark.parametrize("unset", ["", "  "])
def test_an_empty_database_setting_means_no_database(
    run: Run, monkeypatch: pytest.MonkeyPatch, unset: str
) -> None:
    monkeypatch.setenv("DH_GRADER_DATABASE", unset)
    result = run("attempts", "list")
    assert (result.exit_code, "names no database" in result.output) == (2, True)


def test_migrate_creates_the_tables(
    run: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("DH_GRADER_DATABASE", str(tmp_path / "new.db"))
    for _ in range(2):
        assert run("attempts", "migrate").exit_code == 0
    assert run("attempts", "list").stdout.strip() == "No attempts are recorded."


def test_migrate_says_from_what_to_what(
    run: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    file = str(tmp_path / "old.db")
    monkeypatch.setenv("DH_GRADER_DATABASE", file)
    newest = max(path.name[:4] for path in (MIGRATIONS / "versions").glob("0*.py"))
    make_old(file, "0009")
    assert run("attempts", "migrate").output == f"The tables were migrated from 0009 to {newest}.\n"
    assert newest in run("attempts", "migrate").output
    monkeypatch.setenv("DH_GRADER_DATABASE", str(tmp_path / "new.db"))
    assert run("attempts", "migrate").output == f"The tables were created: {newest}.\n"


# One command of each group that works on the database, and those that only read in full.
COMMANDS = (
    ("attempts", "list"),
    ("attempts", "statistics", "scara"),
    ("attempts", "export"),
    ("attempts", "regrade", "scara"),
    ("attempts", "regrade", "scara", "--apply"),
    ("attempts", "override", "0" * 32, "1", "--reason", "r"),
    ("attempts", "expire", "--months", "1"),
    ("attempts", "forget", "ada", "--yes"),
    ("learners", "export", "ada"),
    ("courses", "list"),
    ("courses", "new", "robots", "--title", "Robots", "--zone", "UTC"),
    ("courses", "gradebook", "robots"),
    ("keys", "list"),
    ("keys", "create", "Ada", "--scope", "tutor"),
    ("lti", "list"),
    ("lti", "invite", "Moodle", "--address", "https://grader.example.edu"),
)


@pytest.mark.parametrize("revision", ["0010", "9999"])
def test_no_command_but_migrate_changes_tables_of_another_version(
    run: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, revision: str
) -> None:
    file = tmp_path / "other.db"
    monkeypatch.setenv("DH_GRADER_DATABASE", str(file))
    monkeypatch.setenv("DH_GRADER_SECRET", "0123456789abcdef" * 4)
    make_old(str(file), "0010")
    file.chmod(0o600)
    with closing(sqlite3.connect(file)) as connection:
        connection.execute("PRAGMA journal_mode = WAL")
        connection.execute("UPDATE alembic_version SET version_num = ?", (revision,))
        connection.commit()
    before = file.read_bytes()
    for arguments in COMMANDS:
        result = run(*arguments)
        assert (result.exit_code, revision in result.output) == (2, True), (
            arguments,
            result.output,
        )
        advice = "dh-grader attempts migrate" if revision == "0010" else "newer version"
        assert advice in " ".join(result.output.split()), result.output
        assert file.read_bytes() == before, arguments
    doctor = " ".join(run("doctor").output.split())
    assert ("those of a newer version" in doctor) is (revision == "9999")
    # Before an update, a new program makes a backup of the old tables.
    copy = tmp_path / "copy.db"
    assert run("backup", copy).exit_code == 0
    with closing(sqlite3.connect(copy)) as connection:
        found = connection.execute("SELECT version_num FROM alembic_version").fetchall()
    assert found == [(revision,)]
    restored = run("restore", copy, "--replace")
    assert restored.exit_code == (0 if revision == "0010" else 2), restored.output
    assert file.read_bytes()[100:] == before[100:] or revision == "0010"
    migrated = run("attempts", "migrate")
    assert migrated.exit_code == (0 if revision == "0010" else 2), migrated.output


def test_no_other_command_creates_a_database(
    run: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    file = tmp_path / "missing.db"
    monkeypatch.setenv("DH_GRADER_DATABASE", str(file))
    for arguments in (
        ("attempts", "list"),
        ("attempts", "statistics", "scara"),
        ("attempts", "export"),
        ("attempts", "regrade", "scara"),
        ("attempts", "override", "0" * 32, "1", "--reason", "r"),
        ("attempts", "forget", "ada", "--yes"),
        ("keys", "list"),
        ("keys", "revoke", "0"),
    ):
        result = run(*arguments)
        assert (result.exit_code, result.output.count("\n")) == (2, 1), arguments
        assert "there is no such file" in result.output
    assert not file.exists()


@pytest.mark.parametrize(
    "arguments",
    [
        ("list", "--learner", "\udcff"),
        ("list", "--exercise", "\udcff"),
        ("statistics", "\udcff"),
        ("forget", "\udcff", "--yes"),
        ("override", "0" * 32, "1", "--reason", "\udcff"),
        ("list", "--limit", "99999999999999999999"),
    ],
)
def test_values_that_no_database_can_store_are_refused(
    run: Run, course: list[str], arguments: tuple[str, ...]
) -> None:
    result = run("attempts", *arguments)
    assert (result.exit_code, type(result.exception)) == (2, SystemExit)


def test_the_newest_attempts_are_listed(run: Run, course: list[str]) -> None:
    lines = run("attempts", "list", "--limit", 2).output.splitlines()
    assert [line.split()[0] for line in lines[:2]] == [course[2], course[1]]
    assert lines[0].rstrip().endswith("late")
    assert "--limit 4" in lines[2]
    told = run("attempts", "statistics", "scara").output
    assert "3 attempts of 2 learners" in told
    assert "     2 half_turn (table)" in told
    assert "links: nobody answered" in told


def test_shares_are_rounded(
    run: Run, course: list[str], tmp_path: Path, catalogue: Mapping[str, Exercise]
) -> None:
    store = AttemptStore.open(str(tmp_path / "attempts.db"))
    recorded_all(store, [new_attempt(catalogue["scara"], each, RIGHT) for each in "bcd"])
    store.close()
    # Four of six tables are right, and so are their twists.
    told = run("attempts", "statistics", "scara").output
    assert "table: 67 % right of 6" in told
    assert "alpha 67 %" in told


@pytest.mark.long
def test_gradebooks_contain_only_the_attempt_that_counts(
    run: Run, course: list[str], tmp_path: Path
) -> None:
    lines = [
        json.loads(line)
        for line in run("attempts", "export", "--format", "jsonl").output.splitlines()
    ]
    assert [(each["attempt"], each["counts"]) for each in lines] == [
        (course[0], True),
        (course[1], False),
        (course[2], True),
    ]
    best, wrong = lines[0]["points"], lines[1]["points"]
    assert best > wrong
    file = tmp_path / "grades.csv"
    assert (
        run(
            "attempts", "export", "--exercise", "scara", "--format", "canvas", "--output", file
        ).exit_code
        == 0
    )
    assert file.read_text(encoding="utf-8").splitlines() == [
        "Student,ID,SIS User ID,SIS Login ID,Section,scara",
        "    Points Possible,,,,,24",
        f"ada,,,ada,,{best:g}",
        f"grace,,,grace,,{wrong:.6f}".rstrip("0"),
    ]
    moodle = run("attempts", "export", "--exercise", "scara", "--format", "moodle").output
    assert moodle.splitlines()[1:] == [
        f"ada,{best:g},24,",
        f"grace,{wrong:.6f}".rstrip("0") + ",24,late",
    ]
    assert run("attempts", "export", "--format", "moodle").exit_code == 2
    assert run("attempts", "export").output.count("\n") == 4


@pytest.fixture
def corrected(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = (shipped_folder() / "scara.toml").read_text(encoding="utf-8")
    text = text.replace('kind = "dh_table"\n', 'kind = "dh_table"\nmarking = "rows"\n', 1)
    text = text.partition("[[checks]]")[0]  # they give the points of the other rule
    folder = tmp_path / "exercises"
    folder.mkdir()
    (folder / "scara.toml").write_text(text + '\n[attempts]\ncounts = "last"\n', encoding="utf-8")
    monkeypatch.setenv("DH_GRADER_EXERCISES_DIR", str(folder))


@pytest.mark.long
@pytest.mark.usefixtures("corrected")
def test_a_regrade_is_previewed_before_it_is_applied(
    run: Run, course: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    before = run("attempts", "export").output
    tried = run("attempts", "regrade", "scara").output
    assert "3 attempts were graded by another version; 2 would change." in tried
    assert "grace, attempt 1:" in tried
    assert "table partial, other points" in tried
    assert run("attempts", "export").output == before
    run("attempts", "override", course[2], "7.5", "--reason", "r")
    tried = " ".join(run("attempts", "regrade", "scara").output.split())
    assert "table partial, other points; a tutor's 7.5 stays)" in tried
    assert "2 would change, of which 1 would keep the points of a tutor." in tried
    monkeypatch.setenv("DH_GRADER_LANGUAGE", "es")
    spanish = " ".join(run("attempts", "regrade", "scara").output.split())
    assert "grace, intento 1: " in spanish
    assert "; se queda 7.5 de un docente)" in spanish
    assert "3 intentos se calificaron con otra versión; cambiarían 2, y de esos 1" in spanish
    assert "Aún no se ha guardado nada: añade --apply para guardar." in spanish
    monkeypatch.delenv("DH_GRADER_LANGUAGE")
    assert "Regraded: 3." in run("attempts", "regrade", "scara", "--apply").output
    assert "0 attempts were graded by another" in run("attempts", "regrade", "scara").output
    lines = [
        json.loads(line)
        for line in run("attempts", "export", "--format", "jsonl").output.splitlines()
    ]
    assert [each["counts"] for each in lines] == [False, True, True]
    assert run("attempts", "regrade", "scara", "--apply", "--jobs", "2").exit_code == 2


@pytest.mark.long
def test_an_exercise_that_fails_its_check_is_regraded_only_with_force(
    run: Run, course: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = (shipped_folder() / "scara.toml").read_text(encoding="utf-8")
    folder = tmp_path / "exercises"
    folder.mkdir()
    # Its checks still say what was right before.
    wrong = text.replace('["a2", "180deg",', '["a2", "0",')
    (folder / "scara.toml").write_text(wrong, encoding="utf-8")
    monkeypatch.setenv("DH_GRADER_EXERCISES_DIR", str(folder))
    preview = run("attempts", "regrade", "scara")
    assert "scara fails its check:" in preview.output
    assert preview.exit_code == 0
    refused = run("attempts", "regrade", "scara", "--apply")
    assert refused.exit_code == 2
    assert "--force" in refused.output
    assert "Regraded: 3." in run("attempts", "regrade", "scara", "--apply", "--force").output


@pytest.mark.long
def test_an_override_requires_a_reason(run: Run, course: list[str]) -> None:
    assert run("attempts", "override", course[2], "20").exit_code == 2
    assert run("attempts", "override", "0" * 32, "20", "--reason", "r").exit_code == 2
    assert run("attempts", "override", course[2], "99", "--reason", "r").exit_code == 2
    assert (
        run("attempts", "override", course[2], "20", "--reason", "r", "--by", "me").exit_code == 0
    )
    moodle = ("attempts", "export", "--exercise", "scara", "--format", "moodle")
    assert "grace,20,24,late" in run(*moodle).output
    assert run("attempts", "override", course[2], "--reason", "no", "--by", "me").exit_code == 0
    assert "grace,20" not in run(*moodle).output


def test_no_file_contains_a_forgotten_learner(run: Run, course: list[str], tmp_path: Path) -> None:
    assert run("attempts", "forget", "grace", "--yes").output.startswith("Deleted: attempts: 1,")
    assert run("attempts", "forget", "grace", "--yes").exit_code == 2
    assert run("attempts", "forget", "ada").exit_code == 1  # nobody confirms
    for file in tmp_path.glob("attempts.db*"):
        assert b"grace" not in file.read_bytes()
    assert "ada" in run("attempts", "export").output


@pytest.mark.long
def test_forget_reports_data_that_is_still_in_a_file(
    run: Run, course: list[str], tmp_path: Path
) -> None:
    [path] = map(str, tmp_path.glob("attempts.db"))
    with reader(path):
        told = run("attempts", "forget", "grace", "--yes")
        assert told.exit_code == 0
        assert "still in the file -wal" in told.output
        again = run("attempts", "forget", "grace", "--yes")
        assert (again.exit_code, "still in the file -wal" in again.output) == (2, True)
        assert files_with("grace", path)
    assert "-wal" not in run("attempts", "forget", "grace", "--yes").output
    assert files_with("grace", path) == []
