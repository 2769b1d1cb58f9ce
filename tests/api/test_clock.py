"""If the clock jumps by hours, the service loses no attempt and blocks nobody for long."""

import asyncio
import csv
import importlib
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import asynccontextmanager
from dataclasses import replace
from datetime import UTC, datetime, timedelta, tzinfo
from pathlib import Path
from typing import Any

import httpx
import pytest
from dh_grader.access import OPEN_HERE, Caller, Scope, Secret, new_key_text
from dh_grader.access.key_ring import KeyRing, add_key, settle
from dh_grader.access.rates import Rates
from dh_grader.api.application import application
from dh_grader.api.permissions import Access
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.schema_fields import AttemptsSpec
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.database import in_transaction

from tests.store.databases import new_file
from tests.store.recorded import LAZY, NO_TWIST, RIGHT

SECRET = Secret("0123456789abcdef" * 4)
ATTEMPTS = "/v1/exercises/scara/attempts"


class Clock:
    """A clock that is ``ahead`` of the real time."""

    def __init__(self) -> None:
        self.ahead = timedelta()


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock, real_time = Clock(), time.time
    # The module is imported with the first token.
    importlib.import_module("dh_grader.access.key_ring")

    class Told(datetime):
        @classmethod
        def now(cls, tz: tzinfo | None = None) -> datetime:  # type: ignore[override]
            return datetime.now(tz) + clock.ahead

    for name, module in list(sys.modules.items()):
        own = name.startswith(("dh_grader.", "jwt."))
        if own and getattr(module, "datetime", None) is datetime:
            monkeypatch.setattr(module, "datetime", Told)
    monkeypatch.setattr(time, "time", lambda: real_time() + clock.ahead.total_seconds())
    return clock


class Term:
    """A service with an API key, for tests in which the clock jumps."""

    def __init__(self, store: AttemptStore, clock: Clock, scara: Exercise, **rules: Any) -> None:
        now = datetime.now(UTC)
        self._clock = clock
        self._key = new_key_text()
        in_transaction(store.engine, lambda connection: settle(connection, SECRET, now))
        in_transaction(
            store.engine,
            lambda connection: add_key(
                connection, "course", SECRET.key_digest(self._key),
                (Scope.RECORD, Scope.TUTOR), None, now, now + timedelta(days=1),
            ),
        )  # fmt: skip
        ring = KeyRing(store.engine, SECRET)
        access = Access(OPEN_HERE, solutions=None, read_attempts=None, keys=ring)
        exercise = replace(scara, attempts=AttemptsSpec(**rules))
        self._app = application({"scara": exercise}, store=store, access=access)

    def at(self, hours: float) -> None:
        self._clock.ahead = timedelta(hours=hours)

    @asynccontextmanager
    async def _client(self) -> Any:
        transport = httpx.ASGITransport(self._app)
        async with httpx.AsyncClient(transport=transport, base_url="http://service") as client:
            yield client

    def ask(self, method: str, path: str, by: str = "", **more: Any) -> httpx.Response:
        async def asked() -> httpx.Response:
            headers = {"authorization": f"Bearer {by or self._key}", **more.pop("headers", {})}
            async with self._client() as client:
                found: httpx.Response = await client.request(method, path, headers=headers, **more)
                return found

        return asyncio.run(asked())

    def post(self, table: str, key: str, by: str = "") -> httpx.Response:
        body = {"learner": "ada", "answers": {"table": table}}
        return self.ask("POST", ATTEMPTS, by, json=body, headers={"Idempotency-Key": key})


@pytest.fixture
def store(tmp_path: Path) -> Iterator[AttemptStore]:
    store = AttemptStore.open(new_file(tmp_path))
    store.start()
    yield store
    store.close()


def problem(response: httpx.Response) -> tuple[int, str]:
    return response.status_code, response.json()["type"].rpartition(":")[2]


@pytest.mark.long
def test_attempts_keep_their_order_and_their_keys(
    store: AttemptStore, clock: Clock, catalogue: Mapping[str, Exercise]
) -> None:
    term = Term(store, clock, catalogue["scara"], limit=3, counts="last")
    first = term.post(LAZY, "first")
    term.at(5)
    second = term.post(NO_TWIST, "second")
    page = term.ask("GET", "/v1/attempts?limit=1").json()
    seen = [each["ordinal"] for each in page["attempts"]]
    term.at(-5)
    third = term.post(RIGHT, "third")
    assert [each.json()["attempt"]["ordinal"] for each in (first, second, third)] == [1, 2, 3]
    # No attempt is lost or doubled, and the key is known whatever the time is.
    assert problem(term.post(RIGHT, "fourth")) == (403, "no-attempts-left")
    assert term.post(LAZY, "first").content == first.content
    while page.get("next"):
        page = term.ask("GET", f"/v1/attempts?limit=1&cursor={page['next']}").json()
        seen += [each["ordinal"] for each in page["attempts"]]
    # Each attempt once, ordered by time, also the one recorded between two pages.
    assert seen == [2, 1, 3]
    lines = term.ask("GET", "/v1/attempts/export?format=csv").content.decode("utf-8-sig")
    counting = {row["ordinal"]: row["counts"] for row in csv.DictReader(lines.splitlines())}
    assert counting == {"1": "false", "2": "false", "3": "true"}
    step = term.ask("POST", "/v1/exercises/scara/regrade", json={"apply": True}).json()
    assert (step["regraded"], step["left"]) == (0, 0)


@pytest.mark.long
def test_deadlines_and_tokens_follow_the_clock_and_come_back_with_it(
    store: AttemptStore, clock: Clock, catalogue: Mapping[str, Exercise]
) -> None:
    now = datetime.now(UTC)
    term = Term(
        store, clock, catalogue["scara"],
        opens=now - timedelta(hours=1), due=now + timedelta(hours=3),
    )  # fmt: skip
    made = term.ask("POST", "/v1/tokens", json={"learner": "ada", "minutes": 60}).json()
    token = made["token"]
    for hours, answer in (
        (0, (201, "")),
        (0.9, (201, "")),
        (2, (401, "key-not-valid")),
        (-0.5, (201, "")),
        (-2, (403, "not-open")),
        (0, (201, "")),
    ):
        term.at(hours)
        told = term.post(NO_TWIST, f"at {hours}", token)
        assert (told.status_code, hours) == (answer[0], hours)
        assert told.status_code == 201 or problem(told) == answer
    term.at(4)
    assert problem(term.post(NO_TWIST, "late")) == (403, "closed")
    term.at(25)
    assert term.post(NO_TWIST, "late").status_code == 401
    term.at(0)
    assert term.post(NO_TWIST, "in time").status_code == 201


@pytest.mark.parametrize("jump", [-48, -3, -0.01, 0.01, 3, 48])
def test_a_rate_limit_blocks_nobody_for_longer_than_its_period(clock: Clock, jump: float) -> None:
    rates = Rates(per_address="5/minute")
    caller = Caller(frozenset())

    async def waits(number: int) -> list[int]:
        return [await rates.seconds_to_wait(caller, "192.0.2.7") for _ in range(number)]

    assert asyncio.run(waits(5)) == [0] * 5
    assert 0 < asyncio.run(waits(1))[0] <= 60
    clock.ahead = timedelta(hours=jump)
    after = asyncio.run(waits(20))
    rates.close()
    # A jump of less than a minute may delay a request by that jump.
    assert max(after) <= 60 + 36
    assert sum(wait == 0 for wait in after) <= 5
