"""Each route returns the expected status to each kind of caller."""

import asyncio
import gzip
import json
import re
from collections.abc import AsyncIterator, Iterator, Mapping
from contextlib import asynccontextmanager
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from functools import cache, partial
from itertools import count
from pathlib import Path
from typing import Any
from urllib.parse import urljoin, urlsplit

import httpx
import pytest
from dh_grader.access import OPEN_HERE, Caller, Scope, Secret, new_key_text, open_access
from dh_grader.access.key_ring import KeyRing, add_key, revoke_key
from dh_grader.access.rates import Rates
from dh_grader.api import grading
from dh_grader.api.application import application
from dh_grader.api.document import example
from dh_grader.api.http import ProblemError
from dh_grader.api.permissions import RIGHTS, Access
from dh_grader.catalogue import Exercise, shipped_folder
from dh_grader.contract import MEDIA_TYPE, PROBLEM_TYPES, TYPE_PREFIX
from dh_grader.contract.courses import LinksRequest, NewAssignment, NewCourse, NewLearner
from dh_grader.courses import roll
from dh_grader.courses.assignments import add_assignment
from dh_grader.courses.roll import issue_links
from dh_grader.grading import Report, Submission, grade
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.store.database import in_transaction
from dh_grader.store.results import override
from dh_grader.store.tables import (
    assignments,
    attempts,
    course_learners,
    courses,
    extensions,
    keys,
    overrides,
)
from dh_grader.web import Tutoring, web_routes
from fastapi import FastAPI, Request
from fastapi.routing import iter_route_contexts
from sqlalchemy import Connection, select, update
from starlette.routing import Route

from tests.shipped import shipped_exercises
from tests.solutions.solved import solved

STATUSES = Path(__file__).parent / "statuses.txt"
HERE, ELSEWHERE = "http://127.0.0.1:8000", "http://192.0.2.1:8000"
EXERCISE, OTHER = "planar-rr", "scara"
SECRET = Secret("0123456789abcdef" * 4)
NOW = datetime.now(UTC)
YEAR = timedelta(days=365)
ANSWERS = {"answers": {"table": "a1 0 0 θ1\na2 0 0 θ2"}}
ADA = {"learner": "ada", **ANSWERS}
FILE = {"id": EXERCISE, "text": (shipped_folder() / f"{EXERCISE}.toml").read_text("utf-8")}
CLASS = {"exercise": EXERCISE, "files": [{"path": "ada.json", "text": json.dumps(ANSWERS)}]}
ASSIGNMENT = {"title": "Homework", "exercises": [{"exercise": EXERCISE, "points": 10}]}
# The routes that make something with a new id.
MAKING = (
    "POST /v1/courses",
    "POST /v1/courses/{course_id}/assignments",
    "POST /tutor/files",
)
VARIANTS = "GET /v1/courses/robots/assignments/homework/variants"


