"""The OpenAPI document of the HTTP interface, with schemas, error responses and examples.

The examples are stored in files. A test compares them with real responses.
"""

import json
from collections.abc import Mapping
from http import HTTPStatus
from pathlib import Path
from typing import Any, Final

from pydantic import BaseModel

from service.api.document.schemas import tidy_schemas
from service.contract.problems import MEDIA_TYPE, ProblemDocument

EXAMPLES = Path(__file__).parent / "examples"

_REFUSALS = {
    HTTPStatus.BAD_REQUEST: "The body is not JSON.",
    HTTPStatus.UNAUTHORIZED: "The key is missing or not valid.",
    HTTPStatus.FORBIDDEN: "It is not allowed: the detail says why.",
    HTTPStatus.NOT_FOUND: "There is nothing with this id.",
    HTTPStatus.CONFLICT: "There is one with this id already.",
    HTTPStatus.REQUEST_ENTITY_TOO_LARGE: "The body is larger than 256 KiB.",
    HTTPStatus.UNSUPPORTED_MEDIA_TYPE: "The body is not JSON and does not claim to be.",
    HTTPStatus.UNPROCESSABLE_ENTITY: "The body does not match its schema, or a part is unknown.",
    HTTPStatus.SERVICE_UNAVAILABLE: "The database does not answer, or did not confirm the attempt.",
}
# The responses of every operation for the statuses that it does not name.
OTHER_FAILURES: Final[dict[int | str, dict[str, Any]]] = {
    "4XX": {"description": "Any other refusal of the request."},
    "5XX": {"description": "The service has failed, or has no room for the request now."},
}
_REFUSED_BODIES: Final = (
    HTTPStatus.BAD_REQUEST,
    HTTPStatus.REQUEST_ENTITY_TOO_LARGE,
    HTTPStatus.UNSUPPORTED_MEDIA_TYPE,
    HTTPStatus.UNPROCESSABLE_ENTITY,
)

# The head of the document, as options of FastAPI.
HEADING: Final[Mapping[str, Any]] = {
    "title": "DH Grader",
    "summary": "Grades Denavit-Hartenberg tables, transforms and forward kinematics.",
    "description": """
Answers in, a report out: row by row and cell by cell, what is right, what is wrong, and why.

A student's mistake is never an error of the request: every answer gets a report. Every other
failure is a `Problem`, sent as `application/problem+json` (RFC 9457).

Messages, kinds of answers and problems have stable codes. New versions may add codes: if your
program does not know a code, show its message. Fields without a value are left out.
""",
    "license_info": {"name": "MIT", "identifier": "MIT"},
    "contact": {"name": "DH Grader authors"},
    # Relative to the address of the document, so that it is right behind a proxy, too.
    "servers": [{"url": ".", "description": "The service that this document comes from."}],
    "openapi_tags": [
        {"name": "grading", "description": "Answers in, a report out. Nothing is recorded."},
        {
            "name": "exercises",
            "description": "The catalogue, and everything that a student sees of an exercise "
            "before answering. Never an answer.",
        },
        {"name": "attempts", "description": "Recorded attempts, if the service has a database."},
        {
            "name": "courses",
            "description": "Courses with learners, assignments and a gradebook, if the service has "
            "a database.",
        },
        {
            "name": "drawing",
            "description": "Coordinates to draw with, so that a page needs no kinematics.",
        },
        {
            "name": "preview",
            "description": "How a text is read, shown while the student is typing.",
        },
        {
            "name": "solutions",
            "description": "Model solutions, for tutors. The service must be started with them on.",
        },
        {
            "name": "tokens",
            "description": "Tokens of learners, for pages in browsers, which must not show a key.",
        },
        {"name": "health", "description": "Checks for a supervisor of the service."},
    ],
}


def example(name: str) -> Any:
    """Return the parsed JSON of an example file."""
    return json.loads((EXAMPLES / f"{name}.json").read_text(encoding="utf-8"))


# The options of a route that needs a key if the service has keys.
MAY_NEED_KEY: Final[dict[str, Any]] = {"security": [{"key": []}, {}]}
_SCHEMES: Final = {
    "key": {
        "type": "http",
        "scheme": "bearer",
        "description": "A key from `dh-grader keys create`, or a token of a learner. A service "
        "without keys needs none.",
    }
}
_REF_TEMPLATE: Final = "#/components/schemas/{model}"
# The schemas of bodies. They are empty until the document is requested.
_BODY_SCHEMAS: Final[dict[type[BaseModel], dict[str, Any]]] = {}


def posting(
    body: type[BaseModel],
    model: type,
    name: str | None,
    *further: HTTPStatus,
    success: HTTPStatus = HTTPStatus.OK,
) -> dict[str, Any]:
    """Return FastAPI's arguments for a route that reads a request body with ``read_body``.

    ``name`` is the prefix of the example files. ``further`` are additional error statuses.
    """
    schema = _BODY_SCHEMAS.setdefault(body, {})
    content: dict[str, Any] = {"schema": schema}
    if name is not None:
        content["example"] = example(f"{name}-request")
    request = {"required": True, "content": {"application/json": content}}
    refused = sorted([*_REFUSED_BODIES, *further])
    responses = answers(model, name and f"{name}-response", *refused, success=success)
    return {"openapi_extra": {"requestBody": request, **MAY_NEED_KEY}, "responses": responses}


def answers(
    model: type, name: str | None, *statuses: HTTPStatus, success: HTTPStatus = HTTPStatus.OK
) -> dict[int | str, dict[str, Any]]:
    """Return FastAPI's ``responses`` of a route, by status.

    The successful response has the class ``model`` and the example ``name``.
    """
    answer: dict[str, Any] = {"model": model}
    if name is not None:
        answer["content"] = {"application/json": {"example": example(name)}}
    return {int(success): answer, **refusals(*statuses)}


def refusals(*statuses: HTTPStatus) -> dict[int | str, dict[str, Any]]:
    """Return the OpenAPI responses for these error statuses."""
    return {int(status): {"description": _REFUSALS[status]} for status in statuses}


def completed(document: dict[str, Any]) -> dict[str, Any]:
    """Complete the OpenAPI document that FastAPI has made, and return it."""
    problem = ProblemDocument.model_json_schema(ref_template=_REF_TEMPLATE)
    for path in document["paths"].values():
        for operation in path.values():
            for status, response in operation["responses"].items():
                if not status.startswith("2"):
                    response["content"] = {MEDIA_TYPE: {"schema": problem}}
            operation["responses"] = dict(sorted(operation["responses"].items()))
    tidy_schemas(document)
    document["components"]["securitySchemes"] = _SCHEMES
    # Operations need no key unless they say so themselves.
    document["security"] = []
    return document


def fill_body_schemas() -> None:
    """Fill in the schemas of all request bodies."""
    # Only the document needs them, so startup does not wait for them.
    for body, schema in _BODY_SCHEMAS.items():
        schema.update(body.model_json_schema(ref_template=_REF_TEMPLATE))
