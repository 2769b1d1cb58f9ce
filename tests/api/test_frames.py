"""Test frames, figures and hints."""

import base64
import hashlib
import json
import re
from collections.abc import Mapping
from dataclasses import replace
from math import cos, pi, sin
from pathlib import Path
from typing import Any

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.catalogue import Exercise
from dh_grader.catalogue.robot import Robot
from dh_grader.catalogue.schema_fields import AttemptsSpec, FeedbackLevel
from dh_grader.contract.frames import MOST_CONFIGURATIONS
from dh_grader.figures import exercise_figure
from dh_grader.figures.drawing import Theme
from dh_grader.hints import rule_picture
from dh_grader.kinematics import Convention

from tests.api.conftest import InProcess
from tests.shipped import sampled, shipped_exercises

ROOT = Path(__file__).parents[2]
URL = "/v1/frames"
SHIPPED = shipped_exercises()


def answered(client: httpx.Client, body: object) -> Any:
    response = client.post(URL, json=body)
    assert response.status_code == 200, response.text
    return response.json()


def test_the_requests_of_the_page_on_figures(client: httpx.Client) -> None:
    page = (ROOT / "docs" / "figures.md").read_text(encoding="utf-8")
    robot, table = map(json.loads, re.findall(r"```json \S+\n(.*?)```", page, re.DOTALL))
    found = answered(client, robot)
    assert [cell["error"]["suggestion"] for cell in found["table"]["unread"]] == ["a2"]
    assert found["symbols"] == {"a1": 0.5, "a2": 0.6}
    assert len(found["mechanism"]["configurations"]) == len(found["table"]["frames"]) == 2
    # Two links of 0.5 and 0.6, the first at 0.5 rad, the second at 0.25 rad to x0.
    tool = found["mechanism"]["configurations"][1]["tool"]
    assert tool == pytest.approx([0.5 * 0.877582562 + 0.6 * 0.968912422, 0.388154912, 0])
    free = answered(client, table)
    assert free["symbols"] == {"d1": 0.6}
    assert "mechanism" not in free
    # Of the rows with a frame only, with the joint's value in each picture.
    assert found["table"]["values"] == [[[0.5, 0, 0, 0]], [[0.5, 0, 0, 0.5]]]
    assert f"at most {MOST_CONFIGURATIONS}" in " ".join(page.split())


def texts_in(value: Any) -> set[str]:
    match value:
        case str():
            return {value}
        case dict():
            return {*value, *(text for each in value.values() for text in texts_in(each))}
        case list():
            return {text for each in value for text in texts_in(each)}
        case _:
            return set()


def parameters(exercise: Exercise) -> set[str]:
    assert isinstance(exercise.reference, Robot)
    rows = [row for table in exercise.reference.tables.values() for row in table.rows]
    return {cell.text() for row in rows for cell in row} - {"0"}


TABLES = [name for name, exercise in SHIPPED.items() if isinstance(exercise.reference, Robot)]


@pytest.mark.long
@pytest.mark.parametrize("name", sampled(TABLES))
def test_a_mechanism_tells_nothing_that_the_statement_does_not(
    client: httpx.Client, name: str
) -> None:
    exercise = SHIPPED[name]
    found = answered(client, {"exercise": name})
    public = {variable.name for variable in exercise.variables}
    assert "table" not in found
    assert set(found["symbols"]) <= public
    told = texts_in(found)
    assert not (parameters(exercise) - public) & told
    fields = {
        "symbols", "joints", "mechanism", "joint", "variable", "kind", "low", "high", "home",
        "size", "azimuth", "elevation", "configurations", "centres", "axes", "links", "base",
        "base_normal", "tool", "tool_direction", "frames", "comparable",
    }  # fmt: skip
    assert told - public - set(found["mechanism"]["frames"]) <= {*fields, "R", "P"}
    svg = client.get(f"/v1/exercises/{name}/figure.svg").text
    shown = set(re.findall(r"<text[^>]*>(.*?)</text>", svg))
    plain = {re.sub(r"<[^>]*>", "", each).replace("θ", "theta") for each in shown}
    stated = set(re.findall(r"\b\d+\.\d+", exercise.statement))
    assert not (parameters(exercise) - public - stated) & plain


