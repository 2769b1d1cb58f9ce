"""POST /v1/grade grades many submissions in one request, each independently."""

import asyncio
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.catalogue import Exercise, FeedbackLevel
from dh_grader.grading import grade
from dh_grader.submissions.bodies import MAX_BODY_SIZE, MAX_BRACKETS, MAX_SUBMISSIONS
from fastapi import FastAPI

URL = "/v1/grade"
# From the source of the exercise: Spong's planar arm with two links.
POSITION = ["a1 c1 + a2 c12", "a1 s1 + a2 s12"]
RIGHT: dict[str, Any] = {"exercise": "planar-rr", "answers": {"position": POSITION}}
WRONG: dict[str, Any] = {"exercise": "planar-rr", "answers": {"position": ["a1 c1", "a1 s1 +"]}}
OTHER: dict[str, Any] = {
    "exercise": "planar-rrr",
    "answers": {"table": "l1, 0, 0, q1"},
    "feedback": "score",
}


def results(client: httpx.Client, *submissions: object) -> list[dict[str, Any]]:
    response = client.post(URL, json={"submissions": submissions})
    assert response.status_code == 200, response.text
    assert response.headers["content-type"] == "application/json"
    found: list[dict[str, Any]] = response.json()["results"]
    assert len(found) == len(submissions)
    return found


def alone(client: httpx.Client, submission: Mapping[str, Any]) -> httpx.Response:
    body = {name: value for name, value in submission.items() if name != "exercise"}
    return client.post(f"/v1/exercises/{submission['exercise']}/grade", json=body)


@pytest.mark.long
def test_each_gets_the_report_that_it_gets_alone_in_order(client: httpx.Client) -> None:
    submissions = [WRONG, RIGHT, OTHER, {**WRONG, "echo": True}, {**RIGHT, "angle_unit": "degrees"}]
    expected = [{"report": alone(client, each).json()} for each in submissions]
    assert results(client, *submissions) == expected
    assert expected[1]["report"]["points"] == 2


def test_no_submissions_get_no_results(client: httpx.Client) -> None:
    assert results(client) == []


@pytest.mark.parametrize(
    ("submission", "status", "name", "pointers"),
    [
        ({"exercise": "planar-r", "answers": {}}, 404, "unknown-exercise", None),
        ({"exercise": "x" * 5000, "answers": {}}, 404, "unknown-exercise", None),
        ({"exercise": "planar-rr", "answers": {"tabel": 1, "pose": 1}}, 422, "unknown-part",
         ["#/submissions/1/answers/tabel"]),
        ({"exercise": "planar-rr"}, 422, "invalid-request", ["#/submissions/1/answers"]),
        ({"answers": {}}, 422, "invalid-request", ["#/submissions/1/exercise"]),
        ({"exercise": 7, "answers": {}}, 422, "invalid-request", ["#/submissions/1/exercise"]),
        ({**RIGHT, "feedback": "all"}, 422, "invalid-request", ["#/submissions/1/feedback"]),
        ({**RIGHT, "learner": "x"}, 422, "invalid-request", ["#/submissions/1/learner"]),
        (None, 422, "invalid-request", ["#/submissions/1"]),
        ([], 422, "invalid-request", ["#/submissions/1"]),
    ],
)  # fmt: skip
def test_a_faulty_submission_gets_a_problem_and_the_others_are_graded(
    client: httpx.Client, submission: object, status: int, name: str, pointers: list[str] | None
) -> None:
    first, faulty, last = results(client, RIGHT, submission, WRONG)
    assert [first["report"], last["report"]] == [
        alone(client, each).json() for each in (RIGHT, WRONG)
    ]
    assert set(faulty) == {"problem"}
    problem = faulty["problem"]
    assert problem["status"] == status
    assert problem["type"] == f"urn:dh-grader:problem:{name}"
    assert problem["instance"] == "/v1/grade#/submissions/1"
    found = [each["pointer"] for each in problem["errors"]] if "errors" in problem else None
    assert found == pointers
    assert len(json.dumps(problem)) < 1000


def test_the_problem_is_the_one_that_the_submission_gets_alone(client: httpx.Client) -> None:
    submission = {"exercise": "planar-r", "answers": {}}
    [result] = results(client, submission)
    refused = alone(client, submission).json()
    # The request id belongs to the whole answer.
    del refused["request_id"]
    assert result["problem"] == {**refused, "instance": "/v1/grade#/submissions/0"}


