import json
from pathlib import Path

import pytest
from dh_grader.lti.fetching import published_keys
from dh_grader.store.database import in_transaction, open_database

from tests.cli.conftest import Run
from tests.lti.platform import Platform, running


@pytest.fixture(autouse=True)
def installation(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DH_GRADER_DATABASE", str(tmp_path / "lti.db"))
    monkeypatch.setenv("DH_GRADER_SECRET", "0123456789abcdef" * 4)


@pytest.mark.long
def test_a_platform_is_registered_from_a_file_checked_and_removed(run: Run, tmp_path: Path) -> None:
    platform, file = Platform(), tmp_path / "moodle.json"
    with running(platform.app()) as port:
        platform.port = port
        file.write_text(json.dumps(platform.registration))
        shown = run("lti", "register", "--file", file)
        assert shown.exit_code == 0
        assert "http://127.0.0.1:8000/lti/login" in shown.output
        assert run("lti", "show", "moodle").output == shown.output
        engine = open_database(str(tmp_path / "lti.db"))
        platform.gradebook.own_keys = lambda: in_transaction(engine, published_keys)
        assert run("lti", "register", "--file", file).exit_code == 2
        checked = run("lti", "check", "moodle")
        assert checked.exit_code == 0
        assert "1 of 1 can be used" in checked.output
        assert "Last launch: never" in checked.output
    down = run("lti", "check", "moodle")
    assert (down.exit_code, "does not answer" in down.output) == (1, True)
    assert len(run("lti", "keys", "list").output.splitlines()) == 1
    assert "signs from" in run("lti", "keys", "rotate").output
    assert len(run("lti", "keys", "list").output.splitlines()) == 2
    refused = run("lti", "roster", "robotics", "--names")
    assert (refused.exit_code, "does not tell its roster" in refused.stderr) == (2, True)
    assert run("lti", "remove", "moodle").exit_code == 0
    assert run("lti", "list").output == ""
    assert run("lti", "remove", "moodle").exit_code == 2


def test_unusable_values_are_refused(run: Run, tmp_path: Path) -> None:
    good = Platform(port=9).registration
    for name, value in {
        "auth_url": "http://moodle.example.edu/auth",
        "jwks_url": "javascript:alert(1)",
        "address": "grader.example.edu",
        "zone": "Europe/Nowhere",
        "id": "My Moodle",
        "client": "typo",
    }.items():
        file = tmp_path / "wrong.json"
        file.write_text(json.dumps(good | {name: value}))
        refused = run("lti", "register", "--file", file)
        assert (name, refused.exit_code) == (name, 2)
        assert name in refused.stderr


def test_platforms_are_invited(run: Run) -> None:
    address = ("--address", "https://grader.example.edu")
    link = run("lti", "invite", "University X", *address, "--zone", "Europe/Berlin").output.strip()
    assert link.startswith("https://grader.example.edu/lti/register?invitation=")
    held = run("lti", "invite", "University Y", *address, "--hold").output.strip()
    assert "invitation=held-" in held
    assert run("lti", "invite", "X", *address, "--zone", "Mars/Base").exit_code == 2
    assert run("lti", "invite", "X", "--address", "grader").exit_code == 2
    assert run("lti", "allow", "nobody").exit_code == 2
    found = json.loads(run("lti", "canvas", *address).output)
    assert found["target_link_uri"] == "https://grader.example.edu/lti/launch"
    assert run("lti", "canvas", "--address", "grader").exit_code == 2


def test_the_address_of_the_service_is_that_of_the_setting(
    run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    without = run("lti", "canvas")
    assert (without.exit_code, "DH_GRADER_PUBLIC_URL" in without.stderr) == (2, True)
    monkeypatch.setenv("DH_GRADER_PUBLIC_URL", "https://grader.example.edu/robotics/")
    found = json.loads(run("lti", "canvas").output)
    assert found["oidc_initiation_url"] == "https://grader.example.edu/robotics/lti/login"
    link = run("lti", "invite", "University X").output
    assert link.startswith("https://grader.example.edu/robotics/lti/register")
    given = ("--address", "https://other.example.edu")
    assert run("lti", "invite", "Y", *given).output.startswith("https://other.example.edu/lti/")
    values = {"name": "M", "client_id": "c", "issuer": "https://m.example.edu"}
    values |= {"auth_url": "https://m.example.edu/a", "jwks_url": "https://m.example.edu/j"}
    options = [each for k, v in values.items() for each in (f"--{k.replace('_', '-')}", v)]
    shown = run("lti", "register", *options)
    assert "https://grader.example.edu/robotics/lti/launch" in shown.output