@cache
def bodies() -> Mapping[str, Any]:
    """Return the body of each route that has one."""
    return {
        "POST /v1/exercises/{exercise_id}/grade": ANSWERS,
        "POST /v1/exercises/{exercise_id}/hints": {
            "answers": {"table": "0 0 0 θ1\na2 0 0 θ2"},
            "part": "table",
            "code": "distance_left_out",
            "row": "1",
            "cell": "a",
            "step": 1,
        },
        "POST /v1/exercises/{exercise_id}/solution": {
            "answers": dict(solved(shipped_exercises()[EXERCISE]).answers)
        },
        "POST /v1/exercises/{exercise_id}/choices": {"part": "table", "rows": []},
        "POST /v1/grade": {"submissions": [{"exercise": EXERCISE, **ANSWERS}]},
        "POST /lti/notices": {"notices": [{"jwt": "not signed"}]},
        "POST /v1/preview": {"text": "2*q1", "exercise": EXERCISE},
        "POST /v1/previews": {"exercise": EXERCISE, "part": "table", "entries": [{"text": "a1"}]},
        "POST /v1/frames": {**example("frames-request"), "exercise": EXERCISE, "table": None},
        "POST /v1/tokens": {"learner": "ada", "exercises": [EXERCISE], "minutes": 480},
        "POST /v1/exercises/{exercise_id}/attempts": {"learner": "ada", **ANSWERS},
        # The exercise has no prices of hints.
        "POST /v1/attempts/{attempt_id}/hints": {"part": "table", "code": "sign", "step": 1},
        "POST /v1/attempts/{attempt_id}/override": {"points": 1, "reason": "A misprint."},
        "POST /v1/learners/forget": {"learner": "nobody", "apply": True},
        "POST /v1/exercises/{exercise_id}/regrade": {"apply": True},
        "POST /v1/courses": {"title": "Robots", "zone": "Europe/Berlin"},
        "POST /v1/courses/{course_id}": {"title": "Robots"},
        "POST /v1/courses/{course_id}/learners": {"learners": [{"learner": "ada", "name": "Ada"}]},
        "POST /v1/courses/{course_id}/delete": {"apply": False},
        "POST /v1/courses/{course_id}/learners/remove": {"learner": "ada", "apply": False},
        "POST /v1/courses/{course_id}/assignments/{assignment_id}/delete": {"apply": False},
        "POST /v1/courses/{course_id}/links": {},
        "POST /v1/courses/{course_id}/links/revoke": {"learners": ["nobody"]},
        "POST /v1/courses/{course_id}/scores/send": {},
        "POST /v1/courses/{course_id}/assignments": ASSIGNMENT,
        "POST /v1/courses/{course_id}/assignments/{assignment_id}": {"title": "Homework"},
        "POST /v1/courses/{course_id}/assignments/{assignment_id}/extensions": {"learner": "ada"},
        # The exercise has no variants.
        "POST /v1/courses/{course_id}/assignments/{assignment_id}/variants": {
            "learner": "ada",
            "exercise": EXERCISE,
        },
        "POST /v1/courses/{course_id}/assignments/{assignment_id}/attempts": {
            "exercise": EXERCISE,
            "learner": "ada",
            **ANSWERS,
        },
        "POST /tutor/check": FILE,
        "POST /tutor/import": {"kind": "table", "text": "0 | 0 | 0.3 | q1", "id": "arm"},
        "POST /tutor/drafts": FILE,
        "POST /tutor/files": {**FILE, "id": "my-arm", "before": ""},
        "POST /tutor/class": CLASS,
    }


_number = count()


async def _check_problem(answer: httpx.Response) -> None:
    """Check that an error has a type that the page of problems lists for its status."""
    if answer.headers.get("content-type") == MEDIA_TYPE:
        await answer.aread()
        name = answer.json()["type"].removeprefix(TYPE_PREFIX)
        assert PROBLEM_TYPES[name].status == answer.status_code, name


@dataclass(frozen=True)
class Guarded:
    """A service with keys, and the same service without keys (``open_app``)."""

    app: FastAPI
    open_app: FastAPI
    ring: KeyRing
    store: AttemptStore
    credentials: Mapping[str, list[str]]
    editor_dir: Path
    names: dict[str, str]

    def filled(self, route: str) -> str:
        for place, name in self.names.items():
            for written in (f"{{{place}}}", f"{{{place}:path}}"):
                route = name if place == route else route.replace(written, name)
        return route

    @asynccontextmanager
    async def client(
        self, credential: str = "", address: str = HERE
    ) -> AsyncIterator[httpx.AsyncClient]:
        headers = {"authorization": f"Bearer {credential}"} if credential else {}
        transport = httpx.ASGITransport(self.app)
        async with httpx.AsyncClient(
            transport=transport,
            base_url=address,
            headers=headers,
            event_hooks={"response": [_check_problem]},
        ) as client:
            yield client

    async def send(
        self, client: httpx.AsyncClient, route: str, language: str = "en"
    ) -> httpx.Response:
        for file in self.editor_dir.iterdir():
            file.unlink()
        new = {"id": f"new-{next(_number)}"} if route in MAKING else {}
        body = json.dumps(bodies()[route] | new).encode() if route in bodies() else b""
        if route == "POST /tutor/class":
            body = gzip.compress(body)
        method, path = self.filled(route).split()
        headers = {"Idempotency-Key": f"{next(_number)}", "Accept-Language": language}
        return await client.request(method, path, content=body, headers=headers)

    def new_key(self, scope: Scope, **only: Any) -> str:
        """Make a key; ``only`` may restrict it to ``exercises`` or to a ``course``."""
        text = new_key_text()
        digest, only = SECRET.key_digest(text), {"exercises": None, "course": None, **only}
        in_transaction(
            self.store.engine,
            lambda it: add_key(
                it, "", digest, [scope], only["exercises"], NOW, NOW + YEAR, only["course"]
            ),
        )
        return text

    def ask(self, method: str, path: str, credential: str = "", **more: Any) -> httpx.Response:
        async def asked() -> httpx.Response:
            async with self.client(credential) as client:
                return await client.request(method, path, **more)

        return asyncio.run(asked())


