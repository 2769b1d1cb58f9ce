"""Test that what was acknowledged is kept, and servers of databases that stop."""

import asyncio
import os
import random
import re
import threading
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import count
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.catalogue import Exercise
from dh_grader.server import serve
from dh_grader.settings import Settings
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.database import open_database
from dh_grader.store.tables import attempts
from pydantic import SecretStr
from sqlalchemy import select

from tests.guards import ANSWER
from tests.server.raw import service
from tests.store.databases import STOPS, new_database, start, stop
from tests.store.recorded import NO_TWIST, RIGHT, new_attempt, record_once

# --- Acknowledged attempts survive when the process is killed, and are recorded exactly once

CLIENTS = 4
TABLE = "a1 0 0 θ1\na2 {} 0 θ2\n0 0 d3 0\n0 0 d4 θ4"


class Acknowledged:
    """Posts attempts from several threads, and stores the ids of confirmed attempts."""

    # If a replica is dead, the request is sent to the next replica with the same key. Every fifth
    # request is sent to all replicas.
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


def _serve(url: str, log: Path) -> None:
    output = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(output, 1)
    os.dup2(output, 2)
    serve(Settings(port=0, database=SecretStr(url)))


def _port(process: BaseProcess, log: Path) -> int:
    while True:
        alive = process.is_alive()
        text = log.read_text(encoding="utf-8") if log.exists() else ""
        if found := re.search(r"running on http://127\.0\.0\.1:(\d+)", text):
            return int(found[1])
        assert alive, text
        time.sleep(0.02)


def killed_at_random(
    url: str, folder: Path, killable: Any, replicas: int, seed: int, most: float
) -> None:
    """Kill replicas one after the other; assert that confirmed attempts are recorded once."""
    # After each kill, wait for a response of another replica and up to `most` seconds more.
    dice = random.Random(seed)
    logs = [folder / f"log{i}" for i in range(replicas)]
    processes = [killable(target=_serve, args=(url, log), daemon=True) for log in logs]
    for process in processes:
        process.start()
    clients = Acknowledged(list(map(_port, processes, logs)))
    clients.start()
    for process in processes:
        seen = len(clients.ids)
        while len(clients.ids) == seen and process.is_alive():
            time.sleep(0.01)
        time.sleep(dice.uniform(0.1, most))
        process.kill()
    clients.join()
    assert_recorded_once(url, clients.ids)


def assert_recorded_once(url: str, acknowledged: Mapping[str, str]) -> None:
    engine = open_database(url)
    with engine.connect() as connection:
        rows = connection.execute(select(attempts.c.idempotency_key, attempts.c.id)).all()
    engine.dispose()
    recorded = {row.idempotency_key: row.id for row in rows}
    assert acknowledged
    assert {key: recorded.get(key) for key in acknowledged} == acknowledged
    assert len(rows) == len(recorded)
    # For each client, at most one request was recorded without being acknowledged.
    assert len(recorded) - len(acknowledged) <= CLIENTS


def _record(url: str, exercise: Exercise, told: Connection) -> None:
    new, outcome = new_attempt(exercise, "ada", RIGHT, None)
    store = AttemptStore.open(url)
    store.start()

    async def client(number: int) -> None:
        for i in count():
            written = await record_once(
                store, replace(new, idempotency_key=f"{number}.{i}"), outcome
            )
            assert written is not None
            told.send((written.idempotency_key, written.id))

    async def clients() -> None:
        await asyncio.gather(*map(client, range(CLIENTS)))

    asyncio.run(clients())


@pytest.mark.long
def test_acknowledged_attempts_are_in_the_file_once(
    sqlite_url: str, catalogue: Mapping[str, Exercise], killable: Any
) -> None:
    told, telling = Pipe(duplex=False)
    process = killable(target=_record, args=(sqlite_url, catalogue["scara"], telling))
    process.start()
    telling.close()
    acknowledged: dict[str, str] = {}
    # The process may be killed in the middle of a message.
    with suppress(EOFError, OSError):
        while True:
            key, attempt = told.recv()
            acknowledged[key] = attempt
            if len(acknowledged) == 150:
                process.kill()
    process.join()
    assert_recorded_once(sqlite_url, acknowledged)


@pytest.mark.long
def test_attempts_acknowledged_by_one_of_two_replicas_are_recorded_once(
    postgresql_url: str, tmp_path: Path, killable: Any
) -> None:
    killed_at_random(postgresql_url, tmp_path, killable, 2, 1, 0.2)


