"""Test the commands of operators."""

import json
import re
import shutil
import sqlite3
from collections.abc import Callable
from contextlib import closing
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest
from dh_grader.access import is_spelt_right
from dh_grader.catalogue import shipped_folder
from dh_grader.cli import program
from dh_grader.cli.operate import keys_commands as commands
from dh_grader.contract.courses import NewAssignment, NewCourse, NewLearner
from dh_grader.courses import roll
from dh_grader.courses.assignments import add_assignment
from dh_grader.server import installed_app
from dh_grader.settings import Settings, SettingsError, load_settings
from dh_grader.store.database import in_transaction, open_database
from dh_grader.store.results import months_before
from dh_grader.store.tables import assignments, attempts, extensions, outcomes, overrides
from sqlalchemy import insert, update
from typer.testing import CliRunner, Result

# --- Test the commands for operators: backup, restore, doctor, and a learner's data

NOW = datetime.now(UTC)
SECRET = "0123456789abcdef" * 4


def run(*words: object) -> Result:
    return CliRunner().invoke(program, list(map(str, words)))


def record(connection: Any, learner: str, at: datetime, number: int) -> None:
    values = {
        "number": number, "id": f"{number:032x}", "exercise": "scara", "learner": learner,
        "ordinal": 1, "at": at, "is_late": False, "worth": 1.0, "answers_digest": "",
        "submission": '{"answers": {"table": "a1"}}', "report": '{"points": 1}', "version": "1",
        "grader": "1", "points": 1.0, "max_points": 2.0, "outcome": 1, "owner": "",
        "request_digest": "", "assignment": 1,
    }  # fmt: skip
    connection.execute(insert(attempts).values(values))


