"""Test requests and answers of the HTTP interface."""

import asyncio
import json
import re
from collections.abc import Callable, Mapping
from datetime import UTC, datetime
from http import HTTPStatus
from typing import Any

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.api.http import (
    LANGUAGE_COOKIE,
    MOST_RESULTS,
    MemoizedResults,
    ProblemError,
    keep_language,
    language_of,
    message_of,
)
from dh_grader.api.permissions import ACCESS_PROBLEMS, RIGHTS, access_problem
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.schema_fields import AttemptsSpec
from dh_grader.store import AttemptRefusedError, ruling
from dh_grader.submissions.bodies import MAX_BODY_SIZE
from dh_grader.translations import ENGLISH, LANGUAGES, Sentence, SentenceValue, told
from dh_grader.web import web_routes
from fastapi import FastAPI
from fastapi.routing import iter_route_contexts
from starlette.requests import Request
from starlette.responses import Response

from tests.api.test_scopes import Guarded
from tests.api.test_scopes import guarded as guarded
from tests.translations.pseudo import PSEUDO

# --- Every response that depends on the reader's language says so in its headers

_WORDS = (" ist ", " nicht ", " Sie ", " kein", " der ", " die ", "Aufgabe", "Gelenk")


def is_german(answer: httpx.Response) -> bool:
    text = answer.text
    if answer.headers.get("content-type", "").endswith("json"):
        text = json.dumps(answer.json(), ensure_ascii=False)
    return any(word in text for word in _WORDS)


def says_so(answer: httpx.Response) -> bool:
    vary = answer.headers.get("vary", "")
    return answer.headers.get("content-language") == "de" and "Accept-Language" in vary


def silent(guarded: Guarded, credential: str, routes: set[str]) -> tuple[list[str], set[str]]:
    async def answers() -> dict[str, httpx.Response]:
        async with guarded.client(credential) as client:
            return {route: await guarded.send(client, route, "de") for route in sorted(routes)}

    german = {route: each for route, each in asyncio.run(answers()).items() if is_german(each)}
    return [route for route, each in german.items() if not says_so(each)], set(german)


@pytest.mark.long
@pytest.mark.parametrize(
    "route",
    ["GET /v1/courses/{course_id}/scores", "POST /v1/exercises/{exercise_id}/regrade"],
)
def test_a_list_of_scores_and_a_regrade_say_their_language(guarded: Guarded, route: str) -> None:
    async def answer() -> httpx.Response:
        async with guarded.client(guarded.credentials["tutor"][0]) as client:
            return await guarded.send(client, route, "de")

    answered = asyncio.run(answer())
    assert answered.status_code == 200
    assert says_so(answered)
    assert answered.headers["cache-control"] == "no-store"


@pytest.mark.long
def test_every_answer_in_a_language_says_so(guarded: Guarded) -> None:
    told = set()
    # These are not translated: the style sheets and scripts, and the document of the interface.
    routes = RIGHTS.keys() - {"GET /static/{name}", "GET /docs/{name}"}
    for credential in ("", *guarded.credentials["tutor"], *guarded.credentials["learner"]):
        found, german = silent(guarded, credential, routes)
        assert found == []
        told |= german
    assert len(told) > 60


# --- Every route refuses invalid request bodies in the same way

GRADE = "/v1/exercises/planar-rrr/grade"
PREVIEW = "/v1/preview"


@pytest.mark.parametrize(
    ("body", "pointer"),
    [
        ([], "#"),
        ("text", "#"),
        (None, "#"),
        ({}, "#/answers"),
        ({"answers": []}, "#/answers"),
        ({"answers": None}, "#/answers"),
        ({"answers": {}, "angle_unit": "grad"}, "#/angle_unit"),
        ({"answers": {}, "angle_unit": None}, "#/angle_unit"),
        ({"answers": {}, "feedback": "all"}, "#/feedback"),
        ({"answers": {}, "angle_units": "degrees"}, "#/angle_units"),
    ],
)
def test_a_body_of_another_shape_gets_422_with_a_pointer(
    client: httpx.Client, body: object, pointer: str
) -> None:
    response = client.post(GRADE, content=json.dumps(body))
    assert response.status_code == 422
    assert response.headers["content-type"] == "application/problem+json"
    problem = response.json()
    assert problem["status"] == 422
    assert [error["pointer"] for error in problem["errors"]] == [pointer]


