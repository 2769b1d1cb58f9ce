"""Test the routes for model solutions, which are off by default."""

import asyncio
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.api.grading import _solved
from dh_grader.api.http import MemoizedResults
from dh_grader.api.permissions import Access
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.schema_fields import AttemptsSpec
from fastapi import FastAPI

from tests.api.conftest import InProcess
from tests.solutions.solved import solved

PATH = "/v1/exercises/{}/solution"
OWN_PATH = PATH.format("planar-rr")


@pytest.fixture(scope="module")
def tutor(catalogue: Mapping[str, Exercise]) -> Iterator[httpx.Client]:
    app = application(catalogue, access=Access(solutions=True))
    with httpx.Client(transport=InProcess(app), base_url="http://service") as client:
        yield client


def test_solutions_are_off_and_the_problem_says_how_to_switch_them_on(client: httpx.Client) -> None:
    for name in ("stanford-arm", "nothing"):
        response = client.get(PATH.format(name))
        assert response.status_code == 403
        assert response.headers["content-type"] == "application/problem+json"
        assert response.json()["type"] == "urn:dh-grader:problem:solutions-off"
        assert "DH_GRADER_SOLUTIONS=true" in response.json()["detail"]


def test_the_right_answer_to_each_part(tutor: httpx.Client, client: httpx.Client) -> None:
    response = tutor.get(PATH.format("spatial-rrr"))
    assert response.status_code == 200
    assert response.headers["cache-control"] == "no-store"
    solution = response.json()
    listed = client.get("/v1/exercises/spatial-rrr").json()
    assert [each["part"] for each in solution["parts"]] == [each["id"] for each in listed["parts"]]
    assert solution["version"] == listed["version"]
    assert solution["notation"]["c23"] == "cos(theta2 + theta3)"
    assert [each["label"] for each in solution["links"]] == ["1", "2", "3"]
    assert solution["pose"]["latex"].startswith(r"\begin{bmatrix}")
    for form in ("answer", "text"):
        answers = {
            each["part"]: each[form]
            for each in solution["parts"]
            if form == "answer" or each["kind"] != "link_transforms"
        }
        report = client.post("/v1/exercises/spatial-rrr/grade", json={"answers": answers}).json()
        graded = [part for part in report["parts"] if part["part"] in answers]
        assert {part["verdict"] for part in graded} == {"correct"}


def test_an_exercise_without_a_robot_has_no_links(tutor: httpx.Client) -> None:
    solution = tutor.get(PATH.format("fundamental-rotations")).json()
    assert solution["links"] == []
    assert "pose" not in solution


def test_an_unknown_exercise(tutor: httpx.Client) -> None:
    response = tutor.get(PATH.format("skara"))
    assert response.status_code == 404
    assert "Did you mean 'scara'?" in response.json()["detail"]


@pytest.mark.long
def test_the_documented_example_is_what_is_answered(tutor: httpx.Client) -> None:
    document: dict[str, Any] = tutor.get("/openapi.json").json()
    operation = document["paths"]["/v1/exercises/{exercise_id}/solution"]["get"]
    documented = operation["responses"]["200"]["content"]["application/json"]["example"]
    assert documented == tutor.get(PATH.format("planar-rr")).json()


@pytest.mark.long
def test_a_changed_exercise_has_a_solution_of_its_own(
    catalogue: Mapping[str, Exercise], monkeypatch: pytest.MonkeyPatch,
    client_of: Callable[[FastAPI], httpx.Client],
) -> None:  # fmt: skip
    monkeypatch.setattr("dh_grader.api.grading._solved", lambda each: each.version.encode())
    live = {"scara": catalogue["scara"]}
    with client_of(application(live, access=Access(solutions=True))) as tutor:
        assert tutor.get(PATH.format("scara")).text == catalogue["scara"].version
        live["scara"] = replace(catalogue["scara"], version="other")
        assert tutor.get(PATH.format("scara")).text == "other"


@pytest.mark.long
def test_the_event_loop_runs_while_a_solution_is_computed(
    catalogue: Mapping[str, Exercise], figure: Callable[[str], None]
) -> None:
    # Only the interpreter's switch between threads delays the loop, by some milliseconds.
    arm = catalogue["baxter-left-arm"]

    async def watched() -> tuple[float, float, int]:
        start = last = time.perf_counter()
        longest, turns = 0.0, 0
        task = asyncio.create_task(MemoizedResults().of("arm", partial(_solved, arm)))
        while not task.done():
            await asyncio.sleep(0)
            now = time.perf_counter()
            longest, last, turns = max(longest, now - last), now, turns + 1
        return time.perf_counter() - start, longest, turns

    took, longest, turns = asyncio.run(watched())
    figure(f"solution of baxter-left-arm: {took * 1e3:.0f} ms, loop held up {longest * 1e3:.0f} ms")
    assert turns > 5


PROGRAM = r"""
import sys
import dh_grader.app, dh_grader.grading, dh_grader.cli
print(sorted({"sympy", "dh_grader.solutions.answers"} & set(sys.modules)))
"""


@pytest.mark.long
def test_what_serves_and_grades_imports_no_algebra_system() -> None:
    result = subprocess.run(
        [sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=True
    )
    assert result.stdout.strip() == "[]"


# --- for students with full marks

# The same table in other words.
REWORDED = "a1, 0, 0, q1 + 360°\na2, 0, 0, q2"


def own_answers(exercise: Exercise, *without: str) -> dict[str, object]:
    return {each.part: each.answer for each in solved(exercise).parts if each.part not in without}


def test_right_answers_get_the_solution(
    client: httpx.Client, catalogue: Mapping[str, Exercise]
) -> None:
    exercise = catalogue["planar-rr"]
    answer = client.post(OWN_PATH, json={"answers": own_answers(exercise) | {"table": REWORDED}})
    assert answer.status_code == 200
    assert {each["part"]: each["answer"] for each in answer.json()["parts"]} == own_answers(
        exercise
    )


@pytest.mark.parametrize(
    "change",
    [
        {"table": None},
        {"table": "a1 0 0 θ1\na2 90deg 0 θ2"},
        {"pose": "1"},
    ],
)
def test_other_answers_do_not(
    client: httpx.Client, catalogue: Mapping[str, Exercise], change: Mapping[str, Any]
) -> None:
    answer = client.post(
        OWN_PATH, json={"answers": {**own_answers(catalogue["planar-rr"]), **change}}
    )
    assert answer.status_code == 403
    assert answer.json()["type"].endswith("solution-not-shown")
    assert "theta1 + theta2" not in answer.text


def test_a_part_that_is_left_out_has_no_full_marks(
    client: httpx.Client, catalogue: Mapping[str, Exercise]
) -> None:
    some = client.post(OWN_PATH, json={"answers": own_answers(catalogue["planar-rr"], "pose")})
    assert some.status_code == 403


@pytest.mark.long
def test_an_exercise_that_counts_has_no_solution_for_students(
    catalogue: Mapping[str, Exercise], client_of: Any
) -> None:
    exercise = catalogue["planar-rr"]
    counting = replace(exercise, attempts=AttemptsSpec(limit=3))
    client = client_of(application({"planar-rr": counting}))
    assert client.post(OWN_PATH, json={"answers": own_answers(exercise)}).status_code == 403
