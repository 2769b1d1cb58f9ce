"""A real server that is told to follow its exercise files."""

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from service.authoring import template
from tests.api.serving import ROOT, announced_port
from tests.guards import ANSWER


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    place = tmp_path / "exercises"
    place.mkdir()
    (place / "arm.toml").write_text(template("arm"), encoding="utf-8")
    return place


@pytest.fixture
def log(tmp_path: Path) -> Path:
    return tmp_path / "log"


@pytest.fixture
def server(folder: Path, log: Path) -> Iterator[httpx.Client]:
    environment = os.environ | {
        "NO_COLOR": "1",
        "DH_GRADER_EXERCISES_DIR": str(folder),
        "DH_GRADER_RELOAD_EXERCISES": "true",
        "DH_GRADER_SOLUTIONS": "true",
    }
    command = [sys.executable, "-m", "service", "serve", "--port", "0"]
    with (
        log.open("wb") as output,
        subprocess.Popen(
            command, cwd=ROOT, stdout=output, stderr=output, env=environment
        ) as process,
    ):
        try:
            address = f"http://127.0.0.1:{announced_port(process, log)}"
            with httpx.Client(base_url=address, trust_env=False, timeout=ANSWER) as client:
                yield client
        finally:
            process.terminate()
            process.wait(timeout=ANSWER)


def title(server: httpx.Client) -> str:
    response = server.get("/v1/exercises/arm")
    assert response.status_code == 200
    return str(response.json()["title"])


def until(server: httpx.Client, expected: str) -> None:
    """Asks until the title is this; the test's own timeout bounds that."""
    while title(server) != expected:
        time.sleep(0.05)


def test_a_file_is_changed_broken_mended_and_joined_by_another(
    server: httpx.Client, folder: Path, log: Path
) -> None:
    file, good = folder / "arm.toml", template("arm")
    assert title(server) == "Arm"
    before = server.get("/v1/exercises/arm/solution").json()
    file.write_text(good.replace('"Arm"', '"A better arm"'), encoding="utf-8")
    until(server, "A better arm")
    solution = server.get("/v1/exercises/arm/solution").json()
    assert solution["version"] != before["version"]
    file.write_text(good.replace('"0",     "d2", "0"', '"0",     "d7", "0"'), encoding="utf-8")
    while "its last good version stays" not in log.read_text(encoding="utf-8"):
        assert title(server) == "A better arm"
        graded = server.post("/v1/exercises/arm/grade", json={"answers": {"table": "?"}})
        assert graded.status_code == 200
        time.sleep(0.05)
    assert "arm.toml: robot.table[1].d (line " in log.read_text(encoding="utf-8")
    (folder / "boom.toml").write_text(good, encoding="utf-8")
    file.write_text(good, encoding="utf-8")
    until(server, "Arm")
    assert server.get("/readyz").json() == {"status": "ready", "exercises": 2}
    assert "Traceback" not in log.read_text(encoding="utf-8")
