"""Test who may do what."""

import asyncio
import re
from collections.abc import Callable, Mapping
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import httpx
import pytest
from dh_grader.access import OPEN_HERE, Caller, Scope, open_access
from dh_grader.api.application import WebPages, application
from dh_grader.api.http import ProblemError
from dh_grader.api.permissions import (
    ACCESS_PROBLEMS,
    PLAIN_COOKIE,
    RIGHTS,
    SECURE_COOKIE,
    Access,
    Identity,
    Reach,
    access_problem,
    is_at_the_machine,
    is_loopback,
    is_same_origin,
    require_reach,
    right_of,
    scope_missing,
    session_in,
)
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.load import Drafts
from dh_grader.server import installed_app
from dh_grader.settings import load_settings
from fastapi import APIRouter, FastAPI, Request
from fastapi.routing import iter_route_contexts
from starlette.routing import Route

from tests.api.rights_table import PAGE, row, with_table
from tests.together import together

# --- Test whose requests have a tutor's rights, and which pages may send them

PROGRAM = {"host": "127.0.0.1:8000"}


def answered(
    solutions: bool | None,
    headers: dict[str, str],
    *,
    client: str = "127.0.0.1",
    server: str = "127.0.0.1",
    http_version: str = "1.1",
) -> bool:
    app = FastAPI()
    access = Access(solutions=solutions)

    async def as_spoken(scope: Any, receive: Any, send: Any) -> None:
        await app({**scope, "http_version": http_version}, receive, send)

    @app.get("/")
    def asked(request: Request) -> bool:
        return access.shows_solutions(request)

    async def ask() -> bool:
        transport = httpx.ASGITransport(as_spoken, client=(client, 40000))
        host = f"[{server}]" if ":" in server else server
        async with httpx.AsyncClient(transport=transport, base_url=f"http://{host}:8000") as asking:
            return bool((await asking.get("/", headers=headers)).json())

    return asyncio.run(ask())


@pytest.mark.parametrize("host", ["127.0.0.1:8000", "localhost:8000", "[::1]:8000", "LOCALHOST"])
def test_a_browser_at_the_machine_is_a_tutor_s(host: str) -> None:
    assert answered(None, {"host": host})
    assert answered(None, {"host": host, "origin": f"http://{host}"})
    assert answered(None, {"host": host}, client="::1", server="::1")
    # A browser that shows a page of the service, or whose user has typed the address.
    for site in ("same-origin", "none"):
        assert answered(None, {"host": host, "sec-fetch-site": site})
    own = {"origin": f"http://{host}", "sec-fetch-site": "same-origin", "sec-fetch-mode": "cors"}
    assert answered(None, {"host": host, **own})
    # A link on another page, which does not see the answer.
    link = {"sec-fetch-mode": "navigate", "sec-fetch-dest": "document"}
    for site in ("cross-site", "same-site"):
        assert answered(None, {"host": host, "sec-fetch-site": site, **link})


