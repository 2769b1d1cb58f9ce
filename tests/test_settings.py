import os
from pathlib import Path

import pytest
from dh_grader.catalogue import FeedbackLevel, shipped_folder
from dh_grader.settings import Settings, SettingsError, load_settings


@pytest.fixture(autouse=True)
def _no_settings(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in Settings.model_fields:
        monkeypatch.delenv(f"DH_GRADER_{name.upper()}", raising=False)


def test_by_default_the_service_is_local_and_allows_no_origins() -> None:
    settings = load_settings()
    assert (settings.host, settings.port) == ("127.0.0.1", 8000)
    assert settings.cors_origins == ()
    assert settings.exercises_dir == (shipped_folder(),)
    assert settings.feedback is FeedbackLevel.FULL


def test_settings_are_read_from_the_environment(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("DH_GRADER_PORT", "0")
    monkeypatch.setenv("DH_GRADER_EXERCISES_DIR", str(tmp_path))
    monkeypatch.setenv("DH_GRADER_CORS_ORIGINS", "https://a.example, http://b.example:8080")
    monkeypatch.setenv("DH_GRADER_LOG_LEVEL", "WARNING")
    monkeypatch.setenv("DH_GRADER_FEEDBACK", "Verdicts")
    settings = load_settings()
    assert settings.port == 0
    assert settings.exercises_dir == (tmp_path,)
    assert settings.cors_origins == ("https://a.example", "http://b.example:8080")
    assert settings.log_level == "warning"
    assert settings.feedback is FeedbackLevel.VERDICTS


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("DH_GRADER_PORT", "http"),
        ("DH_GRADER_PORT", "70000"),
        ("DH_GRADER_LOG_LEVEL", "loud"),
        ("DH_GRADER_FEEDBACK", "everything"),
        ("DH_GRADER_CORS_ORIGINS", "course.example"),
        ("DH_GRADER_CORS_ORIGINS", "https://course.example/page"),
        ("DH_GRADER_CORS_ORIGINS", "https://"),
        ("DH_GRADER_CORS_ORIGINS", "https://*.example"),
        ("DH_GRADER_CORS_ORIGINS", "https://k\u00fcrs.example"),
        ("DH_GRADER_CORS_ORIGINS", "https://user@course.example"),
        ("DH_GRADER_CORS_ORIGINS", "https://course.example:443"),
        ("DH_GRADER_CORS_ORIGINS", "https://Course.example"),
        ("DH_GRADER_CORS_ORIGINS", "https://course.example:port"),
        ("DH_GRADER_CORS_ORIGINS", "https://a.example,https://"),
        ("DH_GRADER_HOST", ""),
        ("DH_GRADER_HOST", " "),
        ("DH_GRADER_HOST", "127.0.0.1 0.0.0.0"),
        ("DH_GRADER_WORKERS", "0"),
    ],
)
def test_an_unusable_setting_is_named(
    monkeypatch: pytest.MonkeyPatch, name: str, value: str
) -> None:
    monkeypatch.setenv(name, value)
    with pytest.raises(SettingsError, match=name):
        load_settings()


@pytest.mark.parametrize(
    "origin", ["*", "http://localhost:3000", "https://[::1]:8443", "https://course.example"]
)
def test_a_valid_origin_is_accepted(monkeypatch: pytest.MonkeyPatch, origin: str) -> None:
    monkeypatch.setenv("DH_GRADER_CORS_ORIGINS", origin)
    assert load_settings().cors_origins == (origin,)


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("DH_GRADER_FEEDBAK", "; did you mean DH_GRADER_FEEDBACK?"),
        ("DH_GRADER_EXERCISE_DIR", "; did you mean DH_GRADER_EXERCISES_DIR?"),
        ("dh_grader_solution", "; did you mean DH_GRADER_SOLUTIONS?"),
        ("DH_GRADER_ZZZ", ""),
    ],
)
def test_an_unknown_setting_is_refused_with_a_suggestion(
    monkeypatch: pytest.MonkeyPatch, name: str, meant: str
) -> None:
    monkeypatch.setenv(name, "x")
    with pytest.raises(SettingsError) as refused:
        load_settings()
    assert str(refused.value) == f"{name}: there is no such setting{meant}"


