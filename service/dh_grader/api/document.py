"""The OpenAPI document of the HTTP interface, and the files of the page /docs that shows it.

It knows how a document is made that suits client generators; which routes there are is known by
the files that define them, which describe their routes with ``posting`` and ``refusals``.
"""

import json
from collections.abc import Mapping
from http import HTTPStatus
from pathlib import Path
from typing import Any, Final

from fastapi import APIRouter, Response
from pydantic import BaseModel

from dh_grader.api.http import ChunkedResponse, ProblemError
from dh_grader.contract import MEDIA_TYPE, ProblemDocument

# --- The document, with error responses and examples
#
# The examples are stored in files. A test compares them with real responses.


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
_REFERENCE: Final = "#/components/schemas/"
_REF_TEMPLATE: Final = _REFERENCE + "{model}"
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


# --- Convert the schemas of the document to a form that suits client generators
#
# A generated client needs a name for each model, and must know which fields may be absent.


Schema = dict[str, Any]

_NULL: Final = {"type": "null"}
# The mark of a field that answers recorded by an older version do not have.
ADDED_LATER: Final = "x-added-later"

# The names that classes have in the document if they are not their own.
_PUBLIC_NAMES: Final = {
    "Alive": "Liveness",
    "ComponentView": "ListComponent",
    "ExerciseView": "Exercise",
    "FramesAnswer": "Frames",
    "LinkSolution": "LinkTransform",
    "PartAnswer": "PartSolution",
    "PartView": "Part",
    "PreviewAnswer": "Preview",
    "ProblemDocument": "Problem",
    "Ready": "Readiness",
    "Reason": "ProblemReason",
    "Shown": "PrintedMatrix",
    "SymbolView": "ExerciseSymbol",
}
# The names of choices. The models have them as literals, without a name.
_CHOICES: Final = {
    ("angle", "length", "number"): "Quantity",
    ("R", "P"): "JointKind",
    ("auto", "light", "dark"): "Theme",
    ("content", "cells", "rows", "whole"): "Marking",
    ("full", "hints", "verdicts", "score"): "FeedbackLevel",
    ("given", "free"): "FrameFreedom",
    ("moving", "fixed"): "RotationAxes",
    ("radians", "degrees"): "AngleUnit",
    ("space", "body"): "ScrewFrame",
    ("unread", "zero"): "EmptyCells",
    ("open", "after", "none"): "Practice",
    ("never", "after_full", "after_due"): "ShowSolution",
    ("not_open", "open", "late", "closed"): "AssignmentState",
    ("json", "csv", "moodle", "canvas", "xlsx"): "GradebookFormat",
    ("waiting", "sent", "refused"): "ScoreState",
}


def public_name(name: str) -> str:
    """Return the name that a class has in the OpenAPI document."""
    return _PUBLIC_NAMES.get(name, name)


def tidy_schemas(document: Schema) -> None:
    """Give each model and enumeration a named schema, and sort the schemas by name."""
    components = document.setdefault("components", {})
    tidying = _Tidying()
    operations = [each for path in document["paths"].values() for each in path.values()]
    # A schema of requests and responses has the form of requests.
    for operation in operations:
        tidying.visit_request(operation)
    for name, schema in components.get("schemas", {}).items():
        tidying.name(name, schema)
    for operation in operations:
        tidying.visit_responses(operation)
    components["schemas"] = dict(sorted(tidying.named.items()))


