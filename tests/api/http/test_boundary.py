"""Test what holds for all routes: size limits, methods, headers and failures."""

import asyncio
import re
from collections.abc import Callable, Mapping
from typing import Any

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.api.permissions import RIGHTS
from dh_grader.catalogue import Exercise
from dh_grader.submissions.bodies import MAX_BODY_SIZE
from dh_grader.web import web_routes
from fastapi import FastAPI
from fastapi.routing import iter_route_contexts

GRADE = "/v1/exercises/planar-rrr/grade"
ClientOf = Callable[[FastAPI], httpx.Client]


def scope(headers: list[tuple[bytes, bytes]]) -> dict[str, Any]:
    return {
        "type": "http", "asgi": {"version": "3.0"}, "http_version": "1.1", "method": "POST",
        "path": GRADE, "raw_path": GRADE.encode(), "root_path": "", "scheme": "http",
        "query_string": b"", "headers": headers, "client": None, "server": None,
    }  # fmt: skip


def padded(size: int) -> bytes:
    return b'{"answers": {}}'.ljust(size)


@pytest.mark.parametrize("url", [GRADE, "/v1/preview", "/v1/exercises", "/nowhere"])
def test_a_declared_size_over_the_limit_is_a_413(client: httpx.Client, url: str) -> None:
    response = client.post(url, content=padded(MAX_BODY_SIZE + 1))
    assert response.status_code == 413
    assert response.headers["content-type"] == "application/problem+json"
    assert response.json()["type"] == "urn:dh-grader:problem:body-too-large"
    assert response.headers["connection"] == "close"


def test_a_body_at_the_limit_is_read(client: httpx.Client) -> None:
    assert client.post(GRADE, content=padded(MAX_BODY_SIZE)).status_code == 200


@pytest.mark.parametrize("declared", [None, b"10", b"-1", b"x", b"0" * 5000 + b"10"])
def test_a_body_that_outgrows_its_headers_is_not_read_to_its_end(
    app: FastAPI, declared: bytes | None
) -> None:
    chunk = b" " * 65536
    taken = 0
    sent: list[Any] = []

    async def receive() -> dict[str, Any]:
        nonlocal taken
        taken += 1
        return {"type": "http.request", "body": chunk, "more_body": taken < 320}

    async def send(message: Any) -> None:
        sent.append(message)

    headers = [(b"content-type", b"application/json")]
    if declared is not None:
        headers.append((b"content-length", declared))
    asyncio.run(app(scope(headers), receive, send))
    assert sent[0]["status"] == 413
    assert dict(sent[0]["headers"])[b"content-type"] == b"application/problem+json"
    assert taken == MAX_BODY_SIZE // len(chunk) + 1


def test_a_client_that_goes_away_is_not_a_failure_of_the_service(app: FastAPI) -> None:
    sent: list[Any] = []

    async def receive() -> dict[str, Any]:
        return {"type": "http.disconnect"}

    async def send(message: Any) -> None:
        sent.append(message)

    asyncio.run(app(scope([]), receive, send))
    assert sent[0]["status"] == 400


@pytest.mark.parametrize("url", ["/v1/exercises", "/v1/exercises/scara", "/healthz"])
def test_head_is_get_without_the_body(client: httpx.Client, url: str) -> None:
    name = {"X-Request-ID": "the-same"}
    got, headed = client.get(url, headers=name), client.head(url, headers=name)
    assert headed.status_code == got.status_code == 200
    assert headed.headers == got.headers
    assert headed.content == b""


@pytest.mark.parametrize(
    ("method", "url", "allow"),
    [
        ("DELETE", "/v1/exercises", "GET, HEAD, OPTIONS"),
        ("PUT", "/v1/exercises/scara", "GET, HEAD, OPTIONS"),
        ("GET", GRADE, "OPTIONS, POST"),
        ("HEAD", GRADE, "OPTIONS, POST"),
        ("GET", "/v1/preview", "OPTIONS, POST"),
    ],
)
def test_another_method_is_a_405_that_names_the_allowed_ones(
    client: httpx.Client, method: str, url: str, allow: str
) -> None:
    response = client.request(method, url)
    assert response.status_code == 405
    assert response.headers["allow"] == allow
    assert response.headers["content-type"] == "application/problem+json"


def test_options_names_the_methods(client: httpx.Client) -> None:
    response = client.options(GRADE)
    assert (response.status_code, response.content) == (204, b"")
    assert response.headers["allow"] == "OPTIONS, POST"
    assert client.options("/nowhere").status_code == 404