@pytest.mark.parametrize(
    ("headers", "ends"),
    [
        ({"host": "10.0.0.7:8000"}, {"client": "10.0.0.9", "server": "10.0.0.7"}),
        (PROGRAM, {"client": "10.0.0.9"}),  # a proxy that the server trusts
        (PROGRAM, {"server": "10.0.0.7"}),  # from the machine to an address that others can reach
        ({"host": "grader.example.edu"}, {}),  # nginx as in docs/deployment.md, or DNS rebinding
        ({"host": "localhost.example.edu"}, {}),
        ({"host": "[::1"}, {}),
        ({"host": ""}, {}),
        ({**PROGRAM, "x-forwarded-for": "127.0.0.1"}, {}),
        ({**PROGRAM, "forwarded": "for=127.0.0.1"}, {}),
        ({**PROGRAM, "via": "1.1 proxy"}, {}),
        ({**PROGRAM, "x-forwarded-proto": "https"}, {}),
        ({**PROGRAM, "cf-connecting-ip": "10.0.0.7"}, {}),
        (PROGRAM, {"http_version": "1.0"}),  # an unconfigured nginx
        ({**PROGRAM, "origin": "https://course.example.edu"}, {}),
        ({**PROGRAM, "origin": "http://127.0.0.1:9000"}, {}),
        ({**PROGRAM, "origin": "null"}, {}),
        # The same name with another scheme is another origin.
        ({**PROGRAM, "origin": "https://127.0.0.1:8000"}, {}),
        ({**PROGRAM, "origin": "chrome-extension://127.0.0.1:8000"}, {}),
        # A picture, script, frame or form of another page or of another port of this machine.
        *(
            ({**PROGRAM, "sec-fetch-site": site, **how}, {})
            for site in ("cross-site", "same-site", "unheard-of", "")
            for how in (
                {},
                {"sec-fetch-mode": "no-cors", "sec-fetch-dest": "image"},
                {"sec-fetch-mode": "no-cors", "sec-fetch-dest": "script"},
                {"sec-fetch-mode": "navigate", "sec-fetch-dest": "iframe"},
                {"sec-fetch-mode": "cors", "origin": "http://127.0.0.1:8000"},
            )
        ),
    ],
)
def test_no_other_request_is_a_tutor_s(headers: dict[str, str], ends: dict[str, str]) -> None:
    assert not answered(None, headers, **ends)


def test_the_setting_decides_if_it_is_set() -> None:
    far = {"client": "10.0.0.9", "server": "10.0.0.7"}
    assert answered(True, {"host": "grader.example.edu"}, **far)
    assert not answered(False, PROGRAM)
    # A page of another origin cannot use a tutor's browser.
    assert not answered(True, {**PROGRAM, "origin": "https://course.example.edu"})
    assert not answered(True, {**PROGRAM, "sec-fetch-site": "cross-site"})
    # A proxy ends TLS and does not say so, but the browser does.
    name = {"host": "grader.example.edu", "origin": "https://grader.example.edu"}
    assert answered(True, {**name, "sec-fetch-site": "same-origin"}, **far)
    assert not answered(True, name, **far)


def request(headers: dict[str, str], method: str = "GET", scheme: str = "http") -> Request:
    raw = [(name.encode(), value.encode()) for name, value in headers.items()]
    return Request({"type": "http", "method": method, "scheme": scheme, "headers": raw})


LINK = {"sec-fetch-site": "cross-site", "sec-fetch-mode": "navigate", "sec-fetch-dest": "document"}
OWN = {"host": "a.example", "origin": "http://a.example"}


@together(
    ("method", "scheme", "headers", "expected"),
    [
        # Programs send neither header.
        ("POST", "http", {}, True),
        ("POST", "http", {"sec-fetch-site": "same-origin"}, True),
        ("POST", "http", {"sec-fetch-site": "none"}, True),
        ("POST", "http", {"sec-fetch-site": "cross-site"}, False),
        ("GET", "http", {"sec-fetch-site": "same-site"}, False),
        # A link that the user follows; a form, a frame and a script are none.
        ("GET", "http", LINK, True),
        ("HEAD", "http", LINK, True),
        ("POST", "http", LINK, False),
        ("GET", "http", {**LINK, "sec-fetch-dest": "iframe"}, False),
        ("GET", "http", {**LINK, "sec-fetch-mode": "cors"}, False),
        ("GET", "http", {**LINK, **OWN, "origin": "http://b.example"}, False),
        # The origin is a scheme and a host.
        ("POST", "http", OWN, True),
        ("POST", "https", {**OWN, "origin": "https://a.example"}, True),
        ("POST", "https", OWN, False),
        ("POST", "http", {**OWN, "origin": "https://a.example"}, False),
        ("POST", "http", {**OWN, "origin": "http://b.example"}, False),
        ("POST", "http", {**OWN, "origin": "http://a.example:8000"}, False),
        ("POST", "http", {**OWN, "origin": "null"}, False),
        # Behind a proxy that hides the scheme, the browser knows better.
        (
            "POST", "http",
            {**OWN, "origin": "https://a.example", "sec-fetch-site": "same-origin"}, True,
        ),
        (
            "POST", "http",
            {**OWN, "origin": "https://b.example", "sec-fetch-site": "same-origin"}, False,
        ),
        ("POST", "http", {**OWN, "origin": "https://a.example", "sec-fetch-site": "none"}, False),
    ],
)  # fmt: skip
def test_a_page_of_another_origin_is_noticed(
    method: str, scheme: str, headers: dict[str, str], expected: bool
) -> None:
    assert is_same_origin(request(headers, method, scheme)) is expected


