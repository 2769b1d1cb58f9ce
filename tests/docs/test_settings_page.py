"""docs/settings.md lists every setting once, and is up to date."""

import re
from pathlib import Path

import pytest
from dh_grader.settings import Settings, load_settings

from tests.docs.settings import page

FILE = Path(__file__).parents[2] / "docs" / "settings.md"
_ROW = re.compile(r"^\| `DH_GRADER_([A-Z_]+)` \| (not set|`[^`]+`) \| (.+) \|$", re.MULTILINE)


def test_the_page_is_up_to_date() -> None:
    assert FILE.read_text(encoding="utf-8") == page(), (
        "The settings have changed; run python -m tests.docs.settings > docs/settings.md"
    )


def test_every_setting_has_one_row() -> None:
    rows = _ROW.findall(FILE.read_text(encoding="utf-8"))
    assert sorted(name.lower() for name, _, _ in rows) == sorted(Settings.model_fields)


def test_a_printed_default_is_the_default(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in Settings.model_fields:
        monkeypatch.delenv(f"DH_GRADER_{name.upper()}", raising=False)
    usual = load_settings()
    for name, default, _ in _ROW.findall(FILE.read_text(encoding="utf-8")):
        if default != "not set":
            monkeypatch.setenv(f"DH_GRADER_{name}", default.strip("`"))
    assert load_settings() == usual
