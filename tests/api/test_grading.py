"""Test grading by requests, and previews."""

import asyncio
import hashlib
import json
import re
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import httpx
import pytest
from dh_grader.api import frames as preview
from dh_grader.api import grading
from dh_grader.api import grading as hints
from dh_grader.api.application import application
from dh_grader.api.document import FOLDER
from dh_grader.catalogue import Exercise, FeedbackLevel, least, load_catalogue
from dh_grader.expressions import ExpressionError
from dh_grader.formats.graded import with_texts
from dh_grader.grading import Report, Submission, Verdict, grade
from dh_grader.hints import HintStep
from dh_grader.kinematics import Convention
from dh_grader.submissions.bodies import MAX_BODY_SIZE, MAX_BRACKETS, MAX_SUBMISSIONS
from dh_grader.translations import say
from fastapi import FastAPI
from hypothesis import given
from hypothesis import strategies as st
from playwright.sync_api import expect

from tests.api.serving import Served
from tests.api.test_exercises import SECRETIVE
from tests.browser.fixtures import Visit
from tests.grading.support.bare_numbers import BARE, BareExercise
from tests.guards import ANSWER
from tests.together import together
from tests.translations.german import as_sentence, messages_in, offer_german

# --- Test the route POST /v1/exercises/{id}/grade

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


# --- Preview


def preview_of(client: httpx.Client, **body: Any) -> dict[str, Any]:
    response = client.post("/v1/preview", json=body)
    assert response.status_code == 200, response.text
    result: dict[str, Any] = response.json()
    return result


def test_a_text_comes_back_as_it_is_read(client: httpx.Client) -> None:
    shown = preview_of(client, text="l1 c12", exercise="planar-rrr", part="pose")
    assert shown["ok"] is True
    assert shown["symbols"] == ["l1", "q1", "q2"]
    assert shown["text"].replace(" ", "") == "l1*cos(q1+q2)"
    assert "\\cos" in shown["latex"]
    assert shown["mathml"].startswith("<math")
    assert "error" not in shown


def test_a_text_that_cannot_be_read_says_where_and_what_was_meant(client: httpx.Client) -> None:
    shown = preview_of(client, text="l1 + ", exercise="planar-rrr")
    assert set(shown) == {"ok", "error"}
    assert shown["ok"] is False
    error = shown["error"]
    assert set(error) == {"code", "message", "span", "suggestion"}
    assert "l1 + "[slice(*error["span"])].strip() == "+"
    assert error["suggestion"] == "l1"


def test_without_an_exercise_the_usual_letters_are_known(client: httpx.Client) -> None:
    shown = preview_of(client, text="a1 cos(q1) + d9 s9 + l2 sin(alpha3)")
    assert shown["symbols"] == ["a1", "alpha3", "d9", "l2", "theta1", "theta9"]
    unknown = preview_of(client, text="zz1")["error"]["message"]
    assert unknown.startswith("There is no `zz1` here. There are ")
    assert (
        "This exercise" in preview_of(client, text="zz1", exercise="planar-rrr")["error"]["message"]
    )


def test_the_unit_decides_what_a_bare_number_is(client: httpx.Client) -> None:
    as_angle = preview_of(client, text="90", angle_unit="degrees", quantity="angle")
    as_length = preview_of(client, text="90", angle_unit="degrees", quantity="length")
    assert as_angle["text"] == "90deg"
    assert as_length["text"] == "90"


@pytest.mark.parametrize("text", ["", " ", "x" * 100_000, "(" * 10_000, "\0", "1e999", "\u202e"])
def test_every_text_gets_an_answer(client: httpx.Client, text: str) -> None:
    assert preview_of(client, text=text)["ok"] is False


def test_a_lone_surrogate_gets_an_answer(client: httpx.Client) -> None:
    response = client.post("/v1/preview", content=b'{"text": "\\udc00"}')
    assert response.status_code == 200
    assert response.json()["ok"] is False


