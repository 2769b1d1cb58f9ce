"""Bodies and failures on the OpenAPI page, with examples that the service really gives.

The examples are files, not computed at the start; a test holds them against the service's answers.
"""

import json
from http import HTTPStatus
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from service.api.problems import MEDIA_TYPE, ProblemDocument

EXAMPLES = Path(__file__).parent / "examples"

_REFUSALS = {
    HTTPStatus.BAD_REQUEST: "The body is not JSON.",
    HTTPStatus.FORBIDDEN: "Model solutions are not shown here.",
    HTTPStatus.NOT_FOUND: "There is no such exercise.",
    HTTPStatus.REQUEST_ENTITY_TOO_LARGE: "The body is larger than 256 KiB.",
    HTTPStatus.UNSUPPORTED_MEDIA_TYPE: "The body is not JSON and does not claim to be.",
    HTTPStatus.UNPROCESSABLE_ENTITY: "The body has not the right shape, or names an unknown part.",
}
_REFUSED_BODIES = _REFUSALS.keys() - {HTTPStatus.FORBIDDEN, HTTPStatus.NOT_FOUND}


def example(name: str) -> Any:
    """The JSON value of an example file."""
    return json.loads((EXAMPLES / f"{name}.json").read_text(encoding="utf-8"))


def posting(body: type[BaseModel], model: type, name: str, *further: HTTPStatus) -> dict[str, Any]:
    """Body and responses of a route that reads its body by ``body_as``, as options of the route.

    ``name`` begins the names of its two examples; ``further`` are refusals beside those of a body.
    """
    content = {"schema": body.model_json_schema(), "example": example(f"{name}-request")}
    request = {"required": True, "content": {"application/json": content}}
    responses = answers(model, f"{name}-response", *sorted([*_REFUSED_BODIES, *further]))
    return {"openapi_extra": {"requestBody": request}, "responses": responses}


def answers(model: type, name: str, *statuses: HTTPStatus) -> dict[int | str, dict[str, Any]]:
    """The OpenAPI response 200 with its schema and example, and those for the refusals."""
    success = {"model": model, "content": {"application/json": {"example": example(name)}}}
    return {200: success, **refusals(*statuses)}


def refusals(*statuses: HTTPStatus) -> dict[int | str, dict[str, Any]]:
    """The OpenAPI responses for the ways in which a request may be refused."""
    return {int(status): _refusal(_REFUSALS[status]) for status in statuses}


def any_other_failure() -> dict[int | str, dict[str, Any]]:
    """The OpenAPI response for every status that a route does not name."""
    return {"default": _refusal("Any other failure.")}


def _refusal(description: str) -> dict[str, Any]:
    schema = {"$ref": f"#/components/schemas/{ProblemDocument.__name__}"}
    return {"description": description, "content": {MEDIA_TYPE: {"schema": schema}}}


def with_problem_schema(document: dict[str, Any]) -> dict[str, Any]:
    """The OpenAPI document with the schemas that ``refusals`` refers to."""
    schema = ProblemDocument.model_json_schema(ref_template="#/components/schemas/{model}")
    schemas = document.setdefault("components", {}).setdefault("schemas", {})
    schemas |= {**schema.pop("$defs", {}), ProblemDocument.__name__: schema}
    return document