def test_given_frames_move_with_the_robot(client: httpx.Client) -> None:
    # Frame {0} does not move. The tool frame is at the tool, with x along link 2 of the arm.
    body = {"exercise": "planar-rr", "joints": [[0, 0], [0.4, 0.7]]}
    mechanism = answered(client, body)["mechanism"]
    assert mechanism["frames"] == ["0", "2"]
    assert mechanism["comparable"] is True
    for shown, angle in zip(mechanism["configurations"], [0, 1.1], strict=True):
        base, tool = shown["frames"]
        assert base == [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
        assert [row[3] for row in tool[:3]] == pytest.approx(shown["tool"])
        assert [row[0] for row in tool[:3]] == pytest.approx([cos(angle), sin(angle), 0])
    # All frames of an exercise that gives them all, and none that a student may choose.
    assert answered(client, {"exercise": "rrrp-drawn"})["mechanism"]["frames"] == [*"01234"]
    assert answered(client, {"exercise": "rrrp"})["mechanism"]["frames"] == [*"04"]


@pytest.mark.long
@pytest.mark.parametrize(
    "hidden", [{"attempts": AttemptsSpec(limit=3)}, {"feedback_by_attempt": (FeedbackLevel.SCORE,)}]
)
def test_an_exercise_that_counts_compares_no_frames(hidden: Mapping[str, Any]) -> None:
    # A gap of 0 would say that a table is correct.
    exercise = replace(SHIPPED["planar-rr"], **hidden)
    app = application({exercise.id: exercise})
    with httpx.Client(transport=InProcess(app), base_url="http://service") as own:
        assert answered(own, {"exercise": exercise.id})["mechanism"]["comparable"] is False


def test_another_choice_of_frames_gives_the_same_mechanism(client: httpx.Client) -> None:
    # Two exercises on one arm have different conventions, and therefore different frames.
    answers = [answered(client, {"exercise": name}) for name in ("rrrp", "rrrp-proximal")]
    one, other = (answer["mechanism"]["configurations"][0] for answer in answers)
    assert one["tool"] == pytest.approx(other["tool"])
    for axis, same in zip(one["axes"], other["axes"], strict=True):
        assert axis == pytest.approx(same, abs=1e-9)
    for link, same in zip(one["links"], other["links"], strict=True):
        assert [pytest.approx(corner, abs=1e-9) for corner in link] == same


@pytest.mark.parametrize(
    ("body", "place"),
    [
        ({}, "#"),
        ({"exercise": "nothing"}, "#/exercise"),
        ({"exercise": "dh-conditions"}, "#/exercise"),
        ({"table": {"rows": []}}, "#/table/structure"),
        ({"table": {"rows": [], "structure": "RX"}}, "#/table/structure"),
        ({"table": {"rows": [], "structure": "R" * 11}}, "#/table/structure"),
        ({"exercise": "scara", "table": {"rows": [], "structure": "RR"}}, "#/table/structure"),
        ({"exercise": "planar-rr", "joints": [[0]]}, "#/joints/0"),
        ({"exercise": "planar-rr", "joints": [[0, 1e300]]}, "#/joints/0/1"),
        ({"exercise": "planar-rr", "joints": []}, "#/joints"),
        ({"exercise": "planar-rr", "joints": [[0, 0]] * 31}, "#/joints"),
        ({"exercise": "planar-rr", "symbols": {"b": 1}}, "#/symbols/b"),
        ({"exercise": "planar-rr", "symbols": {"theta1": 1}}, "#/symbols/theta1"),
        ({"exercise": "planar-rr", "symbols": {"a1": "1"}, "more": 1}, "#/more"),
    ],
)
def test_a_request_that_does_not_fit_is_refused(
    client: httpx.Client, body: object, place: str
) -> None:
    response = client.post(URL, json=body)
    assert response.status_code == 422
    assert place in [error["pointer"] for error in response.json()["errors"]]


@pytest.mark.parametrize("length", [0, 1e-9, -0.3, 1e6])
@pytest.mark.parametrize("name", ["stanford-arm", "planar-rr", "spherical-wrist", "planar-rpr-poe"])
def test_any_lengths_can_be_drawn(client: httpx.Client, name: str, length: float) -> None:
    symbols = {
        v.name: length for v in SHIPPED[name].variables if v.kind == "length" and not v.joint
    }
    joints = [[0.1] * len(SHIPPED[name].joints)]
    text = client.post(URL, json={"exercise": name, "symbols": symbols, "joints": joints}).text
    assert "NaN" not in text
    assert "null" not in text
    assert "configurations" in text


@pytest.mark.parametrize(
    "rows",
    [
        "<script>alert(1)</script>",
        [["\u202e", "<b>", "javascript:alert(1)", "]]>"]] * 12,
        [["q1^q1^q1", "9" * 400, "(" * 500, "1/0"]],
        [[[[]], {}, None, True]],
        {"a": {"b": 1}},
        [["0"] * 4] * 400,
    ],
)
def test_hostile_tables_are_only_unread(client: httpx.Client, rows: object) -> None:
    found = answered(client, {"table": {"rows": rows, "structure": "RP"}})
    assert not found["table"]["complete"]
    assert found["table"]["unread"] or found["table"]["error"]


STANFORD = [
    {"axis": 2, "z": "+y", "origin": [0, 0, 0], "x": "+x"},
    {"axis": 3, "z": "-z", "origin": [0, "d2", 0], "x": [1, 1, 0]},
    {"axis": "", "z": "+z", "origin": [0, "d2", ""], "x": "+x"},
    {"axis": 5, "z": "+y", "origin": [0, "d2", 0], "x": "-y"},
    {"axis": "", "z": "", "origin": ["", "", ""], "x": ""},
]


def test_placed_frames_move_with_their_links(client: httpx.Client) -> None:
    body = {
        "exercise": "stanford-arm-frames",
        "placed": {"part": "frames", "rows": STANFORD},
        "symbols": {"d2": 0.2},
        "joints": [[0, 0, 0, 0, 0, 0], [0, 0, 0.7, 0, 0, 0], [pi / 2, 0, 0, 0, 0, 0]],
    }
    found = answered(client, body)["placed"]
    assert found["labels"] == ["1", "2"]
    half = 0.5**0.5
    first = [[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]]
    second = [[half, half, 0, 0], [half, -half, 0, 0.2], [0, 0, -1, 0], [0, 0, 0, 1]]
    home, drawn_out, turned = found["frames"]
    assert home[0] == [pytest.approx(row) for row in first]
    assert home[1] == [pytest.approx(row) for row in second]
    # Frame 2 is on link 2, which joint 3 does not move.
    assert drawn_out == home
    # Joint 1 takes y0 to -x0.
    assert [row[2] for row in turned[0]] == pytest.approx([-1, 0, 0, 0])
    assert [row[3] for row in turned[1]] == pytest.approx([-0.2, 0, 0, 1])
    left_out = {(cell["row"], cell["column"]): cell["error"] for cell in found["left_out"]}
    assert left_out.keys() == {("3", "origin_z"), ("4", "x")}
    assert left_out["4", "x"]["message"] == "x and z are parallel, so they make no frame."


def test_a_frame_behind_a_sliding_joint_slides(client: httpx.Client) -> None:
    row = {"frame": 3, "axis": 4, "z": "+z", "origin": [0, "d2", 0], "x": "+y"}
    body = {
        "exercise": "stanford-arm-frames",
        "placed": {"part": "frames", "rows": [row]},
        "symbols": {"d2": 0.2},
        "joints": [[0, 0, 0.7, 0, 0, 0]],
    }
    [[frame]] = answered(client, body)["placed"]["frames"]
    assert [line[3] for line in frame] == pytest.approx([0, 0.2, 0.7, 1])


@pytest.mark.parametrize("rows", [7, [{"why": 1}], "z is up", [{"z": "up"}] * 9])
def test_placed_frames_of_another_shape_are_not_drawn(client: httpx.Client, rows: object) -> None:
    body = {"exercise": "planar-rrr-frames", "placed": {"part": "frames", "rows": rows}}
    found = answered(client, body)["placed"]
    assert found["error"]["code"] == "wrong_shape"
    assert found["frames"] == []


@pytest.mark.parametrize(
    "body",
    [
        {"table": {"rows": [], "structure": "RR"}, "placed": {"part": "frames", "rows": []}},
        {"exercise": "planar-rrr-frames", "placed": {"part": "table", "rows": []}},
        {"exercise": "planar-rrr-frames", "placed": {"part": "none", "rows": []}},
    ],
)
def test_placed_frames_need_a_part_that_asks_for_them(client: httpx.Client, body: object) -> None:
    response = client.post(URL, json=body)
    assert response.status_code == 422
    assert "a part of it that asks for frames" in response.text


# --- Figures


@pytest.mark.long
def test_a_figure_is_the_drawing_of_the_exercise(
    client: httpx.Client, catalogue: Mapping[str, Exercise]
) -> None:
    answer = client.get("/v1/exercises/scara/figure.svg")
    assert answer.headers["content-type"] == "image/svg+xml"
    assert answer.text == exercise_figure(catalogue["scara"])
    dark = client.get("/v1/exercises/scara/figure.svg?theme=dark")
    assert dark.text == exercise_figure(catalogue["scara"], Theme.DARK)
    assert client.get("/v1/exercises/scara").json()["figure"] is True


@pytest.mark.long
def test_a_figure_runs_no_script_and_uses_only_its_own_style(client: httpx.Client) -> None:
    for theme in Theme:
        answer = client.get(f"/v1/exercises/planar-rr/figure.svg?theme={theme}")
        policy = answer.headers["content-security-policy"]
        style = re.findall(r"<style>(.*?)</style>", answer.text, re.DOTALL)
        digest = base64.b64encode(hashlib.sha256(style[0].encode()).digest()).decode()
        assert "default-src 'none'" in policy
        assert f"style-src 'sha256-{digest}'" in policy


@pytest.mark.parametrize(
    ("path", "status", "kind"),
    [
        ("skara/figure.svg", 404, "unknown-exercise"),
        ("dh-conditions/figure.svg", 404, "no-figure"),
        ("scara/figure.svg?theme=pink", 422, "invalid-request"),
    ],
)
def test_a_figure_of_an_unknown_exercise_or_theme_is_refused(
    client: httpx.Client, path: str, status: int, kind: str
) -> None:
    answer = client.get(f"/v1/exercises/{path}")
    assert answer.status_code == status
    assert answer.json()["type"] == f"urn:dh-grader:problem:{kind}"


def test_an_exercise_without_a_robot_says_so(client: httpx.Client) -> None:
    assert client.get("/v1/exercises/dh-conditions").json()["figure"] is False


# --- Test the routes for hints, and for the pictures that explain rules

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