@pytest.mark.parametrize(
    ("body", "pointer", "hint"),
    [
        ({"text": "1", "exercise": "planar-rrrr"}, "#/exercise", "'planar-rrr'"),
        ({"text": "1", "exercise": "planar-rrr", "part": "tabel"}, "#/part", "table, pose"),
        ({"text": "1", "part": "table"}, "#/part", "exercise"),
        ({"text": 1}, "#/text", "must be a text"),
        ({"text": "1", "quantity": "mass"}, "#/quantity", "angle"),
        ({}, "#/text", "missing"),
    ],
)
def test_a_wrong_request_is_a_422_that_points_there(
    client: httpx.Client, body: object, pointer: str, hint: str
) -> None:
    response = client.post("/v1/preview", json=body)
    assert response.status_code == 422
    [error] = response.json()["errors"]
    assert error["pointer"] == pointer
    assert hint in error["detail"]


def test_a_whole_pasted_table_is_shown_cell_by_cell(client: httpx.Client) -> None:
    text = "a, alpha, d, theta\n0, -90°, 0, θ1*\n0, 90°, d2, q2 +"
    body = {"text": text, "exercise": "stanford-arm", "part": "table"}
    answer = client.post("/v1/preview", json=body).json()
    assert answer["ok"] is False
    first, second = answer["rows"]
    assert [cell["text"] for cell in first] == ["0", "-90deg", "0", "theta1"]
    assert [cell["column"] for cell in first] == ["a", "alpha", "d", "theta"]
    assert text[slice(*first[1]["span"])] == "-90°"
    assert second[3]["error"]["code"] == "trailing_operator"
    assert text[slice(*second[3]["error"]["span"])] == "+"
    assert answer["symbols"] == ["d2", "theta1"]


def test_a_whole_pasted_matrix_is_shown_cell_by_cell(client: httpx.Client) -> None:
    text = "[c1, -s1, 0, 0; s1, c1, 0, 0; 0, 0, 1, d3; 0, 0, 0, 1]"
    body = {"text": text, "exercise": "stanford-arm", "part": "pose"}
    answer = client.post("/v1/preview", json=body).json()
    assert answer["ok"] is True
    assert [len(row) for row in answer["rows"]] == [4, 4, 4, 4]
    assert answer["rows"][0][1]["latex"]
    assert "<math" in answer["rows"][0][1]["mathml"]


def test_one_entry_of_a_part_is_shown_as_one(client: httpx.Client) -> None:
    body = {"text": "atan2(d2, d6)", "exercise": "stanford-arm", "part": "table"}
    answer = client.post("/v1/preview", json=body).json()
    assert answer["ok"] is True
    assert "rows" not in answer
    wrong = {**body, "text": "atan2(d2, d6"}
    assert client.post("/v1/preview", json=wrong).json()["error"]["code"] == "unbalanced_bracket"


def preview_many(client: httpx.Client, entries: list[dict[str, str]]) -> list[dict[str, Any]]:
    body = {"exercise": "rrrp", "part": "table", "entries": entries}
    response = client.post("/v1/previews", json=body)
    assert response.status_code == 200, response.text
    results: list[dict[str, Any]] = response.json()["results"]
    return results


def test_entries_of_a_part_are_read_each_on_its_own_and_in_their_order(
    client: httpx.Client,
) -> None:
    texts = ["q1*", "2 +", "-90°", "l2"]
    results = preview_many(client, [{"text": text} for text in texts])
    assert [each["ok"] for each in results] == [True, False, True, True]
    assert [each.get("text") for each in results] == ["q1", None, "-90deg", "l2"]
    assert results[1]["error"]["suggestion"] == "2"
    # In a table a star marks the variable of a joint; this needs no note.
    assert results[0]["notes"] == []


def test_many_entries_share_the_work_of_one_submission(client: httpx.Client) -> None:
    hard = [{"text": "+".join(["sin(q1 q2 l3)"] * 60)}] * 190
    results = preview_many(client, hard)
    assert len(results) == 190
    assert results[0]["ok"] is True
    assert results[-1]["error"]["code"] == "too_long"


def test_a_cell_below_a_unit_tells_what_to_write_without_the_header(client: httpx.Client) -> None:
    text = "a [mm], alpha [deg], d, theta\n500, 180, 0, q1\n0, 0, 0, q2\n0, 0, 0, q3\n0, 0, q4, 0"
    row = preview_of(client, text=text, exercise="rrrp", part="table")["rows"][0]
    assert [cell["entry"] for cell in row] == ["500/1000", "180deg", "0", "q1"]
    assert [cell["typed"] for cell in row] == ["500", "180", "0", "q1"]