@pytest.fixture(scope="module")
def guarded(
    catalogue: Mapping[str, Exercise], tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Guarded]:
    folder = tmp_path_factory.mktemp("guarded")
    store = AttemptStore.open(str(folder / "attempts.db"))

    def key(
        *scopes: Scope,
        exercises: Any = None,
        until: datetime = NOW + YEAR,
        course: str | None = None,
    ) -> tuple[str, str]:
        text = new_key_text()
        digest = SECRET.key_digest(text)
        made = in_transaction(
            store.engine,
            lambda it: add_key(it, "", digest, scopes, exercises, NOW, until, course),
        )
        return text, made.id

    def link(course: str, *, renew: bool = False) -> str:
        wanted = LinksRequest(learners=["ada"], renew=renew)
        [made] = in_transaction(
            store.engine, lambda it: issue_links(it, course, wanted, SECRET, HERE, NOW)
        )
        return made.link.partition("#")[2]

    for course in ("robots", "others"):
        in_transaction(store.engine, partial(_add_course, course))

    everything = tuple(Scope)
    record, record_id = key(Scope.RECORD)
    expired, expired_id = key(*everything, until=NOW)
    revoked, revoked_id = key(*everything)
    course_key, course_key_id = key(*everything, course="robots")
    for each in (revoked_id, course_key_id):
        in_transaction(store.engine, partial(revoke_key, key_id=each, now=NOW))
    old_link = link("robots")
    new_link = link("robots", renew=True)
    ended, _ = key(*everything, course="robots", until=NOW)
    ring = KeyRing(store.engine, SECRET, seconds=0.2)

    def token(key_id: str, until: datetime = NOW + YEAR, by: KeyRing = ring) -> str:
        bound = None if key_id == record_id else frozenset({EXERCISE})
        return by.token(Caller(frozenset(everything), bound, "ada", key_id), until)

    stranger = KeyRing(store.engine, Secret("another secret of thirty-two chars"))
    misspelt = record[:-1] + ("a" if record[-1] != "a" else "b")
    elsewhere, _ = key(*everything, exercises=[OTHER])
    credentials = {
        "no key": [""],
        "grade": [key(Scope.GRADE)[0], key(Scope.GRADE, exercises=[EXERCISE])[0]],
        "record": [record],
        "tutor": [key(Scope.TUTOR)[0]],
        "token": [token(record_id)],
        "not valid": [
            expired, revoked, misspelt, course_key, old_link, ended,
            new_key_text(), "dhg_", "nonsense", "a.b.c",
            token(record_id, NOW - YEAR), token(expired_id), token(revoked_id),
            token("00000000"), token(record_id, by=stranger),
        ],
        "other exercise": [elsewhere],
        "course tutor": [key(Scope.TUTOR, course="robots")[0]],
        "other tutor": [key(Scope.TUTOR, course="others")[0]],
        "learner": [new_link],
        "other learner": [link("others")],
    }  # fmt: skip
    stranger.close()
    access = Access(OPEN_HERE, solutions=None, read_attempts=None, keys=ring)
    editor_dir = folder / "exercises"
    editor_dir.mkdir()
    open_access = Access(OPEN_HERE, solutions=None, read_attempts=None)
    app, open_app = (
        application(
            catalogue,
            ("https://course.example.edu",),
            access=each,
            store=store,
            pages=web_routes(
                catalogue,
                Tutoring(each, (shipped_folder(),), editor_dir, records=True, store=store),
            ),
        )
        for each in (access, open_access)
    )
    store.start()
    service = Guarded(app, open_app, ring, store, credentials, editor_dir, {})
    path = f"/v1/exercises/{EXERCISE}/attempts"
    recorded = service.ask("POST", path, record, json={"learner": "ada", **ANSWERS})
    file = service.ask("GET", "/").text.partition("static/")[2].partition('"')[0]
    service.names.update(
        {
            "exercise_id": EXERCISE,
            "course_id": "robots",
            "assignment_id": "homework",
            "registration_id": "moodle",
            "convention": "standard",
            "rule": "link_twist",
            "learner": "ada",
            "attempt_id": recorded.json()["attempt"]["id"],
            "GET /tutor/courses/robots/learner": "GET /tutor/courses/robots/learner?learner=ada",
            VARIANTS: f"{VARIANTS}?learner=ada",
            "GET /static/{name}": f"GET /static/{file}",
            "GET /docs/{name}": "GET /docs/start.js",
        }
    )
    yield service
    ring.close()
    store.close()


def _add_course(course: str, connection: Connection) -> None:
    new = NewCourse(id=course, title="Robots", zone="Europe/Berlin")
    roll.add_course(connection, new, NOW)
    people = [NewLearner(learner="ada", name="Ada"), NewLearner(learner="grace", name="Grace")]
    roll.add_learners(connection, course, people)
    homework = NewAssignment.model_validate({"id": "homework", **ASSIGNMENT})
    add_assignment(connection, course, homework, {EXERCISE})


