"""A platform of our own, and a service where it is registered."""

import asyncio
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from html import unescape
from typing import Any
from urllib.parse import parse_qs, urlsplit

import httpx
import pytest
from sqlalchemy import Connection, func, select

from service.access.key_ring import KeyRing
from service.access.keys import Secret
from service.access.open_access import OPEN_HERE
from service.api.application import application
from service.api.permissions.access import Access
from service.attempts.storage import lti_tables as tables
from service.attempts.storage.database import in_transaction
from service.attempts.storage.tables import course_learners, courses, metadata
from service.attempts.store import AttemptStore
from service.catalogue import Exercise
from service.lti.own_keys import ensure_key
from service.lti.registrations import NewRegistration, add_registration
from service.web import Tutoring, web_routes
from tests.attempts.databases import TEMPLATE, new_database, new_file
from tests.lti.platform import Platform, running

SECRET_TEXT = "0123456789abcdef" * 4
SECRET = Secret(SECRET_TEXT)
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
    """A platform for all tests of a process."""
    platform = Platform()
    with running(platform.app()) as port:
        platform.port = port
        yield platform


@pytest.fixture
def platform(one_platform: Platform) -> Iterator[Platform]:
    """The platform with its usual habits and keys."""
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
    """A login as a browser has it: what the platform was asked for, and the cookies."""

    asked: Mapping[str, str]
    cookies: str
    answer: httpx.Response


@dataclass
class Tool:
    """The service, and a browser that goes to and fro between it and the platform."""

    app: Any
    store: AttemptStore
    platform: Platform

    @property
    def url(self) -> str:
        """The address of the database."""
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
        """Begin a login; ``more`` are further fields."""
        fields = self.platform.login(user, link, **more)
        answer = self.send("GET", "/lti/login", params={k: v for k, v in fields.items() if v})
        query = parse_qs(urlsplit(answer.headers.get("location", "")).query)
        cookies = answer.headers.get("set-cookie", "").partition(";")[0]
        return Begun({name: each[0] for name, each in query.items()}, cookies, answer)

    def post(self, state: str, token: str, cookies: str, **more: str) -> httpx.Response:
        """Send a message to the launch."""
        headers = {
            "cookie": cookies,
            "origin": self.platform.address,
            "sec-fetch-site": "cross-site",
        }
        fields = {"state": state, "id_token": token, **more}
        return self.send("POST", "/lti/launch", data=fields, headers=headers)

    def launch(self, user: str = "ada", link: str = "link-1", **more: str) -> httpx.Response:
        """Go the whole way of a launch, over the platform's own page."""
        begun = self.login(user, link, **more)
        # Reading the certificates of the authorities takes longer than a launch.
        page = httpx.get(begun.answer.headers["location"], timeout=60, verify=False)
        fields = dict(re.findall(r'name="(\w+)" value="([^"]*)"', page.text))
        return self.post(unescape(fields["state"]), unescape(fields["id_token"]), begun.cookies)

    def counts(self) -> dict[str, int]:
        """Return the number of rows of all that a launch records."""
        with self.store.engine.connect() as connection:
            return {
                each.name: connection.scalar(select(func.count()).select_from(each)) or 0
                for each in RECORDED
            }


class Services:
    """The service on each kind of database: built once, because that takes longer than a test."""

    def __init__(self, catalogue: Mapping[str, Exercise], url: Callable[[str], str]) -> None:
        self._catalogue, self._url = catalogue, url
        self._built: dict[str, tuple[Any, AttemptStore, KeyRing]] = {}
        self._own_key: dict[str, Any] = {}

    def empty(self, kind: str) -> tuple[Any, AttemptStore]:
        """Return the application and its store, with a key that signs and no other row."""
        if kind not in self._built:
            self._built[kind] = self._build(AttemptStore.open(self._url(kind)))
        app, store, ring = self._built[kind]
        ring.has_keys = False
        in_transaction(store.engine, self._renew)
        return app, store

    def close(self) -> None:
        for _, store, ring in self._built.values():
            ring.close()
            store.close()

    def _build(self, store: AttemptStore) -> tuple[Any, AttemptStore, KeyRing]:
        ring = KeyRing(store.engine, SECRET, seconds=0.01)
        access = Access(OPEN_HERE, solutions=None, read_attempts=None, keys=ring)
        tutoring = Tutoring(access, records=True, store=store)
        pages = web_routes(self._catalogue, tutoring)
        app = application(self._catalogue, access=access, store=store, pages=pages)
        store.start()
        return app, store, ring

    def _renew(self, connection: Connection) -> None:
        for table in reversed(metadata.sorted_tables):
            connection.execute(table.delete())
        if self._own_key:
            connection.execute(tables.own_keys.insert(), self._own_key)
            return
        ensure_key(connection, SECRET, datetime.now(UTC))
        self._own_key = connection.execute(select(tables.own_keys)).one()._asdict()


@pytest.fixture(scope="session")
def services(
    request: pytest.FixtureRequest,
    catalogue: Mapping[str, Exercise],
    tmp_path_factory: pytest.TempPathFactory,
) -> Iterator[Services]:
    def url(kind: str) -> str:
        if kind == "sqlite":
            return new_file(tmp_path_factory.mktemp("lti"))
        return new_database(request.getfixturevalue("postgresql"), "lti", TEMPLATE)

    made = Services(catalogue, url)
    yield made
    made.close()


@pytest.fixture(params=["sqlite"])
def tool(request: pytest.FixtureRequest, services: Services, platform: Platform) -> Tool:
    """The service, in the kind of database of the parameter, where the platform is registered."""
    app, store = services.empty(request.param)
    new = NewRegistration.model_validate(platform.registration)
    in_transaction(store.engine, lambda it: add_registration(it, new, datetime.now(UTC)))
    return Tool(app, store, platform)


def hidden(page: str, name: str) -> str:
    """Return the value of a hidden field of a page."""
    [value] = re.findall(rf'name="{name}" value="([^"]*)"', page)[:1]
    return unescape(value)


def token_of(page: str) -> str:
    """Return the token in a learner's page."""
    [token] = re.findall(r'data-key="([^"]+)"', page)
    return str(token)
