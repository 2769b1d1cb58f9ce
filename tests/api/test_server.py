"""Test a process that serves requests."""

import json
import os
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from dh_grader.authoring import exercise_template

from tests.api.serving import ROOT, Served, served
from tests.guards import ANSWER

# --- Test the real process, `python -m dh_grader serve`, on a free port

GRADE = "/v1/exercises/planar-rrr/grade"


def test_it_grades_and_does_not_name_its_server(server: Served) -> None:
    response = httpx.post(
        f"{server.address}{GRADE}", json={"answers": {}}, trust_env=False, timeout=ANSWER
    )
    assert response.status_code == 200
    assert response.json()["exercise"] == "planar-rrr"
    assert "server" not in response.headers
    assert response.headers["x-content-type-options"] == "nosniff"


def test_it_grades_many_in_one_request(server: Served) -> None:
    content = (ROOT / "docs" / "examples" / "many.json").read_bytes()
    url = f"{server.address}/v1/grade"
    response = httpx.post(url, content=content, trust_env=False, timeout=ANSWER)
    assert response.status_code == 200
    right, refused = response.json()["results"]
    assert (right["report"]["exercise"], right["report"]["points"]) == ("planar-rr", 2)
    assert refused["problem"]["status"] == 404


def test_head_has_no_body_on_the_wire(server: Served) -> None:
    url = f"{server.address}/v1/exercises"
    with httpx.Client(trust_env=False, timeout=ANSWER) as client:
        plain = {"accept-encoding": "identity"}
        length = int(client.head(url, headers=plain).headers["content-length"])
        assert length == len(client.get(url, headers=plain).content)
        # Compressed, both have the same length.
        packed = client.get(url)
        assert packed.headers["content-encoding"] == "gzip"
        assert client.head(url).headers["content-length"] == packed.headers["content-length"]
        assert int(packed.headers["content-length"]) < length / 3


@pytest.mark.parametrize("framing", [b"Content-Length: 20000000", b"Transfer-Encoding: chunked"])
@pytest.mark.parametrize("path", [GRADE, "/v1/preview"])
def test_twenty_megabytes_are_refused_while_they_are_still_coming(
    server: Served, path: str, framing: bytes
) -> None:
    chunked = b"chunked" in framing
    piece = b" " * 65536
    if chunked:
        piece = b"10000\r\n" + piece + b"\r\n"
    with socket.create_connection(("127.0.0.1", server.port), timeout=ANSWER) as connection:
        head = f"POST {path} HTTP/1.1\r\nHost: x\r\n".encode() + framing + b"\r\n\r\n"
        connection.sendall(head)
        # Five pieces are over the limit; the rest of the 20 MB is never sent.
        for _ in range(5 if chunked else 1):
            connection.sendall(piece)
        answer = b""
        while received := receive(connection):
            answer += received
    head, _, body = answer.partition(b"\r\n\r\n")
    assert head.startswith(b"HTTP/1.1 413 ")
    assert json.loads(body)["status"] == 413


def receive(connection: socket.socket) -> bytes:
    """Return the bytes that have arrived; none if the server has closed the connection."""
    try:
        return connection.recv(65536)
    except ConnectionResetError:
        return b""


@pytest.mark.long
def test_a_bad_exercise_file_prevents_startup(tmp_path: Path) -> None:
    (tmp_path / "broken.toml").write_text('title = "x"\n', encoding="utf-8")
    environment = os.environ | {"DH_GRADER_EXERCISES_DIR": str(tmp_path)}
    result = subprocess.run(
        [sys.executable, "-m", "dh_grader", "serve", "--port", "0"],
        cwd=ROOT, env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert result.returncode == 2
    assert "broken.toml: source: Field required" in result.stderr
    assert "Traceback" not in result.stderr


@pytest.mark.long
def test_a_bad_exercise_file_prevents_startup_under_another_server(tmp_path: Path) -> None:
    environment = os.environ | {"DH_GRADER_EXERCISES_DIR": str(tmp_path)}
    result = subprocess.run(
        [sys.executable, "-m", "uvicorn", "dh_grader.app:app", "--port", "0"],
        cwd=ROOT, env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert result.returncode != 0
    assert "holds no exercise file" in result.stderr
    assert "Traceback" not in result.stderr


# --- A real server reloads exercise files that change


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    place = tmp_path / "exercises"
    place.mkdir()
    (place / "arm.toml").write_text(exercise_template("arm"), encoding="utf-8")
    return place


@pytest.fixture
def reloading_server(folder: Path, tmp_path: Path) -> Iterator[Served]:
    settings = {"EXERCISES_DIR": str(folder), "RELOAD_EXERCISES": "true", "SOLUTIONS": "true"}
    environment = {f"DH_GRADER_{name}": value for name, value in settings.items()}
    with served(tmp_path, **environment) as server:
        yield server


@pytest.fixture
def log(reloading_server: Served) -> Path:
    return reloading_server.log


@pytest.fixture
def reloading_client(reloading_server: Served) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=reloading_server.address, trust_env=False, timeout=ANSWER) as client:
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
    reloading_client: httpx.Client, folder: Path, log: Path
) -> None:
    file, good = folder / "arm.toml", exercise_template("arm")
    assert title(reloading_client) == "Arm"
    before = reloading_client.get("/v1/exercises/arm/solution").json()
    file.write_text(good.replace('"Arm"', '"A better arm"'), encoding="utf-8")
    until(reloading_client, "A better arm")
    solution = reloading_client.get("/v1/exercises/arm/solution").json()
    assert solution["version"] != before["version"]
    file.write_text(good.replace('"0",     "d2", "0"', '"0",     "d7", "0"'), encoding="utf-8")
    while "its last good version stays" not in log.read_text(encoding="utf-8"):
        assert title(reloading_client) == "A better arm"
        graded = reloading_client.post("/v1/exercises/arm/grade", json={"answers": {"table": "?"}})
        assert graded.status_code == 200
        time.sleep(0.05)
    assert "arm.toml: robot.table[1].d (line " in log.read_text(encoding="utf-8")
    (folder / "boom.toml").write_text(good, encoding="utf-8")
    file.write_text(good, encoding="utf-8")
    until(reloading_client, "Arm")
    assert reloading_client.get("/readyz").json() == {"status": "ready", "exercises": 2}
    assert "Traceback" not in log.read_text(encoding="utf-8")