class _Tidying:
    def __init__(self) -> None:
        self.named: Schema = {}

    def visit_request(self, operation: Schema) -> None:
        for parameter in operation.get("parameters", ()):
            parameter["schema"] = self.tidied(parameter["schema"])
        for content in operation.get("requestBody", {}).get("content", {}).values():
            content["schema"] = self.tidied(content["schema"], is_sent=False)

    def visit_responses(self, operation: Schema) -> None:
        for message in operation["responses"].values():
            for content in message.get("content", {}).values():
                content["schema"] = self.tidied(content["schema"])

    def name(self, name: str, schema: Schema, *, is_sent: bool = True) -> Schema:
        name = public_name(name)
        if name not in self.named:
            self.named[name] = {}
            self.named[name] = self._body(schema, is_sent=is_sent)
        return {"$ref": f"{_REFERENCE}{name}"}

    def tidied(self, schema: Schema, *, is_sent: bool = True) -> Schema:
        for name, definition in schema.get("$defs", {}).items():
            self.name(name, definition, is_sent=is_sent)
        if "properties" in schema:
            return self.name(schema["title"], schema, is_sent=is_sent)
        if "enum" in schema:
            choice = {"type": schema["type"], "enum": schema["enum"]}
            reference = self.name(_CHOICES[tuple(schema["enum"])], choice)
            return {**reference, **_texts(schema)}
        return self._body(schema, is_sent=is_sent)

    def _body(self, schema: Schema, *, is_sent: bool) -> Schema:
        body = {
            key: value
            for key, value in schema.items()
            if key not in ("$defs", "title", "default", "description", "properties")
        } | _texts(schema)
        if "$ref" in body:
            body["$ref"] = _REFERENCE + public_name(body["$ref"].removeprefix(_REFERENCE))
        for key in ("anyOf", "oneOf", "prefixItems"):
            if key in body:
                body[key] = [self.tidied(each, is_sent=is_sent) for each in body[key]]
        for key in ("items", "additionalProperties"):
            if isinstance(body.get(key), dict):
                body[key] = self.tidied(body[key], is_sent=is_sent)
        if mapping := body.get("discriminator", {}).get("mapping"):
            renamed = {
                value: _REFERENCE + public_name(reference.removeprefix(_REFERENCE))
                for value, reference in mapping.items()
            }
            body["discriminator"] = {**body["discriminator"], "mapping": renamed}
        if "properties" in schema:
            body |= self._fields(schema, is_sent=is_sent)
        return body

    def _fields(self, schema: Schema, *, is_sent: bool) -> Schema:
        # In responses, a field with a default is required, because the service always sends the
        # field. A field with the mark ADDED_LATER is not, because a response that an older version
        # has recorded may lack the field. In requests, a default is written into the description:
        # "default" makes some generators require the field.
        required = list(schema.get("required", ()))
        fields = {}
        for name, field in schema["properties"].items():
            if name not in required:
                field = _without_null(field) if is_sent else _without_null_default(field)
                added_later = field.pop(ADDED_LATER, False)
                if "default" in field:
                    default = json.dumps(field.pop("default"))
                    if is_sent and not added_later:
                        required.append(name)
                    elif not is_sent:
                        field["description"] += f" Default: `{default}`."
            fields[name] = self.tidied(field, is_sent=is_sent)
        in_order = [name for name in fields if name in required]
        return {"properties": fields} | ({"required": in_order} if in_order else {})


def _without_null(field: Schema) -> Schema:
    # The service leaves the field out instead of sending null.
    forms = [form for form in field.get("anyOf", ()) if form != _NULL]
    rest = {key: value for key, value in _without_null_default(field).items() if key != "anyOf"}
    if len(forms) == 1:
        return {**forms[0], **rest}
    return {**rest, "anyOf": forms} if forms else rest


def _without_null_default(field: Schema) -> Schema:
    # In requests, such a field may also be null.
    is_none = field.get("default", ()) is None
    return {key: value for key, value in field.items() if key != "default" or not is_none}


def _texts(schema: Schema) -> Schema:
    if "description" not in schema:
        return {}
    return {"description": schema["description"].replace("``", "`")}


# --- The page /docs, which shows this document
#
# Swagger UI draws the page. The service has a copy of Swagger UI, so the page works without the
# internet.


FOLDER: Final = Path(__file__).parent / "swagger_ui"
SCRIPT: Final = "swagger-ui-5.35.0.js"
STYLE: Final = "swagger-ui-5.35.0.css"
START: Final = "start.js"

# The media type and caching of each file. A file with a version in its name never changes.
_FOR_EVER: Final = "public, max-age=31536000, immutable"
_FILES: Final = {
    SCRIPT: ("text/javascript", _FOR_EVER),
    STYLE: ("text/css", _FOR_EVER),
    START: ("text/javascript", "no-cache"),
}


def reference_routes() -> APIRouter:
    """Return the route that serves the files for the page /docs."""
    router = APIRouter(include_in_schema=False)
    contents = {name: (FOLDER / name).read_bytes() for name in _FILES}

    @router.get("/docs/{name}")
    async def file(name: str) -> Response:
        """Return a script or style of the page."""
        if name not in _FILES:
            raise ProblemError(HTTPStatus.NOT_FOUND, "The page /docs has no such file.")
        media_type, caching = _FILES[name]
        headers = {"Cache-Control": caching}
        return ChunkedResponse(contents[name], headers=headers, media_type=media_type)

    return router
