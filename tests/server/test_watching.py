"""Test logs and metrics."""

import asyncio
import json
import os
import signal
from collections.abc import Mapping
from datetime import datetime
from pathlib import Path
from typing import Any

import httpx
import pytest
from dh_grader.server import installed_app
from dh_grader.settings import Settings
from dh_grader.submissions.bodies import MAX_BODY_SIZE
from prometheus_client.parser import text_string_to_metric_families

from tests.server.raw import Service, service, until, workers
from tests.store.databases import new_file
from tests.store.recorded import NO_TWIST, RIGHT

# --- The JSON log of a real process contains request ids and no secrets

SECRET = "a1_hidden_answer"
ANSWER = b'{"learner": "Ada", "answers": {"table": "%b 0 0 x"}}' % SECRET.encode()


def post(path: str, body: bytes, *headers: bytes) -> bytes:
    lines = [b"POST %b HTTP/1.1" % path.encode(), b"Host: x", b"Content-Length: %d" % len(body)]
    return b"\r\n".join([*lines, *headers]) + b"\r\n\r\n" + body


def logged(folder: Path) -> tuple[list[dict[str, Any]], str]:
    settings = {"DH_GRADER_LOG_FORMAT": "json", "DH_GRADER_DATABASE": new_file(folder)}
    with service(folder, **settings) as running:
        attempts = "/v1/exercises/scara/attempts"
        (answer,) = running.ask(post(attempts, ANSWER, b"X-Request-ID: course-1"))
        assert answer.status == 201
        (answer,) = running.ask(post("/v1/exercises/scara/grade?key=swordfish", ANSWER))
        assert answer.status == 422
        running.ask(b"NONSENSE\r\n\r\n")
        assert running.end() == 0
        lines = [json.loads(line) for line in running.log.splitlines()]
        return lines, running.log


@pytest.mark.long
def test_every_line_is_an_object_and_contains_no_answer(tmp_path: Path) -> None:
    lines, text = logged(tmp_path)
    for line in lines:
        assert {"time", "level", "logger", "message"} <= line.keys()
        assert datetime.fromisoformat(line["time"]).utcoffset() is not None
    requests = [line for line in lines if line["logger"] == "uvicorn.access"]
    logged_requests = [(line["method"], line["path"], line["status"]) for line in requests]
    assert logged_requests == [
        ("POST", "/v1/exercises/scara/attempts", 201),
        ("POST", "/v1/exercises/scara/grade", 422),
        ("-", "-", 400),
    ]
    assert requests[0]["request_id"] == "course-1"
    assert requests[0]["milliseconds"] > 0
    assert len({line["request_id"] for line in requests}) == 3
    for secret in (SECRET, "Ada", "swordfish"):
        assert secret not in text


# --- Test the metrics of a real process and its workers

ROUTE = "/v1/exercises/{exercise_id}/attempts"
Samples = Mapping[tuple[str, frozenset[str]], float]


def asked(running: Service) -> Samples:
    (answer,) = running.ask(b"GET /metrics HTTP/1.1\r\nHost: localhost\r\n\r\n")
    assert answer.status == 200, answer.body
    assert answer.headers["content-type"].startswith("text/plain")
    return {
        (sample.name, frozenset(sample.labels.values())): sample.value
        for family in text_string_to_metric_families(answer.body.decode())
        for sample in family.samples
    }


def value(samples: Samples, name: str, *labels: str) -> float:
    return samples.get((f"dh_grader_{name}", frozenset(labels)), 0.0)


def attempt(running: Service, learner: str, table: str) -> None:
    body = json.dumps({"learner": learner, "answers": {"table": table}}).encode()
    head = b"POST /v1/exercises/scara/attempts HTTP/1.1\r\nHost: x\r\nContent-Length: %d\r\n\r\n"
    (answer,) = running.ask(head % len(body) + body)
    assert answer.status == 201