def test_an_unknown_field_is_answered_with_the_known_ones(client: httpx.Client) -> None:
    problem = client.post(GRADE, json={"answers": {}, "angle_units": "degrees"}).json()
    assert "answers, angle_unit, feedback" in problem["errors"][0]["detail"]


def test_an_unknown_field_inside_an_entry_is_not_answered_with_those_of_the_body(
    client: httpx.Client,
) -> None:
    entry = {"text": "l1*c1", "unit": "degrees"}
    body = {"exercise": "planar-rrr", "part": "position", "entries": [entry]}
    problem = client.post("/v1/previews", json=body).json()
    assert problem["errors"] == [
        {"pointer": "#/entries/0/unit", "detail": "This field is not known."}
    ]


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"  ",
        b"{",
        b"{'answers': {}}",
        b'{"answers": {}',
        b'{"answers": {},}',
        b'{"answers": {}} {}',
        b'\xff\xfe{"answers": {}}',
        b'{"answers": "\xff"}',
        b'{"answers": {"table": 1, "table": 2}}',
        b'{"answers": {"table": ' + b"[" * 10_000 + b"]" * 10_000 + b"}}",
        b'{"answers": {"table": ' + b'{"a":' * 10_000 + b"1" + b"}" * 10_000 + b"}}",
        b'{"answers": {"table": ' + b"[" * 500 + b"]" * 500 + b"}}",
        b"[" * 100_000,
    ],
)
@pytest.mark.parametrize("url", [GRADE, PREVIEW])
def test_a_body_that_is_not_json_gets_400(client: httpx.Client, url: str, content: bytes) -> None:
    response = client.post(url, content=content, headers={"Content-Type": "application/json"})
    assert response.status_code == 400
    assert response.headers["content-type"] == "application/problem+json"
    assert response.json()["type"] == "urn:dh-grader:problem:malformed-json"
    assert len(response.content) < 1000


def test_a_syntax_error_has_its_place(client: httpx.Client) -> None:
    problem = client.post(GRADE, content=b'{\n  "answers": {"table" 1}}').json()
    assert (problem["errors"][0]["line"], problem["errors"][0]["column"]) == (2, 23)
    assert "line 2, column 23" in problem["detail"]


def test_a_syntax_error_is_told_in_the_language(client: httpx.Client) -> None:
    response = client.post(GRADE, content=b'{"a" 1}', headers={"Accept-Language": "de"})
    assert response.headers["content-language"] == "de"
    told = "Das Trennzeichen ':' wird erwartet."
    assert response.json()["detail"] == f"{told} (Zeile 1, Spalte 6)"
    assert response.json()["errors"][0]["detail"] == told


@pytest.mark.parametrize(
    "content_type",
    ["application/json", "application/json; charset=utf-8", "application/x-www-form-urlencoded",
     "text/plain;charset=UTF-8", "application/vnd.course+json", "", "nonsense"],
)  # fmt: skip
def test_json_is_read_under_any_content_type(client: httpx.Client, content_type: str) -> None:
    headers = {"Content-Type": content_type} if content_type else {}
    response = client.post(GRADE, content=b'{"answers": {}}', headers=headers)
    assert response.status_code == 200


@pytest.mark.parametrize(
    ("content_type", "status"),
    [
        ("multipart/form-data; boundary=x", 415),
        ("application/x-www-form-urlencoded", 415),
        ("application/problem+json", 400),
    ],
)
def test_a_body_that_is_not_json_under_another_content_type_gets_415(
    client: httpx.Client, content_type: str, status: int
) -> None:
    headers = {"Content-Type": content_type}
    assert client.post(GRADE, content=b"answers=1", headers=headers).status_code == status


def test_a_byte_order_mark_is_no_mistake(client: httpx.Client) -> None:
    assert client.post(GRADE, content='\ufeff{"answers": {}}'.encode()).status_code == 200


def test_control_characters_in_names_come_back_escaped(client: httpx.Client) -> None:
    content = b'{"answers": {"\\ud800\\u0000\\u001b[31m": 1}}'
    response = client.post(GRADE, content=content)
    assert response.status_code == 422
    assert response.content.isascii()
    assert b"\x1b" not in response.content


