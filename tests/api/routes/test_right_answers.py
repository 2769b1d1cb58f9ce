"""The model solution for students with full marks."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import httpx
import pytest

from service.api.application import application
from service.catalogue import Exercise
from service.catalogue.attempts import AttemptsSpec
from tests.solutions.solved import solved

PATH = "/v1/exercises/planar-rr/solution"

# The same table in other words.
REWORDED = "a1, 0, 0, q1 + 360°\na2, 0, 0, q2"


def answers(exercise: Exercise, *without: str) -> dict[str, object]:
    """Return the model answers, without some parts."""
    return {each.part: each.answer for each in solved(exercise).parts if each.part not in without}


def test_right_answers_get_the_solution(
    client: httpx.Client, catalogue: Mapping[str, Exercise]
) -> None:
    exercise = catalogue["planar-rr"]
    answer = client.post(PATH, json={"answers": answers(exercise) | {"table": REWORDED}})
    assert answer.status_code == 200
    assert {each["part"]: each["answer"] for each in answer.json()["parts"]} == answers(exercise)


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
    answer = client.post(PATH, json={"answers": {**answers(catalogue["planar-rr"]), **change}})
    assert answer.status_code == 403
    assert answer.json()["type"].endswith("solution-not-shown")
    assert "theta1 + theta2" not in answer.text


def test_a_part_that_is_left_out_has_no_full_marks(
    client: httpx.Client, catalogue: Mapping[str, Exercise]
) -> None:
    some = client.post(PATH, json={"answers": answers(catalogue["planar-rr"], "pose")})
    assert some.status_code == 403


def test_an_exercise_that_counts_has_no_solution_for_students(
    catalogue: Mapping[str, Exercise], client_of: Any
) -> None:
    exercise = catalogue["planar-rr"]
    counting = replace(exercise, attempts=AttemptsSpec(limit=3))
    client = client_of(application({"planar-rr": counting}))
    assert client.post(PATH, json={"answers": answers(exercise)}).status_code == 403