def test_options_and_a_wrong_method_name_all_methods_of_every_path(
    client_of: ClientOf, catalogue: Mapping[str, Exercise]
) -> None:
    app = application(catalogue, pages=web_routes(catalogue))
    client = client_of(app)
    there = {route.path for route in iter_route_contexts(app.router.routes)}
    # The methods of each path by the table of rights, which names every route.
    methods: dict[str, set[str]] = {}
    for each in RIGHTS:
        method, path = each.split(" ")
        if path in there:
            methods.setdefault(path, set()).add(method)
    assert len(methods) > 80
    assert {"GET", "POST"} <= methods["/v1/courses"]
    shapes = {path: re.compile(re.sub(r"\{\w+\}", "[^/]+", path)) for path in methods}
    for path in methods:
        url = re.sub(r"\{\w+\}", "x", path)
        allowed = {"OPTIONS"}.union(
            *(methods[each] for each, shape in shapes.items() if shape.fullmatch(url))
        )
        allowed |= {"HEAD"} if "GET" in allowed else set()
        answer = client.options(url)
        assert (answer.status_code, answer.headers["allow"]) == (204, ", ".join(sorted(allowed)))
        refused = client.request("PROPFIND", url)
        assert (refused.status_code, refused.headers["allow"]) == (405, answer.headers["allow"])


@pytest.mark.parametrize(
    "url", ["/", "/nowhere", "/metrics", "/v1/exercises/", "/v1/exercises/a/b", "/%ff"]
)
def test_an_unknown_address_is_a_404_problem(client: httpx.Client, url: str) -> None:
    response = client.get(url)
    assert response.status_code == 404
    assert response.headers["content-type"] == "application/problem+json"
    problem = response.json()
    assert set(problem) == {"type", "title", "status", "detail", "instance", "request_id"}
    assert problem["status"] == 404


@pytest.mark.parametrize("id_", ["abc", "Root=1-67891233:9", "x" * 128])
def test_an_id_of_the_client_comes_back(client: httpx.Client, id_: str) -> None:
    response = client.get("/nowhere", headers={"X-Request-ID": id_})
    assert response.headers["x-request-id"] == response.json()["request_id"] == id_


@pytest.mark.parametrize("id_", ["", "a b", 'a"', "x" * 129, "ä".encode(), "a\tb"])
def test_an_id_that_could_not_stand_in_a_log_is_replaced(
    client: httpx.Client, id_: str | bytes
) -> None:
    headers = httpx.Headers([(b"X-Request-ID", id_.encode() if isinstance(id_, str) else id_)])
    given = [client.get("/healthz", headers=headers).headers["x-request-id"] for _ in range(2)]
    assert given[0] != given[1]
    assert all(re.fullmatch("[0-9a-f]{32}", each) for each in given)


@pytest.mark.parametrize(
    ("method", "url"),
    [("GET", "/v1/exercises"), ("GET", "/nowhere"), ("POST", GRADE), ("DELETE", "/healthz")],
)
def test_every_answer_is_hardened(client: httpx.Client, method: str, url: str) -> None:
    response = client.request(method, url)
    assert response.headers["x-content-type-options"] == "nosniff"
    assert response.headers["cross-origin-resource-policy"] == "same-origin"
    assert "server" not in response.headers


def test_any_page_may_show_a_figure(client: httpx.Client) -> None:
    figure = client.get("/v1/exercises/scara/figure.svg")
    assert figure.headers["cross-origin-resource-policy"] == "cross-origin"


def test_a_failure_inside_says_nothing_of_itself(
    catalogue: Mapping[str, Exercise], client_of: ClientOf
) -> None:
    app = application(catalogue)

    @app.get("/fails")
    async def fails() -> None:
        raise RuntimeError("the secret")

    response = client_of(app).get("/fails")
    assert response.status_code == 500
    assert response.headers["content-type"] == "application/problem+json"
    assert response.headers["x-content-type-options"] == "nosniff"
    assert "secret" not in response.text
    assert "Traceback" not in response.text
    assert response.json()["instance"] == "/fails"


def test_what_the_framework_itself_refuses_is_a_problem_as_well(
    catalogue: Mapping[str, Exercise], client_of: ClientOf
) -> None:
    app = application(catalogue)

    @app.get("/attempts/{number}")
    async def attempts(number: int) -> int:
        return number

    response = client_of(app).get("/attempts/x")
    assert response.status_code == 422
    assert response.headers["content-type"] == "application/problem+json"
    assert [error["pointer"] for error in response.json()["errors"]] == ["#/number"]


COURSE = "https://course.example.edu"


def test_by_default_no_other_page_may_call(client: httpx.Client) -> None:
    response = client.get("/v1/exercises", headers={"Origin": COURSE})
    assert not [name for name in response.headers if name.startswith("access-control")]


def test_a_page_of_the_course_may_call_and_read_problems(
    catalogue: Mapping[str, Exercise], client_of: ClientOf
) -> None:
    client = client_of(application(catalogue, cors_origins=(COURSE,)))
    preflight = client.options(
        GRADE,
        headers={
            "Origin": COURSE,
            "Access-Control-Request-Method": "POST",
            "Access-Control-Request-Headers": "content-type",
        },
    )
    assert preflight.status_code == 200
    assert preflight.headers["access-control-allow-origin"] == COURSE
    too_large = client.post(GRADE, content=padded(MAX_BODY_SIZE + 1), headers={"Origin": COURSE})
    assert too_large.status_code == 413
    assert too_large.headers["access-control-allow-origin"] == COURSE
    elsewhere = client.get("/v1/exercises", headers={"Origin": "https://elsewhere.example"})
    assert "access-control-allow-origin" not in elsewhere.headers