def routes_of(app: FastAPI) -> set[str]:
    return {
        f"{method} {route.path}"
        for route in iter_route_contexts(app.routes)
        for method in (route.methods or {"ANY"}) - {"HEAD"}
    }


def expected() -> dict[str, dict[str, int]]:
    """Return the expected status of each route for each kind of caller."""
    head, *lines = STATUSES.read_text(encoding="utf-8").splitlines()
    _, *headings = re.split(" {2,}", head)
    rows = [re.split(" {2,}", line) for line in lines]
    return {row[0]: dict(zip(headings, map(int, row[1:]), strict=True)) for row in rows}


@pytest.mark.long
def test_every_route_answers_each_caller_as_expected(guarded: Guarded) -> None:
    statuses = expected()
    assert set(statuses) == routes_of(guarded.app) == set(RIGHTS)

    async def with_each() -> AsyncIterator[tuple[str, int, httpx.AsyncClient]]:
        for heading, credentials in guarded.credentials.items():
            for i, credential in enumerate(credentials):
                async with guarded.client(credential) as client:
                    yield heading, i, client
        without_keys = replace(guarded, app=guarded.open_app)
        for heading, address in (("this machine", HERE), ("elsewhere", ELSEWHERE)):
            async with without_keys.client(address=address) as client:
                yield heading, 0, client

    async def wrong() -> list[tuple[str, str, int, int]]:
        return [
            (route, f"{heading} {i}", status, row[heading])
            async for heading, i, client in with_each()
            for route, row in statuses.items()
            # Routes that need no key are asked with one credential of each kind.
            if i == 0 or row["no key"] == 401
            if (status := (await guarded.send(client, route)).status_code) != row[heading]
        ]

    assert asyncio.run(wrong()) == []


def _strangers(guarded: Guarded) -> dict[str, str]:
    def made(connection: Connection) -> dict[str, str]:
        found = {}
        for heading, scopes in (("record", [Scope.RECORD, Scope.GRADE]), ("all", list(Scope))):
            found[f"{heading}, another course"] = text = new_key_text()
            digest = SECRET.key_digest(text)
            add_key(connection, "", digest, scopes, None, NOW, NOW + YEAR, "others")
        for heading, course in (("classmate", "robots"), ("expired link", "others")):
            wanted = LinksRequest(learners=["grace"])
            [link] = issue_links(connection, course, wanted, SECRET, HERE, NOW)
            found[heading] = link.link.partition("#")[2]
        expired = (keys.c.learner == "grace") & (keys.c.course == "others")
        connection.execute(update(keys).where(expired).values(expires_at=NOW))
        return found

    headings = ("no key", "not valid", "other tutor", "other learner", "other exercise")
    return in_transaction(guarded.store.engine, made) | {
        f"{heading} {i}": credential
        for heading in headings
        for i, credential in enumerate(guarded.credentials[heading])
    }


def _state(store: AttemptStore) -> list[Any]:
    wanted = (
        select(courses).where(courses.c.id == "robots"),
        select(course_learners).where(course_learners.c.course == "robots"),
        select(assignments).where(assignments.c.course == "robots"),
        select(attempts, assignments).join_from(attempts, assignments),
        select(overrides),
        select(extensions),
        select(keys.c.id, keys.c.expires_at, keys.c.revoked_at).where(keys.c.course == "robots"),
    )
    with store.engine.connect() as connection:
        return [[tuple(row) for row in connection.execute(each)] for each in wanted]


async def _told(guarded: Guarded, credential: str, mark: str) -> list[str]:
    found = []
    # That route grades files of the request itself.
    routes = sorted(RIGHTS.keys() - {"POST /tutor/class"})
    async with guarded.client(credential) as client:
        for route in routes:
            body = json.dumps(bodies()[route]).encode() if route in bodies() else None
            method, path = guarded.filled(route).split()
            headers = {"Idempotency-Key": f"{next(_number)}"}
            answer = await client.request(method, path, content=body, headers=headers)
            if mark in answer.text:
                found.append(route)
    return found


