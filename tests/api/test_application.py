"""Test the application, its health, and its page of docs."""

import asyncio
import gc
import json
import logging
import re
import threading
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import httpx
import pytest
from dh_grader.api.application import application
from dh_grader.catalogue import Exercise, LateCatalogue, open_catalogue, shipped_folder
from dh_grader.store import StoreDownError
from dh_grader.store.attempt_store import AttemptStore
from dh_grader.submissions.bodies import MAX_SUBMISSIONS
from fastapi import FastAPI
from sqlalchemy import event, text

from tests.store.databases import new_file

# --- Test the application as a whole, apart from its routes


def test_garbage_is_collected_while_it_serves() -> None:
    # This also holds if the process started with the collector off.
    async def serve() -> None:
        app = application({})
        async with app.router.lifespan_context(app):
            assert gc.isenabled()
            assert gc.get_freeze_count() > 0

    gc.disable()
    try:
        asyncio.run(serve())
    finally:
        gc.enable()


def test_the_exercises_are_compiled_one_by_one_after_the_start() -> None:
    catalogue = open_catalogue([shipped_folder()], reload=False)
    assert isinstance(catalogue, LateCatalogue)

    async def serve() -> None:
        app = application(catalogue)
        async with app.router.lifespan_context(app):
            # The first requests come between two exercises.
            assert next(catalogue.compile_one_by_one(), None) is not None
            await asyncio.sleep(0)
            assert next(catalogue.compile_one_by_one(), None) is not None
            while next(catalogue.compile_one_by_one(), None) is not None:
                await asyncio.sleep(0)

    asyncio.run(asyncio.wait_for(serve(), 60))


def test_the_service_may_end_before_all_exercises_are_compiled() -> None:
    catalogue = open_catalogue([shipped_folder()], reload=False)
    assert isinstance(catalogue, LateCatalogue)

    async def serve() -> None:
        app = application(catalogue)
        async with app.router.lifespan_context(app):
            await asyncio.sleep(0)

    asyncio.run(serve())
    assert next(catalogue.compile_one_by_one(), None) is not None


# --- The service describes the shape of each answer, such as 4 × 4


def shape(client: httpx.Client, exercise: str, part_id: str) -> dict[str, Any]:
    parts = client.get(f"/v1/exercises/{exercise}").json()["parts"]
    [found] = [part["shape"] for part in parts if part["id"] == part_id]
    return dict(found)


THREE, FOUR, SIX = ["1", "2", "3"], ["1", "2", "3", "4"], ["1", "2", "3", "4", "5", "6"]


def components(*pairs: tuple[str, str]) -> list[dict[str, str]]:
    return [{"name": name, "quantity": quantity} for name, quantity in pairs]


SHAPES: dict[tuple[str, str], dict[str, Any]] = {
    ("planar-rpr-poe", "home"): {"form": "matrix", "columns": FOUR, "rows": FOUR},
    ("fundamental-rotations", "about-x"): {"form": "matrix", "columns": THREE, "rows": THREE},
    ("planar-rr", "position"): {
        "form": "list",
        "rows": ["1", "2"],
        "components": components(("x", "length"), ("y", "length")),
    },
    ("planar-rr", "task-space"): {
        "form": "list",
        "rows": THREE,
        "components": components(("p_x", "length"), ("p_y", "length"), ("φ", "angle")),
    },
    ("spherical-wrist", "zyz"): {
        "form": "list",
        "rows": THREE,
        "components": components(("about z", "angle"), ("about y", "angle"), ("about z", "angle")),
        "sequence": "ZYZ",
        "axes": "moving",
    },
    ("planar-rpr-poe", "body-screws"): {
        "form": "screw_axes",
        "columns": SIX,
        "rows": THREE,
        "frame": "body",
        "directions": "given",
    },
    ("simple-twist", "pitch"): {
        "form": "screw_axes",
        "columns": SIX,
        "rows": ["1"],
        "frame": "space",
        "directions": "given",
    },
    ("dh-conditions", "first"): {
        "form": "dh_row",
        "columns": ["a", "alpha", "d", "theta"],
        "convention": "standard",
    },
}


@pytest.mark.parametrize("place", SHAPES)
def test_the_shape_of_an_answer(place: tuple[str, str], client: httpx.Client) -> None:
    assert shape(client, *place) == SHAPES[place]


def test_an_exercise_without_a_robot_has_no_structure(client: httpx.Client) -> None:
    listed = {each["id"]: each for each in client.get("/v1/exercises").json()["exercises"]}
    assert listed["composite-rotations"]["structure"] is None
    assert listed["planar-rpr-poe"]["structure"] == "RPR"
    assert "structure" not in client.get("/v1/exercises/composite-rotations").json()


@pytest.mark.parametrize("exercise", ["rigid-motion-chain", "simple-twist", "planar-rpr-poe"])
def test_no_formula_of_an_answer_is_shown(exercise: str, client: httpx.Client) -> None:
    shown = client.get(f"/v1/exercises/{exercise}").json()
    for part in shown["parts"]:
        fields = {"id", "title", "prompt", "prompt_html", "kind", "points", "marking", "shape"}
        assert set(part) == fields
    assert "expected" not in str(shown["parts"])


# --- The docs pages on HTTP and on frame choice show the service's real responses

ROOT = Path(__file__).parents[2]
HTTP = ROOT / "docs" / "http.md"
CURL = re.compile(
    r"^\$ curl -s http://127\.0\.0\.1:8000(\S+) \\\n"
    r" +-H 'Content-Type: application/json' -d @(\S+)$",
    re.MULTILINE,
)


def json_blocks(page: str) -> list[dict[str, Any]]:
    text = (ROOT / page).read_text(encoding="utf-8")
    return [json.loads(block) for block in re.findall(r"```json\n(.*?)```", text, re.DOTALL)]


