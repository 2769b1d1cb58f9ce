from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.catalogue import Exercise, Robot, load_catalogue
from fastapi import FastAPI

from tests.together import together

# Its reference has the numbers 0.125, 0.75, 61 and 0.3125, which are nowhere else in it.
SECRETIVE = """
title = "Two joints"
source = "none"
statement = "An arm."

[robot]
structure = "RP"
convention = "standard"
joints = ["q1", "d2"]
table = [["0.125 * l1", "61deg", "0", "q1 + 0.3125"], ["0.75 * l1", "0", "d2", "0"]]

[symbols]
l1 = { kind = "length", description = "a length" }

[[parts]]
id = "table"
kind = "dh_table"
title = "Table"
prompt = "Give the table."
points = 3
convention = "standard"

[[parts]]
id = "any"
kind = "dh_table"
title = "Table, either way"
convention = "either"
frames = "free"

[[parts]]
id = "pose"
kind = "transform"
title = "Pose"
marking = "whole"
"""


@pytest.fixture
def secretive(tmp_path: Path, client_of: Callable[[FastAPI], httpx.Client]) -> httpx.Client:
    (tmp_path / "two-joints.toml").write_text(SECRETIVE, encoding="utf-8")
    return client_of(application(load_catalogue(tmp_path)))


def test_the_list_names_every_exercise_with_its_parts(
    client: httpx.Client, catalogue: Mapping[str, Exercise]
) -> None:
    response = client.get("/v1/exercises")
    assert response.status_code == 200
    listed = response.json()
    assert list(listed) == ["exercises"]
    assert [exercise["id"] for exercise in listed["exercises"]] == list(catalogue)
    [scara] = [exercise for exercise in listed["exercises"] if exercise["id"] == "scara"]
    described = {"level", "order", "minutes", "summary", "keywords", "conventions"}
    assert set(scara) == {"id", "title", "source", "structure", "parts"} | described
    assert (scara["level"], scara["conventions"]) == ("industrial", ["standard"])
    assert scara["structure"] == "RRPR"
    kinds = {part["id"]: part["kind"] for part in scara["parts"]}
    assert kinds["table"] == "dh_table"
    assert kinds["pose"] == "transform"
    assert set(scara["parts"][0]) == {"id", "kind", "points"}


def test_an_exercise_shows_exactly_what_a_student_may_see(secretive: httpx.Client) -> None:
    response = secretive.get("/v1/exercises/two-joints")
    assert response.status_code == 200
    shown = response.json()
    version = shown.pop("version")
    assert isinstance(version, str)
    assert version
    given: dict[str, Any] = {"frames": "given", "base": "given", "tool": "given"}
    given |= {"directions": "given", "empty_cells": "unread", "given": {}}
    table = {"form": "dh_table", "columns": ["a", "alpha", "d", "theta"], "rows": ["1", "2"]}
    four = ["1", "2", "3", "4"]
    assert shown == {
        "id": "two-joints",
        "title": "Two joints",
        "source": "none",
        "summary": "",
        "keywords": [],
        "conventions": ["standard", "modified"],
        "structure": "RP",
        "statement": "An arm.",
        "statement_html": "<p>An arm.</p>\n",
        "figure": True,
        "feedback": "hints",
        "symbols": [
            {
                "name": "q1",
                "kind": "angle",
                "unit": "rad",
                "description": "joint angle of joint 1",
                "joint": 1,
            },
            {
                "name": "d2",
                "kind": "length",
                "unit": "m",
                "description": "joint displacement of joint 2",
                "joint": 2,
            },
            {"name": "l1", "kind": "length", "unit": "m", "description": "a length"},
        ],
        "parts": [
            part("table", "dh_table", "Table", "Give the table.", 3)
            | {"shape": table | given | {"convention": "standard"}},
            part("any", "dh_table", "Table, either way", "", 1)
            | {
                "shape": {
                    **table,
                    **given,
                    "frames": "free",
                    "convention": "either",
                    "rows": ["1", "2", "e"],
                }
            },
            part("pose", "transform", "Pose", "", 1)
            | {"marking": "whole", "shape": {"form": "matrix", "columns": four, "rows": four}},
        ],
    }


def part(part_id: str, kind: str, title: str, prompt: str, points: float) -> dict[str, Any]:
    return {
        "id": part_id,
        "kind": kind,
        "title": title,
        "prompt": prompt,
        "prompt_html": f"<p>{prompt}</p>\n" if prompt else "",
        "points": points,
        "marking": "content",
    }


@together("path", ["/v1/exercises", "/v1/exercises/two-joints", "/openapi.json"])
@together("secret", ["0.125", "0.75", "61deg", "1.06", "0.3125", '"robot"'])
def test_nothing_of_the_reference_leaks(secretive: httpx.Client, path: str, secret: str) -> None:
    assert secret not in secretive.get(path).text


@pytest.mark.long
def test_no_shipped_table_leaks(client: httpx.Client, catalogue: Mapping[str, Exercise]) -> None:
    for exercise in catalogue.values():
        if not isinstance(exercise.reference, Robot):
            continue
        shown = client.get(f"/v1/exercises/{exercise.id}").json()
        del shown["statement"]
        for part in shown["parts"]:
            part["shape"].pop("given", None)
        for table in exercise.robot.tables.values():
            twists = {row[1].text() for row in table.rows} - {"0"}
            assert not [text for text in twists if text in str(shown)]


def test_a_table_with_a_slip_is_shown_but_not_where_it_is(client: httpx.Client) -> None:
    shown = client.get("/v1/exercises/find-the-slip-scara").json()
    [part] = shown["parts"]
    assert part["shape"]["given"] == [
        ["a1", "0", "0", "theta1"],
        ["a2", "0", "0", "theta2"],
        ["0", "0", "d3", "0"],
        ["0", "0", "d4", "theta4"],
    ]
    assert part.keys().isdisjoint({"seed", "slip"})
    assert "half_turn" not in str(shown)
    assert "180" not in str(shown)


def test_an_unknown_exercise_is_a_404_that_suggests_the_nearest(client: httpx.Client) -> None:
    response = client.get("/v1/exercises/stanford_arm")
    assert response.status_code == 404
    assert response.headers["content-type"] == "application/problem+json"
    problem = response.json()
    assert problem["type"] == "urn:dh-grader:problem:unknown-exercise"
    assert problem["instance"] == "/v1/exercises/stanford_arm"
    assert "Did you mean 'stanford-arm'?" in problem["detail"]


@pytest.mark.parametrize("path", ["/healthz", "/readyz", "/openapi.json"])
def test_supervisors_and_readers_are_answered(client: httpx.Client, path: str) -> None:
    assert client.get(path).status_code == 200


def test_readiness_counts_the_exercises(
    client: httpx.Client, catalogue: Mapping[str, Exercise]
) -> None:
    assert client.get("/readyz").json() == {"status": "ready", "exercises": len(catalogue)}


def test_statements_and_prompts_are_typeset(client: httpx.Client) -> None:
    shown = client.get("/v1/exercises/baxter-left-arm").json()
    assert "<msub><mi>θ</mi><mn>2</mn></msub>" in shown["statement_html"]
    assert shown["statement_html"].count("<li>") == 7
    shown = client.get("/v1/exercises/dh-conditions").json()
    # The prompt has a length of the exercise in its matrix.
    assert "<mtd><mi>h</mi></mtd>" in shown["parts"][0]["prompt_html"]
