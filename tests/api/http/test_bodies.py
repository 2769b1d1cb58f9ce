"""Every route refuses invalid request bodies in the same way."""

import json

import httpx
import pytest

GRADE = "/v1/exercises/planar-rrr/grade"
PREVIEW = "/v1/preview"


@pytest.mark.parametrize(
    ("body", "pointer"),
    [
        ([], "#"),
        ("text", "#"),
        (None, "#"),
        ({}, "#/answers"),
        ({"answers": []}, "#/answers"),
        ({"answers": None}, "#/answers"),
        ({"answers": {}, "angle_unit": "grad"}, "#/angle_unit"),
        ({"answers": {}, "angle_unit": None}, "#/angle_unit"),
        ({"answers": {}, "feedback": "all"}, "#/feedback"),
        ({"answers": {}, "angle_units": "degrees"}, "#/angle_units"),
    ],
)
def test_a_body_of_another_shape_gets_422_with_a_pointer(
    client: httpx.Client, body: object, pointer: str
) -> None:
    response = client.post(GRADE, content=json.dumps(body))
    assert response.status_code == 422
    assert response.headers["content-type"] == "application/problem+json"
    problem = response.json()
    assert problem["status"] == 422
    assert [error["pointer"] for error in problem["errors"]] == [pointer]


def test_an_unknown_field_is_answered_with_the_known_ones(client: httpx.Client) -> None:
    problem = client.post(GRADE, json={"answers": {}, "angle_units": "degrees"}).json()
    assert "answers, angle_unit, feedback" in problem["errors"][0]["detail"]


def test_an_unknown_field_inside_an_entry_is_not_answered_with_those_of_the_body(
    client: httpx.Client,
) -> None:
    entry = {"text": "l1*c1", "unit": "degrees"}
    body = {"exercise": "planar-rrr", "part": "position", "entries": [entry]}
    problem = client.post("/v1/previews", json=body).json()
    assert problem["errors"] == [
        {"pointer": "#/entries/0/unit", "detail": "This field is not known."}
    ]


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"  ",
        b"{",
        b"{'answers': {}}",
        b'{"answers": {}',
        b'{"answers": {},}',
        b'{"answers": {}} {}',
        b'\xff\xfe{"answers": {}}',
        b'{"answers": "\xff"}',
        b'{"answers": {"table": 1, "table": 2}}',
        b'{"answers": {"table": ' + b"[" * 10_000 + b"]" * 10_000 + b"}}",
        b'{"answers": {"table": ' + b'{"a":' * 10_000 + b"1" + b"}" * 10_000 + b"}}",
        b'{"answers": {"table": ' + b"[" * 500 + b"]" * 500 + b"}}",
        b"[" * 100_000,
    ],
)
@pytest.mark.parametrize("url", [GRADE, PREVIEW])
def test_a_body_that_is_not_json_gets_400(client: httpx.Client, url: str, content: bytes) -> None:
    response = client.post(url, content=content, headers={"Content-Type": "application/json"})
    assert response.status_code == 400
    assert response.headers["content-type"] == "application/problem+json"
    assert response.json()["type"] == "urn:dh-grader:problem:malformed-json"
    assert len(response.content) < 1000


def test_a_syntax_error_has_its_place(client: httpx.Client) -> None:
    problem = client.post(GRADE, content=b'{\n  "answers": {"table" 1}}').json()
    assert (problem["errors"][0]["line"], problem["errors"][0]["column"]) == (2, 23)
    assert "line 2, column 23" in problem["detail"]


def test_a_syntax_error_is_told_in_the_language(client: httpx.Client) -> None:
    response = client.post(GRADE, content=b'{"a" 1}', headers={"Accept-Language": "de"})
    assert response.headers["content-language"] == "de"
    told = "Das Trennzeichen ':' wird erwartet."
    assert response.json()["detail"] == f"{told} (Zeile 1, Spalte 6)"
    assert response.json()["errors"][0]["detail"] == told


@pytest.mark.parametrize(
    "content_type",
    ["application/json", "application/json; charset=utf-8", "application/x-www-form-urlencoded",
     "text/plain;charset=UTF-8", "application/vnd.course+json", "", "nonsense"],
)  # fmt: skip
def test_json_is_read_under_any_content_type(client: httpx.Client, content_type: str) -> None:
    headers = {"Content-Type": content_type} if content_type else {}
    response = client.post(GRADE, content=b'{"answers": {}}', headers=headers)
    assert response.status_code == 200


@pytest.mark.parametrize(
    ("content_type", "status"),
    [
        ("multipart/form-data; boundary=x", 415),
        ("application/x-www-form-urlencoded", 415),
        ("application/problem+json", 400),
    ],
)
def test_a_body_that_is_not_json_under_another_content_type_gets_415(
    client: httpx.Client, content_type: str, status: int
) -> None:
    headers = {"Content-Type": content_type}
    assert client.post(GRADE, content=b"answers=1", headers=headers).status_code == status


def test_a_byte_order_mark_is_no_mistake(client: httpx.Client) -> None:
    assert client.post(GRADE, content='\ufeff{"answers": {}}'.encode()).status_code == 200


def test_control_characters_in_names_come_back_escaped(client: httpx.Client) -> None:
    content = b'{"answers": {"\\ud800\\u0000\\u001b[31m": 1}}'
    response = client.post(GRADE, content=content)
    assert response.status_code == 422
    assert response.content.isascii()
    assert b"\x1b" not in response.content


@pytest.mark.parametrize("url", [GRADE, PREVIEW])
def test_only_the_first_of_thousands_of_unknown_fields_are_listed(
    client: httpx.Client, url: str
) -> None:
    # Known fields that follow the unknown fields are not reported as missing.
    known: dict[str, object] = {"answers": {}} if url == GRADE else {"text": "q1"}
    response = client.post(url, json={**{f"field{i}": 0 for i in range(12_000)}, **known})
    assert response.status_code == 422
    pointers = [error["pointer"] for error in response.json()["errors"]]
    assert pointers == [f"#/field{i}" for i in range(20)]


def test_only_the_first_of_thousands_of_unknown_parts_are_listed(client: httpx.Client) -> None:
    response = client.post(GRADE, json={"answers": {f"part{i}": 0 for i in range(12_000)}})
    assert response.status_code == 422
    pointers = [error["pointer"] for error in response.json()["errors"]]
    assert pointers == [f"#/answers/part{i}" for i in range(20)]