@pytest.mark.parametrize("url", [GRADE, PREVIEW])
def test_only_the_first_of_thousands_of_unknown_fields_are_listed(
    client: httpx.Client, url: str
) -> None:
    # Known fields that follow the unknown fields are not reported as missing.
    known: dict[str, object] = {"answers": {}} if url == GRADE else {"text": "q1"}
    response = client.post(url, json={**{f"field{i}": 0 for i in range(12_000)}, **known})
    assert response.status_code == 422
    pointers = [error["pointer"] for error in response.json()["errors"]]
    assert pointers == [f"#/field{i}" for i in range(20)]


def test_only_the_first_of_thousands_of_unknown_parts_are_listed(client: httpx.Client) -> None:
    response = client.post(GRADE, json={"answers": {f"part{i}": 0 for i in range(12_000)}})
    assert response.status_code == 422
    pointers = [error["pointer"] for error in response.json()["errors"]]
    assert pointers == [f"#/answers/part{i}" for i in range(20)]


# --- Test what holds for all routes: size limits, methods, headers and failures

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


# --- Memoized


def test_results_are_computed_once_and_the_last_ones_are_kept() -> None:
    worked: list[object] = []

    def work(key: object) -> bytes:
        worked.append(key)
        return str(key).encode()

    async def ask() -> None:
        kept = MemoizedResults()
        asked = [kept.of("first", lambda: work("first")) for _ in range(3)]
        assert await asyncio.gather(*asked) == [b"first"] * 3
        assert worked == ["first"]
        for i in range(MOST_RESULTS):
            assert await kept.of(i, lambda: work(i)) == str(i).encode()  # noqa: B023 -- awaited here
        await kept.of(MOST_RESULTS - 1, lambda: work("again"))
        assert len(worked) == 1 + MOST_RESULTS
        await kept.of("first", lambda: work("first"))
        assert len(worked) == 2 + MOST_RESULTS

    asyncio.run(ask())


# --- Error messages of the service are in the reader's language

GERMAN = {"Accept-Language": "de-AT, en;q=0.5"}
VALUES: dict[str, SentenceValue] = {
    "reason": "?", "allowed": "?", "scope": "?", "seconds": 3, "number": 64, "most": 20,
}  # fmt: skip


def test_a_problem_is_in_the_language_of_the_reader(client: httpx.Client) -> None:
    answer = client.get("/v1/exercises/planar-r", headers=GERMAN)
    problem = answer.json()
    assert problem["title"] == "Diese Aufgabe gibt es nicht"
    assert problem["detail"].startswith("Eine Aufgabe 'planar-r' gibt es nicht. Meinten Sie ")
    assert problem["type"].endswith("unknown-exercise")
    assert answer.headers["Content-Language"] == "de"
    assert "Accept-Language" in answer.headers["Vary"]


def test_without_a_language_it_is_in_english(client: httpx.Client) -> None:
    answer = client.get("/v1/exercises/planar-r")
    assert answer.json()["title"] == "There is no such exercise"


def test_the_query_decides_before_the_header(client: httpx.Client) -> None:
    answer = client.post("/v1/grade?lang=fr", content=b"no JSON", headers=GERMAN)
    assert answer.json()["title"] == "Le corps est illisible"


def test_problems_of_single_submissions_are_told_too(client: httpx.Client) -> None:
    submissions = {"submissions": [{"exercise": "no-such-arm", "answers": {}}]}
    [result] = client.post("/v1/grade?lang=es", json=submissions).json()["results"]
    assert result["problem"]["title"] == "No existe ese ejercicio"


@pytest.mark.parametrize("code", [code for code in LANGUAGES if code != "en"])
@pytest.mark.parametrize("name", ACCESS_PROBLEMS)
def test_each_problem_of_access_is_translated(name: str, code: str) -> None:
    problem = access_problem(name, **VALUES)
    translation = LANGUAGES[code].translation
    assert told(problem.title, translation) != problem.title
    if name != "key-not-valid":  # its detail is the reason
        assert told(problem.detail, translation) != problem.detail


def test_a_refused_attempt_says_why_in_the_language_of_the_learner() -> None:
    with pytest.raises(AttemptRefusedError) as refused:
        ruling(AttemptsSpec(limit=1), 1, datetime.now(UTC))
    message = message_of(refused.value)
    assert isinstance(message, Sentence)
    assert told(message, LANGUAGES["de"].translation).startswith("Es ist kein Versuch mehr übrig")


