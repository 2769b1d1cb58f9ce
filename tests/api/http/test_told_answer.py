"""The language of a response is that of the query, else of the header, else English."""

import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import httpx
import pytest
from dh_grader.api import frames as preview
from dh_grader.api import grading
from dh_grader.api import grading as hints
from dh_grader.api.application import application
from dh_grader.catalogue import load_catalogue
from dh_grader.expressions import ExpressionError
from dh_grader.formats.graded import with_texts
from dh_grader.grading import Report, Submission, grade
from dh_grader.hints import HintStep
from dh_grader.kinematics import Convention
from dh_grader.translations import say
from fastapi import FastAPI

from tests.api.routes.test_exercises import SECRETIVE
from tests.translations.german import as_sentence, messages_in, offer_german

WORDS = {
    "no answer": "keine Antwort",
    "There is no {name}.": "Es gibt kein {name}.",
    "Look at {axis}.": "Sehen Sie sich {axis} an.",
    "joint angle of joint {joint}": "Gelenkwinkel von Gelenk {joint}",
}
TRANSLATED = """
[translations.de]
title = "Zwei Gelenke"
statement = "Ein Arm."
symbols.l1 = "eine Länge"

[translations.de.parts.table]
title = "Tabelle"
"""
HEADER = {"Accept-Language": "de-AT, en;q=0.5"}
GRADE = "/v1/exercises/planar-rr/grade"


@pytest.fixture(autouse=True)
def _german(monkeypatch: pytest.MonkeyPatch) -> None:
    offer_german(monkeypatch, WORDS)

    def graded(exercise: Any, submission: Submission) -> Report:
        return with_texts(grade(exercise, submission), as_sentence)

    monkeypatch.setattr(grading, "grade", graded)


@pytest.mark.parametrize(
    ("query", "header", "language", "message"),
    [
        ("", {}, "en", "no answer"),
        ("", HEADER, "de", "keine Antwort"),
        ("?lang=de", {}, "de", "keine Antwort"),
        ("?lang=en", HEADER, "en", "no answer"),
        ("?lang=xx", {}, "en", "no answer"),
        ("?lang=", {"Accept-Language": "tlh"}, "en", "no answer"),
    ],
)
def test_a_report_is_in_the_language_of_the_reader(
    client: httpx.Client, query: str, header: Mapping[str, str], language: str, message: str
) -> None:
    one = client.post(f"{GRADE}{query}", json={"answers": {}}, headers=header)
    assert (one.status_code, one.headers["content-language"]) == (200, language)
    assert set(messages_in(one.json())) == {message}
    body = {"submissions": [{"exercise": "planar-rr", "answers": {}}, {"exercise": "x"}]}
    many = client.post(f"/v1/grade{query}", json=body, headers=header)
    assert many.headers["content-language"] == language
    assert set(messages_in(many.json()["results"][0]["report"])) == {message}


def test_a_preview_is_in_the_language_of_the_reader(
    client: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    def unread(*_: object, **__: object) -> None:
        raise ExpressionError("name", say("There is no {name}.", name="zz"), (0, 2))

    monkeypatch.setattr(preview, "read", unread)
    for query, message in (("", "There is no zz."), ("?lang=de", "Es gibt kein zz.")):
        shown = client.post(f"/v1/preview{query}", json={"text": "zz"})
        assert shown.json()["error"]["message"] == message
        assert shown.headers["content-language"] == (query[-2:] or "en")


def test_a_hint_is_in_the_language_of_the_reader(
    client: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    step = HintStep("α", say("Look at {axis}.", axis="z1"), Convention.STANDARD)
    monkeypatch.setattr(hints, "hint_step", lambda *_: step)
    body = {"answers": {"table": "0"}, "part": "table", "code": "sign", "step": 1}
    shown = client.post("/v1/exercises/planar-rr/hints?lang=de", json=body)
    assert (shown.json()["title"], shown.json()["text"]) == ("α", "Sehen Sie sich z1 an.")
    assert shown.headers["content-language"] == "de"


def test_an_exercise_is_in_the_language_of_the_reader(
    tmp_path: Path, client_of: Callable[[FastAPI], httpx.Client]
) -> None:
    (tmp_path / "two-joints.toml").write_text(SECRETIVE + TRANSLATED, encoding="utf-8")
    client = client_of(application(load_catalogue(tmp_path)))
    shown = client.get("/v1/exercises/two-joints", headers=HEADER)
    assert shown.headers["content-language"] == "de"
    assert {"Accept-Language", "Cookie"} <= set(shown.headers["vary"].split(", "))
    view = shown.json()
    assert (view["title"], view["statement"]) == ("Zwei Gelenke", "Ein Arm.")
    assert "Ein Arm." in view["statement_html"]
    assert [part["title"] for part in view["parts"]] == ["Tabelle", "Table, either way", "Pose"]
    assert view["parts"][0]["prompt"] == "Give the table."
    described = {each["name"]: each["description"] for each in view["symbols"]}
    assert described["q1"] == "Gelenkwinkel von Gelenk 1"
    assert described["l1"] == "eine Länge"
    [entry] = client.get("/v1/exercises?lang=de").json()["exercises"]
    assert entry["title"] == "Zwei Gelenke"
    for query in ("", "?lang=xx"):
        english = client.get(f"/v1/exercises/two-joints{query}").json()
        assert english["title"] == tomllib.loads(SECRETIVE)["title"]
        assert english["version"] == view["version"]


def test_the_reference_names_the_parameter(app: FastAPI) -> None:
    paths = app.openapi()["paths"]
    named = {
        (path, method)
        for path, operations in paths.items()
        for method, operation in operations.items()
        if any(each["name"] == "lang" for each in operation.get("parameters", ()))
    }
    assert {
        ("/v1/exercises", "get"),
        ("/v1/exercises/{exercise_id}", "get"),
        ("/v1/exercises/{exercise_id}/grade", "post"),
        ("/v1/exercises/{exercise_id}/hints", "post"),
        ("/v1/exercises/{exercise_id}/choices", "post"),
        ("/v1/attempts/{attempt_id}/hints", "post"),
        ("/v1/frames", "post"),
        ("/v1/grade", "post"),
        ("/v1/preview", "post"),
        ("/v1/previews", "post"),
    } <= named
