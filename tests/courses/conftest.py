"""A course with the learners ada and grace, in a service with keys."""

import asyncio
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Any

import httpx
import pytest
from dh_grader import courses as roll
from dh_grader.access import OPEN_HERE
from dh_grader.access.keys import KeyRing
from dh_grader.api.application import application
from dh_grader.api.permissions import Access
from dh_grader.catalogue import Exercise
from dh_grader.contract.courses import LinksRequest, NewAssignment, NewCourse, NewLearner
from dh_grader.courses import issue_links
from dh_grader.courses.assignments import add_assignment
from dh_grader.store import AttemptStore
from dh_grader.store.database import in_transaction
from sqlalchemy import Connection

from tests.access.kept_services import SECRET, KeptServices

NOW = datetime.now(UTC)
ADDRESS = "http://127.0.0.1:8000"
RIGHT = {"table": "a1 0 0 θ1\na2 180deg 0 θ2\n0 0 d3 0\n0 0 d4 θ4"}
NO_TWIST = {"table": "a1 0 0 θ1\na2 0 0 θ2\n0 0 d3 0\n0 0 d4 θ4"}


@dataclass
class Class:
    """The course ``robots`` in a running service, and each learner's key."""

    store: AttemptStore
    keys: Mapping[str, str]
    app: Any

    def do(self, work: Callable[[Connection], Any]) -> Any:
        """Call ``work`` in a database transaction, and return its result."""
        return in_transaction(self.store.engine, work)

    def assign(self, **more: Any) -> None:
        """Add an assignment: the exercise scara for ten points."""
        exercises = [{"exercise": "scara", "points": 10}]
        fields = {"id": "homework", "title": "Homework", "exercises": exercises, **more}
        new = NewAssignment.model_validate(fields)
        self.do(lambda it: add_assignment(it, "robots", new, {"scara"}))

    async def send(
        self, method: str, path: str, by: str = "ada", key: str = "", **body: Any
    ) -> httpx.Response:
        headers = {"authorization": f"Bearer {self.keys[by]}"}
        if key:
            headers["Idempotency-Key"] = key
        transport = httpx.ASGITransport(self.app)
        async with httpx.AsyncClient(transport=transport, base_url=ADDRESS) as client:
            return await client.request(method, path, json=body or None, headers=headers)

    def ask(self, *words: str, **body: Any) -> httpx.Response:
        return asyncio.run(self.send(*words, **body))

    def hand_in(self, key: str, answers: Any = None, learner: str = "ada") -> httpx.Response:
        """Submit answers to the exercise scara."""
        path = "/v1/courses/robots/assignments/homework/attempts"
        body = {"exercise": "scara", "answers": answers or NO_TWIST}
        return self.ask("POST", path, learner, key, **body)

    def own(self, learner: str = "ada") -> Any:
        [course] = self.ask("GET", "/v1/me", learner).json()["courses"]
        return course["assignments"][0]["exercises"][0]


@pytest.fixture(scope="session")
def services(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[KeptServices]:
    made = KeptServices(request, tmp_path_factory)
    yield made
    made.close()


@pytest.fixture(params=["sqlite"])
def class_(
    request: pytest.FixtureRequest, services: KeptServices, catalogue: Mapping[str, Exercise]
) -> Class:
    def build(store: AttemptStore, keys: KeyRing) -> Any:
        access = Access(OPEN_HERE, read_attempts=None, keys=keys)
        return application(catalogue, access=access, store=store)

    app, store, ring = services.empty(request.param, catalogue, build)
    ring.expect_keys()

    def set_up(connection: Connection) -> dict[str, str]:
        course = NewCourse(id="robots", title="Robots", zone="Europe/Berlin")
        roll.add_course(connection, course, NOW)
        people = [NewLearner(learner=each, name=each.title()) for each in ("ada", "grace")]
        roll.add_learners(connection, "robots", people)
        links = issue_links(connection, "robots", LinksRequest(), SECRET, ADDRESS, NOW)
        return {each.learner: each.link.partition("#")[2] for each in links}

    return Class(store, in_transaction(store.engine, set_up), app)


def days(count: float) -> str:
    """Return the moment ``count`` days from now."""
    return (NOW + timedelta(days=count)).isoformat()
