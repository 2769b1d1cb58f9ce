"""Run a small part of the generated requests of `make attack`."""

from pathlib import Path

import pytest

from tests.attack.interface import SECRET, faults, with_key
from tests.server.raw import service


@pytest.mark.long
@pytest.mark.parametrize("keyed", [False, pytest.param(True, marks=pytest.mark.campaign)])
def test_the_service_follows_its_openapi_document(tmp_path: Path, keyed: bool) -> None:
    phases = "examples,fuzzing" if keyed else "examples"
    sample = ["--phases", phases, "--no-shrink", "--generation-database", "none"]
    settings, key = with_key(tmp_path) if keyed else ({}, "")
    with service(tmp_path, **settings) as running:
        assert list(faults(running, tmp_path, 2, "--seed", "1", *sample, key=key)) == []
    log = (tmp_path / "log").read_text(encoding="utf-8")
    assert ("/v1/attempts" if keyed else "/v1/exercises") in log
    assert not any(secret in log for secret in (key or "dhg_", SECRET))
