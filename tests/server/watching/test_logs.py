"""The JSON log of a real process contains request ids and no secrets."""

import json
from datetime import datetime
from pathlib import Path
from typing import Any

import pytest

from tests.server.raw import service
from tests.store.databases import new_file

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