# --- The page /docs works without the internet

PAGE = "/docs"


def sources(html: str) -> list[str]:
    return re.findall(r'(?:src|href)="([^"]+)"', html)


@pytest.mark.long
def test_the_page_names_no_other_host(server: Served) -> None:
    with httpx.Client(base_url=server.address, trust_env=False, timeout=ANSWER) as client:
        page = client.get(PAGE)
        assert page.headers["content-type"] == "text/html; charset=utf-8"
        addresses = sources(page.text)
        assert len([each for each in addresses if each.startswith("docs/")]) == 3
        assert [each for each in addresses if "//" in each or each.startswith("/")] == []
        assert all(client.get(f"/{each}").status_code == 200 for each in addresses)


@pytest.mark.long
def test_the_browser_is_told_to_load_and_call_nothing_else(server: Served) -> None:
    page = httpx.get(f"{server.address}{PAGE}", trust_env=False, timeout=ANSWER)
    policy = page.headers["content-security-policy"]
    directives = dict(part.strip().split(" ", 1) for part in policy.split(";"))
    assert directives["default-src"] == "'none'"
    assert set(" ".join(directives.values()).split()) == {"'none'", "'self'", "data:"}
    assert "data:" not in directives["script-src"]


@pytest.mark.parametrize(
    ("name", "media_type"),
    [
        ("swagger-ui-5.35.0.js", "text/javascript; charset=utf-8"),
        ("swagger-ui-5.35.0.css", "text/css; charset=utf-8"),
        ("start.js", "text/javascript; charset=utf-8"),
    ],
)
def test_a_file_of_the_page(client: httpx.Client, name: str, media_type: str) -> None:
    answer = client.get(f"{PAGE}/{name}")
    assert answer.headers["content-type"] == media_type
    assert ("immutable" in answer.headers["cache-control"]) == ("5.35.0" in name)
    assert answer.content == (FOLDER / name).read_bytes()


@pytest.mark.parametrize("name", ["SHA256SUMS", "LICENSE", "x.js", "..%2fpage.py", "%2e%2e"])
def test_there_are_no_other_files(client: httpx.Client, name: str) -> None:
    answer = client.get(f"{PAGE}/{name}")
    assert answer.status_code == 404
    assert answer.headers["content-type"] == "application/problem+json"


@pytest.mark.parametrize("path", ["/redoc", "/docs/oauth2-redirect"])
def test_the_framework_s_own_pages_are_off(client: httpx.Client, path: str) -> None:
    assert client.get(path).status_code == 404


def test_the_files_are_those_that_were_published() -> None:
    # The checksums were taken from the npm package when the files were copied.
    lines = (FOLDER / "SHA256SUMS").read_text(encoding="utf-8").splitlines()
    assert len(lines) == 2
    for line in lines:
        published, name = line.split("  ")
        assert hashlib.sha256((FOLDER / name).read_bytes()).hexdigest() == published
    assert "Apache License" in (FOLDER / "LICENSE").read_text(encoding="utf-8")


@pytest.mark.campaign
def test_in_a_browser_without_the_internet(visit: Callable[..., Visit], server: Served) -> None:
    origin = f"{server.address}/"
    document = httpx.get(f"{origin}openapi.json", trust_env=False, timeout=ANSWER).json()
    paths = document["paths"].values()
    opened = visit()
    page = opened.page
    page.goto(server.address + PAGE)
    expect(page.locator(".opblock")).to_have_count(sum(map(len, paths)))
    many = page.locator("#operations-grading-gradeMany")
    many.locator(".opblock-summary-control").click()
    many.locator(".execute").click()
    answer = many.locator(".live-responses-table .response")
    expect(answer).to_contain_text("200")
    expect(answer).to_contain_text("urn:dh-grader:problem:unknown-exercise")
    assert [url for url in opened.requests if not url.startswith((origin, "data:"))] == []
    assert f"{origin}v1/grade" in opened.requests


# --- POST /v1/grade grades many submissions in one request, each independently

