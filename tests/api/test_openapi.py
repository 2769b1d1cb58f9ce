"""The OpenAPI page tells the truth."""

import json
from typing import Any

import httpx
import pytest

from service.api.openapi import EXAMPLES

EXAMPLE_URLS = {
    "grade": "/v1/exercises/stanford-arm/grade",
    "grade-many": "/v1/grade",
    "preview": "/v1/preview",
}
ROUTES = {**EXAMPLE_URLS, "grade": "/v1/exercises/{exercise_id}/grade"}


@pytest.fixture(scope="module")
def document(client: httpx.Client) -> dict[str, Any]:
    result: dict[str, Any] = client.get("/openapi.json").json()
    return result


def without_versions(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: without_versions(each) for name, each in value.items() if name != "version"}
    return [without_versions(each) for each in value] if isinstance(value, list) else value


@pytest.mark.parametrize("name", EXAMPLE_URLS)
def test_the_documented_answer_is_what_the_service_answers(
    client: httpx.Client, document: dict[str, Any], name: str
) -> None:
    operation = document["paths"][ROUTES[name]]["post"]
    request = operation["requestBody"]["content"]["application/json"]["example"]
    documented = operation["responses"]["200"]["content"]["application/json"]["example"]
    answered = client.post(EXAMPLE_URLS[name], json=request).json()
    # A digest of the exercise's file: every change of a statement changes it.
    answered, documented = (without_versions(each) for each in (answered, documented))
    assert documented == answered, (
        f"The answer has changed; {EXAMPLES / name}-response.json should now be:\n"
        + json.dumps(answered, indent=2, ensure_ascii=False)
    )


def test_every_operation_is_described(document: dict[str, Any]) -> None:
    operations = [each for path in document["paths"].values() for each in path.values()]
    assert operations
    assert all(each["description"] for each in operations)


def test_every_refusal_is_documented_as_a_problem(document: dict[str, Any]) -> None:
    responses = [
        response
        for path in document["paths"].values()
        for operation in path.values()
        for status, response in operation["responses"].items()
        if status != "200"
    ]
    assert responses
    reference = {"$ref": "#/components/schemas/ProblemDocument"}
    assert all(
        each["content"] == {"application/problem+json": {"schema": reference}} for each in responses
    )


def test_every_reference_in_the_document_leads_somewhere(document: dict[str, Any]) -> None:
    text = json.dumps(document)
    names = {part.split('"')[0] for part in text.split('"#/components/schemas/')[1:]}
    assert {"Report", "PartReport", "Correction", "Place", "ProblemDocument", "Reason"} <= names
    assert names <= set(document["components"]["schemas"])


def test_the_request_is_described_field_by_field(document: dict[str, Any]) -> None:
    operation = document["paths"][ROUTES["grade"]]["post"]
    schema = operation["requestBody"]["content"]["application/json"]["schema"]
    assert schema["required"] == ["answers"]
    assert set(schema["properties"]) == {"answers", "angle_unit", "feedback", "echo"}
    assert all(field["description"] for field in schema["properties"].values())
