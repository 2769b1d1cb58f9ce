"""A service that a learning platform launches, and what it sends there."""

import asyncio
import itertools
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from html import unescape
from typing import Any
from urllib.parse import parse_qs, urlsplit

import httpx
import pytest
from dh_grader.access import OPEN_HERE
from dh_grader.access.key_ring import KeyRing
from dh_grader.api.application import application
from dh_grader.api.permissions import Access
from dh_grader.catalogue import Exercise
from dh_grader.lti.fetching import ensure_key, published_keys
from dh_grader.lti.launch import pseudonym
from dh_grader.lti.outbox import ScoreSender
from dh_grader.lti.registrations import NewRegistration, add_registration
from dh_grader.store import tables
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.database import in_transaction
from dh_grader.store.results import everything_of
from dh_grader.store.tables import course_learners, courses
from dh_grader.web import Tutoring, web_routes
from sqlalchemy import Connection, Row, func, select

from tests.access.kept_services import SECRET, KeptServices
from tests.lti.gradebook import Gradebook
from tests.lti.platform import Platform, running
from tests.store.databases import new_file

# --- Fixtures: an LTI platform, and a service that is registered there

ADDRESS = "http://127.0.0.1:8000"
RECORDED = (
    tables.contexts,
    tables.resource_links,
    tables.learners,
    courses,
    course_learners,
)


@pytest.fixture(scope="session")
def one_platform() -> Iterator[Platform]:
    platform = Platform()
    with running(platform.app()) as port:
        platform.port = port
        yield platform


@pytest.fixture
def platform(one_platform: Platform) -> Iterator[Platform]:
    # Return the platform; after the test, reset its behaviour, keys and records.
    keys = list(one_platform.keys)
    # The service memoizes keys by their address.
    one_platform.visit += 1
    yield one_platform
    one_platform.habits.clear()
    one_platform.fetched.clear()
    one_platform.asked.clear()
    one_platform.members, one_platform.page_size, one_platform.next_page = [], 50, ""
    one_platform.keys[:] = keys
    one_platform.gradebook.reset()
    one_platform.files.reset()


@dataclass(frozen=True)
class Begun:
    """The state of a browser after a login has begun: its query and cookies."""

    asked: Mapping[str, str]
    cookies: str
    answer: httpx.Response


@dataclass
class Tool:
    """The service, and a browser that visits the service and the platform."""

    app: Any
    store: AttemptStore
    platform: Platform

    @property
    def url(self) -> str:
        return self.store.engine.url.render_as_string(hide_password=False)

    def do(self, work: Callable[[Connection], Any]) -> Any:
        return in_transaction(self.store.engine, work)

    def send(self, method: str, path: str, **more: Any) -> httpx.Response:
        async def sent() -> httpx.Response:
            transport = httpx.ASGITransport(self.app)
            async with httpx.AsyncClient(transport=transport, base_url=ADDRESS) as client:
                return await client.request(method, path, **more)

        return asyncio.run(sent())

    def login(self, user: str = "ada", link: str = "link-1", **more: str) -> Begun:
        fields = self.platform.login(user, link, **more)
        answer = self.send("GET", "/lti/login", params={k: v for k, v in fields.items() if v})
        query = parse_qs(urlsplit(answer.headers.get("location", "")).query)
        cookies = answer.headers.get("set-cookie", "").partition(";")[0]
        return Begun({name: each[0] for name, each in query.items()}, cookies, answer)

    def post(self, state: str, token: str, cookies: str, **more: str) -> httpx.Response:
        headers = {
            "cookie": cookies,
            "origin": self.platform.address,
            "sec-fetch-site": "cross-site",
        }
        fields = {"state": state, "id_token": token, **more}
        return self.send("POST", "/lti/launch", data=fields, headers=headers)

    def launch(self, user: str = "ada", link: str = "link-1", **more: str) -> httpx.Response:
        """Log in, get the platform's page, and post its form to the service."""
        begun = self.login(user, link, **more)
        # Reading the certificates of the authorities takes longer than a launch.
        page = httpx.get(begun.answer.headers["location"], timeout=60, verify=False)
        fields = dict(re.findall(r'name="(\w+)" value="([^"]*)"', page.text))
        return self.post(unescape(fields["state"]), unescape(fields["id_token"]), begun.cookies)

    def counts(self) -> dict[str, int]:
        with self.store.engine.connect() as connection:
            return {
                each.name: connection.scalar(select(func.count()).select_from(each)) or 0
                for each in RECORDED
            }


@pytest.fixture(scope="session")
def services(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[KeptServices]:
    made = KeptServices(request, tmp_path_factory)
    yield made
    made.close()


@pytest.fixture(scope="session")
def own_key(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    # The database row of one signing key for all tests: making a key takes longer than a test.
    store = AttemptStore.open(new_file(tmp_path_factory.mktemp("own-key")))
    in_transaction(store.engine, lambda it: ensure_key(it, SECRET, datetime.now(UTC)))
    with store.engine.connect() as connection:
        found = connection.execute(select(tables.own_keys)).one()._asdict()
    store.close()
    return found


@pytest.fixture(params=["sqlite"])
def tool(
    request: pytest.FixtureRequest,
    services: KeptServices,
    own_key: dict[str, Any],
    catalogue: Mapping[str, Exercise],
    platform: Platform,
) -> Tool:
    def build(store: AttemptStore, keys: KeyRing) -> Any:
        access = Access(OPEN_HERE, solutions=None, read_attempts=None, keys=keys)
        pages = web_routes(catalogue, Tutoring(access, records=True, store=store))
        return application(catalogue, access=access, store=store, pages=pages)

    app, store, ring = services.empty(request.param, catalogue, build)
    ring.has_keys = False
    new = NewRegistration.model_validate(platform.registration)

    def set_up(connection: Connection) -> None:
        connection.execute(tables.own_keys.insert(), own_key)
        add_registration(connection, new, datetime.now(UTC))

    in_transaction(store.engine, set_up)
    return Tool(app, store, platform)


def hidden(page: str, name: str) -> str:
    """Return the value of a hidden field of a page."""
    [value] = re.findall(rf'name="{name}" value="([^"]*)"', page)[:1]
    return unescape(value)


def token_of(page: str) -> str:
    """Return the token in a learner's page."""
    [token] = re.findall(r'data-key="([^"]+)"', page)
    return str(token)


# --- Fixtures: a course at a platform whose gradebook gets scores, and a clock

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
        from dh_grader.access.key_ring import add_key

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
