"""PostgreSQL stops during recording: no attempt is lost, and clients get a clear response."""

import asyncio
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.catalogue import Exercise
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.tables import attempts
from sqlalchemy import select

from tests.attempts.databases import STOPS, new_database, start, stop
from tests.attempts.recorded import NO_TWIST
from tests.guards import ANSWER
from tests.server.raw import service

CLIENTS = 4
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