def test_the_curl_of_the_page_gets_the_answer_that_it_prints(client: httpx.Client) -> None:
    (url, file), _ = CURL.findall(HTTP.read_text(encoding="utf-8"))
    (printed,) = json_blocks("docs/http.md")
    # By default, curl sends the content type of a form.
    for content_type in ("application/json", "application/x-www-form-urlencoded"):
        answered = client.post(
            url, content=(ROOT / file).read_bytes(), headers={"Content-Type": content_type}
        )
        assert answered.status_code == 200
        assert answered.json() == {**printed, "version": answered.json()["version"]}


def test_the_curl_for_many_gets_a_report_and_a_problem(client: httpx.Client) -> None:
    _, (url, file) = CURL.findall(HTTP.read_text(encoding="utf-8"))
    results = client.post(url, content=(ROOT / file).read_bytes()).json()["results"]
    assert [set(result) for result in results] == [{"report"}, {"problem"}]
    page = HTTP.read_text(encoding="utf-8")
    assert f"up to {MAX_SUBMISSIONS} submissions" in page


def test_the_worked_example_of_frame_choice_gets_full_marks(client: httpx.Client) -> None:
    (submission,) = json_blocks("docs/frame-choice.md")
    report = client.post("/v1/exercises/stanford-arm/grade", json=submission).json()
    table = report["parts"][0]
    assert table["points"] == table["max_points"]
    remarks = [message["message"] for message in table["feedback"]]
    assert remarks == ["You let z2 point the opposite way; that is a valid choice."]
    forgot = {**submission["answers"]["table"]["rows"][2], "d": "d3"}
    submission["answers"]["table"]["rows"][2] = forgot
    report = client.post("/v1/exercises/stanford-arm/grade", json=submission).json()
    wrong = [
        (row["label"], cell["label"], [message["code"] for message in cell["feedback"]])
        for row in report["parts"][0]["rows"]
        for cell in row["cells"]
        if cell["verdict"] != "correct"
    ]
    assert wrong == [("3", "d", ["joint_variable_sign"])]


def test_every_link_of_the_pages_leads_somewhere() -> None:
    for page in (ROOT / "README.md", *(ROOT / "docs").glob("*.md")):
        for link in re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text(encoding="utf-8")):
            if "://" not in link:
                assert (page.parent / link).exists(), f"{page.name}: {link}"


# --- Test the health checks of a service with a real database


@pytest.fixture
def store(tmp_path: Path) -> Iterator[AttemptStore]:
    store = AttemptStore.open(new_file(tmp_path))
    store.start()
    yield store
    store.close()


def asked(app: FastAPI, path: str, times: int = 1) -> list[httpx.Response]:
    async def ask() -> list[httpx.Response]:
        transport = httpx.ASGITransport(app)
        async with httpx.AsyncClient(transport=transport, base_url="http://service") as client:
            return await asyncio.gather(*(client.get(path) for _ in range(times)))

    return asyncio.run(ask())


def test_readiness_asks_the_database_once_for_all_and_liveness_never(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    app = application(catalogue, store=store)
    statements: list[Any] = []
    event.listen(store.engine, "before_cursor_execute", lambda *given: statements.append(given[2]))
    assert {answer.status_code for answer in asked(app, "/healthz", 20)} == {200}
    assert statements == []
    assert {answer.status_code for answer in asked(app, "/readyz", 20)} == {200}
    assert 1 <= len(statements) < 5


def test_readiness_writes_at_most_once_in_a_second(
    store: AttemptStore, catalogue: Mapping[str, Exercise]
) -> None:
    app = application(catalogue, store=store)
    writes: list[str] = []

    def note(_: Any, __: Any, statement: str, *___: Any) -> None:
        if statement.startswith("INSERT"):
            writes.append(statement)

    event.listen(store.engine, "before_cursor_execute", note)
    begun = time.monotonic()
    for _ in range(30):
        assert asked(app, "/readyz")[0].status_code == 200
    assert 1 <= len(writes) <= 1 + (time.monotonic() - begun)
    with store.engine.connect() as connection:
        assert connection.scalar(text("SELECT count(*) FROM outcomes")) == 0


def test_a_check_of_a_moment_ago_does_not_count_after_an_attempt_waited_in_vain(
    store: AttemptStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Here a success counts for long; normally it counts for a second.
    monkeypatch.setattr("dh_grader.store.attempt_store._CHECKED", 3600.0)
    reacts = threading.Event()

    async def wait_in_vain() -> None:
        await store.check()
        monkeypatch.setattr("dh_grader.store.database._TIMEOUT", 0.2)
        with pytest.raises(StoreDownError):
            await store.write(lambda _: reacts.wait())
        with pytest.raises(StoreDownError):
            await store.check()

    try:
        asyncio.run(wait_in_vain())
    finally:
        reacts.set()


def test_a_database_without_its_tables_is_not_ready_and_the_log_says_why(
    store: AttemptStore, catalogue: Mapping[str, Exercise], caplog: pytest.LogCaptureFixture
) -> None:
    app = application(catalogue, store=store)
    with store.engine.execution_options(writes=True).begin() as connection:
        connection.execute(text("ALTER TABLE attempts RENAME TO hidden"))
    with caplog.at_level(logging.WARNING):
        (answer,) = asked(app, "/readyz")
    assert answer.status_code == 503
    assert answer.json()["type"].endswith(":store-down")
    assert "no such table: attempts" in caplog.text
    assert asked(app, "/healthz")[0].status_code == 200


def test_a_service_without_exercises_is_not_ready() -> None:
    (answer,) = asked(application({}), "/readyz")
    assert answer.status_code == 503
    assert answer.json()["type"].endswith(":no-exercises")