def test_the_message_of_a_plain_error_is_its_text() -> None:
    assert message_of(ValueError("no such file")) == "no such file"
    assert message_of(ProblemError(HTTPStatus.NOT_FOUND, "x"))


def _hostile(schema: Mapping[str, Any]) -> list[str]:
    times = ["2026-10-01", "2026-99-01T25:00", "10000-01-01T00:00", "0001-01-01T00:00+10:00"]
    return ["", "x", "a\nb", "x" * 300, "7.5", "-1", *times, str(schema.get("maximum", 0) + 1)]


def test_every_error_of_a_query_is_told_in_the_language(app: FastAPI, client: httpx.Client) -> None:
    told_there = 0
    for path, operations in app.openapi()["paths"].items():
        for given in operations.get("get", {}).get("parameters", ()):
            if given["in"] == "query" and given["name"] != "lang":
                for value in _hostile(given["schema"]):
                    answer = client.get(path, params={given["name"]: value, "lang": "zh"})
                    if answer.status_code == HTTPStatus.UNPROCESSABLE_ENTITY:
                        told_there += 1
                        for error in answer.json()["errors"]:
                            assert not error["detail"].startswith("此值不可用"), error
                            assert not error["detail"].isascii(), error
    assert told_there > 50


def test_the_errors_of_fields_are_told_in_the_language(client: httpx.Client) -> None:
    body = {"answers": [], "angle_unit": 7}
    answer = client.post("/v1/exercises/planar-rr/grade", json=body, headers=GERMAN)
    assert answer.headers["Content-Language"] == "de"
    assert [error["detail"] for error in answer.json()["errors"]] == [
        "Hier ist ein JSON-Objekt nötig.",
        "Einer dieser Werte ist nötig: radians, degrees.",
    ]
    assert answer.json()["detail"].startswith("#/answers: Hier ist ein JSON-Objekt nötig. #/angle")


# --- Choose the language of a response


@pytest.fixture
def _offered(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(LANGUAGES, PSEUDO.code, PSEUDO)


def request(query: str = "", cookie: str = "", accepted: str = "", root: str = "") -> Request:
    headers = [(b"host", b"service")]
    if cookie:
        headers.append((b"cookie", f"{LANGUAGE_COOKIE}={cookie}".encode()))
    if accepted:
        headers.append((b"accept-language", accepted.encode()))
    return Request({
        "type": "http", "method": "GET", "scheme": "http", "path": "/", "root_path": root,
        "query_string": query.encode(), "headers": headers, "server": ("service", 80),
    })  # fmt: skip


@pytest.mark.usefixtures("_offered")
def test_the_query_decides_before_the_cookie_and_the_cookie_before_the_header() -> None:
    assert language_of(request("lang=qps", "en", "en")) is PSEUDO
    assert language_of(request("", "qps", "en")) is PSEUDO
    assert language_of(request("", "", "tlh, qps;q=0.5")) is PSEUDO
    assert language_of(request("lang=en", "qps", "qps")) is ENGLISH
    assert language_of(request("", "en", "qps")) is ENGLISH
    assert language_of(request()) is ENGLISH


@pytest.mark.usefixtures("_offered")
def test_an_unknown_language_decides_nothing() -> None:
    assert language_of(request("lang=tlh", "qps")) is PSEUDO
    assert language_of(request("lang=", "%0d%0a", "qps")) is PSEUDO


@pytest.mark.usefixtures("_offered")
def test_the_language_on_a_platform_comes_after_the_cookie() -> None:
    assert language_of(request(accepted="en"), "qps-Ploc") is PSEUDO
    assert language_of(request(cookie="en"), "qps") is ENGLISH
    assert language_of(request(accepted="qps"), "") is PSEUDO


@pytest.mark.usefixtures("_offered")
def test_only_a_choice_by_the_query_is_kept() -> None:
    answer = Response()
    keep_language(request("", "qps", "qps"), answer)
    keep_language(request("lang=tlh"), answer)
    assert "set-cookie" not in answer.headers
    keep_language(request("lang=qps", root="/grader"), answer)
    [cookie] = answer.headers.getlist("set-cookie")
    assert cookie.startswith(f"{LANGUAGE_COOKIE}=qps;")
    for attribute in ("HttpOnly", "Max-Age=31536000", "Path=/grader", "SameSite=lax"):
        assert attribute in cookie
