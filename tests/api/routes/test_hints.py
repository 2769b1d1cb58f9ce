"""Test the routes for hints, and for the pictures that explain rules."""

from collections.abc import Mapping
from typing import Any

import httpx
import pytest
from dh_grader.catalogue import FeedbackLevel
from dh_grader.figures.drawing import Theme
from dh_grader.hints import rule_picture
from dh_grader.kinematics import Convention

PATH = "/v1/exercises/planar-rr/hints"
ASKED: Mapping[str, Any] = {
    "answers": {"table": "a1 0 0 θ1\na2 π 0 θ2"},
    "part": "table",
    "code": "half_turn",
    "row": "2",
    "cell": "alpha",
}


def test_the_three_steps_of_a_hint(client: httpx.Client) -> None:
    hints = [client.post(PATH, json={**ASKED, "step": step}).json() for step in (1, 2, 3)]
    assert [hint["step"] for hint in hints] == [1, 2, 3]
    assert {hint["steps"] for hint in hints} == {3}
    assert {hint["title"] for hint in hints} == {"Link twist α"}
    assert len({hint["text"] for hint in hints}) == 3
    assert [hint.get("picture") for hint in hints] == [
        None,
        "v1/rules/standard/link_twist.svg",
        None,
    ]
    assert [hint.get("lesson") for hint in hints] == [
        None,
        "learn-dh?convention=standard#alpha",
        None,
    ]
    picture = client.get(f"/{hints[1]['picture']}")
    assert picture.headers["content-type"] == "image/svg+xml"
    assert picture.text == rule_picture("link_twist", Convention.STANDARD, Theme.AUTO)


@pytest.mark.parametrize(
    ("change", "status", "kind"),
    [
        ({"code": "sign"}, 404, "no-hint"),
        ({"row": "1"}, 404, "no-hint"),
        ({"answers": {}}, 404, "no-hint"),
        ({"part": "pose"}, 404, "no-hint"),
        ({"part": "nothing"}, 422, "unknown-part"),
        ({"answers": {"nothing": 1}}, 422, "unknown-part"),
        ({"step": 4}, 422, "invalid-request"),
        ({"step": 0}, 422, "invalid-request"),
        ({"step": True}, 422, "invalid-request"),
        ({"feedback": "verdicts"}, 403, "no-hints"),
    ],
)
def test_other_hints_are_refused(
    client: httpx.Client, change: Mapping[str, Any], status: int, kind: str
) -> None:
    answer = client.post(PATH, json={**ASKED, "step": 1, **change})
    assert (answer.status_code, answer.json()["type"]) == (
        status,
        f"urn:dh-grader:problem:{kind}",
    )


def test_more_feedback_does_not_change_a_hint(client: httpx.Client) -> None:
    # A report at the level full groups messages differently, but the hints are the same.
    body = {**ASKED, "step": 3}
    full = client.post(PATH, json={**body, "feedback": str(FeedbackLevel.FULL)})
    assert full.json() == client.post(PATH, json=body).json()


@pytest.mark.parametrize("path", ["standard/product", "standard/nothing", "other/link_twist"])
def test_a_rule_without_a_picture_has_none(client: httpx.Client, path: str) -> None:
    assert client.get(f"/v1/rules/{path}.svg").status_code in (404, 422)


def test_a_picture_runs_no_script(client: httpx.Client) -> None:
    policy = client.get("/v1/rules/modified/convention.svg?theme=dark").headers[
        "content-security-policy"
    ]
    assert "default-src 'none'" in policy


ROWS = [
    {"a": "a1", "alpha": "0", "d": "0", "theta": "theta1"},
    {"a": "a2", "alpha": "0", "d": "0", "theta": "theta2"},
]


def test_a_right_table_has_other_choices(client: httpx.Client) -> None:
    body = {"part": "table", "rows": ROWS}
    answer = client.post("/v1/exercises/planar-rr/choices", json=body).json()
    assert [each["change"] for each in answer["choices"]] == [
        "x1 points the other way.",
        "z1 points the other way.",
        "The origin of frame {1} lies farther along z1.",
    ]
    for each in answer["choices"]:
        graded = client.post(
            "/v1/exercises/planar-rr/grade", json={"answers": {"table": {"rows": each["rows"]}}}
        ).json()
        assert graded["parts"][0]["verdict"] == "correct"


@pytest.mark.parametrize("change", [{"part": "pose"}, {"rows": ROWS[:1]}, {"rows": []}])
def test_other_answers_have_no_choices(client: httpx.Client, change: Mapping[str, Any]) -> None:
    body = {"part": "table", "rows": ROWS, **change}
    answer = client.post("/v1/exercises/planar-rr/choices", json=body)
    assert (answer.status_code, answer.json()) == (200, {"choices": []})
