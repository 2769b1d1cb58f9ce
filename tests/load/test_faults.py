"""No attempt is lost or recorded twice when real faults happen under load."""

# Clients send an attempt again until it is recorded. tests/store has short tests of these
# faults.

import os
import shutil
import sqlite3
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
import pytest

from tests.guards import ANSWER
from tests.load.__main__ import MIXED, misrecorded, replicas
from tests.load.clients import Mix, Results, submitted
from tests.load.proxy import nginx
from tests.server.raw import Service, service
from tests.store.databases import new_database, new_file, postgresql_server
from tests.store.recorded import NO_TWIST

pytestmark = [
    pytest.mark.campaign,
    pytest.mark.skipif(sys.platform != "linux", reason="loopback has one address there"),
]

CLIENTS = 20
SECONDS = 10.0
NGINX = shutil.which("nginx") or shutil.which("nginx", path="/usr/sbin")


@contextmanager
def meanwhile(happens: Callable[[], None], after: float = 2.0) -> Iterator[None]:
    """Call ``happens`` after some seconds, during the ``with`` block."""
    timer = threading.Timer(after, happens)
    timer.start()
    yield
    timer.join()


@contextmanager
def cramped(folder: Path, url: str, most: int) -> Iterator[Service]:
    """Run a service that cannot write large files, as if the disk were full."""
    limited = (
        "import resource, runpy, sys;"
        f"resource.setrlimit(resource.RLIMIT_FSIZE, ({most}, {most}));"
        "sys.argv = ['dh_grader', 'serve', '--port', '0'];"
        "runpy.run_module('dh_grader', run_name='__main__')"
    )
    environment = os.environ | {"NO_COLOR": "1", "DH_GRADER_DATABASE": url}
    log = folder / "cramped-log"
    with (
        log.open("wb") as output,
        subprocess.Popen(
            [sys.executable, "-c", limited], env=environment, stdout=subprocess.DEVNULL,
            stderr=output,
        ) as process,
    ):  # fmt: skip
        try:
            yield Service(process, log)
        finally:
            process.kill()


def post(client: httpx.Client, address: str, key: int) -> httpx.Response:
    body = {"learner": "ada", "answers": {"table": NO_TWIST}}
    return client.post(address, json=body, headers={"Idempotency-Key": str(key)})


def check_grading(port: int) -> None:
    with httpx.Client(base_url=f"http://127.0.0.1:{port}", timeout=ANSWER) as client:
        answer = client.post("/v1/exercises/scara/grade", json={"answers": {}})
        assert answer.status_code == 200
        assert client.get("/healthz").status_code == 200


def test_a_full_disk(tmp_path: Path) -> None:
    url = new_file(tmp_path)
    results = Results()
    with service(tmp_path, DH_GRADER_DATABASE=url) as running:
        submitted([running.port], CLIENTS, 1.0, Mix(recorded=1.0), "before", results)
        assert running.end() == 0
    room = Path(url).stat().st_size + 500_000
    kept = dict(results.attempts)
    with cramped(tmp_path, url, room) as running:
        address = f"http://127.0.0.1:{running.port}/v1/exercises/scara/attempts"
        with httpx.Client(timeout=ANSWER) as client:
            key = 0
            while (answer := post(client, address, key)).status_code == 201:
                kept[str(key)] = answer.json()["attempt"]["id"]
                key += 1
            assert answer.json()["type"].endswith(":store-down")
        check_grading(running.port)
        assert "The database fails" in running.log
    assert len(kept) > len(results.attempts)
    assert misrecorded(url, kept) == []
    # With free space again, the refused attempt is recorded under the same key.
    with service(tmp_path, DH_GRADER_DATABASE=url) as running:
        address = f"http://127.0.0.1:{running.port}/v1/exercises/scara/attempts"
        with httpx.Client(timeout=ANSWER) as client:
            assert post(client, address, key).status_code == 201


def test_a_file_that_another_program_locks(tmp_path: Path) -> None:
    url = new_file(tmp_path)
    with service(tmp_path, DH_GRADER_DATABASE=url) as running:

        def lock() -> None:
            other = sqlite3.connect(url, isolation_level=None)
            other.execute("BEGIN EXCLUSIVE")
            time.sleep(8.0)
            other.execute("ROLLBACK")
            other.close()

        with meanwhile(lock):
            results = submitted([running.port], CLIENTS, SECONDS, MIXED, "locked")
        assert running.end() == 0
    assert results.failures == []
    # The service waits for five seconds.
    assert results.refused > 0
    assert misrecorded(url, results.attempts) == []


def test_a_server_that_stops_and_starts_again(tmp_path: Path) -> None:
    with postgresql_server() as server:
        url = new_database(server, "attempts")
        with replicas(tmp_path, 2, 1, url) as running:

            def restart() -> None:
                server.stop()
                time.sleep(2.0)
                check_grading(running[0].port)
                server.start()

            ports = [each.port for each in running]
            with meanwhile(restart):
                results = submitted(ports, CLIENTS, SECONDS, MIXED, "stopped")
            assert [each.end() for each in running] == [0, 0]
        assert results.failures == []
        assert results.refused > 0
        assert misrecorded(url, results.attempts) == []


@pytest.mark.skipif(NGINX is None, reason="nginx is not installed")
def test_a_replica_behind_the_proxy_of_compose_that_is_killed(tmp_path: Path) -> None:
    assert NGINX
    with postgresql_server() as server:
        url = new_database(server, "attempts")
        settings = {"DH_GRADER_METRICS": "all", "FORWARDED_ALLOW_IPS": "*"}
        with (
            replicas(tmp_path, 2, 1, url, **settings) as running,
            nginx(NGINX, tmp_path, [each.port for each in running]) as port,
        ):
            address = f"http://127.0.0.1:{port}"
            named = httpx.get(f"{address}/healthz", headers={"X-Request-ID": "mine"})
            assert named.headers["x-request-id"] == "mine"
            assert httpx.get(f"{address}/metrics").status_code == 404
            # The pause keeps the clients below the rate limit of the proxy.
            with meanwhile(running[0].process.kill):
                results = submitted(
                    [port], CLIENTS, SECONDS, Mix(recorded=0.5), "killed", pause=0.2
                )
            assert running[1].end() == 0
        # Requests in the killed replica are answered with 502, or their connections end.
        assert [each for each in results.failures if " 502 " not in each] == []
        assert len(results.failures) <= CLIENTS
        assert len(results.attempts) > CLIENTS
        assert misrecorded(url, results.attempts) == []
