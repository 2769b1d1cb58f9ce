"""A request that is answered by 401, 403 or 404 costs no reading of answers."""

import json
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from http import HTTPStatus
from pathlib import Path
from typing import Any

import httpx
import pytest
from dh_grader.access import open_access
from dh_grader.api import frames as preview
from dh_grader.api.application import application
from dh_grader.api.grading_gates import PracticeGate
from dh_grader.api.http import ProblemError
from dh_grader.api.permissions import RIGHTS, Access
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.schema_fields import AttemptsSpec
from dh_grader.grading import grade
from dh_grader.grading.reading.entries import Reader
from dh_grader.store.attempt_store import AttemptStore
from fastapi import FastAPI

from tests.store.databases import new_file

ARM = "stanford-arm"
_TEXT = "[" + "(" * 12_900 + ")" * 12_900 + "]"
COSTLY = dict.fromkeys(("table", "links", "pose"), _TEXT)
HINT = {"part": "table", "code": "sign", "row": "1", "cell": "alpha", "step": 1}
# The routes that students use; each has the path below an exercise, and its further fields.
STUDENTS: Mapping[str, Mapping[str, Any]] = {
    "grade": {},
    "hints": HINT,
    "choices": {"part": "table", "rows": []},
    "solution": {},
    "attempts": {"learner": "ada"},
}
_REFUSED = ProblemError(HTTPStatus.FORBIDDEN, "No practice.", "no-practice")