@together(
    ("scheme", "cookies", "headers", "expected"),
    [
        ("http", {}, {}, ""),
        ("http", {PLAIN_COOKIE: "plain"}, {}, "plain"),
        ("http", {SECURE_COOKIE: "secure"}, {}, "secure"),
        ("http", {PLAIN_COOKIE: "plain", SECURE_COOKIE: "secure"}, {}, "secure"),
        ("https", {SECURE_COOKIE: "secure"}, {}, "secure"),
        # Over HTTPS, anybody in the network may have set the plain cookie.
        ("https", {PLAIN_COOKIE: "plain"}, {}, ""),
        (
            "http", {PLAIN_COOKIE: "plain"},
            {"host": "a", "origin": "https://a", "sec-fetch-site": "same-origin"}, "",
        ),
        (
            "http", {SECURE_COOKIE: "secure"},
            {"host": "a", "origin": "https://a", "sec-fetch-site": "same-origin"}, "secure",
        ),
        ("http", {"other": "x"}, {}, ""),
        ("http", {PLAIN_COOKIE: "plain"}, {"sec-fetch-site": "cross-site"}, ""),
    ],
)  # fmt: skip
def test_the_session_is_in_the_cookie_that_counts(
    scheme: str, cookies: dict[str, str], headers: dict[str, str], expected: str
) -> None:
    cookie = "; ".join(f"{name}={value}" for name, value in cookies.items())
    sent = request({**headers, "cookie": cookie}, scheme=scheme)
    assert session_in(sent.scope) == expected


HERE = ("127.0.0.1", 8000)


@together(
    ("server", "client", "expected"),
    [
        (HERE, HERE, True), (("::1", 8000), ("::1", 9), True),
        # A socket in the file system has no address: the client may be a proxy.
        (None, None, False), (None, HERE, False), (HERE, None, False),
        (HERE, ("10.0.0.7", 9), False), (("10.0.0.7", 8000), HERE, False),
    ],
)  # fmt: skip
def test_a_client_at_the_machine_uses_its_loopback_address(
    server: tuple[str, int] | None, client: tuple[str, int] | None, expected: bool
) -> None:
    sent = request({"host": "localhost"})
    sent.scope.update({"server": server, "client": client, "http_version": "1.1"})
    assert is_at_the_machine(sent) is expected
    for changed in ({"http_version": "1.0"}, {"headers": [(b"host", b"a.example")]}):
        assert not is_at_the_machine(Request({**sent.scope, **changed}))


@together(
    ("setting", "server", "expected"),
    [
        (None, HERE, "grade record"), (None, ("::1", 8000), "grade record"),
        (None, None, "grade record"),
        (None, ("/run/grader.sock", None), "grade record"), (None, ("192.0.2.1", 8000), ""),
        ("until-keys", ("192.0.2.1", 8000), "grade record"),
        ("grade", ("192.0.2.1", 8000), "grade"), ("record", HERE, "grade record"),
        ("none", HERE, ""),
    ],
)  # fmt: skip
def test_without_keys_everybody_has_the_rights_of_the_setting(
    setting: str | None, server: tuple[str, int | None] | None, expected: str
) -> None:
    access = Access(open_access(setting))
    sent = request({})
    sent.scope["server"] = server
    everybody = Caller(frozenset(map(Scope, expected.split())))
    assert access.caller(sent) == everybody
    assert asyncio.run(access.identify(sent.scope)) == Identity(everybody)
    assert not access.is_signed_in(sent)


