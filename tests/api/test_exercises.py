"""Test exercises, their solutions and variants, and practice."""

import asyncio
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import httpx
import pytest
from dh_grader import variants
from dh_grader.api.application import application
from dh_grader.api.grading import _solved
from dh_grader.api.http import MemoizedResults
from dh_grader.api.permissions import Access
from dh_grader.catalogue import Exercise, Robot, load_catalogue
from dh_grader.catalogue.schema_fields import AttemptsSpec
from dh_grader.kinematics import Convention
from dh_grader.variants import BuiltVariants, built
from dh_grader.variants.robots import (
    MOST_ROBOTS,
    CatalogueWithPractice,
    PracticeId,
    Situation,
    _memoized,
    has_situation,
    practice_id,
    robot_exercise,
)
from fastapi import FastAPI

from tests.api.conftest import InProcess
from tests.solutions.solved import solved
from tests.together import together
from tests.variants.robots.checks import lazy_share
from tests.variants.varied_files import shipped

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


# --- Test the routes for model solutions, which are off by default

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


# --- Test the routes for generated robots


@pytest.mark.long
def test_a_robot_is_found_by_its_id_everywhere(client: httpx.Client) -> None:
    dealt = client.get("/v1/practice/next?level=2&convention=modified").json()
    assert dealt["level"] == 2
    path = f"/v1/exercises/{dealt['id']}"
    shown = client.get(path).json()
    assert shown["parts"][0]["shape"]["convention"] == "modified"
    assert client.get(f"{path}/figure.svg").status_code == 200
    report = client.post(f"{path}/grade", json={"answers": {"table": {"rows": []}}}).json()
    assert report["points"] == 0
    drawing = client.post("/v1/frames", json={"exercise": dealt["id"]})
    assert drawing.status_code == 200
    assert dealt["id"] not in client.get("/v1/exercises").text
    assert "robot_table" not in client.get(path).text


def test_the_next_robot_follows_the_last_one(client: httpx.Client) -> None:
    first = "practice-1-standard~5"
    following = client.get(f"/v1/practice/next?level=1&after={first}").json()
    assert following["id"] == "practice-1-standard~6"
    harder = client.get(f"/v1/practice/next?level=2&convention=modified&after={first}").json()
    assert harder["id"] == "practice-2-modified~6"
    assert harder["difficulty"] > following["difficulty"]


@pytest.mark.long
def test_a_robot_in_which_zeros_earn_much_is_not_dealt(client: httpx.Client) -> None:
    # In robot 1000 of level 1 they earn more than a quarter, because marks give one row up.
    for number in (998, 999, 1000):
        last = PracticeId(1, Convention.MODIFIED, number)
        dealt = client.get(f"/v1/practice/next?level=1&convention=modified&after={last}").json()
        later = (last.following(steps) for steps in range(1, 9))
        fair = next(each for each in later if lazy_share(robot_exercise(each)) <= 0.25)
        assert dealt["id"] == str(fair)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("favour", Situation)
def test_a_situation_may_be_wished(client: httpx.Client, favour: Situation) -> None:
    for after in ("practice-1-standard~5", "practice-3-standard~zz"):
        query = f"level=2&after={after}&favour={favour.value}"
        name = practice_id(client.get(f"/v1/practice/next?{query}").json()["id"])
        assert name is not None
        assert has_situation(name, favour)


@pytest.mark.parametrize(
    "query",
    ["level=0", "level=5", "level=1&after=scara", "level=1&convention=x", "level=1&favour=x"],
)
def test_other_queries_are_refused(client: httpx.Client, query: str) -> None:
    assert client.get(f"/v1/practice/next?{query}").status_code == 422


def test_unknown_robots_are_no_exercises(client: httpx.Client) -> None:
    for name in ("practice-9-standard~a", "practice-1-standard~01", "scara~a"):
        assert client.get(f"/v1/exercises/{name}").status_code == 404


@pytest.mark.long
def test_many_seeds_do_not_fill_the_memory() -> None:
    robots = CatalogueWithPractice({})
    for number in range(1, 20):
        assert robots[f"practice-1-standard~{number}"].parts
    assert _memoized.cache_info().maxsize == MOST_ROBOTS
    assert len(robots) == 0
    assert application(robots) is not None


# --- All routes accept ``<exercise>~<seed>``, the id of a variant of an exercise

NAME = "vertical-axes~k7"
VARIANT = built(shipped("vertical-axes"), "k7")
ROWS = [
    [cell.text() for cell in row] for row in VARIANT.robot.tables[VARIANT.robot.convention].rows
]
TABLE = {"table": {"rows": ROWS}}


def test_an_exercise_is_shown_and_graded_as_its_variant(client: httpx.Client) -> None:
    told = client.get(f"/v1/exercises/{NAME}").json()
    assert (told["id"], told["version"]) == (NAME, VARIANT.version)
    assert told["statement"] == VARIANT.statement
    report = client.post(f"/v1/exercises/{NAME}/grade", json={"answers": TABLE}).json()
    assert (report["exercise"], report["version"]) == (NAME, VARIANT.version)
    assert report["points"] == 6
    plain = client.post("/v1/exercises/vertical-axes/grade", json={"answers": TABLE}).json()
    assert plain["points"] < 6
    many = {"submissions": [{"exercise": NAME, "answers": TABLE}]}
    [result] = client.post("/v1/grade", json=many).json()["results"]
    assert result["report"] == report


def test_the_figure_and_the_frames_are_those_of_the_variant(client: httpx.Client) -> None:
    figure = client.get(f"/v1/exercises/{NAME}/figure.svg")
    assert figure.headers["content-type"].startswith("image/svg+xml")
    assert figure.text != client.get("/v1/exercises/vertical-axes/figure.svg").text
    frames = client.post("/v1/frames", json={"exercise": NAME}).json()
    assert [each["variable"] for each in frames["joints"]] == [j.variable for j in VARIANT.joints]


def test_entries_are_read_with_the_symbols_of_the_variant(client: httpx.Client) -> None:
    [sliding] = [joint.variable for joint in VARIANT.joints if joint.prismatic]
    body = {"exercise": NAME, "part": "table", "text": sliding}
    assert "error" not in client.post("/v1/preview", json=body).json()
    entries = {"exercise": NAME, "part": "table", "entries": []}
    assert client.post("/v1/previews", json=entries).status_code in (200, 422)


ANY: dict[str, Any] = {"answers": {}}
REQUESTS = [
    ("GET", "/v1/exercises/{}", None),
    ("GET", "/v1/exercises/{}/figure.svg", None),
    ("POST", "/v1/exercises/{}/grade", ANY),
]


@together(("method", "path", "body"), REQUESTS)
def test_an_exercise_without_variants_has_no_ids_with_seeds(
    method: str, path: str, body: Any, client: httpx.Client
) -> None:
    for name, message in {
        "scara~1": "The exercise scara has no variants.",
        "vertical-axes~A": "The seed of a variant has 1 to 20 small letters and digits.",
        "nothing~1": "There is no exercise 'nothing'.",
    }.items():
        refused = client.request(method, path.format(name), json=body)
        assert refused.status_code == 404
        assert refused.json()["type"].endswith("unknown-exercise")
        assert refused.json()["detail"].startswith(message)


def test_many_seeds_of_variants_do_not_fill_the_memory(
    client: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    few = BuiltVariants(most=4)
    monkeypatch.setattr(variants, "_variants", few)
    for seed in range(12):
        assert client.get(f"/v1/exercises/vertical-axes~{seed}").status_code == 200
    assert len(few) == 4