MANY_URL = "/v1/grade"
# From the source of the exercise: Spong's planar arm with two links.
POSITION = ["a1 c1 + a2 c12", "a1 s1 + a2 s12"]
MANY_RIGHT: dict[str, Any] = {"exercise": "planar-rr", "answers": {"position": POSITION}}
WRONG: dict[str, Any] = {"exercise": "planar-rr", "answers": {"position": ["a1 c1", "a1 s1 +"]}}
OTHER: dict[str, Any] = {
    "exercise": "planar-rrr",
    "answers": {"table": "l1, 0, 0, q1"},
    "feedback": "score",
}


def results(client: httpx.Client, *submissions: object) -> list[dict[str, Any]]:
    response = client.post(MANY_URL, json={"submissions": submissions})
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
    submissions = [
        WRONG,
        MANY_RIGHT,
        OTHER,
        {**WRONG, "echo": True},
        {**MANY_RIGHT, "angle_unit": "degrees"},
    ]
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
        ({**MANY_RIGHT, "feedback": "all"}, 422, "invalid-request", ["#/submissions/1/feedback"]),
        ({**MANY_RIGHT, "learner": "x"}, 422, "invalid-request", ["#/submissions/1/learner"]),
        (None, 422, "invalid-request", ["#/submissions/1"]),
        ([], 422, "invalid-request", ["#/submissions/1"]),
    ],
)  # fmt: skip
def test_a_faulty_submission_gets_a_problem_and_the_others_are_graded(
    client: httpx.Client, submission: object, status: int, name: str, pointers: list[str] | None
) -> None:
    first, faulty, last = results(client, MANY_RIGHT, submission, WRONG)
    assert [first["report"], last["report"]] == [
        alone(client, each).json() for each in (MANY_RIGHT, WRONG)
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
    [result] = results(client, {**MANY_RIGHT, "learner": "x"})
    assert "answers, angle_unit, feedback, echo, exercise" in result["problem"]["detail"]


@pytest.mark.parametrize(
    ("body", "pointer"),
    [
        ([], "#"),
        ({}, "#/submissions"),
        ({"submissions": {}}, "#/submissions"),
        ({"submissions": [], "feedback": "full"}, "#/feedback"),
        ({"submissions": [MANY_RIGHT] * (MAX_SUBMISSIONS + 1)}, "#/submissions"),
    ],
)
def test_a_body_of_another_shape_gets_422(client: httpx.Client, body: object, pointer: str) -> None:
    response = client.post(MANY_URL, json=body)
    assert response.status_code == 422
    assert response.headers["content-type"] == "application/problem+json"
    assert [error["pointer"] for error in response.json()["errors"]] == [pointer]


def test_too_many_submissions_are_told_how_many_there_may_be(client: httpx.Client) -> None:
    response = client.post(MANY_URL, json={"submissions": [0] * (MAX_SUBMISSIONS + 1)})
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
    first, broken, last = results(client, MANY_RIGHT, {**MANY_RIGHT, "answers": {}}, MANY_RIGHT)
    assert first == last == {"report": alone(client, MANY_RIGHT).json()}
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
            many = asyncio.create_task(
                client.post(MANY_URL, json={"submissions": [MANY_RIGHT] * 60})
            )
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


# --- The language of a response is that of the query, else of the header, else English

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


@pytest.fixture
def _german(monkeypatch: pytest.MonkeyPatch) -> None:
    offer_german(monkeypatch, WORDS)

    def graded(exercise: Any, submission: Submission) -> Report:
        return with_texts(grade(exercise, submission), as_sentence)

    monkeypatch.setattr(grading, "grade", graded)


@pytest.mark.usefixtures("_german")
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


@pytest.mark.usefixtures("_german")
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


@pytest.mark.usefixtures("_german")
def test_a_hint_is_in_the_language_of_the_reader(
    client: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    step = HintStep("α", say("Look at {axis}.", axis="z1"), Convention.STANDARD)
    monkeypatch.setattr(hints, "hint_step", lambda *_: step)
    body = {"answers": {"table": "0"}, "part": "table", "code": "sign", "step": 1}
    shown = client.post("/v1/exercises/planar-rr/hints?lang=de", json=body)
    assert (shown.json()["title"], shown.json()["text"]) == ("α", "Sehen Sie sich z1 an.")
    assert shown.headers["content-language"] == "de"


@pytest.mark.usefixtures("_german")
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


@pytest.mark.usefixtures("_german")
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
