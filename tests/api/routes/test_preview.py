from typing import Any

import httpx
import pytest


def preview(client: httpx.Client, **body: Any) -> dict[str, Any]:
    response = client.post("/v1/preview", json=body)
    assert response.status_code == 200, response.text
    result: dict[str, Any] = response.json()
    return result


def test_a_text_comes_back_as_it_is_read(client: httpx.Client) -> None:
    shown = preview(client, text="l1 c12", exercise="planar-rrr", part="pose")
    assert shown["ok"] is True
    assert shown["symbols"] == ["l1", "q1", "q2"]
    assert shown["text"].replace(" ", "") == "l1*cos(q1+q2)"
    assert "\\cos" in shown["latex"]
    assert shown["mathml"].startswith("<math")
    assert "error" not in shown


def test_a_text_that_cannot_be_read_says_where_and_what_was_meant(client: httpx.Client) -> None:
    shown = preview(client, text="l1 + ", exercise="planar-rrr")
    assert set(shown) == {"ok", "error"}
    assert shown["ok"] is False
    error = shown["error"]
    assert set(error) == {"code", "message", "span", "suggestion"}
    assert "l1 + "[slice(*error["span"])].strip() == "+"
    assert error["suggestion"] == "l1"


def test_without_an_exercise_the_usual_letters_are_known(client: httpx.Client) -> None:
    shown = preview(client, text="a1 cos(q1) + d9 s9 + l2 sin(alpha3)")
    assert shown["symbols"] == ["a1", "alpha3", "d9", "l2", "theta1", "theta9"]
    unknown = preview(client, text="zz1")["error"]["message"]
    assert unknown.startswith("There is no `zz1` here. There are ")
    assert "This exercise" in preview(client, text="zz1", exercise="planar-rrr")["error"]["message"]


def test_the_unit_decides_what_a_bare_number_is(client: httpx.Client) -> None:
    as_angle = preview(client, text="90", angle_unit="degrees", quantity="angle")
    as_length = preview(client, text="90", angle_unit="degrees", quantity="length")
    assert as_angle["text"] == "90deg"
    assert as_length["text"] == "90"


@pytest.mark.parametrize("text", ["", " ", "x" * 100_000, "(" * 10_000, "\0", "1e999", "\u202e"])
def test_every_text_gets_an_answer(client: httpx.Client, text: str) -> None:
    assert preview(client, text=text)["ok"] is False


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
    row = preview(client, text=text, exercise="rrrp", part="table")["rows"][0]
    assert [cell["entry"] for cell in row] == ["500/1000", "180deg", "0", "q1"]
    assert [cell["typed"] for cell in row] == ["500", "180", "0", "q1"]