@pytest.mark.long
def test_nothing_of_another_course_or_learner_is_told_or_changed(guarded: Guarded) -> None:
    mark = "zora9"
    new = NewLearner(learner="zora", name=mark, email=f"{mark}@example.edu")
    in_transaction(guarded.store.engine, lambda it: roll.add_learners(it, "robots", [new]))
    [record], [tutor] = guarded.credentials["record"], guarded.credentials["course tutor"]
    path = "/v1/courses/robots/assignments/homework/attempts"
    answers = {"table": f"{mark} 0 0 θ1\na2 0 0 θ2"}
    body = {"exercise": EXERCISE, "learner": "zora", "answers": answers}
    handed_in = guarded.ask("POST", path, record, json=body, headers={"Idempotency-Key": mark})
    names = {**guarded.names, "attempt_id": handed_in.json()["attempt"]["id"], "learner": "zora"}
    names["GET /tutor/courses/robots/learner"] = "GET /tutor/courses/robots/learner?learner=zora"
    asked, strangers = replace(guarded, names=names), _strangers(guarded)
    before = _state(guarded.store)
    told = {heading: asyncio.run(_told(asked, each, mark)) for heading, each in strangers.items()}
    assert {heading: routes for heading, routes in told.items() if routes} == {}
    assert _state(guarded.store) == before
    # The same questions of the course's tutor are answered.
    assert {
        "GET /v1/attempts/{attempt_id}",
        "GET /v1/courses/{course_id}/gradebook",
        "GET /v1/courses/{course_id}/learners",
        "GET /v1/courses/{course_id}/learners/{learner:path}/view",
        "GET /tutor/courses/{course_id}/learner",
    } <= set(asyncio.run(_told(asked, tutor, mark)))


def test_a_learner_reads_what_is_the_learner_s_own(guarded: Guarded) -> None:
    [token] = guarded.credentials["token"]
    [record], [tutor] = guarded.credentials["record"], guarded.credentials["tutor"]
    path = f"/v1/exercises/{EXERCISE}/attempts"
    of_grace = guarded.ask("POST", path, record, json={"learner": "grace", **ANSWERS}).json()
    own = guarded.names["attempt_id"]
    other = of_grace["attempt"]["id"]
    assert guarded.ask("POST", path, token, json={"learner": "grace", **ANSWERS}).status_code == 403
    listed = guarded.ask("GET", "/v1/attempts", token).json()["attempts"]
    assert {each["learner"] for each in listed} == {"ada"}
    assert guarded.ask("GET", "/v1/attempts?learner=grace", token).status_code == 403
    assert guarded.ask("GET", f"/v1/attempts/{other}", token).status_code == 404
    assert guarded.ask("GET", f"/v1/attempts/{other}", tutor).status_code == 200
    reason = "Copied from a friend."

    def judged(connection: Connection) -> None:
        override(connection, own, 1.0, reason, "Prof. X", NOW)

    in_transaction(guarded.store.engine, judged)
    assert reason in guarded.ask("GET", f"/v1/attempts/{own}", tutor).text
    read = guarded.ask("GET", f"/v1/attempts/{own}", token)
    assert (read.json()["attempt"]["awarded"], read.json()["overrides"]) == (1.0, [])
    assert reason not in read.text


def test_idempotency_keys_belong_to_their_sender(guarded: Guarded) -> None:
    path, body = f"/v1/exercises/{EXERCISE}/attempts", {"learner": "ada", **ANSWERS}
    [record], [token] = guarded.credentials["record"], guarded.credentials["token"]

    def recorded(credential: str) -> str:
        headers = {"Idempotency-Key": "first"}
        answer = guarded.ask("POST", path, credential, json=body, headers=headers)
        return str(answer.json()["attempt"]["id"])

    assert recorded(record) == recorded(record) != recorded(token) == recorded(token)


def test_a_token_has_no_right_that_its_key_does_not_have(guarded: Guarded) -> None:
    def made(credential: str, **more: Any) -> httpx.Response:
        return guarded.ask("POST", "/v1/tokens", credential, json={"learner": "ada", **more})

    graded = made(guarded.credentials["grade"][1], minutes=1)
    assert graded.headers["Cache-Control"] == "no-store"
    left = datetime.fromisoformat(graded.json()["expires_at"]) - datetime.now(UTC)
    assert timedelta(seconds=30) < left <= timedelta(minutes=1)
    token = graded.json()["token"]
    for exercise, status in ((EXERCISE, 200), (OTHER, 403)):
        path = f"/v1/exercises/{exercise}/grade"
        assert guarded.ask("POST", path, token, json={"answers": {}}).status_code == status
    path = f"/v1/exercises/{EXERCISE}/attempts"
    refused = guarded.ask("POST", path, token, json={"learner": "ada", **ANSWERS})
    assert refused.json()["type"].endswith("scope-missing")
    [record] = guarded.credentials["record"]
    wrong: list[dict[str, Any]] = [
        {"exercises": []}, {"exercises": ["nothing"]}, {"minutes": 481}, {"key": "x"}
    ]  # fmt: skip
    assert [made(record, **each).status_code for each in wrong] == [422] * len(wrong)