@together(
    ("setting", "read_here", "read_elsewhere", "changed_here"),
    [(True, True, True, True), (None, True, False, True), (False, False, False, False)],
)
def test_only_tutors_change_attempts_that_everybody_reads(
    setting: bool | None, read_here: bool, read_elsewhere: bool, changed_here: bool
) -> None:
    access = Access(read_attempts=setting)

    def permits(method: str, path: str, client: str) -> bool:
        sent = request({"host": "127.0.0.1"}, method)
        ends = {"server": HERE, "client": (client, 9), "http_version": "1.1"}
        sent.scope.update({**ends, "route": Route(path, print)})
        try:
            asyncio.run(access.permit(sent))
        except ProblemError:
            return False
        return True

    assert permits("GET", "/v1/attempts", "127.0.0.1") is read_here
    assert permits("GET", "/v1/attempts", "10.0.0.7") is read_elsewhere
    assert permits("POST", "/v1/learners/forget", "127.0.0.1") is changed_here
    assert not permits("POST", "/v1/learners/forget", "10.0.0.7")


@together(
    ("exercises", "exercise", "reaches"),
    [
        (None, "scara", True), (None, None, True), (["scara"], "scara", True),
        (["scara"], None, True),
        (["scara"], "scara~k7", True), (["scara"], "puma", False),
    ],
)  # fmt: skip
def test_another_exercise_than_those_of_the_caller_is_refused(
    exercises: list[str] | None, exercise: str | None, reaches: bool
) -> None:
    caller = Caller(frozenset(), None if exercises is None else frozenset(exercises))
    with nullcontext() if reaches else pytest.raises(ProblemError, match="certain exercises"):
        require_reach(caller, exercise)


@pytest.mark.parametrize(
    ("host", "expected"),
    [
        ("127.0.0.1", True), ("127.8.8.8", True), ("::1", True), ("10.0.0.7", False),
        ("::2", False), ("localhost", False), ("", False), ("127.0.0.1.example", False),
    ],
)  # fmt: skip
def test_a_loopback_address_is_a_number(host: str, expected: bool) -> None:
    assert is_loopback(host) is expected


@pytest.mark.parametrize(
    ("allowed", "origin", "passes"),
    [
        ((), "https://course.example", False),
        (("https://course.example",), "https://course.example", True),
        (("https://course.example",), "https://evil.example", False),
        (("*",), "https://evil.example", True),
        ((), "http://a.example", True),
    ],
)
def test_only_pages_of_allowed_origins_record_attempts(
    allowed: tuple[str, ...], origin: str, passes: bool
) -> None:
    access = Access(OPEN_HERE)
    sent = request({"host": "a.example", "origin": origin}, "POST")
    sent.scope["server"] = ("127.0.0.1", 8000)
    if passes:
        access.require_allowed_origin(sent, allowed)
    else:
        with pytest.raises(ProblemError) as refused:
            access.require_allowed_origin(sent, allowed)
        assert refused.value.status == 403


# --- docs/keys.md lists the right that each route requires

# Values for the texts of all problems.
VALUES: dict[str, str | int] = {
    "reason": "The key has expired.", "allowed": "record attempts", "scope": "record",
    "seconds": 7, "number": 100, "most": 64,
}  # fmt: skip


def test_the_page_has_the_table_of_rights() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert page == with_table(page), "The rights have changed; run python -m tests.api.rights_table"


def test_each_route_needs_the_right_on_the_page() -> None:
    lines = PAGE.read_text(encoding="utf-8").splitlines(keepends=True)
    listed = 0
    for route in RIGHTS:
        method, path = route.split(" ")
        right = right_of(Request({"type": "http", "method": method, "route": Route(path, print)}))
        # Routes that everybody may use are not on the page.
        assert (row(route, right) in lines) is (right.scope is not None), route
        listed += right.scope is not None
    assert sum(line.startswith(("| `GET /", "| `POST /")) for line in lines) == listed