def test_an_unknown_field_is_answered_with_the_known_ones(client: httpx.Client) -> None:
    [result] = results(client, {**RIGHT, "learner": "x"})
    assert "answers, angle_unit, feedback, echo, exercise" in result["problem"]["detail"]


@pytest.mark.parametrize(
    ("body", "pointer"),
    [
        ([], "#"),
        ({}, "#/submissions"),
        ({"submissions": {}}, "#/submissions"),
        ({"submissions": [], "feedback": "full"}, "#/feedback"),
        ({"submissions": [RIGHT] * (MAX_SUBMISSIONS + 1)}, "#/submissions"),
    ],
)
def test_a_body_of_another_shape_gets_422(client: httpx.Client, body: object, pointer: str) -> None:
    response = client.post(URL, json=body)
    assert response.status_code == 422
    assert response.headers["content-type"] == "application/problem+json"
    assert [error["pointer"] for error in response.json()["errors"]] == [pointer]


def test_too_many_submissions_are_told_how_many_there_may_be(client: httpx.Client) -> None:
    response = client.post(URL, json={"submissions": [0] * (MAX_SUBMISSIONS + 1)})
    assert response.status_code == 422
    said = "#/submissions: This may have at most 64 entries, but has 65."
    assert response.json()["detail"] == said


def test_the_bound_lets_a_full_request_through(client: httpx.Client) -> None:
    # The request has all answers to the exercise with seven joints, as often as is allowed.
    rows = [dict.fromkeys(("a", "alpha", "d", "theta"), "2*L1 + 90deg")] * 8
    matrix = [["cos(theta1)*sin(theta2)"] * 4] * 4
    answers = {"table": {"rows": rows}, "home": matrix, "pose": matrix, "wrist": ["L1"] * 3}
    body = {"submissions": [{"exercise": "baxter-left-arm", "answers": answers}] * MAX_SUBMISSIONS}
    text = json.dumps(body)
    assert len(text) < MAX_BODY_SIZE
    assert text.count("[") + text.count("{") < MAX_BRACKETS


@pytest.mark.long
def test_no_report_tells_more_than_the_service_allows(
    catalogue: Mapping[str, Exercise], client_of: Callable[[FastAPI], httpx.Client]
) -> None:
    with client_of(application(catalogue, feedback=FeedbackLevel.VERDICTS)) as client:
        told = [each["report"]["feedback"] for each in results(client, WRONG, OTHER)]
    assert told == ["verdicts", "score"]


def test_a_failure_of_the_program_costs_one_submission(
    client: httpx.Client, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:

    def breaks(exercise: Exercise, submission: Any) -> Any:
        if not submission.answers:
            raise ZeroDivisionError("a secret")
        return grade(exercise, submission)

    monkeypatch.setattr("dh_grader.api.grading.grade", breaks)
    first, broken, last = results(client, RIGHT, {**RIGHT, "answers": {}}, RIGHT)
    assert first == last == {"report": alone(client, RIGHT).json()}
    assert broken["problem"]["status"] == 500
    assert "secret" not in json.dumps(broken)
    assert "a secret" in caplog.text


def test_others_are_served_between_two_gradings(
    app: FastAPI, monkeypatch: pytest.MonkeyPatch
) -> None:
    events: list[str] = []

    def noted(exercise: Exercise, submission: Any) -> Any:
        events.append("grading")
        return grade(exercise, submission)

    async def asked_meanwhile() -> None:
        transport = httpx.ASGITransport(app)
        async with httpx.AsyncClient(transport=transport, base_url="http://service") as client:
            many = asyncio.create_task(client.post(URL, json={"submissions": [RIGHT] * 60}))
            while not events:
                await asyncio.sleep(0)
            await client.get("/healthz")
            events.append("served")
            await many

    monkeypatch.setattr("dh_grader.api.grading.grade", noted)
    asyncio.run(asked_meanwhile())
    assert events.count("grading") == 60
    assert events[-1] == "grading"


def test_the_readme_s_example_is_the_documented_one() -> None:
    root = Path(__file__).parents[2]
    shown = (root / "docs" / "examples" / "many.json").read_text("utf-8")
    example = root / "service" / "dh_grader" / "api" / "examples" / "grade-many-request.json"
    assert shown == example.read_text("utf-8")