@pytest.fixture
def database(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    path = tmp_path / "attempts.db"
    monkeypatch.setenv("DH_GRADER_DATABASE", str(path))
    monkeypatch.setenv("DH_GRADER_SECRET", SECRET)

    def fill(connection: Any) -> None:
        roll.add_course(connection, NewCourse(id="robots", title="R", zone="Europe/Berlin"), NOW)
        people = [
            NewLearner(learner=each, name=each.title(), email=f"{each}@example.edu")
            for each in ("ada", "grace", "emmy")
        ]
        roll.add_learners(connection, "robots", people)
        exercises, due = [{"exercise": "scara", "points": 10}], NOW - timedelta(days=700)
        fields = {"id": "hw", "title": "H", "exercises": exercises, "due": due}
        add_assignment(connection, "robots", NewAssignment.model_validate(fields), {"scara"})
        connection.execute(insert(outcomes).values(id=1, exercise="scara", digest="", content=""))
        record(connection, "ada", NOW, 1)
        record(connection, "grace", NOW - timedelta(days=730), 2)
        given = {"attempt": 2, "points": 2.0, "reason": "x", "author": "y", "at": NOW}
        connection.execute(insert(overrides).values(given))

    engine = open_database(str(path))
    in_transaction(engine, fill)
    engine.dispose()
    return path


def learners(path: Path) -> list[str]:
    with closing(sqlite3.connect(path)) as connection:
        rows = connection.execute("SELECT learner FROM attempts ORDER BY number").fetchall()
    return [learner for [learner] in rows]


def test_a_backup_replaces_a_damaged_database_and_its_log(database: Path, tmp_path: Path) -> None:
    copy = tmp_path / "copy.db"
    assert run("backup", copy).exit_code == 0
    database.write_bytes(bytes(range(256)) * 32)
    log = database.with_name(f"{database.name}-wal")
    log.write_bytes(b"an old log")
    assert run("restore", copy, "--replace").exit_code == 0
    assert learners(database) == ["ada", "grace"]
    assert database.with_name(f"{database.name}.before-wal").exists() or not log.exists()


def test_the_log_of_a_deleted_database_is_not_replayed(database: Path, tmp_path: Path) -> None:
    copy = tmp_path / "copy.db"
    assert run("backup", copy).exit_code == 0
    log = database.with_name(f"{database.name}-wal")
    with closing(sqlite3.connect(database)) as service:
        service.execute("DELETE FROM overrides")
        service.execute("DELETE FROM attempts")
        service.commit()
        left = log.read_bytes()
    database.unlink()
    log.write_bytes(left)
    assert run("restore", copy).exit_code == 0
    assert learners(database) == ["ada", "grace"]


def test_a_backup_that_cannot_be_written_is_named(database: Path, tmp_path: Path) -> None:
    told = run("backup", tmp_path / "no" / "copy.db")
    assert (told.exit_code, "cannot be written" in told.output) == (2, True)


def test_a_backup_comes_back(database: Path, tmp_path: Path) -> None:
    copy = tmp_path / "copy.db"
    assert run("backup", copy).exit_code == 0
    assert copy.stat().st_mode & 0o777 == 0o600
    again = run("backup", copy)
    assert (again.exit_code, "is there already" in again.output) == (2, True)
    assert run("attempts", "forget", "ada", "--yes").exit_code == 0
    assert learners(database) == ["grace"]
    content = copy.read_bytes()
    assert "--replace" in run("restore", copy).output
    with closing(sqlite3.connect(database)) as service:
        service.execute("SELECT * FROM attempts").fetchone()
        refused = run("restore", copy, "--replace")
        assert (refused.exit_code, "Stop the service" in refused.output) == (2, True)
    assert run("restore", copy, "--replace").exit_code == 0
    assert learners(database) == ["ada", "grace"]
    assert learners(tmp_path / "attempts.db.before") == ["grace"]
    assert database.stat().st_mode & 0o777 == 0o600
    assert copy.read_bytes() == content
    (tmp_path / "broken.db").write_bytes(content[:5000])
    (tmp_path / "attempts.db.before").unlink()
    assert run("restore", tmp_path / "broken.db", "--replace").exit_code == 2
    assert learners(database) == ["ada", "grace"]


def test_nobody_begins_with_an_empty_database_after_an_interrupted_restore(
    database: Path, tmp_path: Path
) -> None:
    copy = tmp_path / "copy.db"
    assert run("backup", copy).exit_code == 0
    kept = database.rename(database.with_name("attempts.db.before"))
    for words in (("keys", "create", "Ada"), ("attempts", "migrate"), ("attempts", "list")):
        told = run(*words)
        assert (told.exit_code, "restore again" in spaced_out(told)) == (2, True), told.output
    with pytest.raises(SettingsError, match="restore again"):
        installed_app(load_settings())
    assert "a restore was interrupted" in run("doctor").output
    assert not database.exists()
    assert run("restore", copy).exit_code == 0
    assert learners(database) == learners(kept) == ["ada", "grace"]
    database.unlink()
    kept.rename(database.with_name("attempts.db.0123abcd.part"))
    assert "delete" in run("keys", "create", "Ada").output
    assert run("restore", copy).exit_code == 0
    assert sorted(each.name for each in tmp_path.iterdir()) == ["attempts.db", "copy.db"]


def spaced_out(result: Result) -> str:
    return " ".join(result.output.split())


@pytest.mark.parametrize("damaged", [True, False])
def test_a_restore_without_hard_links_keeps_the_old_database(
    database: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, damaged: bool
) -> None:
    copy = tmp_path / "copy.db"
    assert run("backup", copy).exit_code == 0
    assert run("attempts", "forget", "ada", "--yes").exit_code == 0
    if damaged:
        database.write_bytes(b"no database" * 1000)

    def link(*_: object) -> None:
        raise PermissionError("no links here")

    monkeypatch.setattr("os.link", link)
    assert run("restore", copy, "--replace").exit_code == 0
    assert learners(database) == ["ada", "grace"]
    kept = database.with_name("attempts.db.before")
    if damaged:
        assert kept.read_bytes() == b"no database" * 1000
    else:
        assert learners(kept) == ["grace"]
    assert kept.stat().st_mode & 0o777 == 0o600
    assert run("backup", tmp_path / "second.db").exit_code == 0
    assert run("backup", tmp_path / "second.db").exit_code == 2
    assert learners(tmp_path / "second.db") == ["ada", "grace"]
    assert not list(tmp_path.glob("*.part*"))


def test_old_attempts_are_deleted_and_no_others(
    database: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert run("attempts", "expire").exit_code == 2
    monkeypatch.setenv("DH_GRADER_KEEP_MONTHS", "12")
    assert run("attempts", "expire").output.startswith("1 attempts are from before")
    assert learners(database) == ["ada", "grace"]
    assert run("attempts", "expire", "--apply").exit_code == 0
    assert learners(database) == ["ada"]
    assert months_before(datetime(2026, 3, 31, 8, tzinfo=UTC), 1).isoformat()[:10] == "2026-02-28"
    assert months_before(datetime(2026, 1, 5, 8, tzinfo=UTC), 13).isoformat()[:10] == "2024-12-05"


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("due", "closes", "extended", "left"),
    [
        (-700, None, None, ["ada"]),
        (-400, -300, None, ["ada", "grace"]),
        (-700, -400, None, ["ada"]),
        (-700, None, -300, ["ada", "grace"]),
        (-700, None, -400, ["ada"]),
        (None, None, None, ["ada", "grace"]),
    ],
)
def test_attempts_are_kept_until_their_assignment_has_been_closed_for_as_long(
    database: Path, due: int | None, closes: int | None, extended: int | None, left: list[str]
) -> None:
    def moment(days: int | None) -> datetime | None:
        return None if days is None else NOW + timedelta(days=days)

    def change(connection: Any) -> None:
        values = {"due": moment(due), "closes": moment(closes)}
        connection.execute(update(assignments).values(values))
        if extended is not None:
            given = {"assignment": 1, "learner": "emmy", "due": moment(extended)}
            connection.execute(insert(extensions).values(given))

    engine = open_database(str(database))
    in_transaction(engine, change)
    engine.dispose()
    count = 2 - len(left)
    told = run("attempts", "expire", "--months", 12).output
    assert told.startswith(f"{count} attempts are from before")
    assert ("1 older attempts are kept" in told) is (count == 0)
    assert run("attempts", "expire", "--months", 12, "--apply").exit_code == 0
    assert learners(database) == left


@pytest.mark.long
def test_the_service_deletes_old_attempts_at_its_start(
    database: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    installed_app(load_settings())
    assert learners(database) == ["ada", "grace"]
    monkeypatch.setenv("DH_GRADER_KEEP_MONTHS", "12")
    installed_app(load_settings())
    assert learners(database) == ["ada"]


def test_everything_known_of_a_learner_is_exported_and_forgotten(database: Path) -> None:
    found = json.loads(run("learners", "export", "grace").output)
    assert found["courses"] == [
        {"course": "robots", "learner": "grace", "name": "Grace", "email": "grace@example.edu"}
    ]
    [attempt] = found["attempts"]
    assert attempt["submission"] == {"answers": {"table": "a1"}}
    assert (attempt["course"], attempt["in_assignment"]) == ("robots", "hw")
    assert [each["reason"] for each in attempt["overrides"]] == ["x"]
    assert "ada" not in json.dumps(found)
    # Emmy is in the course, and has handed nothing in.
    for learner in ("grace", "emmy"):
        assert run("attempts", "forget", learner, "--yes").exit_code == 0
        assert run("learners", "export", learner).exit_code == 2
        assert learner.encode() not in database.read_bytes()


Spoil = Callable[[Path, pytest.MonkeyPatch], None]


def unset_secret(_: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run("keys", "create", "Ada", "--scope", "tutor")
    monkeypatch.delenv("DH_GRADER_SECRET")


def other_secret(_: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run("keys", "create", "Ada", "--scope", "tutor")
    monkeypatch.setenv("DH_GRADER_SECRET", "f" * 64)


def only_course_site(_: Path, __: pytest.MonkeyPatch) -> None:
    run("keys", "create", "Site", "--scope", "record")


def readable(database: Path, _: pytest.MonkeyPatch) -> None:
    database.chmod(0o644)


def damaged(database: Path, _: pytest.MonkeyPatch) -> None:
    database.write_bytes(b"no database" * 1000)


def typo(_: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DH_GRADER_KEEP_MONTH", "12")


def open_to_all(_: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DH_GRADER_HOST", "0.0.0.0")


def no_folder(_: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DH_GRADER_DATABASE", "/nowhere/attempts.db")


def no_exercises(database: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DH_GRADER_EXERCISES_DIR", str(database.parent / "nothing"))


@pytest.mark.long
@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (unset_secret, "no secret"),
        (other_secret, "not the secret"),
        (only_course_site, "no tutor can sign in"),
        (readable, "chmod 600"),
        (damaged, "database"),
        (typo, "did you mean DH_GRADER_KEEP_MONTHS?"),
        (open_to_all, "there are no keys"),
        (no_folder, "is no folder"),
        (no_exercises, "exercises"),
    ],
)
def test_the_doctor_says_what_is_wrong(
    database: Path, monkeypatch: pytest.MonkeyPatch, spoil: Spoil, said: str
) -> None:
    spoil(database, monkeypatch)
    result = run("doctor")
    wrong = [line for line in result.output.splitlines() if line.startswith("WRONG")]
    assert result.exit_code == 1
    assert any(said in line for line in wrong), result.output
    assert SECRET not in result.output


@pytest.mark.long
def test_the_doctor_finds_nothing_wrong(
    database: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    healthy = run("doctor")
    assert healthy.exit_code == 0, healthy.output
    assert "its tables are those of this version" in healthy.output
    assert "courses: 1 course" in healthy.output
    monkeypatch.setenv("DH_GRADER_DATABASE", str(tmp_path / "new.db"))
    assert run("doctor").exit_code == 0
    assert not (tmp_path / "new.db").exists()


@pytest.mark.long
def test_the_doctor_speaks_the_language_of_the_user(
    database: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    english = run("doctor").output.splitlines()
    monkeypatch.setenv("DH_GRADER_LANGUAGE", "de")
    german = run("doctor").output.splitlines()
    assert "ok      Kurse: 1 Kurs" in german
    assert "ok      Zeitzonen: die Zeitzonen sind bekannt" in german
    assert german[-1] == "Alles ist in Ordnung."
    assert [line for line in german if line in english] == []
    database.chmod(0o644)
    wrong = f"FALSCH  Datenbank: andere Benutzer dieses Rechners können {database} lesen."
    assert wrong in run("doctor").output
    monkeypatch.setenv("DH_GRADER_LANGUAGE", "fr")
    monkeypatch.setenv("DH_GRADER_PORT", "many")
    monkeypatch.setenv("DH_GRADER_KEY_RATE", "1/second")
    assert "réglages : DH_GRADER_PORT: Il faut ici un nombre entier." in spaced(run("doctor"))
    monkeypatch.setenv("DH_GRADER_KEEP_MONTH", "12")
    assert "ce réglage n’existe pas ; vouliez-vous dire DH_" in spaced(run("doctor"))


def spaced(result: Result) -> str:
    return result.output.replace("\xa0", " ")


# --- Test `dh-grader keys`, and that the service does not start without keys


@pytest.fixture
def _installation(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for name in Settings.model_fields:
        monkeypatch.delenv(f"DH_GRADER_{name.upper()}", raising=False)
    monkeypatch.setenv("DH_GRADER_DATABASE", str(tmp_path / "attempts.db"))
    # One exercise, so that an application is made quickly.
    folder = tmp_path / "exercises"
    folder.mkdir()
    shutil.copy(shipped_folder() / "scara.toml", folder)
    monkeypatch.setenv("DH_GRADER_EXERCISES_DIR", str(folder))


def run_keys(*arguments: str) -> Result:
    return CliRunner().invoke(commands, arguments)


def refused(host: str | None = "0.0.0.0", **options: Any) -> str:
    try:
        installed_app(load_settings(**options), host)
    except SettingsError as error:
        return str(error)
    return ""


@pytest.mark.usefixtures("_installation")
def test_a_key_is_created_shown_once_listed_and_revoked(monkeypatch: pytest.MonkeyPatch) -> None:
    assert "DH_GRADER_SECRET" in run_keys("create", "a course").stderr
    monkeypatch.setenv("DH_GRADER_SECRET", SECRET)
    created = run_keys("create", "a [b]course[/b]\x1b", "--scope", "tutor", "--exercise", "scara")
    text = created.stdout.strip()
    assert is_spelt_right(text)
    [key] = re.findall(r"Key (\w{8}), valid until", created.stderr)
    listed = run_keys("list").stdout
    for told in (key, "a [b]course[/b]", "grade tutor", "scara", "until 20", "never used"):
        assert told in listed
    assert text not in listed
    assert "\x1b" not in listed
    monkeypatch.setenv("DH_GRADER_LANGUAGE", "de")
    assert run_keys("revoke", key).stdout.startswith("Widerrufen. Jeder laufende Dienst")
    assert re.search("scara  widerrufen 20[-0-9]+  nie benutzt", run_keys("list").stdout)
    created = run_keys("create", "b")
    assert "Bewahren Sie ihn jetzt auf" in created.stderr
    assert is_spelt_right(created.stdout.strip())
    monkeypatch.delenv("DH_GRADER_LANGUAGE")
    assert "revoked 20" in run_keys("list").stdout
    assert run_keys("revoke", key).exit_code == 2
    assert run_keys("create", "c", "--exercise", "scarra").exit_code != 0


@pytest.mark.usefixtures("_installation")
@pytest.mark.long
def test_a_public_service_needs_keys_or_an_explicit_setting(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert "DH_GRADER_OPEN=until-keys" in refused()
    assert refused("192.0.2.1")
    assert refused("grader.example.edu")
    for here in ("127.0.0.1", "localhost", "::1", "127.1.2.3", None):
        assert not refused(here)
    for said in ("until-keys", "grade", "grade,record", "none"):
        assert not refused(open=said)
    monkeypatch.setenv("DH_GRADER_SECRET", SECRET)
    assert refused()
    run_keys("create", "a course")
    assert not refused()
    monkeypatch.delenv("DH_GRADER_SECRET")
    assert "DH_GRADER_SECRET" in refused("127.0.0.1")


@pytest.mark.usefixtures("_installation")
@pytest.mark.long
def test_a_wrong_secret_is_refused_until_all_keys_are_revoked(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("DH_GRADER_SECRET", SECRET)
    [key] = re.findall(r"Key (\w{8}), valid until", run_keys("create", "a course").stderr)
    told = "This is not the secret with which the keys in the database were made."
    monkeypatch.setenv("DH_GRADER_SECRET", SECRET[::-1])
    assert refused("127.0.0.1").startswith(f"DH_GRADER_SECRET: {told}")
    for arguments in (("create", "another"), ("list",)):
        result = run_keys(*arguments)
        assert (result.exit_code, told in result.stderr.replace("\n", " ")) == (2, True)
        assert "another" not in result.output
    assert key in run_keys("list").stdout
    # A database of the previous version records no secret; the next key sets it.
    with sqlite3.connect(tmp_path / "attempts.db") as connection:
        connection.execute("DELETE FROM key_secrets")
    assert not refused()
    monkeypatch.setenv("DH_GRADER_SECRET", SECRET)
    [other] = re.findall(r"Key (\w{8}), valid until", run_keys("create", "a course").stderr)
    # After losing the secret, revoke all keys and create new ones.
    monkeypatch.setenv("DH_GRADER_SECRET", SECRET[::-1])
    assert told in refused()
    for each in (key, other):
        assert run_keys("create", "a course").exit_code == 2
        assert run_keys("revoke", each).exit_code == 0
    assert run_keys("create", "a course").exit_code == 0
    assert not refused()


@pytest.mark.usefixtures("_installation")
def test_unusable_settings_are_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    file = tmp_path / "secret"
    monkeypatch.setenv("DH_GRADER_SECRET_FILE", str(file))
    assert "DH_GRADER_SECRET_FILE: cannot be read" in refused()
    file.write_text("short\n", encoding="utf-8")
    assert "DH_GRADER_SECRET_FILE: the secret is short" in refused()
    file.write_text(f"{SECRET}\n", encoding="utf-8")
    assert is_spelt_right(run_keys("create", "a course").stdout.strip())
    for name, value in (
        ("secret", "short"),
        ("open", "tutor"),
        ("open", "grade,all"),
        ("key_rate", "often"),
        ("address_rate", "1 per fortnight"),
    ):
        given = refused(**{name: value})
        assert f"--{name}: " in given or f"DH_GRADER_{name.upper()}: " in given
    told = refused(key_rate="1/day", rates_store="redis+nonsense://user:hidden@host")
    assert told.startswith("DH_GRADER_RATES_STORE: ")
    assert "hidden" not in told
