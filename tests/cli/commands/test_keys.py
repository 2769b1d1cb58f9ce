"""Test `dh-grader keys`, and that the service does not start without keys."""

import re
import shutil
import sqlite3
from pathlib import Path
from typing import Any

import pytest
from dh_grader.access import is_spelt_right
from dh_grader.catalogue import shipped_folder
from dh_grader.cli.operate import keys_commands as commands
from dh_grader.server import installed_app
from dh_grader.settings import Settings, SettingsError, load_settings
from typer.testing import CliRunner, Result

SECRET = "0123456789abcdef" * 4


@pytest.fixture(autouse=True)
def _installation(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for name in Settings.model_fields:
        monkeypatch.delenv(f"DH_GRADER_{name.upper()}", raising=False)
    monkeypatch.setenv("DH_GRADER_DATABASE", str(tmp_path / "attempts.db"))
    # One exercise, so that an application is made quickly.
    folder = tmp_path / "exercises"
    folder.mkdir()
    shutil.copy(shipped_folder() / "scara.toml", folder)
    monkeypatch.setenv("DH_GRADER_EXERCISES_DIR", str(folder))


def run(*arguments: str) -> Result:
    return CliRunner().invoke(commands, arguments)


def refused(host: str | None = "0.0.0.0", **options: Any) -> str:
    try:
        installed_app(load_settings(**options), host)
    except SettingsError as error:
        return str(error)
    return ""


def test_a_key_is_created_shown_once_listed_and_revoked(monkeypatch: pytest.MonkeyPatch) -> None:
    assert "DH_GRADER_SECRET" in run("create", "a course").stderr
    monkeypatch.setenv("DH_GRADER_SECRET", SECRET)
    created = run("create", "a [b]course[/b]\x1b", "--scope", "tutor", "--exercise", "scara")
    text = created.stdout.strip()
    assert is_spelt_right(text)
    [key] = re.findall(r"Key (\w{8}), valid until", created.stderr)
    listed = run("list").stdout
    for told in (key, "a [b]course[/b]", "grade tutor", "scara", "until 20", "never used"):
        assert told in listed
    assert text not in listed
    assert "\x1b" not in listed
    monkeypatch.setenv("DH_GRADER_LANGUAGE", "de")
    assert run("revoke", key).stdout.startswith("Widerrufen. Jeder laufende Dienst")
    assert re.search("scara  widerrufen 20[-0-9]+  nie benutzt", run("list").stdout)
    created = run("create", "b")
    assert "Bewahren Sie ihn jetzt auf" in created.stderr
    assert is_spelt_right(created.stdout.strip())
    monkeypatch.delenv("DH_GRADER_LANGUAGE")
    assert "revoked 20" in run("list").stdout
    assert run("revoke", key).exit_code == 2
    assert run("create", "c", "--exercise", "scarra").exit_code != 0


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
    run("create", "a course")
    assert not refused()
    monkeypatch.delenv("DH_GRADER_SECRET")
    assert "DH_GRADER_SECRET" in refused("127.0.0.1")


@pytest.mark.long
def test_a_wrong_secret_is_refused_until_all_keys_are_revoked(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("DH_GRADER_SECRET", SECRET)
    [key] = re.findall(r"Key (\w{8}), valid until", run("create", "a course").stderr)
    told = "This is not the secret with which the keys in the database were made."
    monkeypatch.setenv("DH_GRADER_SECRET", SECRET[::-1])
    assert refused("127.0.0.1").startswith(f"DH_GRADER_SECRET: {told}")
    for arguments in (("create", "another"), ("list",)):
        result = run(*arguments)
        assert (result.exit_code, told in result.stderr.replace("\n", " ")) == (2, True)
        assert "another" not in result.output
    assert key in run("list").stdout
    # A database of the previous version records no secret; the next key sets it.
    with sqlite3.connect(tmp_path / "attempts.db") as connection:
        connection.execute("DELETE FROM key_secrets")
    assert not refused()
    monkeypatch.setenv("DH_GRADER_SECRET", SECRET)
    [other] = re.findall(r"Key (\w{8}), valid until", run("create", "a course").stderr)
    # After losing the secret, revoke all keys and create new ones.
    monkeypatch.setenv("DH_GRADER_SECRET", SECRET[::-1])
    assert told in refused()
    for each in (key, other):
        assert run("create", "a course").exit_code == 2
        assert run("revoke", each).exit_code == 0
    assert run("create", "a course").exit_code == 0
    assert not refused()


def test_unusable_settings_are_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    file = tmp_path / "secret"
    monkeypatch.setenv("DH_GRADER_SECRET_FILE", str(file))
    assert "DH_GRADER_SECRET_FILE: cannot be read" in refused()
    file.write_text("short\n", encoding="utf-8")
    assert "DH_GRADER_SECRET_FILE: the secret is short" in refused()
    file.write_text(f"{SECRET}\n", encoding="utf-8")
    assert is_spelt_right(run("create", "a course").stdout.strip())
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