@pytest.fixture
def readings(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return a list that gets an entry whenever the program begins to read answers."""
    found: list[str] = []

    def counted(owner: Any, name: str) -> None:
        original = getattr(owner, name)

        def call(*arguments: Any, **named: Any) -> Any:
            found.append(name)
            return original(*arguments, **named)

        monkeypatch.setattr(owner, name, call)

    counted(Reader, "of")
    counted(preview, "read")
    return found


@pytest.fixture
def store(tmp_path: Path) -> Iterator[AttemptStore]:
    opened = AttemptStore.open(new_file(tmp_path))
    opened.start()
    yield opened
    opened.close()


def posted(client: httpx.Client, path: str, body: Mapping[str, Any]) -> httpx.Response:
    return client.post(path, content=json.dumps(body))


def body_of(route: str, answers: Mapping[str, Any] = COSTLY) -> dict[str, Any]:
    fields = STUDENTS[route]
    return dict(fields) if route == "choices" else {"answers": answers, **fields}


def test_a_costly_body_is_read_where_it_is_graded(
    client: httpx.Client, readings: list[str]
) -> None:
    # Otherwise the other tests here would test nothing.
    cheap = dict.fromkeys(COSTLY, "(")
    assert posted(client, f"/v1/exercises/{ARM}/grade", {"answers": cheap}).status_code == 200
    assert posted(client, "/v1/preview", {"text": "("}).status_code == 200
    assert readings == ["of", "read"]


@pytest.mark.parametrize("route", STUDENTS)
def test_of_an_unknown_exercise(
    catalogue: Mapping[str, Exercise], client_of: Callable[[FastAPI], httpx.Client],
    store: AttemptStore, readings: list[str], route: str,
) -> None:  # fmt: skip
    client = client_of(application(catalogue, store=store))
    assert posted(client, f"/v1/exercises/nothing/{route}", body_of(route)).status_code == 404
    assert readings == []


def test_without_a_right(
    catalogue: Mapping[str, Exercise], client_of: Callable[[FastAPI], httpx.Client],
    store: AttemptStore, readings: list[str],
) -> None:  # fmt: skip
    access = Access(open_access("none"))
    client = client_of(application(catalogue, access=access, store=store))
    everything = {"answers": COSTLY, "text": _TEXT, "exercise": ARM, **HINT}
    asked = 0
    for route, right in RIGHTS.items():
        method, _, path = route.partition(" ")
        if method == "POST" and right.scope is not None and path.startswith("/v1/"):
            filled = re.sub(r"\{\w+(:path)?\}", ARM, path)
            assert posted(client, filled, everything).status_code in (401, 403, 404), route
            asked += 1
    assert asked > 20
    assert readings == []


@pytest.mark.parametrize("route", STUDENTS)
def test_of_an_exercise_that_may_not_be_practised_now(
    catalogue: Mapping[str, Exercise], client_of: Callable[[FastAPI], httpx.Client],
    store: AttemptStore, readings: list[str], monkeypatch: pytest.MonkeyPatch, route: str,
) -> None:  # fmt: skip
    async def refusal(*_: object) -> ProblemError:
        return _REFUSED

    async def refused(*_: object) -> None:
        raise _REFUSED

    monkeypatch.setattr(PracticeGate, "refusal", refusal)
    monkeypatch.setattr(PracticeGate, "check_solution", refused)
    client = client_of(application(catalogue, store=store))
    # The body is not looked at either.
    path = f"/v1/exercises/{ARM}/{route}"
    assert client.post(path, content="{").json()["type"].endswith("no-practice")
    assert posted(client, path, body_of(route)).status_code == 403
    batch = {"submissions": [{"exercise": ARM, "answers": COSTLY}] * 2}
    results = posted(client, "/v1/grade", batch).json()["results"]
    assert [each["problem"]["status"] for each in results] == [403, 403]
    assert readings == []


def test_a_batch_names_unknown_exercises(client: httpx.Client, readings: list[str]) -> None:
    batch = {"submissions": [{"exercise": "nothing", "answers": COSTLY}] * 2}
    results = posted(client, "/v1/grade", batch).json()["results"]
    assert [each["problem"]["status"] for each in results] == [404, 404]
    assert readings == []


@pytest.mark.parametrize(
    ("changes", "status"),
    [
        ({"code": "nothing"}, 404),
        # The code of a message on an unreadable entry, which has no hint.
        ({"code": "unbalanced_bracket"}, 404),
        ({"answers": {"links": _TEXT, "pose": _TEXT}}, 404),
        ({"feedback": "verdicts"}, 403),
    ],
)
def test_a_hint_that_no_report_has(
    client: httpx.Client, readings: list[str], changes: Mapping[str, Any], status: int
) -> None:
    answer = posted(client, f"/v1/exercises/{ARM}/hints", {**body_of("hints"), **changes})
    assert answer.status_code == status
    assert readings == []


def test_a_hint_reads_no_later_part(client: httpx.Client, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []
    graded = grade.__globals__["_graded"]

    def noted(part: Any, *others: Any) -> Any:
        asked.append(part.id)
        return graded(part, *others)

    monkeypatch.setitem(grade.__globals__, "_graded", noted)
    cheap = dict.fromkeys(COSTLY, "(")
    answer = posted(client, f"/v1/exercises/{ARM}/hints", body_of("hints", cheap))
    assert answer.status_code == 404
    assert asked == ["table"]
    asked.clear()
    path = f"/v1/exercises/{ARM}/solution"
    assert posted(client, path, {"answers": cheap}).status_code == 403
    # The first wrong answer decides.
    assert asked == ["table"]


@pytest.mark.parametrize("answers", [COSTLY, {"links": _TEXT, "pose": _TEXT}])
def test_a_solution_that_is_not_shown(
    catalogue: Mapping[str, Exercise], client_of: Callable[[FastAPI], httpx.Client],
    readings: list[str], answers: Mapping[str, Any],
) -> None:  # fmt: skip
    counts = answers is COSTLY
    rules = AttemptsSpec(limit=3) if counts else AttemptsSpec()
    exercises = {ARM: replace(catalogue[ARM], attempts=rules)}
    client = client_of(application(exercises))
    path = f"/v1/exercises/{ARM}/solution"
    assert posted(client, path, {"answers": answers}).status_code == 403
    assert readings == []
