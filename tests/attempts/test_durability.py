"""An acknowledged attempt survives the death of the process that took it."""

import os
import random
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import httpx
import pytest
from sqlalchemy import select

from service.attempts.database import open_database
from service.attempts.tables import attempts
from tests.api.serving import ROOT, announced_port
from tests.guards import ANSWER

CLIENTS = 4
TABLE = "a1 0 0 θ1\na2 {} 0 θ2\n0 0 d3 0\n0 0 d4 θ4"


class Acknowledged:
    """Posts attempts from several threads until the server is gone; keeps what it was told."""

    def __init__(self, port: int) -> None:
        self._url = f"http://127.0.0.1:{port}/v1/exercises/scara/attempts"
        self.ids: dict[str, str] = {}
        self._threads = [threading.Thread(target=self._post, args=(i,)) for i in range(CLIENTS)]

    def start(self) -> None:
        for thread in self._threads:
            thread.start()

    def join(self) -> None:
        for thread in self._threads:
            thread.join(ANSWER)

    def _post(self, client: int) -> None:
        with httpx.Client(timeout=ANSWER) as http:
            for i in range(100_000):
                key = f"{client}.{i}"
                body = {"learner": f"learner {client}", "answers": {"table": TABLE.format(i)}}
                try:
                    answer = http.post(self._url, json=body, headers={"Idempotency-Key": key})
                except httpx.TransportError:
                    return
                assert answer.status_code == 201, answer.text
                self.ids[key] = answer.json()["attempt"]["id"]


def killed_at_random(url: str, folder: Path, seed: int) -> tuple[dict[str, str], list[str]]:
    """What was acknowledged by key before a kill, and the keys that are in the database after it.

    The second list repeats a key that was recorded twice.
    """
    log = folder / "log"
    environment = os.environ | {"NO_COLOR": "1", "DH_GRADER_DATABASE": url}
    command = [sys.executable, "-m", "service", "serve", "--port", "0"]
    with (
        log.open("wb") as output,
        subprocess.Popen(
            command, cwd=ROOT, stdout=output, stderr=output, env=environment
        ) as process,
    ):
        clients = Acknowledged(announced_port(process, log))
        clients.start()
        while not clients.ids and process.poll() is None:
            time.sleep(0.01)
        time.sleep(random.Random(seed).uniform(0.2, 1.0))
        process.send_signal(signal.SIGKILL)
        clients.join()
    engine = open_database(url)
    with engine.connect() as connection:
        rows = connection.execute(select(attempts.c.idempotency_key, attempts.c.id)).all()
    engine.dispose()
    recorded = {row.idempotency_key: row.id for row in rows}
    assert {key: recorded.get(key) for key in clients.ids} == clients.ids
    return clients.ids, [row.idempotency_key for row in rows]


def test_what_was_acknowledged_is_there_once(database_url: str, tmp_path: Path) -> None:
    acknowledged, recorded = killed_at_random(database_url, tmp_path, 1)
    assert acknowledged
    assert len(recorded) == len(set(recorded))
    # At most the request that each client had under way was recorded without being acknowledged.
    assert len(recorded) - len(acknowledged) <= CLIENTS


@pytest.mark.campaign
@pytest.mark.parametrize("seed", range(20))
def test_every_one_of_many_runs(database_url: str, tmp_path: Path, seed: int) -> None:
    killed_at_random(database_url, tmp_path, seed)
