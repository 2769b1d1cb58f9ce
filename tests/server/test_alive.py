"""The question of the image whether the service answers."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from service.server.alive import main
from tests.server.raw import ROOT, service


def test_it_follows_the_port_and_says_when_nobody_answers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("DH_GRADER_OPEN", "until-keys")
    with service(tmp_path, "--host", "0.0.0.0") as running:
        monkeypatch.setenv("DH_GRADER_PORT", str(running.port))
        for host in ("0.0.0.0", "127.0.0.1"):
            monkeypatch.setenv("DH_GRADER_HOST", host)
            assert main() == 0
        assert subprocess.run(question(), cwd=ROOT, check=False).returncode == 0
        assert running.end() == 0
    assert main() == 1
    assert subprocess.run(question(), cwd=ROOT, check=False).returncode == 1


def question() -> list[str]:
    """The command by which the image asks."""
    text = (ROOT / "Dockerfile").read_text(encoding="utf-8")
    [command] = re.findall(r"^HEALTHCHECK .*\\\n +CMD (\[.*\])$", text, re.MULTILINE)
    python, *options = json.loads(command)
    assert python == "python"
    return [sys.executable, *options]
