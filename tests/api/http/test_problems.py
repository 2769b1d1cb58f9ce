"""Error messages of the service are in the reader's language."""

from collections.abc import Mapping
from datetime import UTC, datetime
from http import HTTPStatus
from typing import Any

import httpx
import pytest
from dh_grader.api.http import ProblemError, message_of
from dh_grader.api.permissions import ACCESS_PROBLEMS, access_problem
from dh_grader.catalogue.schema_fields import AttemptsSpec
from dh_grader.store import AttemptRefusedError, ruling
from dh_grader.translations import LANGUAGES, Sentence, SentenceValue, told
from fastapi import FastAPI

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
