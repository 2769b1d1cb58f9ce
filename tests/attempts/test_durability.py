"""An acknowledged attempt survives the death of the process that took it, and is recorded once."""

import os
import random
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Sequence
from contextlib import ExitStack
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
    """Posts attempts from several threads while there is a replica; keeps what it was told.

    Where one has died, a request is sent again to the next, with the same key; every fifth is sent
    to all of them.
    """

    def __init__(self, ports: Sequence[int]) -> None:
        self._urls = [f"http://127.0.0.1:{port}/v1/exercises/scara/attempts" for port in ports]
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
                told: set[str] = set()
                for k in range(len(self._urls)):
                    url = self._urls[(client + k) % len(self._urls)]
                    try:
                        answer = http.post(url, json=body, headers={"Idempotency-Key": key})
                    except httpx.TransportError:
                        continue
                    assert answer.status_code == 201, answer.text
                    told.add(answer.json()["attempt"]["id"])
                    if i % 5:
                        break
                if not told:
                    return
                (self.ids[key],) = told


def killed_at_random(url: str, folder: Path, seed: int, replicas: int) -> None:
    """Kill one replica and then the others; all that was acknowledged must be there, once."""
    dice = random.Random(seed)
    environment = os.environ | {"NO_COLOR": "1", "DH_GRADER_DATABASE": url}
    command = [sys.executable, "-m", "service", "serve", "--port", "0"]
    logs = [folder / f"log{i}" for i in range(replicas)]
    with ExitStack() as stack:
        processes = []
        for log in logs:
            output = stack.enter_context(log.open("wb"))
            process = subprocess.Popen(
                command, cwd=ROOT, stdout=output, stderr=output, env=environment
            )
            stack.enter_context(process)
            stack.callback(process.kill)
            processes.append(process)
        clients = Acknowledged(list(map(announced_port, processes, logs)))
        clients.start()
        for process in processes:
            seen = len(clients.ids)
            while len(clients.ids) == seen and process.poll() is None:
                time.sleep(0.01)
            time.sleep(dice.uniform(0.1, 0.8))
            process.send_signal(signal.SIGKILL)
        clients.join()
    engine = open_database(url)
    with engine.connect() as connection:
        rows = connection.execute(select(attempts.c.idempotency_key, attempts.c.id)).all()
    engine.dispose()
    recorded = {row.idempotency_key: row.id for row in rows}
    assert clients.ids
    assert {key: recorded.get(key) for key in clients.ids} == clients.ids
    assert len(rows) == len(recorded)
    # At most the request that each client had under way was recorded without being acknowledged.
    assert len(recorded) - len(clients.ids) <= CLIENTS


def test_what_was_acknowledged_is_in_the_file_once(sqlite_url: str, tmp_path: Path) -> None:
    killed_at_random(sqlite_url, tmp_path, 1, 1)


def test_what_one_of_two_replicas_acknowledged_is_there_once(
    postgresql_url: str, tmp_path: Path
) -> None:
    killed_at_random(postgresql_url, tmp_path, 1, 2)


@pytest.mark.campaign
@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize(
    ("kind", "replicas"), [("sqlite", 1), ("sqlite", 2), ("postgresql", 1), ("postgresql", 2)]
)
def test_every_one_of_many_runs(
    request: pytest.FixtureRequest, tmp_path: Path, kind: str, replicas: int, seed: int
) -> None:
    killed_at_random(request.getfixturevalue(f"{kind}_url"), tmp_path, seed, replicas)
