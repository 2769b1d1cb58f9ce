"""Test the route POST /v1/exercises/{id}/grade."""

import json
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.catalogue import Exercise, FeedbackLevel, least
from dh_grader.grading import Verdict
from fastapi import FastAPI
from hypothesis import given
from hypothesis import strategies as st

from tests.grading.support.bare_numbers import BARE, BareExercise
from tests.together import together

URL = "/v1/exercises/planar-rrr/grade"

# From the source of the exercise: the table of the planar arm, modified convention.
TABLE = [
    {"a": 0, "alpha": 0, "d": 0, "theta": "q1"},
    {"a": "l1", "alpha": 0, "d": 0, "theta": "q2"},
    {"a": "l2", "alpha": 0, "d": 0, "theta": "q3"},
    {"a": "l3", "alpha": 0, "d": 0, "theta": 0},
]
# Planar forward kinematics with sums of angles, as in textbooks.
X = "l1*cos(q1) + l2*cos(q1+q2) + l3*cos(q1+q2+q3)"
Y = "l1*sin(q1) + l2*sin(q1+q2) + l3*sin(q1+q2+q3)"
POSE = [
    ["cos(q1+q2+q3)", "-sin(q1+q2+q3)", 0, X],
    ["sin(q1+q2+q3)", "cos(q1+q2+q3)", 0, Y],
    [0, 0, 1, 0],
    [0, 0, 0, 1],
]
RIGHT = {"table": {"rows": TABLE}, "pose": POSE}


def post(client: httpx.Client, body: object) -> httpx.Response:
    return client.post(URL, json=body)


def report(client: httpx.Client, body: object) -> dict[str, Any]:
    response = post(client, body)
    assert response.status_code == 200, response.text
    assert response.headers["content-type"] == "application/json"
    result: dict[str, Any] = response.json()
    return result


def test_right_answers_earn_everything(client: httpx.Client) -> None:
    result = report(client, {"answers": RIGHT})
    assert (result["exercise"], result["gradable"], result["score"]) == ("planar-rrr", True, 1.0)
    assert {part["verdict"] for part in result["parts"]} == {"correct"}


def test_a_wrong_cell_is_named_and_fields_without_a_value_are_left_out(
    client: httpx.Client,
) -> None:
    rows = [*TABLE[:1], {**TABLE[1], "a": "l2"}, *TABLE[2:]]
    result = report(client, {"answers": {**RIGHT, "table": {"rows": rows}}})
    cell = result["parts"][0]["rows"][1]["cells"][0]
    assert (cell["label"], cell["verdict"]) == ("a", "incorrect")
    assert [message["code"] for message in cell["feedback"]] == ["value"]
    assert result["score"] < 1
    assert "null" not in post(client, {"answers": RIGHT}).text


def test_the_same_body_gives_the_same_bytes(client: httpx.Client) -> None:
    body = {"answers": {"pose": [["q1"] * 4] * 4}}
    assert post(client, body).content == post(client, body).content


def test_the_angle_unit_is_heeded(client: httpx.Client) -> None:
    rows = [{**TABLE[0], "alpha": 360}, *TABLE[1:]]
    answers = {**RIGHT, "table": {"rows": rows}}
    assert report(client, {"answers": answers, "angle_unit": "degrees"})["score"] == 1
    assert report(client, {"answers": answers})["score"] < 1


def test_the_feedback_level_is_heeded(client: httpx.Client) -> None:
    rows = [*TABLE[:1], {**TABLE[1], "a": "-l1"}, *TABLE[2:]]
    answers = {"table": {"rows": rows}}
    hints, verdicts, score = (
        report(client, {"answers": answers, "feedback": level})["parts"][0]
        for level in ("hints", "verdicts", "score")
    )
    wrong = hints["rows"][1]["cells"][0]
    assert [message["code"] for message in wrong["feedback"]] == ["sign"]
    assert verdicts["rows"][1]["cells"][0] == {**wrong, "feedback": []}
    assert score["rows"] == []
    assert score["points"] == hints["points"]


@pytest.mark.parametrize("asked", ["full", None])
def test_no_caller_gets_more_than_the_exercise_allows(
    client: httpx.Client, asked: str | None
) -> None:
    rows = [*TABLE[:1], {**TABLE[1], "a": "-l1"}, *TABLE[2:]]
    result = report(client, {"answers": {"table": {"rows": rows}}, "feedback": asked})
    assert result["feedback"] == "hints"
    assert "correction" not in json.dumps(result)


@pytest.mark.sampled(4)
@pytest.mark.parametrize(
    ("exercise", "service", "asked", "told"),
    [
        ("full", "full", None, "full"),
        ("full", "full", "hints", "hints"),
        ("full", "verdicts", None, "verdicts"),
        ("full", "verdicts", "full", "verdicts"),
        ("verdicts", "full", "full", "verdicts"),
        ("verdicts", "score", "hints", "score"),
        ("score", "full", "hints", "score"),
    ],
)
def test_a_report_has_the_lower_of_the_requested_and_the_allowed_level(
    exercise: str, service: str, asked: str | None, told: str,
    catalogue: Mapping[str, Exercise], client_of: Callable[[FastAPI], httpx.Client],
) -> None:  # fmt: skip
    allowed = replace(catalogue["planar-rrr"], feedback_by_attempt=(FeedbackLevel(exercise),))
    app = application({"planar-rrr": allowed}, feedback=FeedbackLevel(service))
    with client_of(app) as client:
        ceiling = client.get("/v1/exercises/planar-rrr").json()["feedback"]
        assert ceiling == least(FeedbackLevel(exercise), FeedbackLevel(service))
        assert report(client, {"answers": RIGHT, "feedback": asked})["feedback"] == told