def test_an_option_overrides_its_variable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DH_GRADER_PORT", "9000")
    monkeypatch.setenv("DH_GRADER_HOST", "0.0.0.0")
    settings = load_settings(port=9001, host=None)
    assert (settings.port, settings.host) == (9001, "0.0.0.0")
    with pytest.raises(SettingsError, match=r"^--host: "):
        load_settings(host="")


def test_every_setting_has_a_description() -> None:
    assert all(field.description for field in Settings.model_fields.values())


def test_exercises_may_be_in_several_folders(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("DH_GRADER_EXERCISES_DIR", f" {tmp_path} {os.pathsep}shipped{os.pathsep}")
    assert load_settings().exercises_dir == (tmp_path, shipped_folder())
    monkeypatch.setenv("DH_GRADER_EXERCISES_DIR", " ")
    with pytest.raises(SettingsError, match="names no folder"):
        load_settings()


def test_solutions_and_reloading_are_off_by_default(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert (load_settings().solutions, load_settings().reload_exercises) == (None, False)
    monkeypatch.setenv("DH_GRADER_SOLUTIONS", "true")
    monkeypatch.setenv("DH_GRADER_RELOAD_EXERCISES", "1")
    assert (load_settings().solutions, load_settings().reload_exercises) == (True, True)


@pytest.mark.parametrize(
    ("given", "known"),
    [
        ("https://grader.example.edu", "https://grader.example.edu"),
        ("https://grader.example.edu/", "https://grader.example.edu"),
        ("https://uni.example.edu:8443/robotics/grader/", "https://uni.example.edu:8443/robotics/grader"),
        ("http://localhost:8000", "http://localhost:8000"),
        ("http://127.0.0.1:8000/", "http://127.0.0.1:8000"),
        ("http://[::1]:8000", "http://[::1]:8000"),
        ("https://xn--krs-hoa.example", "https://xn--krs-hoa.example"),
        ("", None),
        ("  ", None),
    ],
)  # fmt: skip
def test_a_public_address_has_no_slash_at_the_end(
    monkeypatch: pytest.MonkeyPatch, given: str, known: str | None
) -> None:
    monkeypatch.setenv("DH_GRADER_PUBLIC_URL", given)
    assert load_settings().public_url == known


@pytest.mark.parametrize(
    "address",
    [
        "grader.example.edu", "http://grader.example.edu", "http://10.0.0.1:8000", "ftp://a.example/",
        "https://", "https:///path", "https://a.example?x=1", "https://a.example/#top",
        "https://a.example/a//b", "https://a.example//", "https://a.example/a/../b",
        "https://a.example/./b", "https://user@a.example", "https://user:pw@a.example",
        "https://a.example:port", "https://a.example:70000", "https://a.example/a b",
        "https://a.example\\b", "https://k\u00fcrs.example", "https://a.example\nX: 1",
        "https://a.example/\"", "javascript:alert(1)", "//a.example", "http://127.0.0.1.example/",
    ],
)  # fmt: skip
def test_an_address_that_links_cannot_begin_with_is_refused(
    monkeypatch: pytest.MonkeyPatch, address: str
) -> None:
    monkeypatch.setenv("DH_GRADER_PUBLIC_URL", address)
    with pytest.raises(SettingsError, match=r"^DH_GRADER_PUBLIC_URL: "):
        load_settings()


# For each setting that an option of the command line overrides: a value that cannot be used.
OVERRIDDEN = {
    "host": ("a b", "127.0.0.1"),
    "port": ("http", 9000),
    "workers": ("0", 2),
    "server": ("ftp://a.example", "https://a.example"),
    "language": ("xx", "de"),
}


@pytest.mark.parametrize("name", OVERRIDDEN)
def test_an_option_does_not_hide_an_unusable_variable(
    monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    invalid, option = OVERRIDDEN[name]
    assert getattr(load_settings(**{name: option}), name) == option
    with pytest.raises(SettingsError, match=rf"^--{name}: "):
        load_settings(**{name: invalid})
    monkeypatch.setenv(f"DH_GRADER_{name.upper()}", invalid)
    with pytest.raises(SettingsError, match=rf"^DH_GRADER_{name.upper()}: "):
        load_settings(**{name: option})


def test_a_secret_does_not_hide_an_unreadable_file(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("DH_GRADER_SECRET", "s" * 40)
    monkeypatch.setenv("DH_GRADER_SECRET_FILE", str(tmp_path / "secret"))
    with pytest.raises(SettingsError, match=r"^DH_GRADER_SECRET_FILE: "):
        load_settings().known_secret()