def test_a_token_of_a_course_s_key_is_for_this_course_only(guarded: Guarded) -> None:
    made = guarded.new_key(Scope.RECORD, course="robots")
    token = guarded.ask("POST", "/v1/tokens", made, json={"learner": "ada"}).json()["token"]
    body = {"exercise": EXERCISE, **ADA}

    def status(path: str) -> int:
        headers = {"Idempotency-Key": path}
        return guarded.ask("POST", path, token, json=body, headers=headers).status_code

    assert status("/v1/courses/robots/assignments/homework/attempts") == 201
    assert status("/v1/courses/others/assignments/homework/attempts") == 403
    # An attempt outside of the course's assignments.
    path = f"/v1/exercises/{EXERCISE}/attempts"
    assert guarded.ask("POST", path, token, json=ADA).status_code == 403


def test_a_key_of_an_exercise_is_for_its_variants_too(guarded: Guarded) -> None:
    varied = "vertical-axes"
    own, other = (guarded.new_key(Scope.RECORD, exercises=[each]) for each in (varied, OTHER))
    for name in (varied, f"{varied}~k7"):
        for key, graded, recorded in ((own, 200, 201), (other, 403, 403)):
            path = f"/v1/exercises/{name}"
            assert guarded.ask("POST", f"{path}/grade", key, json=ANSWERS).status_code == graded
            assert guarded.ask("POST", f"{path}/attempts", key, json=ADA).status_code == recorded
            many = {"submissions": [{"exercise": name, **ANSWERS}]}
            [told] = guarded.ask("POST", "/v1/grade", key, json=many).json()["results"]
            assert list(told) == ["report" if graded == 200 else "problem"]


def test_each_of_many_submissions_must_be_to_an_exercise_of_the_key(guarded: Guarded) -> None:
    [elsewhere] = guarded.credentials["other exercise"]
    many = [{"exercise": exercise, "answers": {}} for exercise in (EXERCISE, OTHER)]
    answer = guarded.ask("POST", "/v1/grade", elsewhere, json={"submissions": many}).json()
    assert [next(iter(each)) for each in answer["results"]] == ["problem", "report"]
    assert answer["results"][0]["problem"]["type"].endswith("other-exercise")
    # A restricted key lists the attempts at the exercise that it names.
    assert guarded.ask("GET", f"/v1/attempts?exercise={OTHER}", elsewhere).status_code == 200
    assert guarded.ask("GET", f"/v1/attempts?exercise={EXERCISE}", elsewhere).status_code == 403


@pytest.mark.long
def test_a_tutor_of_one_exercise_finds_the_pages_of_it(guarded: Guarded) -> None:
    [elsewhere], [tutor] = guarded.credentials["other exercise"], guarded.credentials["tutor"]

    def links(path: str, key: str) -> set[str]:
        page = guarded.ask("GET", path, key)
        assert page.status_code == 200
        found = re.findall(r'<a href="([^"]*)', page.text.partition("<main")[2])
        return {urlsplit(urljoin(f"http://host{path}", each)).path for each in found}

    pages = links("/tutor", elsewhere) | links(f"/tutor/solutions/{OTHER}", elsewhere)
    assert {f"/tutor/{each}/{OTHER}" for each in ("solutions", "statistics")} <= pages
    assert "/tutor/attempts" in pages
    # The key may open all pages that they link to.
    assert {path: guarded.ask("GET", path, elsewhere).status_code for path in pages} == (
        dict.fromkeys(pages, 200)
    )
    assert {"/tutor/editor", "/tutor/class"} <= links("/tutor", tutor)
    assert "/tutor/editor" in links(f"/tutor/solutions/{OTHER}", tutor)
    # The page lists only its exercise, and offers no deletion in all exercises.
    attempts = guarded.ask("GET", "/tutor/attempts", elsewhere).text
    everything = guarded.ask("GET", "/tutor/attempts", tutor).text
    for text in ("All exercises", EXERCISE, "Forget a learner"):
        assert (text in attempts, text in everything) == (False, True)
    assert guarded.ask("GET", f"/tutor/attempts?exercise={EXERCISE}", elsewhere).status_code == 403
    assert 'href="tutor"' in guarded.ask("GET", "/", elsewhere).text


