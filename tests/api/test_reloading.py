"""A real server reloads exercise files that change."""

import time
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from dh_grader.authoring import exercise_template

from tests.api.serving import Served, served
from tests.guards import ANSWER


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    place = tmp_path / "exercises"
    place.mkdir()
    (place / "arm.toml").write_text(exercise_template("arm"), encoding="utf-8")
    return place


@pytest.fixture
def server(folder: Path, tmp_path: Path) -> Iterator[Served]:
    settings = {"EXERCISES_DIR": str(folder), "RELOAD_EXERCISES": "true", "SOLUTIONS": "true"}
    environment = {f"DH_GRADER_{name}": value for name, value in settings.items()}
    with served(tmp_path, **environment) as server:
        yield server


@pytest.fixture
def log(server: Served) -> Path:
    return server.log


@pytest.fixture
def client(server: Served) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=server.address, trust_env=False, timeout=ANSWER) as client:
        yield client


def title(client: httpx.Client) -> str:
    response = client.get("/v1/exercises/arm")
    assert response.status_code == 200
    return str(response.json()["title"])


def until(client: httpx.Client, expected: str) -> None:
    while title(client) != expected:
        time.sleep(0.05)


@pytest.mark.long
def test_a_file_is_changed_broken_mended_and_joined_by_another(
    client: httpx.Client, folder: Path, log: Path
) -> None:
    file, good = folder / "arm.toml", exercise_template("arm")
    assert title(client) == "Arm"
    before = client.get("/v1/exercises/arm/solution").json()
    file.write_text(good.replace('"Arm"', '"A better arm"'), encoding="utf-8")
    until(client, "A better arm")
    solution = client.get("/v1/exercises/arm/solution").json()
    assert solution["version"] != before["version"]
    file.write_text(good.replace('"0",     "d2", "0"', '"0",     "d7", "0"'), encoding="utf-8")
    while "its last good version stays" not in log.read_text(encoding="utf-8"):
        assert title(client) == "A better arm"
        graded = client.post("/v1/exercises/arm/grade", json={"answers": {"table": "?"}})
        assert graded.status_code == 200
        time.sleep(0.05)
    assert "arm.toml: robot.table[1].d (line " in log.read_text(encoding="utf-8")
    (folder / "boom.toml").write_text(good, encoding="utf-8")
    file.write_text(good, encoding="utf-8")
    until(client, "Arm")
    assert client.get("/readyz").json() == {"status": "ready", "exercises": 2}
    assert "Traceback" not in log.read_text(encoding="utf-8")
