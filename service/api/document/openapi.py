"""The OpenAPI document: bodies, failures and examples that the service really gives.

The examples are files, not computed at the start; a test holds them against the service's answers.
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
    HTTPStatus.UNAUTHORIZED: "There is no key, or one that is not valid.",
    HTTPStatus.FORBIDDEN: "It is not allowed: the detail says why.",
    HTTPStatus.NOT_FOUND: "There is no such exercise.",
    HTTPStatus.REQUEST_ENTITY_TOO_LARGE: "The body is larger than 256 KiB.",
    HTTPStatus.UNSUPPORTED_MEDIA_TYPE: "The body is not JSON and does not claim to be.",
    HTTPStatus.UNPROCESSABLE_ENTITY: "The body has not the right shape, or names an unknown part.",
    HTTPStatus.SERVICE_UNAVAILABLE: "The database cannot be reached, or did not confirm.",
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

# How the document is headed, as options of FastAPI.
HEADING: Final[Mapping[str, Any]] = {
    "title": "DH Grader",
    "summary": "Grades Denavit-Hartenberg tables, transforms and forward kinematics.",
    "description": """
Answers in, a report out: row by row and cell by cell, what is right, what is wrong, and why.

A student's mistake is never an error of the request: whatever an answer holds, a report comes back.
Every other failure is a `Problem`, sent as `application/problem+json` (RFC 9457).

Messages, kinds of answers and problems have stable codes. New ones come with new versions: show the
message of a code that your program does not know. A field that says nothing is left out.
""",
    "license_info": {"name": "MIT", "identifier": "MIT"},
    "contact": {"name": "DH Grader authors"},
    # Relative to the document's own address, whatever stands in front of it.
    "servers": [{"url": ".", "description": "The service that this document comes from."}],
    "openapi_tags": [
        {"name": "grading", "description": "Answers in, a report out. Nothing is recorded."},
        {
            "name": "exercises",
            "description": "The catalogue, and all that a student sees of an exercise before "
            "answering. Never an answer.",
        },
        {"name": "attempts", "description": "Attempts that are recorded, where a database is set."},
        {
            "name": "drawing",
            "description": "Numbers to draw with, so that no page needs a kinematics of its own.",
        },
        {"name": "preview", "description": "How a text is read, while the student still types."},
        {
            "name": "solutions",
            "description": "The model solutions, for tutors: off unless the service is started "
            "with them on.",
        },
        {
            "name": "tokens",
            "description": "Tokens of learners, for pages that must not show a key.",
        },
        {"name": "health", "description": "What a supervisor asks."},
    ],
}


def example(name: str) -> Any:
    """The JSON value of an example file."""
    return json.loads((EXAMPLES / f"{name}.json").read_text(encoding="utf-8"))


# What a route says of itself that needs a key, where the service knows keys.
MAY_NEED_KEY: Final[dict[str, Any]] = {"security": [{"key": []}, {}]}
_SCHEMES: Final = {
    "key": {
        "type": "http",
        "scheme": "bearer",
        "description": "A key of `dh-grader keys create`, or a token of a learner. A service that "
        "was given no keys needs none.",
    }
}
_REF_TEMPLATE: Final = "#/components/schemas/{model}"
# The schemas of bodies, each empty until a document is asked for.
_BODY_SCHEMAS: Final[dict[type[BaseModel], dict[str, Any]]] = {}


def posting(
    body: type[BaseModel],
    model: type,
    name: str,
    *further: HTTPStatus,
    success: HTTPStatus = HTTPStatus.OK,
) -> dict[str, Any]:
    """Body and responses of a route that reads its body by ``body_as``, as options of the route.

    ``name`` begins the names of its two examples; ``further`` are refusals beside those of a body.
    """
    schema = _BODY_SCHEMAS.setdefault(body, {})
    content = {"schema": schema, "example": example(f"{name}-request")}
    request = {"required": True, "content": {"application/json": content}}
    refused = sorted([*_REFUSED_BODIES, *further])
    responses = answers(model, f"{name}-response", *refused, success=success)
    return {"openapi_extra": {"requestBody": request, **MAY_NEED_KEY}, "responses": responses}


def answers(
    model: type, name: str, *statuses: HTTPStatus, success: HTTPStatus = HTTPStatus.OK
) -> dict[int | str, dict[str, Any]]:
    """The OpenAPI response of success with its schema and example, and those for the refusals."""
    answer = {"model": model, "content": {"application/json": {"example": example(name)}}}
    return {int(success): answer, **refusals(*statuses)}


def refusals(*statuses: HTTPStatus) -> dict[int | str, dict[str, Any]]:
    """Return the OpenAPI responses for the ways in which a request may be refused."""
    return {int(status): {"description": _REFUSALS[status]} for status in statuses}


def completed(document: dict[str, Any]) -> dict[str, Any]:
    """Return FastAPI's document with the content of problems, tidy schemas and the use of keys."""
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


def work_out_schemas() -> None:
    """Fill in the schemas of all bodies; done for the document, so that no start waits for it."""
    for body, schema in _BODY_SCHEMAS.items():
        schema.update(body.model_json_schema(ref_template=_REF_TEMPLATE))