def test_a_refused_browser_gets_a_page_that_says_what_to_do(guarded: Guarded) -> None:
    reader = {"Accept": "text/html,application/xhtml+xml,*/*;q=0.8"}
    [record], [elsewhere] = guarded.credentials["record"], guarded.credentials["other exercise"]
    [tutor] = guarded.credentials["tutor"]
    create = 'dh-grader keys create "Your name" --scope tutor'
    for key, path, status, said in [
        (record, "/tutor/class", 403, create),
        (elsewhere, f"/tutor/statistics/{EXERCISE}", 403, 'href="../../tutor"'),
        (tutor, "/tutor/statistics/nothing", 404, 'href="../../"'),
        (tutor, "/tutor/nothing", 404, 'href="../"'),
        ("", "/exercises/<b>", 404, 'href="../"'),
    ]:
        page = guarded.ask("GET", path, key, headers=reader)
        assert (path, page.status_code) == (path, status)
        assert page.headers["Content-Type"] == "text/html; charset=utf-8"
        assert "script-src 'self'" in page.headers["Content-Security-Policy"]
        assert said in page.text.partition("<main")[2].partition("</main")[0]
        assert "<b>" not in page.text
        # The relative address of its style is right.
        [style] = re.findall(r'href="([^"]*static/page-[^"]*css)', page.text)
        assert guarded.ask("GET", urljoin(path, style)).status_code == 200
        program = guarded.ask("GET", path, key)
        assert program.headers["Content-Type"] == "application/problem+json"
    interface = guarded.ask("GET", "/v1/attempts", headers=reader)
    assert interface.headers["Content-Type"] == "application/problem+json"


def test_the_key_may_be_the_password_of_a_request(guarded: Guarded) -> None:
    [tutor] = guarded.credentials["tutor"]
    # No browser asks its user for a password.
    asked = guarded.ask("GET", "/tutor")
    assert (asked.status_code, asked.headers["WWW-Authenticate"]) == (401, "Bearer")
    assert guarded.ask("GET", "/tutor", auth=("anybody", tutor)).status_code == 200
    # A browser would also send it for a page of another origin, but a program decides itself.
    path, headers = f"/v1/exercises/{EXERCISE}/solution", {"Origin": "https://evil.example"}
    assert guarded.ask("GET", path, auth=("", tutor), headers=headers).status_code == 403
    assert guarded.ask("GET", path, tutor, headers=headers).status_code == 200
    # The password of a proxy is ignored, and is not an error.
    for password in ("secret", "dhg_"):
        refused = guarded.ask("GET", "/v1/attempts", auth=("proxy", password))
        kind = "key-needed" if password == "secret" else "key-not-valid"
        assert refused.json()["type"].endswith(kind)


def test_no_request_avoids_authentication(guarded: Guarded) -> None:
    async def below_a_prefix() -> list[int]:
        transport = httpx.ASGITransport(guarded.app, root_path="/grader")
        address = "http://127.0.0.1:8000/grader/"
        async with httpx.AsyncClient(transport=transport, base_url=address) as client:
            paths = ("readyz", f"v1/exercises/{EXERCISE}", f"v1/exercises/{EXERCISE}/solution")
            return [(await client.get(path)).status_code for path in paths]

    assert asyncio.run(below_a_prefix()) == [200, 200, 401]
    access = Access(OPEN_HERE, solutions=None, keys=guarded.ring)
    scope = {"type": "http", "headers": [(b"host", b"127.0.0.1")], "path": "/"}
    here = {"server": ("127.0.0.1", 8000), "client": ("127.0.0.1", 1)}
    request = Request({**scope, **here, "method": "POST", "route": Route("/v1/grade", print)})
    with pytest.raises(ProblemError, match="needs a key"):
        asyncio.run(access.permit(request))
    assert not access.shows_solutions(request)


def test_a_page_of_an_allowed_origin_may_send_a_token(guarded: Guarded) -> None:
    origin = {"Origin": "https://course.example.edu"}
    wanted = {
        "Access-Control-Request-Method": "POST",
        "Access-Control-Request-Headers": "authorization,content-type",
    }
    path = f"/v1/exercises/{EXERCISE}/grade"
    assert guarded.ask("OPTIONS", path, headers={**origin, **wanted}).status_code == 200
    refused = guarded.ask("POST", path, json=ANSWERS, headers=origin)
    assert refused.status_code == 401
    assert refused.headers["Access-Control-Allow-Origin"] == origin["Origin"]
    assert refused.headers["X-Content-Type-Options"] == "nosniff"
    assert "Access-Control-Allow-Credentials" not in refused.headers


