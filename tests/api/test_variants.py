"""All routes accept ``<exercise>~<seed>``, the id of a variant of an exercise."""

from typing import Any

import httpx
import pytest
from dh_grader import variants
from dh_grader.variants import BuiltVariants, built

from tests.together import together
from tests.variants.varied_files import shipped

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


def test_many_seeds_do_not_fill_the_memory(
    client: httpx.Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    few = BuiltVariants(most=4)
    monkeypatch.setattr(variants, "_variants", few)
    for seed in range(12):
        assert client.get(f"/v1/exercises/vertical-axes~{seed}").status_code == 200
    assert len(few) == 4