def check_counts(samples: Samples, attempts: int) -> None:
    assert value(samples, "requests_total", "POST", ROUTE, "201") == attempts
    assert value(samples, "requests_total", "GET", "other", "404") == 3
    assert value(samples, "request_seconds_count", ROUTE) == attempts
    assert value(samples, "grading_seconds_count") == attempts
    assert 0 < value(samples, "grading_seconds_sum") < 60
    assert value(samples, "parts_total", "dh_table", "correct") == attempts - 1
    assert value(samples, "parts_total", "dh_table", "partial") == 1
    assert value(samples, "messages_total", "half_turn") == 1
    assert value(samples, "store_seconds_count", "record") == attempts
    assert value(samples, "store_failures_total", "record") == 0
    # The request for the metrics itself.
    assert value(samples, "requests_in_progress") == 1
    assert value(samples, "requests_waiting") == 0


@pytest.mark.campaign
def test_each_worker_returns_the_metrics_of_all_workers(tmp_path: Path) -> None:
    settings = {"DH_GRADER_METRICS": "local", "DH_GRADER_DATABASE": new_file(tmp_path)}
    with service(tmp_path, "--workers", "2", **settings) as running:
        until(lambda: running.log.count("startup complete") == 2)
        attempt(running, "ada", NO_TWIST)
        attempt(running, "ada", RIGHT)
        attempt(running, "bob", RIGHT)
        for i in range(3):
            running.ask(b"GET /nowhere/%d HTTP/1.1\r\nHost: x\r\n\r\n" % i)
        check_counts(asked(running), 3)
        os.kill(min(workers(running)), signal.SIGKILL)
        until(lambda: running.log.count("startup complete") == 3)
        attempt(running, "bob", RIGHT)
        check_counts(asked(running), 4)
        through_a_proxy = b"GET /metrics HTTP/1.1\r\nHost: localhost\r\nVia: 1.1 x\r\n\r\n"
        (answer,) = running.ask(through_a_proxy)
        assert answer.status == 403
        assert running.end() == 0


def told(client: tuple[str, int], **settings: Any) -> httpx.Response:
    app = installed_app(Settings(**settings))

    async def ask() -> httpx.Response:
        transport = httpx.ASGITransport(app, client=client)
        async with httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1") as http:
            await http.get("/v1/exercises/scara")
            return await http.get("/metrics")

    return asyncio.run(ask())


def test_refused_requests_are_counted_under_their_route() -> None:
    app = installed_app(Settings(metrics="local", address_rate="2/hour"))
    path = "/v1/exercises/scara/grade"
    large = {"Content-Length": str(10 * MAX_BODY_SIZE)}

    async def ask() -> str:
        transport = httpx.ASGITransport(app, client=("127.0.0.1", 1))
        async with httpx.AsyncClient(transport=transport, base_url="http://127.0.0.1") as http:
            assert (await http.post(path, content=b"", headers=large)).status_code == 413
            asked = [await http.post(path, json={"answers": {}}) for _ in range(3)]
            assert [each.status_code for each in asked] == [200, 200, 429]
            assert (await http.get("/v1/nowhere")).status_code == 429
            return (await http.get("/metrics")).text

    own = asyncio.run(ask())
    counted = [("POST", ROUTE.replace("attempts", "grade"), status) for status in (200, 413, 429)]
    for method, route, status in (*counted, ("GET", "other", 429)):
        labels = f'{{method="{method}",route="{route}",status="{status}"}}'
        assert f"dh_grader_requests_total{labels} {2.0 if status == 200 else 1.0}" in own


@pytest.mark.long
def test_metrics_contain_the_memory_and_are_shown_to_other_machines_only_if_set_to_all() -> None:
    here, elsewhere = ("127.0.0.1", 1), ("192.0.2.7", 1)
    own = told(here, metrics="local").text
    count = (
        'dh_grader_requests_total{method="GET",route="/v1/exercises/{exercise_id}",status="200"}'
    )
    assert f"{count} 1.0" in own
    assert "process_resident_memory_bytes" in own
    assert [told(elsewhere, metrics=whom).status_code for whom in ("local", "all")] == [403, 200]
    assert told(here).status_code == 404
