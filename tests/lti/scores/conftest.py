"""Fixtures: a course at a platform whose gradebook gets scores, and a clock."""

import itertools
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from typing import Any

import pytest
from dh_grader.lti.fetching import published_keys
from dh_grader.lti.launch import pseudonym
from dh_grader.lti.outbox import ScoreSender
from dh_grader.store import tables
from dh_grader.store.results import everything_of
from sqlalchemy import Row, select

from tests.access.kept_services import SECRET
from tests.lti.conftest import Tool, token_of
from tests.lti.gradebook import Gradebook

# An answer that earns points, and one that earns none.
RIGHT = {"table": "a1 0 0 θ1\na2 0 0 θ2"}
WRONG = {"table": "7 1 1 0\n7 1 1 0"}


@dataclass
class Clock:
    """The time of this machine, plus the time that tests have added."""

    added: timedelta = timedelta()

    def now(self) -> datetime:
        return datetime.now(UTC) + self.added

    def go_on(self, **more: float) -> None:
        self.added += timedelta(**more)


@dataclass
class Journey:
    """Learners who submit answers, and a service that sends their scores to the platform."""

    tool: Tool
    clock: Clock
    sender: ScoreSender
    tokens: dict[str, dict[str, str]] = field(default_factory=dict)
    numbers: Iterator[int] = field(default_factory=itertools.count)

    @property
    def gradebook(self) -> Gradebook:
        return self.tool.platform.gradebook

    def launch(self, user: str = "ada", link: str = "link-1") -> None:
        page = self.tool.launch(user, link).text
        self.tokens[user] = {"authorization": f"Bearer {token_of(page)}"}

    def place(self, user: str = "ada", number: int = 0) -> tuple[str, str]:
        view = self.tool.send("GET", "/v1/me", headers=self.tokens[user]).json()
        course = view["courses"][0]
        return course["id"], course["assignments"][number]["id"]

    def hand_in(
        self,
        user: str = "ada",
        answers: dict[str, Any] = RIGHT,
        exercise: str = "planar-rr",
        number: int = 0,
    ) -> dict[str, Any]:
        """Submit answers as a learner, three seconds ago; return the recorded attempt."""
        if user not in self.tokens:
            self.launch(user)
        course, assignment = self.place(user, number)
        answer = self.tool.send(
            "POST",
            f"/v1/courses/{course}/assignments/{assignment}/attempts",
            json={"exercise": exercise, "answers": answers},
            headers=self.tokens[user] | {"Idempotency-Key": str(next(self.numbers))},
        )
        assert answer.status_code == 201, answer.text
        self.clock.go_on(seconds=3)
        found: dict[str, Any] = answer.json()["attempt"]
        return found

    def total(self, user: str = "ada") -> float:
        course, assignment = self.place(user)
        learner = self.learner(user)
        path = f"/v1/courses/{course}/gradebook?assignment={assignment}"
        rows = self.tool.send("GET", path, headers=self.tutor()).json()["rows"]
        [total] = [row["total"] for row in rows if row["learner"] == learner]
        return float(total)

    def learner(self, user: str = "ada") -> str:
        """Return the pseudonym that the service uses for a user of the platform."""
        return pseudonym("moodle", f"user {user}", SECRET)

    def known(self, user: str = "ada") -> dict[str, Any]:
        """Return all data that the service stores about a user of the platform."""
        with self.tool.store.engine.connect() as connection:
            return everything_of(connection, self.learner(user))

    def post(self, path: str, **body: Any) -> dict[str, Any]:
        """Send a tutor's request."""
        answer = self.tool.send("POST", f"/v1/{path}", json=body, headers=self.tutor())
        assert answer.status_code < 300, answer.text
        found: dict[str, Any] = answer.json()
        return found

    def tutor(self) -> dict[str, str]:
        from dh_grader.access import Scope, new_key_text
        from dh_grader.access.keys import add_key

        if "tutor" not in self.tokens:
            text, now = new_key_text(), datetime.now(UTC)
            digest = SECRET.key_digest(text)
            end = now + timedelta(days=1)
            self.tool.do(lambda it: add_key(it, "t", digest, set(Scope), None, now, end))
            self.tokens["tutor"] = {"authorization": f"Bearer {text}"}
        return self.tokens["tutor"]

    def send(self, most: int = 1000) -> int:
        for i in range(most):
            if not self.sender.send_next():
                return i
        return most

    def rows(self) -> list[Row[Any]]:
        """Return the rows of the outbox (the queued scores)."""
        ordered = select(tables.scores).order_by(tables.scores.c.sub)
        found: list[Row[Any]] = self.tool.do(lambda it: it.execute(ordered).all())
        return found

    def states(self) -> dict[str, str]:
        """Return the state of each learner's score."""
        return {each.sub.removeprefix("user "): each.state for each in self.rows()}

    def another_sender(self, chance: Callable[[], float] = lambda: 1.0) -> ScoreSender:
        return ScoreSender(self.tool.store.engine, SECRET, self.clock.now, chance)


@pytest.fixture
def journey(tool: Tool) -> Journey:
    clock = Clock()
    sender = ScoreSender(tool.store.engine, SECRET, clock.now, lambda: 1.0)
    made = Journey(tool, clock, sender)
    gradebook = tool.platform.gradebook
    gradebook.now = clock.now
    gradebook.own_keys = lambda: tool.do(published_keys)
    return made