def test_echo_tells_how_each_cell_was_read(client: httpx.Client) -> None:
    answers = {"table": {"rows": [{**TABLE[0], "theta": "θ_1"}, *TABLE[1:]]}}
    result = report(client, {"answers": answers, "echo": True})
    read = [cell["read"] for cell in result["parts"][0]["rows"][0]["cells"]]
    assert read[3] == {"text": "q1", "latex": "q_{1}"}
    assert '"read"' not in json.dumps(report(client, {"answers": answers}))


def test_nothing_handed_in_is_not_gradable(client: httpx.Client) -> None:
    result = report(client, {"answers": {}})
    assert (result["gradable"], result["score"]) == (False, 0.0)


@pytest.mark.sampled(4)
@pytest.mark.parametrize(
    "cell",
    [
        None, True, [], {}, [[[]]], "", " ", "l1 +", "__import__('os')", "x" * 10_000, "\0",
        "💥", 10**400, "1" * 5000, 1e308, "1e999", "1/0", "(" * 499,
        "q1" * 249, "9^9^9^9^9",
    ],
)  # fmt: skip
@pytest.mark.parametrize("level", ["full", "hints", "verdicts", "score"])
def test_no_cell_fails_the_request_or_the_rest(
    client: httpx.Client, cell: object, level: str
) -> None:
    rows = [*TABLE[:1], {**TABLE[1], "a": cell}, *TABLE[2:]]
    answers = {**RIGHT, "table": {"rows": rows}}
    result = report(client, {"answers": answers, "feedback": level})
    table, pose = result["parts"][:2]
    assert table["verdict"] == "partial"
    assert pose["verdict"] == "correct"


@pytest.mark.parametrize(
    "literal",
    ["NaN", "-Infinity", "1e999", "9" * 400, "9" * 5000, "-" + "9" * 5000, '"\\ud800"'],
)
def test_a_literal_that_is_no_finite_number_affects_only_its_cell(
    client: httpx.Client, literal: str
) -> None:
    body = json.dumps({"answers": RIGHT}).replace('"l2"', literal, 1)
    response = client.post(URL, content=body)
    assert response.status_code == 200, response.text
    cell = response.json()["parts"][0]["rows"][2]["cells"][0]
    assert cell["verdict"] == "unreadable"
    assert response.json()["parts"][1]["verdict"] == "correct"


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: (
        st.lists(inner, max_size=5)
        | st.dictionaries(st.sampled_from(["rows", "a", "d", "theta", "x"]), inner, max_size=4)
    ),
    max_leaves=20,
)


@pytest.mark.long
@given(answer=JSON, part=st.sampled_from(["table", "pose"]))
def test_every_answer_gets_a_report(client: httpx.Client, answer: object, part: str) -> None:
    response = client.post(URL, content=json.dumps({"answers": {part: answer}}))
    assert response.status_code == 200
    graded = next(each for each in response.json()["parts"] if each["part"] == part)
    assert graded["verdict"] in set(Verdict)
    assert 0 <= graded["points"] <= graded["max_points"]


def test_a_part_that_does_not_exist_is_a_422_that_names_those_that_do(
    client: httpx.Client,
) -> None:
    response = post(client, {"answers": {"table": None, "a/b~c": 1, "tabel": 1}})
    assert response.status_code == 422
    problem = response.json()
    assert problem["type"] == "urn:dh-grader:problem:unknown-part"
    assert [error["pointer"] for error in problem["errors"]] == [
        "#/answers/a~1b~0c",
        "#/answers/tabel",
    ]
    assert "no such part. Its parts are: table, pose." in problem["errors"][0]["detail"]
    assert "Did you mean 'table'? Its parts are" in problem["errors"][1]["detail"]


def test_ten_thousand_unknown_parts_get_a_short_answer(client: httpx.Client) -> None:
    response = post(client, {"answers": {f"p{i}": 0 for i in range(10_000)}})
    assert response.status_code == 422
    assert len(response.content) < 5000
    response = post(client, {"answers": {"p" * 200_000: 0}})
    assert response.status_code == 422
    assert len(response.content) < 2000


def test_an_unknown_exercise_is_a_404(client: httpx.Client) -> None:
    response = client.post("/v1/exercises/planar-rrrr/grade", json={"answers": {}})
    assert response.status_code == 404
    assert "planar-rrr" in response.json()["detail"]


@pytest.mark.long
@together("bare", BARE)
def test_exercises_of_numbers_alone(
    bare: BareExercise, make_exercise: Callable[[str], Exercise], client_of: Any
) -> None:
    exercise = make_exercise(bare.text)
    with client_of(application({exercise.id: exercise})) as client:
        url = f"/v1/exercises/{exercise.id}"
        assert client.get(url).status_code == 200
        for answer, right in [(bare.right, True), *((each, False) for each in bare.wrong)]:
            response = client.post(f"{url}/grade", json={"answers": {"it": answer}, "echo": True})
            assert response.status_code == 200
            assert (response.json()["score"] == 1) == right
            body = {"text": str(answer), "exercise": exercise.id, "part": "it"}
            assert client.post("/v1/preview", json=body).status_code == 200
