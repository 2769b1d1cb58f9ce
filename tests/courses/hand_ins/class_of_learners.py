"""A course whose learners repeat each hand-in until it is confirmed."""

import asyncio
import json
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import UTC, datetime
from itertools import count
from typing import Any, Final

from dh_grader.access import Secret
from dh_grader.contract.courses import LinksRequest, NewAssignment, NewCourse, NewLearner
from dh_grader.courses import roll
from dh_grader.courses.assignments import add_assignment
from dh_grader.courses.roll import issue_links
from dh_grader.store.database import in_transaction, open_database
from sqlalchemy import Connection

from tests.guards import ANSWER

COURSE: Final = "robots"
SECRET: Final = "0123456789abcdef" * 4
# How often a hand-in is sent again if its connection breaks.
TRIES: Final = 1200


@dataclass(frozen=True)
class HandIn:
    """A learner's hand-in, ``at`` seconds after the start."""

    learner: str
    assignment: str
    key: str
    at: float
    body: Mapping[str, Any]


@dataclass
class Outcome:
    """The waiting times in seconds, and the ids of the attempts."""

    waits: list[float] = field(default_factory=list)
    attempts: dict[str, str] = field(default_factory=dict)
    is_late: dict[str, bool] = field(default_factory=dict)
    refused: dict[str, str] = field(default_factory=dict)
    failures: list[str] = field(default_factory=list)
    lost_connections: int = 0

    def quantile(self, share: float) -> float:
        ordered = sorted(self.waits)
        return ordered[min(int(len(ordered) * share), len(ordered) - 1)]


def enrol(url: str, learners: Sequence[str]) -> dict[str, str]:
    """Create the course with these learners; return the keys in their links."""
    engine, now = open_database(url), datetime.now(UTC)

    def work(connection: Connection) -> dict[str, str]:
        roll.add_course(connection, NewCourse(id=COURSE, title="R", zone="Europe/Berlin"), now)
        people = [NewLearner(learner=each, name=each) for each in learners]
        roll.add_learners(connection, COURSE, people)
        links = issue_links(connection, COURSE, LinksRequest(), Secret(SECRET), "", now)
        return {each.learner: each.link.partition("#")[2] for each in links}

    keys = in_transaction(engine, work)
    engine.dispose()
    return keys


def assign(url: str, name: str, exercises: Sequence[str], **fields: Any) -> None:
    chosen = [{"exercise": each, "points": 10} for each in exercises]
    new = NewAssignment.model_validate({"id": name, "title": name, "exercises": chosen, **fields})
    engine = open_database(url)
    in_transaction(engine, lambda it: add_assignment(it, COURSE, new, exercises))
    engine.dispose()


class Learners:
    """Simulated learners who hand in over HTTP."""

    # Each learner has a separate address, and each hand-in has a separate connection. If the
    # connection breaks, the learner sends the hand-in again with the same key, to the next of the
    # `ports`.
    def __init__(self, ports: Sequence[int], keys: Mapping[str, str], outcome: Outcome) -> None:
        self._ports = ports
        self._keys = keys
        self._outcome = outcome
        self._turn = count()
        addresses = enumerate(keys)
        self._sources = {each: f"127.2.{i // 250}.{i % 250 + 1}" for i, each in addresses}

    async def all_hand_in(self, hand_ins: Sequence[HandIn]) -> None:
        """Send each hand-in at its time, and repeat it until the service answers."""
        began = time.perf_counter()
        await asyncio.gather(*(self._hand_in(each, began + each.at) for each in hand_ins))

    async def _hand_in(self, hand_in: HandIn, at: float) -> None:
        await asyncio.sleep(max(0.0, at - time.perf_counter()))
        pressed, told, first = time.perf_counter(), self._outcome, next(self._turn)
        for i in range(TRIES):
            port = self._ports[(first + i) % len(self._ports)]
            try:
                status, answer = await asyncio.wait_for(self._posted(port, hand_in), ANSWER)
            except TimeoutError:
                told.failures.append(f"{hand_in.key}: no answer")
                return
            except (OSError, EOFError):
                told.lost_connections += 1
                await asyncio.sleep(0.1)
                continue
            break
        else:
            told.failures.append(f"{hand_in.key}: never confirmed")
            return
        found = json.loads(answer)
        if status == 201:
            told.waits.append(time.perf_counter() - pressed)
            told.attempts[hand_in.key] = found["attempt"]["id"]
            told.is_late[hand_in.key] = found["attempt"]["is_late"]
        elif status == 403:
            told.refused[hand_in.key] = found["type"].rpartition(":")[2]
        else:
            told.failures.append(f"{hand_in.key}: {status} {answer[:200].decode()}")

    async def _posted(self, port: int, hand_in: HandIn) -> tuple[int, bytes]:
        content = json.dumps(hand_in.body).encode()
        head = (
            f"POST /v1/courses/{COURSE}/assignments/{hand_in.assignment}/attempts HTTP/1.1\r\n"
            f"Host: localhost\r\nAuthorization: Bearer {self._keys[hand_in.learner]}\r\n"
            f"Idempotency-Key: {hand_in.key}\r\nContent-Type: application/json\r\n"
            f"Connection: close\r\nContent-Length: {len(content)}\r\n\r\n"
        )
        reader, writer = await asyncio.open_connection(
            "127.0.0.1", port, local_addr=(self._sources[hand_in.learner], 0)
        )
        try:
            writer.write(head.encode() + content)
            answer = await reader.readuntil(b"\r\n\r\n")
            length = int(answer.lower().partition(b"content-length:")[2].split(b"\r\n")[0])
            return int(answer.split(b" ", 2)[1]), await reader.readexactly(length)
        finally:
            writer.close()
            with suppress(OSError):
                await writer.wait_closed()