@pytest.mark.campaign
@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize(
    ("kind", "replicas"), [("sqlite", 1), ("sqlite", 2), ("postgresql", 1), ("postgresql", 2)]
)
def test_acknowledged_attempts_survive_kills_at_random_moments(
    request: pytest.FixtureRequest,
    tmp_path: Path,
    killable: Any,
    kind: str,
    replicas: int,
    seed: int,
) -> None:
    url = request.getfixturevalue(f"{kind}_url")
    killed_at_random(url, tmp_path, killable, replicas, seed, 0.8)


# --- PostgreSQL stops during recording: no attempt is lost, and clients get a clear response

ATTEMPTS = "/v1/exercises/scara/attempts"


class Course:
    """Learners who repeat each request until their attempt is recorded."""

    def __init__(self, client: httpx.AsyncClient) -> None:
        self._client = client
        self.ids: dict[str, str] = {}
        self.refused = 0
        self.over = False

    async def learner(self, name: str) -> None:
        body = {"learner": name, "answers": {"table": NO_TWIST}}
        number = 0
        while not self.over:
            key = f"{name}.{number}"
            answer = await self._client.post(ATTEMPTS, json=body, headers={"Idempotency-Key": key})
            if answer.status_code == 201:
                self.ids[key] = answer.json()["attempt"]["id"]
                number += 1
                continue
            self.check(answer)
            self.refused += 1
            await asyncio.sleep(0.01)

    def check(self, answer: httpx.Response) -> None:
        told = answer.status_code, answer.headers.get("retry-after"), answer.json()["type"]
        assert told == (503, "5", "urn:dh-grader:problem:store-down")

    async def more(self) -> None:
        known = len(self.ids)
        while len(self.ids) < known + 2 * CLIENTS:
            await asyncio.sleep(0.01)

    async def survive(self, server: Any, how: str) -> None:
        await self.more()
        await asyncio.to_thread(stop, server, how)
        known = self.refused
        while self.refused < known + CLIENTS:
            await asyncio.sleep(0.01)
        self.check(await self._client.get("/readyz"))
        graded = await self._client.post("/v1/exercises/scara/grade", json={"answers": {}})
        assert graded.status_code == 200
        await asyncio.to_thread(start, server, how)
        await self.more()
        # A check may take longer than the time limit of this test on a busy machine.
        while (await self._client.get("/readyz")).status_code != 200:
            await asyncio.sleep(0.01)


@pytest.mark.long
def test_every_acknowledged_attempt_is_recorded_once_however_the_server_stops(
    postgresql: Any,
    postgresql_url: str,
    catalogue: Mapping[str, Exercise],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("dh_grader.store.database._TIMEOUT", 0.5)
    store = AttemptStore.open(postgresql_url)
    store.start()

    async def term() -> Course:
        transport = httpx.ASGITransport(application(catalogue, store=store))
        async with httpx.AsyncClient(transport=transport, base_url="http://service") as client:
            course = Course(client)
            async with asyncio.TaskGroup() as learners:
                for i in range(CLIENTS):
                    learners.create_task(course.learner(f"learner {i}"))
                for how in STOPS:
                    await course.survive(postgresql, how)
                course.over = True
        return course

    course = asyncio.run(term())
    with store.engine.connect() as connection:
        rows = connection.execute(select(attempts.c.idempotency_key, attempts.c.id)).all()
    store.close()
    assert sorted((key, found) for key, found in rows) == sorted(course.ids.items())


@pytest.mark.long
def test_a_service_ends_in_time_although_its_database_does_not_react(
    postgresql: Any, tmp_path: Path
) -> None:
    url = new_database(postgresql, "paused")
    with service(tmp_path, module="tests.server.impatient", DH_GRADER_DATABASE=url) as running:
        address = f"http://127.0.0.1:{running.port}"
        body = {"learner": "ada", "answers": {"table": NO_TWIST}}
        assert httpx.post(address + ATTEMPTS, json=body, timeout=ANSWER).status_code == 201
        stop(postgresql, "pause")
        try:
            # From here on the service waits for its check of the database.
            ready = httpx.get(f"{address}/readyz", timeout=ANSWER)
            assert (ready.status_code, "does not react within" in running.log) == (503, True)
            assert running.end() == 0
        finally:
            start(postgresql, "pause")
        assert "exiting without waiting" in running.log