def test_the_page_lists_every_problem_of_access() -> None:
    section = PAGE.read_text(encoding="utf-8").partition("## Errors\n")[2].partition("\n## ")[0]
    listed = {name: int(code) for code, name in re.findall(r"\| (\d+) \| `([a-z-]+)` \|", section)}
    assert listed.pop("store-down") == 503
    problems = {name: access_problem(name, **VALUES) for name in ACCESS_PROBLEMS}
    assert listed == {name: problem.status for name, problem in problems.items()}
    assert {problem.name for problem in problems.values()} == problems.keys()
    assert len({problem.title for problem in problems.values()}) == len(problems)
    assert len({problem.detail for problem in problems.values()}) == len(problems)


def test_a_refusal_says_how_to_be_authenticated_and_when_to_come_again() -> None:
    for name in ACCESS_PROBLEMS:
        answer = access_problem(name, **VALUES).response("/v1/grade")
        # RFC 6750, section 3: without a key, the challenge says nothing about an error.
        challenge = {"key-needed": "Bearer", "key-not-valid": 'Bearer error="invalid_token"'}
        assert answer.headers.get("WWW-Authenticate") == challenge.get(name)
        again = {"too-often": "7", "busy": "1"}
        assert answer.headers.get("Retry-After") == again.get(name)


@pytest.mark.parametrize(
    ("scope", "allowed"),
    [
        (Scope.GRADE, "have answers graded"), (Scope.RECORD, "record attempts"),
        (Scope.TUTOR, "see what tutors see"),
    ],
)  # fmt: skip
def test_the_missing_scope_is_named(scope: Scope, allowed: str) -> None:
    problem = scope_missing(scope)
    assert (problem.status, problem.name) == (403, "scope-missing")
    assert problem.detail == f"This key may not {allowed}: it has not the scope {scope.value}."


def routes_of(app: FastAPI) -> set[str]:
    return {
        f"{method} {route.path}"
        for route in iter_route_contexts(app.router.routes)
        for method in (route.methods or {"ANY"}) - {"HEAD"}
    }


def test_the_table_has_each_route_and_no_other(tmp_path: Path) -> None:
    # With a database and a secret, the service has all its routes.
    database, secret = f"sqlite:///{tmp_path}/attempts.db", "one secret of thirty letters or more"
    app = installed_app(load_settings(database=database, secret=secret))

    async def routes() -> set[str]:
        async with app.router.lifespan_context(app):
            return routes_of(app)

    assert asyncio.run(routes()) == RIGHTS.keys()


def test_a_route_without_an_entry_answers_nobody(
    catalogue: Mapping[str, Exercise], client_of: Callable[[FastAPI], httpx.Client]
) -> None:
    pages = APIRouter(prefix="/tutor")
    pages.add_api_route("/secrets", lambda: "secret")
    app = application(catalogue, pages=WebPages(pages, lambda *_: None, lambda: None, Drafts()))
    assert "GET /tutor/secrets" in routes_of(app)
    answer = client_of(app).get("/tutor/secrets")
    assert answer.status_code == 500
    assert answer.json()["type"].endswith(":failed")


def test_the_exercise_of_a_right_is_that_of_the_route(
    client_of: Callable[[FastAPI], httpx.Client],
) -> None:
    # If a query names several exercises, both the right and the route use the last exercise.
    app = FastAPI()

    @app.get("/{exercise_id}")
    def named(request: Request, exercise_id: str, exercise: str | None = None) -> list[object]:
        checked = [each.named(request) for each in (Reach.PATH, Reach.QUERY, Reach.ALL, Reach.OWN)]
        return [checked, exercise_id, exercise]

    client = client_of(app)
    for query in ("", "?exercise=a", "?exercise=a&exercise=b", "?exercise=b;exercise=a"):
        [path, of_query, *none], exercise_id, exercise = client.get(f"/scara{query}").json()
        assert (path, of_query, none) == (exercise_id, exercise, [None, None])
