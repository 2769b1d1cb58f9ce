"""Test the health check of the container image."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from dh_grader.server.alive import main

from tests.server.raw import ROOT, service


@pytest.mark.long
def test_the_health_check_uses_the_port_and_fails_if_nobody_answers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DH_GRADER_OPEN", "until-keys")
    with service(tmp_path, "--host", "0.0.0.0") as running:
        monkeypatch.setenv("DH_GRADER_PORT", str(running.port))
        for host in ("0.0.0.0", "127.0.0.1"):
            monkeypatch.setenv("DH_GRADER_HOST", host)
            assert main() == 0
        assert subprocess.run(health_check(), cwd=ROOT, check=False).returncode == 0
        assert running.end() == 0
    assert main() == 1
    assert subprocess.run(health_check(), cwd=ROOT, check=False).returncode == 1


def health_check() -> list[str]:
    """Return the command of the image's health check."""
    text = (ROOT / "Dockerfile").read_text(encoding="utf-8")
    [command] = re.findall(r"^HEALTHCHECK .*\\\n +CMD (\[.*\])$", text, re.MULTILINE)
    python, *options = json.loads(command)
    assert python == "python"
    return [sys.executable, *options]