@pytest.mark.sampled(4)
@pytest.mark.parametrize(
    ("says", "needed", "grades", "records"),
    [
        (None, False, True, True), (None, True, False, False),
        ("until-keys", False, True, True), ("until-keys", True, False, False),
        ("grade", False, True, False), ("grade", True, True, False),
        ("grade,record", False, True, True), ("grade,record", True, True, True),
        ("none", False, False, False), ("none", True, False, False),
    ],
)  # fmt: skip
def test_the_setting_says_which_routes_need_no_key(
    guarded: Guarded, catalogue: Mapping[str, Exercise],
    says: str | None, needed: bool, grades: bool, records: bool,
) -> None:  # fmt: skip
    keys = guarded.ring if needed else None
    access = Access(open_access(says), solutions=None, read_attempts=None, keys=keys)
    app = application(catalogue, access=access, store=guarded.store)

    def asked(to: str = "127.0.0.1", credential: str = "", **more: str) -> tuple[bool, bool, bool]:
        async def ask() -> list[int]:
            headers = {"authorization": f"Bearer {credential}"} if credential else {}
            async with httpx.AsyncClient(
                transport=httpx.ASGITransport(app), base_url=f"http://{to}", headers=headers | more
            ) as client:
                path = f"/v1/exercises/{EXERCISE}"
                return [
                    (await client.post(f"{path}/grade", json=ANSWERS)).status_code,
                    (await client.post(f"{path}/attempts", json=ADA)).status_code,
                    (await client.get(f"{path}/solution")).status_code,
                ]

        statuses = asyncio.run(ask())
        assert set(statuses) <= {200, 201, 401, 403}
        return tuple(status < 300 for status in statuses)  # type: ignore[return-value]

    assert asked() == (grades, records, not needed)
    # Asked at an address that other machines can reach.
    far = says is not None
    assert asked("192.0.2.1") == (grades and far, records and far, False)
    [record] = guarded.credentials["record"]
    # Without keys the header is ignored: it may be for a proxy.
    assert asked("192.0.2.1", record) == (
        (True, True, False) if needed else (grades and far, records and far, False)
    )
    if needed:
        assert asked(credential=record[:-1] + "!") == (False, False, False)


def test_without_keys_nobody_makes_tokens(client: httpx.Client) -> None:
    made = client.post("/v1/tokens", json={"learner": "ada"})
    assert made.json()["type"].endswith("tokens-not-made")


def test_each_submission_of_a_batch_counts_as_a_request(
    guarded: Guarded, catalogue: Mapping[str, Exercise], monkeypatch: pytest.MonkeyPatch
) -> None:
    rates = Rates("64/hour", "3/hour")
    app = application(
        catalogue, access=Access(open_access("grade"), keys=guarded.ring), rates=rates
    )
    limited = replace(guarded, app=app)
    key = guarded.credentials["grade"][0]
    graded: list[str] = []

    def noted(exercise: Exercise, submission: Submission) -> Report:
        graded.append(exercise.id)
        return grade(exercise, submission)

    monkeypatch.setattr(grading, "grade", noted)

    def batch(number: int, credential: str = key) -> tuple[int, int]:
        submissions = [{"exercise": "scara", "answers": {}}] * number
        content = json.dumps({"submissions": submissions})
        answer = limited.ask("POST", "/v1/grade", credential, content=content)
        if answer.status_code == 429:
            assert answer.json()["type"].endswith("too-often")
            assert 0 < int(answer.headers["Retry-After"]) <= 2 * 3600
        if answer.status_code == 422:
            assert answer.json()["type"].endswith("batch-too-large")
            assert "at most 3 in one request" in answer.json()["detail"]
        return answer.status_code, len(graded)

    # A class with the largest batch within the limit is graded.
    assert batch(60) == (200, 60)
    # Four are left: the request itself counts as one of them.
    assert batch(5) == (429, 60)
    assert batch(3) == (200, 63)
    assert batch(1) == (429, 63)
    assert batch(4, "") == (422, 63)
    assert batch(2, "") == (200, 65)
    rates.close()


def test_too_many_requests_get_429_with_retry_after(
    guarded: Guarded, catalogue: Mapping[str, Exercise]
) -> None:
    rates = Rates("2/hour", "1/hour")
    app = application(catalogue, access=Access(keys=guarded.ring), rates=rates)
    limited = replace(guarded, app=app)
    [record], [tutor] = guarded.credentials["record"], guarded.credentials["tutor"]
    path = "/v1/exercises"
    asked = [limited.ask("GET", path, each) for each in (record, record, record, tutor, "", "")]
    assert [each.status_code for each in asked] == [200, 200, 429, 200, 200, 429]
    for refused in (asked[2], asked[5]):
        assert refused.headers["Content-Type"] == "application/problem+json"
        assert 0 < int(refused.headers["Retry-After"]) <= 2 * 3600
        assert refused.json()["type"].endswith("too-often")
    assert limited.ask("GET", "/healthz").status_code == 200
    rates.close()
